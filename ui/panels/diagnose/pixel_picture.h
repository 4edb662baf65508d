// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QImage>
#include <QRectF>
#include <QWidget>

#include "core/base/image.h"
#include "core/match/whs_types.h"
#include "sessions/trace/score_map.h"

class QLabel;

namespace boresight::ui {

/// A square of `side` pixels about a centre: centre - side/2 ... centre + side/2 - 1.
struct PatchPlace {
  int center_x = 0;
  int center_y = 0;
  int side_px = 0;
};

/// Fixed colours on a dark background in every palette; they also differ in lightness.
namespace patch_colors {
inline constexpr QRgb kGround = qRgb(24, 24, 28);
inline constexpr QRgb kMask = qRgb(74, 74, 86);
inline constexpr QRgb kEdge = qRgb(255, 255, 255);
inline constexpr QRgb kOnlyRendered = qRgb(240, 140, 20);
inline constexpr QRgb kOnlySeen = qRgb(70, 150, 255);
}  // namespace patch_colors

/// Rendered edges over the mask.
QImage templatePicture(const BitImage& edges, const BitImage& mask, const PatchPlace& place);
/// Edges of the image; the background outside it.
QImage seenPicture(const BitImage& test_edges, const PatchPlace& place);
/// The template over the position where it was found: edges of both, of the render alone, and of
/// the image alone (inside the mask, where they count).
QImage agreementPicture(const BitImage& edges, const BitImage& mask, const PatchPlace& rendered,
                        const BitImage& test_edges, const PatchPlace& found);

/// Rectangle of a small picture inside `room`: centred, as large as possible. From three device
/// pixels per pixel on, the scale is an integer.
QRectF pixelPlace(const QSize& picture, const QRectF& room, double device_pixel_ratio);

/// A sample of a colour with its meaning, as HTML for a note.
QString colorText(QRgb color, const QString& meaning);

/// A small picture with its pixels enlarged and crisp, under a title and over a note.
class PixelPicture : public QWidget {
  Q_OBJECT

 public:
  explicit PixelPicture(QWidget* parent = nullptr);

  void setTitle(const QString& title);
  /// A null picture shows the note alone. The note explains the colours or why there is no picture.
  void setPicture(const QImage& picture, const QString& note);
  const QImage& picture() const { return picture_; }
  QString note() const;

  QSize sizeHint() const override { return {170, 200}; }
  QSize minimumSizeHint() const override { return {110, 130}; }

 protected:
  /// Rectangle of the picture.
  QRectF place() const;
  /// Room that a scale takes at the right of the picture.
  virtual double marginRight() const { return 0.0; }
  virtual void paintOver(QPainter& /*painter*/) const {}
  void paintEvent(QPaintEvent* event) override;

 private:
  QLabel* title_;
  QLabel* note_;
  QImage picture_;
};

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

  /// Position on the widget of a pixel's centre in the window.
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
