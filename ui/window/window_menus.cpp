// SPDX-License-Identifier: Apache-2.0
#include "ui/window/window_menus.h"

#include <algorithm>
#include <utility>

#include <QtWidgets>

#include "sessions/version.h"
#include "ui/annotation/annotation_panel.h"
#include "ui/annotation/annotation_tool.h"
#include "ui/annotation/image_annotation.h"
#include "ui/annotation/loupe.h"
#include "ui/manual/manual_window.h"
#include "ui/models/text.h"
#include "ui/panels/annotate/mask_panel.h"
#include "ui/panels/diagnose/iterations_panel.h"
#include "ui/panels/run/nudge_gizmo.h"
#include "ui/panels/run/pose_panel.h"
#include "ui/review/onboard_panel.h"
#include "ui/review/pose_export.h"
#include "ui/review/queue_panel.h"
#include "ui/run/run_controller.h"
#include "ui/run/sequence_runner.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/style/icons.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/views/mask_editor.h"
#include "ui/views/measure_tool.h"
#include "ui/widgets/command_palette.h"
#include "ui/widgets/widgets.h"
#include "ui/window/case_controller.h"
#include "ui/window/change_input.h"
#include "ui/window/log_hint.h"
#include "ui/window/sequence_dialog.h"
#include "ui/window/session_files.h"
#include "ui/window/shortcut_sheet.h"
#include "ui/window/window_docks.h"
#include "ui/workspaces/run_bar.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

constexpr double kBrushStep = 1.25;

template <class Receiver, class Function>
void on(QAction* action, Receiver* receiver, Function function) {
  QObject::connect(action, &QAction::triggered, receiver, function);
}

/// A switch of something that reports its own changes.
template <class Owner>
void connectSwitch(QAction* action, Owner* owner, bool (Owner::*isOn)() const,
                   void (Owner::*set)(bool), void (Owner::*changed)()) {
  action->setChecked((owner->*isOn)());
  QObject::connect(action, &QAction::toggled, owner, set);
  QObject::connect(owner, changed, action, [=] { action->setChecked((owner->*isOn)()); });
}

}  // namespace

WindowMenus::WindowMenus(QMainWindow& window, WindowParts& parts, const WindowDocks& docks,
                         Workspaces& workspaces, RunBar& run_bar, SessionFiles& files)
    : QObject(&window),
      window_(window),
      parts_(parts),
      docks_(docks),
      workspaces_(workspaces),
      run_bar_(run_bar),
      files_(files) {
  ui_.setupUi(&window);
  connectFile();
  connectEdit();
  connectAnnotate();
  connectImageAnnotation();
  connectRun();
  connectOnboard();
  fillGoMenu();
  fillWorkspaces();
  connectView();
  connectQueue();
  fillLayersMenu();
  connectHelp();
  window_.installEventFilter(this);
  connect(&workspaces_, &Workspaces::changed, this, &WindowMenus::endTools);
  for (QAction* each : window_.findChildren<QAction*>())
    if (!each->statusTip().isEmpty()) setTip(*each, each->statusTip());
}

/// Tools that edit end with their workspace; annotating lives in Annotate.
void WindowMenus::endTools(Workspace now) {
  if (std::exchange(workspace_, now) == now) return;
  CanvasTool* tool = docks_.image.view().tool();
  const bool annotates = parts_.annotation.mode() != PlaceMode::kOff;
  if (tool && tool != &docks_.image.measure() && !(annotates && now == Workspace::kAnnotate))
    tool->leave();
}

/// Escape that no panel takes ends the tool, wherever the focus is.
bool WindowMenus::eventFilter(QObject* watched, QEvent* event) {
  const bool override = event->type() == QEvent::ShortcutOverride;
  if (!(override || event->type() == QEvent::KeyPress) ||
      static_cast<QKeyEvent*>(event)->key() != Qt::Key_Escape)
    return QObject::eventFilter(watched, event);
  CanvasTool* tool = docks_.image.view().tool();
  if (!tool) return false;
  if (override)
    event->accept();  // before it stops jobs
  else
    tool->escape();
  return true;
}

