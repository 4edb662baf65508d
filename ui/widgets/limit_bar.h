// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QWidget>

namespace boresight::ui {

/// A figure against its limit, as a bar with the limit as a tick. The numbers are next to it.
class LimitBar : public QWidget {
  Q_OBJECT

 public:
  using QWidget::QWidget;

  /// `passed` chooses the colour; the bar ends at twice the limit at least.
  void setFigure(double value, double limit, bool passed);
  void clear();
  QSize sizeHint() const override { return {120, 8}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  double value_ = 0.0;
  double limit_ = 0.0;
  bool passed_ = false;
};

}  // namespace boresight::ui
