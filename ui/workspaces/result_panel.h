// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QWidget>

class QHBoxLayout;
class QLabel;
class QTableWidget;

namespace boresight::ui {

class ViewState;

/// A figure against its limit, as a bar with the limit as a tick. The numbers stand next to it.
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

/// What came out of the shown run: agreement of the edges, sigma, and the pose.
class ResultPanel : public QWidget {
  Q_OBJECT

 public:
  explicit ResultPanel(ViewState& state, QWidget* parent = nullptr);

 private:
  struct Figure {
    QLabel* name = nullptr;
    QLabel* value = nullptr;
    LimitBar* bar = nullptr;
    QLabel* needed = nullptr;
  };

  Figure addFigure(QHBoxLayout& row);
  void showRun();
  void showAgreement();
  void showSigma();
  void showPose();

  ViewState& state_;
  Figure agreement_;
  Figure sigma_;
  QTableWidget* pose_ = nullptr;
};

}  // namespace boresight::ui