void WindowMenus::connectFile() {
  on(ui_.newFromFiles, &files_, &SessionFiles::askForFiles);
  on(ui_.openSession, &files_, &SessionFiles::askForSession);
  on(ui_.closeSession, &files_, &SessionFiles::closeSession);
  connect(ui_.recentMenu, &QMenu::aboutToShow, this, &WindowMenus::showRecent);
  on(ui_.save, &files_, &SessionFiles::save);
  on(ui_.saveAs, &files_, &SessionFiles::saveAs);
  on(ui_.quit, &window_, &QWidget::close);
  poses_ = new PoseExport(window_, parts_.document, parts_.state, parts_.exports);
  poses_->addTo(*ui_.exportMenu);
  connect(poses_, &PoseExport::noted, this,
          [this](const QString& message) { window_.statusBar()->showMessage(message); });
}

void WindowMenus::connectEdit() {
  on(ui_.undo, this, &WindowMenus::undo);
  on(ui_.redo, this, &WindowMenus::redo);
  ui_.redo->setShortcut(QKeySequence::Redo);  // desktops differ
  ui_.editMenu->addAction(&docks_.gizmo.action());
  const auto fill_change = [this] {
    ui_.changeMenu->clear();
    addChangeInput(*ui_.changeMenu, parts_, window_, parts_.cases.caseId());
  };
  parts_.state.onChange(ViewChange::kOtherCase, this, fill_change);
  fill_change();
  on(ui_.findCommand, this, [this] {
    CommandPalette palette(*ui_.menuBar, &window_);
    palette.exec();
  });
  connect(&parts_.document, &Document::aboutToChange, &docks_.poses.nudgeController(),
          &NudgeController::finishGesture);
  connect(&parts_.document, &Document::changed, this, [this] {
    // An undo is no longer the last change.
    if (window_.statusBar()->currentMessage() == shown_change_) window_.statusBar()->clearMessage();
  });
  MaskEditor* editor = &docks_.mask_editor;
  const auto toggle = [editor](MaskTool tool) {
    return [editor, tool] { editor->setTool(editor->tool() == tool ? MaskTool::kNone : tool); };
  };
  on(ui_.maskBrush, editor, toggle(MaskTool::kBrush));
  on(ui_.maskPolygon, editor, toggle(MaskTool::kPolygon));
  on(ui_.maskErase, editor, [editor] { editor->setErase(!editor->erases()); });
  on(ui_.smallerBrush, editor, [editor] { editor->setRadius(editor->radius_px() / kBrushStep); });
  on(ui_.largerBrush, editor, [editor] { editor->setRadius(editor->radius_px() * kBrushStep); });
  on(ui_.maskSaturated, &docks_.mask, &MaskPanel::askForSaturated);
  on(ui_.clearMask, &docks_.mask, &MaskPanel::clearAll);
}

void WindowMenus::connectMode(QAction* action, PlaceMode mode) {
  AnnotationController& annotation = parts_.annotation;
  on(action, this, [this, action, mode, &annotation](bool checked) {
    parts_.annotation.setMode(checked ? mode : PlaceMode::kOff);
    action->setChecked(annotation.mode() == mode);
  });
  connect(&annotation, &AnnotationController::modeChanged, action, [=, this, &annotation] {
    action->setChecked(annotation.mode() == mode);
    if (action->isChecked()) workspaces_.reveal(QStringLiteral("annotation"));
  });
}

void WindowMenus::connectAnnotate() {
  AnnotationController* annotation = &parts_.annotation;
  annotation_edits_ = {ui_.placePoints, ui_.placeLines,        ui_.removeAnnotation, ui_.useAsTruth,
                       ui_.putAside,    ui_.importAnnotations, ui_.exportAnnotations};
  connectMode(ui_.placePoints, PlaceMode::kPoint);
  connectMode(ui_.placeLines, PlaceMode::kLine);
  on(ui_.removeAnnotation, annotation,
     [annotation] { annotation->remove(annotation->selected()); });
  on(ui_.useAsTruth, annotation, &AnnotationController::useAsTruth);
  on(ui_.putAside, &docks_.annotation, &AnnotationPanel::askForName);
}

/// Snapping, the loupe and its magnification, the magnification of residuals.
void WindowMenus::connectImageAnnotation() {
  ImageAnnotation* annotation = &docks_.image_annotation;
  Loupe* loupe = &annotation->loupe();
  connectSwitch(ui_.snap, &annotation->tool(), &AnnotationTool::snaps, &AnnotationTool::setSnaps,
                &AnnotationTool::snapsChanged);
  connectSwitch(ui_.loupe, loupe, &Loupe::isSwitchedOn, &Loupe::setSwitchedOn, &Loupe::changed);
  const auto magnify = [loupe](double factor) {
    return [loupe, factor] { loupe->setMagnification(loupe->magnification() * factor); };
  };
  on(ui_.magnifyMore, loupe, magnify(Loupe::kStep));
  on(ui_.magnifyLess, loupe, magnify(1.0 / Loupe::kStep));
  ui_.magnifyMore->setShortcuts({ui_.magnifyMore->shortcut(), keys("Ctrl+=")});
  auto* group = new QActionGroup(ui_.residualsMenu);
  for (const double factor : {1.0, 10.0, 40.0, 100.0}) {
    QAction* each = ui_.residualsMenu->addAction(tr("%1 times").arg(factor));
    each->setStatusTip(tr("Magnification of the drawn residuals"));
    each->setCheckable(true);
    each->setChecked(factor == annotation->magnification());
    group->addAction(each);
    on(each, annotation, [annotation, factor] { annotation->setMagnification(factor); });
  }
}

