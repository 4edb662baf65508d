// SPDX-License-Identifier: Apache-2.0
// Pictures of a template and of the place where it was found, one pixel per pixel of the level.
#pragma once

#include <QColor>
#include <QImage>
#include <QRectF>
#include <QWidget>

#include "core/base/image.h"

class QLabel;

namespace boresight::ui {

/// A square of `side` pixels about a centre: centre - side/2 ... centre + side/2 - 1.
struct PatchPlace {
  int center_x = 0;
  int center_y = 0;
  int side_px = 0;
};

/// Fixed, on a dark ground whatever the palette: they differ in lightness as well as in colour.
namespace patch_colors {
inline constexpr QRgb kGround = qRgb(24, 24, 28);
inline constexpr QRgb kMask = qRgb(74, 74, 86);
inline constexpr QRgb kEdge = qRgb(255, 255, 255);
inline constexpr QRgb kOnlyRendered = qRgb(240, 140, 20);
inline constexpr QRgb kOnlySeen = qRgb(70, 150, 255);
}  // namespace patch_colors

/// Rendered edges over the mask.
QImage templatePicture(const BitImage& edges, const BitImage& mask, const PatchPlace& place);
/// Edges of the image; what lies outside it is ground.
QImage seenPicture(const BitImage& test_edges, const PatchPlace& place);
/// The template laid over where it was found: edges of both, of the render alone, and of the image
/// alone (inside the mask, where they count).
QImage agreementPicture(const BitImage& edges, const BitImage& mask, const PatchPlace& rendered,
                        const BitImage& test_edges, const PatchPlace& found);

/// Where a small picture is drawn inside `room`: centred, as large as fits; from three device
/// pixels a pixel on every one is a square of the same whole number of them.
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
  /// Where the picture is drawn.
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

}  // namespace boresight::ui
