// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <QWidget>

#include "ui_close_ups_panel.h"

#include "sessions/trace/close_ups.h"

namespace boresight::ui {

class ImagePanel;
class ViewState;

/// A magnified part of the canvas's image with its lines. A click shows the position on the canvas.
class CloseUpView : public QWidget {
  Q_OBJECT

 public:
  static constexpr double kScale = 4.0;

  explicit CloseUpView(ImagePanel& image);

  /// Empty: an empty field. Of a rejected pose the found share is shown: the distance of the few
  /// edges found looks as good as a correct pose's.
  void setPlace(const std::optional<sessions::CloseUp>& place, bool rejected = false);
  /// "0.12 px", "13 % found".
  QString figureText() const;
  const std::optional<sessions::CloseUp>& place() const { return place_; }

  QSize sizeHint() const override { return {180, 130}; }
  QSize minimumSizeHint() const override { return {90, 64}; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;

 private:
  QRectF pictureArea() const;
  void paintPicture(QPainter& painter) const;

  ImagePanel& image_;
  std::optional<sessions::CloseUp> place_;
  bool rejected_ = false;
};

/// Four places where the shown refinement's edges can be compared with the image's.
class CloseUpsPanel : public QWidget {
  Q_OBJECT

 public:
  CloseUpsPanel(ImagePanel& image, ViewState& state);

 private:
  void showIteration();

  ViewState& state_;
  std::array<CloseUpView*, 4> views_{};
  Ui::CloseUpsPanel ui_;
};

}  // namespace boresight::ui