void WindowMenus::connectRun() {
  CaseController* cases = &parts_.cases;
  const auto advance = [cases](sessions::StepUntil until) {
    return [cases, until] { cases->advance(until); };
  };
  on(ui_.runToEnd, cases, advance(sessions::StepUntil::kEnd));
  on(ui_.stepIteration, cases, advance(sessions::StepUntil::kIteration));
  on(ui_.stepStage, cases, advance(sessions::StepUntil::kStage));
  on(ui_.runTogether, cases, &CaseController::runTogether);
  on(ui_.rerunFromHere, cases, [this] { parts_.cases.rerunFrom(parts_.state.cursor().iteration); });
  on(ui_.stop, this, &WindowMenus::stopRequested);
  on(ui_.verdictStep, this, &WindowMenus::verdictStepRequested);
  on(ui_.reset, cases, &CaseController::reset);
  on(ui_.runAll, this, [this] {
    QStringList ids;
    for (const auto& session_case : parts_.document.session().cases)
      ids << fromText(session_case->id);
    parts_.cases.runAll(ids);
  });
  on(ui_.runRest, cases, &CaseController::runRest);
  on(ui_.runSequence, this, &WindowMenus::showSequence);
  connect(&parts_.sequence, &SequenceRunner::changed, this, &WindowMenus::update);
  connect(&parts_.cases, &CaseController::stalenessChanged, this, &WindowMenus::update);
  parts_.state.onChange(ViewChange::kCursor, this, &WindowMenus::update);
  ui_.runToEnd->setIcon(iconOf(Icon::kRun));
  ui_.stepIteration->setIcon(iconOf(Icon::kStepIteration));
  ui_.stepStage->setIcon(iconOf(Icon::kStepStage));
  ui_.reset->setIcon(iconOf(Icon::kReset));
  run_bar_.setActions({ui_.runToEnd, ui_.stepIteration, ui_.stepStage, ui_.reset});
}

/// One dialog, which keeps its frames while it is closed.
void WindowMenus::showSequence() {
  if (!sequence_) sequence_ = new SequenceDialog(parts_, &window_);
  sequence_->show();
  sequence_->raise();
  sequence_->activateWindow();
}

void WindowMenus::connectOnboard() {
  OnboardController* onboard = &parts_.onboard;
  on(ui_.loadRecord, this, [this] { askForOnboardRecord(parts_.onboard, &window_); });
  on(ui_.showOtherRun, onboard,
     [onboard] { onboard->showsOnboard() ? onboard->showGround() : onboard->showOnboard(); });
  on(ui_.rerunRecord, onboard, &OnboardController::rerun);
  on(ui_.firstDifference, onboard, &OnboardController::goToFirstDifference);
  connect(onboard, &OnboardController::changed, this, &WindowMenus::update);
}

/// When the action is disabled, its tip gives the reason.
void WindowMenus::updateTogether(bool idle) {
  const QString alone = parts_.cases.whyAlone();
  if (together_tip_.isEmpty()) together_tip_ = ui_.runTogether->statusTip();
  ui_.runTogether->setEnabled(idle && alone.isEmpty());
  setTip(*ui_.runTogether, alone.isEmpty() ? together_tip_ : alone);
}

/// The steps of the scrubber: its buttons name and enable them, the menu gives them their keys.
void WindowMenus::fillGoMenu() {
  using Scrub = RunScrubber::Step;
  static constexpr std::pair<Scrub, const char*> kKeys[] = {
      {Scrub::kPrevious, "Ctrl+Left"},
      {Scrub::kNext, "Ctrl+Right"},
      {Scrub::kPreviousStage, "Ctrl+Shift+Left"},
      {Scrub::kNextStage, "Ctrl+Shift+Right"},
      {Scrub::kFirst, "Ctrl+Home"},
      {Scrub::kLast, "Ctrl+End"},
  };
  for (const auto& [step, key] : kKeys) {
    QAction* go = run_bar_.scrubber().action(step);
    go->setShortcut(keys(key));
    setTip(*go, go->toolTip());
    ui_.goMenu->addAction(go);
  }
}

