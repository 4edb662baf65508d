// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QWidget>

#include "ui_result_panel.h"

namespace boresight::ui {

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

  void setUpFigure(const Figure& figure);
  static void clear(const Figure& figure, const QString& name);
  void showRun();
  void showAgreement();
  void showQuality();
  void showPose();

  ViewState& state_;
  QualityController& quality_;
  Ui::ResultPanel ui_;
  Figure agreement_;
  Figure precision_;
};

}  // namespace boresight::ui
