// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QWidget>

#include "sessions/io/images/image_file.h"

namespace boresight::ui {

class DisplayImage;

/// Histogram of gray levels, and below it black and white of the display as handles to drag.
class LevelsHistogram : public QWidget {
  Q_OBJECT

 public:
  explicit LevelsHistogram(DisplayImage& display);

  QSize sizeHint() const override { return {240, 96}; }
  /// Position of a gray level on the widget.
  double xOf(int level) const;

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;

 private:
  enum class Handle { kNone, kBlack, kWhite };

  int largest() const;
  int levelAt(double x) const;
  void drag(double x);

  DisplayImage& display_;
  Handle dragged_ = Handle::kNone;
};

}  // namespace boresight::ui
