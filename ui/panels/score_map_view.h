// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/match/whs_types.h"
#include "sessions/run/score_map.h"
#include "ui/panels/pixel_picture.h"

namespace boresight::ui {

/// The score map of one template as a heat map with a scale; the predicted place (cross), the peak
/// (circle) and the second peak (square) are marked. The tool tip shows offset and score.
class ScoreMapView : public PixelPicture {
  Q_OBJECT

 public:
  using MapPtr = std::shared_ptr<const sessions::ScoreMap>;

  struct Marks {
    int predicted_x = 0, predicted_y = 0;  ///< at the level; may lie outside the window
    WhsPeak peak;
  };

  explicit ScoreMapView(QWidget* parent = nullptr);

  void setMap(MapPtr map, const Marks& marks);
  /// Shows a sentence instead of a map.
  void setNote(const QString& note);
  const MapPtr& map() const { return map_; }

  /// Where a place of the window is on the widget (its pixel's centre).
  QPointF toWidget(double x, double y) const;
  /// Offset and score at a place of the widget; empty outside the map.
  QString textAt(const QPointF& widget) const;

  QSize sizeHint() const override { return {280, 260}; }
  QSize minimumSizeHint() const override { return {180, 170}; }

 protected:
  double marginRight() const override;
  void paintOver(QPainter& painter) const override;
  bool event(QEvent* event) override;

 private:
  void paintScale(QPainter& painter) const;
  QString legend() const;

  MapPtr map_;
  Marks marks_;
};

}  // namespace boresight::ui
