// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QScrollArea>

namespace boresight::ui {

/// A panel that scrolls in a low dock. Docks as high as their panels squeeze each other, or make
/// the window larger than the screen.
class PanelArea final : public QScrollArea {
  Q_OBJECT

 public:
  /// Takes ownership of the panel.
  explicit PanelArea(QWidget* panel);

  QSize sizeHint() const override { return widget()->sizeHint(); }
  /// As wide as the panel must be, and low.
  QSize minimumSizeHint() const override;

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  QSize leastOfPanel() const;
  int leastHeight(int width) const;
  void followPanel();

  bool scrolls_ = false;
};

}  // namespace boresight::ui
