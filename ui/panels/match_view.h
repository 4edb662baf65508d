// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QWidget>

#include "sessions/run/match_details.h"
#include "ui/panels/score_mapper.h"

class QHBoxLayout;
class QLabel;

namespace boresight::ui {

class PixelPicture;
class ScoreMapView;

/// The story of one match: its template, what was found, where they agree, the scores around, and
/// the figures.
class MatchView : public QWidget {
  Q_OBJECT

 public:
  explicit MatchView(QWidget* parent = nullptr);

  /// template_index of the request chooses; the iteration must hold it.
  void showMatch(const ScoreMapper::Request& request);
  /// Whether the score map is still to come.
  bool isComputing() const { return computing_; }
  /// A sentence instead.
  void showNote(const QString& note);

 private:
  QLabel* addFigures(QHBoxLayout& row, const QString& name);
  void showPictures(const sessions::EdgeMapTrace& edges, const sessions::IterationTrace& iteration,
                    std::size_t index, const Match* match);
  void showFigures(const sessions::IterationTrace& iteration,
                   const sessions::MatchDetails& details);
  void showMap(const ScoreMapper::MapPtr& map);

  ScoreMapper mapper_;
  bool computing_ = false;
  ScoreMapper::Request shown_;
  PixelPicture* template_ = nullptr;
  PixelPicture* found_ = nullptr;
  PixelPicture* agreement_ = nullptr;
  ScoreMapView* map_ = nullptr;
  QLabel* places_ = nullptr;
  QLabel* scores_ = nullptr;
};

}  // namespace boresight::ui
