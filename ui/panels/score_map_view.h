// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QImage>
#include <QRectF>
#include <QWidget>

#include "core/match/whs_types.h"
#include "sessions/run/score_map.h"

namespace boresight::ui {

/// The score map of one template as a heat map with a scale; the predicted place (cross), the peak
/// (circle) and the second peak (square) are marked. Under the cursor: offset and score.
class ScoreMapView : public QWidget {
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
  const QImage& picture() const { return picture_; }
  const QString& note() const { return note_; }

  /// Where a place of the window is on the widget (its pixel's centre).
  QPointF toWidget(double x, double y) const;
  /// What a place of the widget shows, for people; empty beside the map.
  QString textAt(const QPointF& widget) const;

  QSize sizeHint() const override { return {280, 260}; }
  QSize minimumSizeHint() const override { return {180, 170}; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;

 private:
  QRectF mapPlace() const;
  void paintScale(QPainter& painter, const QRectF& beside) const;
  void paintMarks(QPainter& painter) const;
  /// In as many lines as the width asks for; returns how many. A null painter only counts.
  int layOutLegend(QPainter* painter) const;
  QString outsideText() const;

  MapPtr map_;
  Marks marks_;
  QImage picture_;
  QString note_;
};

}  // namespace boresight::ui
