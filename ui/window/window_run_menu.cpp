// SPDX-License-Identifier: Apache-2.0
// What can be run, and how.
#include <QtWidgets>

#include "ui/panels/widgets.h"
#include "ui/review/onboard_panel.h"
#include "ui/run/run_controller.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/window/case_controller.h"
#include "ui/window/window_menus.h"

namespace boresight::ui {

using sessions::StepUntil;

void WindowMenus::buildRunMenu() {
  QMenu& menu = *window_.menuBar()->addMenu(tr("&Run"));
  CaseController* cases = &parts_.cases;
  const auto advance = [cases](StepUntil until) {
    return [cases, until] { cases->advance(until); };
  };
  run_to_end_ = addAction(menu, tr("&Run"), Qt::Key_F5, tr("Run to the end"), cases,
                          advance(StepUntil::kEnd));
  run_together_ = addAction(menu, tr("Run with the other &views"), keys("F4"), {}, cases,
                            &CaseController::runTogether);
  step_iteration_ = addAction(menu, tr("Step an &iteration"), Qt::Key_F6, tr("Run one iteration"),
                              cases, advance(StepUntil::kIteration));
  step_stage_ = addAction(menu, tr("Step a s&tage"), Qt::Key_F7,
                          tr("Run one stage: render, templates, match, pose or refinement"), cases,
                          advance(StepUntil::kStage));
  rerun_ = addAction(menu, tr("Re-run &from here"), keys("Shift+F5"),
                     tr("Keep the iterations before the shown one and compute it and those after "
                        "it anew, with the options as they are now"),
                     cases, [this] { parts_.cases.rerunFrom(parts_.state.cursor().iteration); });
  stop_ = addAction(menu, tr("&Stop"), Qt::Key_F8, tr("Stop; the run can go on from here"), cases,
                    &CaseController::stop);
  reset_ = addAction(menu, tr("R&eset"), keys("Ctrl+R"), tr("Drop the run and begin anew"), cases,
                     &CaseController::reset);
  QToolBar* bar = window_.addToolBar(tr("Run"));
  bar->setObjectName(QStringLiteral("runBar"));
  bar->setToolButtonStyle(Qt::ToolButtonTextOnly);
  bar->addActions(menu.actions());
  menu.addSeparator();
  run_all_ = addAction(menu, tr("Run &all cases"), keys("Ctrl+F5"), tr("Run every case to its end"),
                       this, [this] {
                         QStringList ids;
                         for (const auto& one : parts_.document.session().cases)
                           ids << QString::fromStdString(one->id);
                         parts_.cases.runAll(ids);
                       });
  parts_.state.onChange(ViewChange::kCursor, this, &WindowMenus::update);
  buildOnboardMenu(*menu.addMenu(tr("&Onboard record")));
}

void WindowMenus::buildOnboardMenu(QMenu& menu) {
  OnboardController* onboard = &parts_.onboard;
  load_record_ = addAction(menu, tr("&Load onboard record..."), keys("Ctrl+Shift+O"),
                           tr("Attach the record that the flight side sent down to the shown case"),
                           this, [this] { askForOnboardRecord(parts_.onboard, &window_); });
  show_other_run_ = addAction(
      menu, tr("&Onboard or ground run"), keys("Ctrl+B"),
      tr("Show the run of the onboard record in every view, or that on the ground again"), onboard,
      [onboard] { onboard->showsOnboard() ? onboard->showGround() : onboard->showOnboard(); });
  rerun_record_ = addAction(menu, tr("&Re-run on the ground"), keys("Ctrl+Shift+F5"),
                            tr("Run the case here by the options of the onboard record"), onboard,
                            &OnboardController::rerun);
  first_difference_ =
      addAction(menu, tr("Go to the first &difference"), keys("Ctrl+Shift+B"),
                tr("Show where the onboard run and that on the ground differ first"), onboard,
                &OnboardController::goToFirstDifference);
  connect(onboard, &OnboardController::changed, this, &WindowMenus::update);
}

/// Where it cannot be asked for, the tip says why.
void WindowMenus::updateTogether(bool idle) {
  const QString alone = parts_.cases.whyAlone();
  const QString tip =
      tr("Find one pose from this image and those of its rig; each case gets the run, and this "
         "one's seed and uncertainty hold");
  run_together_->setEnabled(idle && alone.isEmpty());
  setTip(*run_together_, alone.isEmpty() ? tip : alone);
}

}  // namespace boresight::ui