/// One key a workspace, in the order of the tabs.
void WindowMenus::fillWorkspaces() {
  auto* group = new QActionGroup(ui_.viewMenu);
  for (int i = 0; i < kWorkspaceCount; ++i) {
    const auto workspace = static_cast<Workspace>(i);
    auto* each = new QAction(workspaceTitle(workspace), ui_.viewMenu);
    each->setShortcut(QKeySequence(QStringLiteral("Ctrl+%1").arg(i + 1)));
    each->setStatusTip(workspaceHelp(workspace));
    each->setCheckable(true);
    group->addAction(each);
    ui_.viewMenu->insertAction(ui_.layersMenu->menuAction(), each);
    on(each, this, [this, workspace] { workspaces_.show(workspace); });
    connect(&workspaces_, &Workspaces::changed, each, [each, workspace](Workspace now) {
      if (now == workspace) each->setChecked(true);
    });
    each->setChecked(workspace == workspaces_.current());
  }
  ui_.viewMenu->insertSeparator(ui_.layersMenu->menuAction());
  on(ui_.nextCase, this, [this] { showCase(1); });
  on(ui_.previousCase, this, [this] { showCase(-1); });
}

void WindowMenus::showCase(int steps) {
  QStringList ids;
  for (const auto& session_case : parts_.document.session().cases)
    ids << fromText(session_case->id);
  const int shown = static_cast<int>(ids.indexOf(parts_.cases.caseId()));
  const QString next = shown < 0 ? QString() : ids.value(shown + steps);
  if (!next.isEmpty()) parts_.cases.chooseCase(next);
}

void WindowMenus::connectView() {
  ImagePanel* image = &docks_.image;
  on(ui_.blink, &image->blink(), &QAction::toggle);
  on(ui_.swipe, &image->swipe(), &QAction::toggle);
  on(ui_.coreView, &image->coreView(), &QAction::toggle);
  on(ui_.review, this, [this] { workspaces_.reveal(QStringLiteral("review")); });
  on(ui_.arrange, &workspaces_, &Workspaces::arrange);
  on(ui_.sidePane, this, [this] { workspaces_.toggleArea(Qt::RightDockWidgetArea); });
  on(ui_.bottomPane, this, [this] { workspaces_.toggleArea(Qt::BottomDockWidgetArea); });
  for (QDockWidget* each : docks_.all())
    ui_.viewMenu->insertAction(ui_.arrange, each->toggleViewAction());
  ui_.viewMenu->insertSeparator(ui_.arrange);
}

/// Keys that hold in the queue's list alone are listed next to the text: elsewhere they are the
/// image's.
void WindowMenus::connectQueue() {
  QueuePanel* queue = &docks_.queue;
  on(ui_.showQueue, queue, [this] {
    workspaces_.reveal(QStringLiteral("queue"));
    docks_.queue.focusList();
  });
  on(ui_.queueOpen, queue, &QueuePanel::openChosen);
  on(ui_.queueAccept, queue, &QueuePanel::validationRequested);
  on(ui_.queueReject, queue, &QueuePanel::rejectionRequested);
  on(ui_.queueNext, queue, &QueuePanel::next);
  on(ui_.queuePrevious, queue, &QueuePanel::previous);
  on(ui_.queueDifferences, queue, [this] {
    workspaces_.reveal(QStringLiteral("queue"));
    docks_.queue.showDifferences(true);
  });
}

void WindowMenus::fillLayersMenu() {
  for (int i = 0; i < kLayerCount; ++i) {
    const LayerInfo& info = layerInfo(static_cast<LayerId>(i));
    QAction* each = ui_.layersMenu->addAction(tr(info.name));
    each->setShortcut(keys(info.key));
    each->setStatusTip(tr(info.help));
    on(each, this,
       [this, id = info.id] { docks_.image.showLayer(id, !docks_.image.style(id).visible); });
  }
}

void WindowMenus::connectHelp() {
  auto* help = new ManualHelp(window_);
  on(ui_.manual, help, &ManualHelp::showHere);
  on(ui_.keys, this, [this, help] {
    ShortcutSheet sheet(window_);
    connect(&sheet, &ShortcutSheet::manualRequested, help, &ManualHelp::showHere);
    sheet.exec();
  });
  on(ui_.about, this, &WindowMenus::showAbout);
}

