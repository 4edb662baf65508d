// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QWidget>

class QHBoxLayout;
class QLabel;
class QTableWidget;

namespace boresight::ui {

class QualityController;
class ViewState;

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

/// Result of the shown run: agreement of the edges, quality against the requirement, and the pose.
/// A rejected pose is labelled as such and cannot be copied from here.
class ResultPanel : public QWidget {
  Q_OBJECT

 public:
  ResultPanel(ViewState& state, QualityController& quality, QWidget* parent = nullptr);

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
  void showQuality();
  void showPose();

  ViewState& state_;
  QualityController& quality_;
  Figure agreement_;
  Figure precision_;
  QLabel* rejected_ = nullptr;
  QTableWidget* pose_ = nullptr;
};

}  // namespace boresight::ui
