// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QString>
#include <QWidget>

#include "ui/review/onboard_controller.h"

class QFrame;
class QLabel;
class QPushButton;
class QTableWidget;

namespace boresight::ui {

class RunController;

/// Asks for a file and attaches it to the current case.
void askForOnboardRecord(OnboardController& onboard, QWidget* parent);

/// What the onboard record of the current case says, which run the views show, and how the onboard
/// run compares with the one on the ground: the first difference and a table of the iterations.
class OnboardPanel : public QWidget {
  Q_OBJECT

 public:
  OnboardPanel(OnboardController& onboard, ViewState& state, RunController& run,
               QWidget* parent = nullptr);

 protected:
  void changeEvent(QEvent* event) override;

 private:
  QWidget* buildButtons();
  QWidget* buildRecord();
  QWidget* buildComparison();
  void update();
  void updateButtons();
  void showRecord();
  void showComparison();
  void showTable(const sessions::RecordComparison* comparison);

  OnboardController& onboard_;
  ViewState& state_;
  RunController& run_;
  QFrame* banner_ = nullptr;
  QLabel* shown_ = nullptr;
  QPushButton* show_onboard_ = nullptr;
  QPushButton* show_ground_ = nullptr;
  QPushButton* rerun_ = nullptr;
  QPushButton* load_ = nullptr;
  QPushButton* remove_ = nullptr;
  QLabel* sheet_ = nullptr;
  QLabel* remarks_ = nullptr;
  QLabel* verdict_ = nullptr;
  QLabel* first_ = nullptr;
  QTableWidget* table_ = nullptr;
  QLabel* limits_ = nullptr;
};

}  // namespace boresight::ui
