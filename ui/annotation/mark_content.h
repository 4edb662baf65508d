// SPDX-License-Identifier: Apache-2.0
// What marks look like as layers of the image.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <QColor>

#include "sessions/annotation/edge_band.h"
#include "sessions/annotation/landmarks.h"
#include "sessions/annotation/marks_on_image.h"
#include "ui/views/layer.h"

namespace boresight::ui {

inline const QColor kChosenMark(255, 255, 255);
inline const QColor kDisabledMark(175, 175, 175);
inline const QColor kOutlierMark(255, 130, 60);

/// What the signs of marks say besides the marks.
struct MarkLook {
  std::string selected;
  std::map<std::string, double> outliers;  ///< normalized residual by id
  Camera camera;
  Pose camera_from_station;  ///< predicts what has no place in the image yet
};

/// State of a mark as its sign shows it.
struct MarkState {
  bool complete = true;
  bool enabled = true;
  bool chosen = false;
  double outlier = 0.0;  ///< residual in sigmas where it stands out, else 0
};
/// "p1", "p1 ?" (incomplete), "p1 (off)", "p1 ! 4.2 sigma".
QString markLabel(const std::string& id, const MarkState& state);
/// Colour of a mark's sign; invalid: the layer's own.
QColor markColor(const MarkState& state);
/// The sign of a mark, with a triangle round an outlier and a ring round the chosen mark.
std::vector<Mark> withState(Mark sign, const MarkState& state);

/// One sign for each mark, its item being the index of the point, or the number of points plus the
/// index of the line. A complete pair is a target, a locked one a square, one without its station
/// side a circle with "?", one without its place in the image a dashed diamond where the pose
/// predicts it, one that is off is struck through, one that stands out has a triangle round it.
std::vector<Mark> markSigns(const sessions::Marks& marks, const MarkLook& look);

/// From where the pose puts each mark to where it was marked, magnified. `stale`: dashed.
std::vector<Mark> residualSigns(const std::vector<sessions::MarkVector>& vectors,
                                const MarkLook& look, double magnification, bool stale);

std::vector<Mark> proposalSigns(const std::vector<sessions::Proposal>& proposals);

/// Strips along the edges.
std::vector<Mark> bandSigns(const std::vector<sessions::BandPiece>& band);

/// The mark that an item of `markSigns` is of, or nothing.
std::string idOfSign(const sessions::Marks& marks, int item);

}  // namespace boresight::ui