void WindowMenus::showAbout() {
  QMessageBox::about(&window_, tr("Boresight"),
                     tr("<b>Boresight %1</b><p>Localization of a station in one image by salient "
                        "edges and Weighted Hamming Similarity.</p><p>%2</p>")
                         .arg(QString::fromUtf8(sessions::kVersion), logHint().toHtmlEscaped()));
}

void WindowMenus::undo() {
  Q_EMIT parts_.document.aboutToChange();  // what is under way is undone first
  stepHistory(&Document::undo, tr("Undone: %1").arg(parts_.document.undoText()));
}

void WindowMenus::redo() {
  stepHistory(&Document::redo, tr("Redone: %1").arg(parts_.document.redoText()));
}

void WindowMenus::stepHistory(bool (Document::*undo_or_redo)(), const QString& message) {
  const sessions::Session before = parts_.document.session();
  if (!(parts_.document.*undo_or_redo)()) return;
  const auto changed = sessions::changedCases(before, parts_.document.session());
  shown_change_ = message;
  if (!changed.empty() &&
      std::ranges::find(changed, parts_.cases.caseId().toStdString()) == changed.end()) {
    const QString other = fromText(changed.front());
    shown_change_ = tr("%1, in %2 (now shown)").arg(message, other);
    parts_.cases.chooseCase(other);
  }
  window_.statusBar()->showMessage(shown_change_);
}

void WindowMenus::showRecent() {
  ui_.recentMenu->clear();
  const QStringList files = recentFiles();
  for (const QString& file : files) {
    ui_.recentMenu->addAction(file, this, [this, file] { files_.leaveFor(file.toStdString()); });
  }
  if (files.isEmpty()) ui_.recentMenu->addAction(tr("None yet"))->setEnabled(false);
}

void WindowMenus::update() {
  const Document& document = parts_.document;
  const bool open = document.isOpen();
  const bool editable = document.isEditable();
  const bool working = parts_.cases.isWorking();
  const bool has_case = parts_.state.currentCase() != nullptr;
  const bool idle = has_case && !working;
  const bool replayed = parts_.onboard.showsOnboard();
  ui_.save->setEnabled(editable && (document.isModified() || document.isUntitled() ||
                                    !parts_.store.unstored().isEmpty()));
  ui_.saveAs->setEnabled(open);
  ui_.undo->setEnabled(editable && document.canUndo());
  ui_.redo->setEnabled(editable && document.canRedo());
  ui_.undo->setText(document.canUndo() ? tr("&Undo: %1").arg(document.undoText()) : tr("&Undo"));
  ui_.redo->setText(document.canRedo() ? tr("&Redo: %1").arg(document.redoText()) : tr("&Redo"));
  const QString obstacle = parts_.cases.whyNotRunnable();
  const bool runs = !parts_.cases.caseId().isEmpty() && !working;  // as soon as it is read
  for (QAction* each : {ui_.runToEnd, ui_.stepIteration, ui_.stepStage})
    each->setEnabled(runs && obstacle.isEmpty());
  if (run_tip_.isEmpty()) run_tip_ = ui_.runToEnd->statusTip();
  setTip(*ui_.runToEnd, obstacle.isEmpty() ? run_tip_ : obstacle);
  ui_.closeSession->setEnabled(open);
  ui_.rerunFromHere->setEnabled(idle && parts_.state.snapshot() && !replayed);
  updateTogether(idle);
  ui_.stop->setEnabled(true);  // there is no moment at which it does not stop
  ui_.reset->setEnabled(idle && parts_.state.snapshot());
  const QList<QAction*> edits = ui_.maskMenu->actions() + annotation_edits_;
  for (QAction* each : edits) each->setEnabled(editable && has_case);
  ui_.changeMenu->setEnabled(editable && !working && !parts_.cases.caseId().isEmpty());
  ui_.loadRecord->setEnabled(editable && has_case);
  for (QAction* each : {ui_.showOtherRun, ui_.rerunRecord})
    each->setEnabled(parts_.onboard.review() && !working);
  ui_.firstDifference->setEnabled(parts_.onboard.comparison() &&
                                  parts_.onboard.comparison()->first.has_value());
  for (QAction* each : {ui_.runAll, ui_.runRest})
    each->setEnabled(open && !working && !document.session().cases.empty());
  ui_.runSequence->setEnabled(has_case || parts_.sequence.isRunning());
}

}  // namespace boresight::ui
