// SPDX-License-Identifier: Apache-2.0
// What can be run, and how.
#include <QAction>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QToolBar>

#include "ui/review/onboard_panel.h"
#include "ui/run/run_controller.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/window/case_controller.h"
#include "ui/window/window_menus.h"

namespace boresight::ui {

using sessions::StepUntil;

void WindowMenus::buildRunMenu() {
  QMenu* menu = window_.menuBar()->addMenu(tr("&Run"));
  run_to_end_ = action(tr("&Run"), Qt::Key_F5, tr("Run to the end"));
  step_iteration_ = action(tr("Step an &iteration"), Qt::Key_F6, tr("Run one iteration"));
  step_stage_ = action(tr("Step a s&tage"), Qt::Key_F7,
                       tr("Run one stage: render, templates, match, pose or refinement"));
  stop_ = action(tr("&Stop"), Qt::Key_F8, tr("Stop; the run can go on from here"));
  reset_ = action(tr("R&eset"), QKeySequence(QStringLiteral("Ctrl+R")),
                  tr("Drop the run and begin anew"));
  run_all_ = action(tr("Run &all cases"), QKeySequence(QStringLiteral("Ctrl+F5")),
                    tr("Run every case to its end"));
  run_together_ = action(tr("Run with the other &views"), QKeySequence(QStringLiteral("F4")), {});
  rerun_ = action(tr("Re-run &from here"), QKeySequence(QStringLiteral("Shift+F5")),
                  tr("Keep the iterations before the shown one and compute it and those after it "
                     "anew, with the options as they are now"));
  CaseController& cases = parts_.cases;
  connect(rerun_, &QAction::triggered, this,
          [this] { parts_.cases.rerunFrom(parts_.state.cursor().iteration); });
  connect(&parts_.state, &ViewState::cursorChanged, this, &WindowMenus::update);
  connect(run_to_end_, &QAction::triggered, this, [&cases] { cases.advance(StepUntil::kEnd); });
  connect(step_iteration_, &QAction::triggered, this,
          [&cases] { cases.advance(StepUntil::kIteration); });
  connect(step_stage_, &QAction::triggered, this, [&cases] { cases.advance(StepUntil::kStage); });
  connect(run_together_, &QAction::triggered, &cases, &CaseController::runTogether);
  connect(stop_, &QAction::triggered, &cases, &CaseController::stop);
  connect(reset_, &QAction::triggered, &cases, &CaseController::reset);
  connect(run_all_, &QAction::triggered, this, [this] {
    QStringList ids;
    for (const auto& one : parts_.document.session().cases) ids << QString::fromStdString(one->id);
    parts_.cases.runAll(ids);
  });
  QToolBar* bar = window_.addToolBar(tr("Run"));
  bar->setObjectName(QStringLiteral("runBar"));
  bar->setToolButtonStyle(Qt::ToolButtonTextOnly);
  for (QAction* each :
       {run_to_end_, run_together_, step_iteration_, step_stage_, rerun_, stop_, reset_}) {
    menu->addAction(each);
    bar->addAction(each);
  }
  menu->addSeparator();
  menu->addAction(run_all_);
  buildOnboardMenu(*menu->addMenu(tr("&Onboard record")));
}

void WindowMenus::buildOnboardMenu(QMenu& menu) {
  load_record_ = action(tr("&Load onboard record..."), QKeySequence(QStringLiteral("Ctrl+Shift+O")),
                        tr("Attach the record that the flight side sent down to the shown case"));
  show_other_run_ = action(tr("&Onboard or ground run"), QKeySequence(QStringLiteral("Ctrl+B")),
                           tr("Show the run of the onboard record in every view, or that on the "
                              "ground again"));
  rerun_record_ = action(tr("&Re-run on the ground"), QKeySequence(QStringLiteral("Ctrl+Shift+F5")),
                         tr("Run the case here by the options of the onboard record"));
  first_difference_ =
      action(tr("Go to the first &difference"), QKeySequence(QStringLiteral("Ctrl+Shift+B")),
             tr("Show where the onboard run and that on the ground differ first"));
  OnboardController& onboard = parts_.onboard;
  connect(load_record_, &QAction::triggered, this,
          [this] { askForOnboardRecord(parts_.onboard, &window_); });
  connect(show_other_run_, &QAction::triggered, this,
          [&onboard] { onboard.showsOnboard() ? onboard.showGround() : onboard.showOnboard(); });
  connect(rerun_record_, &QAction::triggered, &onboard, &OnboardController::rerun);
  connect(first_difference_, &QAction::triggered, &onboard,
          &OnboardController::goToFirstDifference);
  connect(&onboard, &OnboardController::changed, this, &WindowMenus::update);
  for (QAction* each : {load_record_, show_other_run_, rerun_record_, first_difference_})
    menu.addAction(each);
}

/// Where it cannot be asked for, the tip says why.
void WindowMenus::updateTogether(bool idle) {
  const QString alone = parts_.cases.whyAlone();
  const QString tip =
      tr("Find one pose from this image and those of its rig; each case gets the run, and this "
         "one's seed and uncertainty hold");
  run_together_->setEnabled(idle && alone.isEmpty());
  run_together_->setStatusTip(alone.isEmpty() ? tip : alone);
  run_together_->setToolTip(QStringLiteral("%1 (%2)").arg(
      alone.isEmpty() ? tip : alone, run_together_->shortcut().toString(QKeySequence::NativeText)));
}

}  // namespace boresight::ui
