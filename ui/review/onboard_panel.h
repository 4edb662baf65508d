// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QWidget>

#include "ui_onboard_panel.h"

#include "ui/review/onboard_controller.h"

namespace boresight::ui {

class RunController;

/// Asks for a file and attaches it to the current case.
void askForOnboardRecord(OnboardController& onboard, QWidget* parent);

/// Content of the current case's onboard record, choice of the run that the views show, and
/// comparison of the onboard run with the ground's: first difference and a table of the iterations.
class OnboardPanel : public QWidget {
  Q_OBJECT

 public:
  OnboardPanel(OnboardController& onboard, ViewState& state, RunController& run);

 private:
  void update();
  void updateButtons();
  void showRecord();
  void showComparison();
  void showTable(const sessions::RecordComparison* comparison);

  OnboardController& onboard_;
  ViewState& state_;
  RunController& run_;
  Ui::OnboardPanel ui_;
};

}  // namespace boresight::ui
