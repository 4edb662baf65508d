// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include <QImage>
#include <QPointF>
#include <QWidget>

#include "sessions/io/images/image_file.h"
#include "ui/annotation/annotation_aim.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {

/// The picture of a loupe: every screen pixel of `size` has the gray value of the image pixel at
/// its centre, stretched between the darkest and the brightest shown, a few clipped. Dark outside
/// the image. `transform` is in coordinates of `device_pixel_ratio` screen pixels. For display
/// only.
QImage loupePicture(const sessions::ImageSamples& samples, const ViewTransform& transform,
                    const QSize& size, double device_pixel_ratio);

/// The 8-bit values of an image as samples, for images whose file has not been read.
sessions::ImageSamples samplesOf(const QImage& gray);

/// Side of a square loupe: a share of the view's shorter side, with limits, in coordinates.
struct LoupeSize {
  double share;
  double least;
  double most;
};

/// Moves a loupe to the upper corner of its parent away from `place`; `left`: whether it is in the
/// left corner.
void putLoupeAside(QWidget& loupe, const LoupeSize& size, const QPoint& place, bool& left);

/// The loupe's frame, and a text at its foot.
void paintLoupeFoot(QPainter& painter, const QWidget& loupe, const QString& text);

class ImageView;

/// A magnified part of the image in a corner of the image view away from the pointer: image pixels
/// as squares, stretched in contrast, under a cross at a sub-pixel position. Annotations and
/// rendered edges are drawn as in the view. The magnification counts screen pixels per image pixel;
/// Ctrl+wheel over the view changes it.
class Loupe : public QWidget {
  Q_OBJECT

 public:
  static constexpr double kLeastMagnification = 4.0;
  static constexpr double kMostMagnification = 64.0;
  static constexpr double kStep = 1.4142135623730951;  ///< of magnifications

  explicit Loupe(ImageView& view);

  /// nullptr: there is no image.
  void setSamples(std::shared_ptr<const sessions::ImageSamples> samples);
  /// At least twice the magnification of the view.
  double magnification() const;
  void setMagnification(double magnification);
  bool isSwitchedOn() const { return on_; }
  void setSwitchedOn(bool on);

  /// Shows a position (px) under the cross; `aim` is the target of a click there. Empty: the loupe
  /// hides.
  void lookAt(const std::optional<QPointF>& pixel, const AnnotationAim& aim);
  const std::optional<QPointF>& place() const { return pixel_; }
  /// Between image pixels and this widget's coordinates.
  ViewTransform transform() const;

  bool eventFilter(QObject* watched, QEvent* event) override;

 Q_SIGNALS:
  void changed();  ///< its magnification, or whether it is on

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void showOrHide();
  void putAside();
  void paintEdges(QPainter& painter, const ViewTransform& transform) const;
  void paintMarks(QPainter& painter, const ViewTransform& transform) const;
  void paintText(QPainter& painter) const;

  ImageView& view_;
  std::shared_ptr<const sessions::ImageSamples> samples_;
  double magnification_ = 8.0;
  bool on_ = true;
  std::optional<QPointF> pixel_;
  AnnotationAim aim_;
  bool left_ = false;  ///< in the left corner
};

}  // namespace boresight::ui
