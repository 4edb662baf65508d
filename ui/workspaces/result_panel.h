// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QWidget>

class QHBoxLayout;
class QLabel;
class QTableWidget;

namespace boresight::ui {

class LimitBar;
class QualityController;
class ViewState;

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
  QLabel* heading_ = nullptr;
  QTableWidget* pose_ = nullptr;
};

}  // namespace boresight::ui
