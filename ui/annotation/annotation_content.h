// SPDX-License-Identifier: Apache-2.0
// Appearance of annotations as layers of the image.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <QColor>

#include "sessions/annotation/annotations_on_image.h"
#include "sessions/annotation/edge_band.h"
#include "sessions/annotation/landmarks.h"
#include "ui/views/layer.h"

namespace boresight::ui {

inline const QColor kChosenAnnotation(255, 255, 255);
inline const QColor kDisabledAnnotation(175, 175, 175);
inline const QColor kOutlierAnnotation(kBadMarkLine.color);

/// State that the signs of annotations show.
struct AnnotationLook {
  std::string selected;
  std::map<std::string, double> outliers;  ///< normalized residual by id
  Camera camera;
  /// Predicts the position of annotations without image side. Empty: these are not drawn.
  std::optional<Pose> camera_from_station = {};
};

/// State of an annotation that its sign shows.
struct AnnotationState {
  bool complete = true;
  bool enabled = true;
  bool chosen = false;
  double outlier = 0.0;  ///< residual in sigmas if it is an outlier, else 0
};
/// State of a point or a line. `outliers` holds normalized residuals by id.
template <class Pair>
AnnotationState stateOf(const Pair& pair, const std::string& selected,
                        const std::map<std::string, double>& outliers) {
  const auto outlier = pair.used() ? outliers.find(pair.id) : outliers.end();
  return {pair.complete(), pair.enabled, pair.id == selected,
          outlier == outliers.end() ? 0.0 : outlier->second};
}
/// "p1", "p1 ?" (incomplete), "p1 (off)", "p1 ! 4.2 sigma".
QString annotationLabel(const std::string& id, const AnnotationState& state);
/// Colour of an annotation's sign; invalid: the layer's own.
QColor annotationColor(const AnnotationState& state);
/// The sign of an annotation, with a triangle round an outlier and a ring round the chosen
/// annotation.
std::vector<Mark> withState(Mark sign, const AnnotationState& state);

/// One sign for each annotation, its item being the index of the point, or the number of points
/// plus the index of the line. A complete pair is a target, a locked pair a square. A pair without
/// its station side is a circle with "?"; without its image side it is a dashed diamond at the
/// predicted position. Disabled pairs are struck through; outliers have a triangle round them.
std::vector<Mark> annotationSigns(const sessions::Annotations& annotations,
                                  const AnnotationLook& look);

/// Lines from each annotation's projection to its annotated position, magnified. `stale`: dashed.
std::vector<Mark> residualSigns(const std::vector<sessions::AnnotationVector>& vectors,
                                const AnnotationLook& look, double magnification, bool stale);

std::vector<Mark> proposalSigns(const std::vector<sessions::Proposal>& proposals);

/// Strips along the edges.
std::vector<Mark> bandSigns(const std::vector<sessions::BandPiece>& band);

/// The id of the annotation of an item of annotationSigns(), or empty.
std::string idOfSign(const sessions::Annotations& annotations, int item);

}  // namespace boresight::ui
