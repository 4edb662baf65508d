// SPDX-License-Identifier: Apache-2.0
#include "ui/window/window_menus.h"

#include <algorithm>

#include <QtWidgets>

#include "sessions/version.h"
#include "ui/annotation/annotation_panel.h"
#include "ui/annotation/image_annotation.h"
#include "ui/annotation/loupe.h"
#include "ui/annotation/mark_tool.h"
#include "ui/manual/manual_window.h"
#include "ui/panels/mask_panel.h"
#include "ui/panels/pose_panel.h"
#include "ui/panels/run_scrubber.h"
#include "ui/panels/widgets.h"
#include "ui/review/onboard_panel.h"
#include "ui/review/pose_export.h"
#include "ui/run/run_controller.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/views/image_panel.h"
#include "ui/views/mask_editor.h"
#include "ui/window/case_controller.h"
#include "ui/window/panel_links.h"
#include "ui/window/session_files.h"
#include "ui/window/shortcut_sheet.h"
#include "ui/window/window_docks.h"

namespace boresight::ui {
namespace {

constexpr double kBrushStep = 1.25;

/// A switch of something that tells when it has changed by itself.
template <class Owner>
void addSwitch(QMenu& menu, const QString& text, const QKeySequence& keys, const QString& tip,
               Owner* owner, bool (Owner::*isOn)() const, void (Owner::*set)(bool),
               void (Owner::*changed)()) {
  QAction* made = addAction(menu, text, keys, tip);
  made->setCheckable(true);
  made->setChecked((owner->*isOn)());
  QObject::connect(made, &QAction::toggled, owner, set);
  QObject::connect(owner, changed, made, [=] { made->setChecked((owner->*isOn)()); });
}

void addMagnifications(QMenu& menu, Loupe* loupe) {
  const auto magnify = [loupe](double factor) {
    return [loupe, factor] { loupe->setMagnification(loupe->magnification() * factor); };
  };
  QAction* more =
      addAction(menu, WindowMenus::tr("Loupe: &magnify more"), keys("Ctrl++"),
                WindowMenus::tr("More screen pixels per image pixel; also Ctrl and the wheel"),
                loupe, magnify(Loupe::kStep));
  more->setShortcuts({more->shortcut(), keys("Ctrl+=")});
  addAction(menu, WindowMenus::tr("Loupe: magnify l&ess"), keys("Ctrl+-"),
            WindowMenus::tr("Fewer screen pixels per image pixel; also Ctrl and the wheel"), loupe,
            magnify(1.0 / Loupe::kStep));
}

void addResiduals(QMenu& menu, ImageAnnotation* annotation) {
  QMenu* residuals = menu.addMenu(WindowMenus::tr("Magnify resi&duals"));
  auto* group = new QActionGroup(residuals);
  for (const double factor : {1.0, 10.0, 40.0, 100.0}) {
    QAction* each = addAction(
        *residuals, WindowMenus::tr("%1 times").arg(factor), {},
        WindowMenus::tr("Draw what the solved pose leaves of each mark this many times as long"),
        annotation, [annotation, factor] { annotation->setMagnification(factor); });
    each->setCheckable(true);
    each->setChecked(factor == annotation->magnification());
    group->addAction(each);
  }
}

/// How annotating on the image looks and behaves: snapping, the loupe and its magnification, the
/// magnification of residuals.
void addLoupeActions(QMenu& menu, ImageAnnotation& annotation) {
  addSwitch(
      menu, WindowMenus::tr("&Snap"), Qt::Key_Q,
      WindowMenus::tr(
          "Snap to corners, edges, ellipses and what the mesh has; Alt held refuses once, Tab "
          "goes on to another"),
      &annotation.tool(), &MarkTool::snaps, &MarkTool::setSnaps, &MarkTool::snapsChanged);
  addSwitch(menu, WindowMenus::tr("L&oupe"), Qt::Key_L,
            WindowMenus::tr("Magnify the image under the pointer, or the mark that is moved"),
            &annotation.loupe(), &Loupe::isSwitchedOn, &Loupe::setSwitchedOn, &Loupe::changed);
  addMagnifications(menu, &annotation.loupe());
  addResiduals(menu, &annotation);
}

}  // namespace

WindowMenus::WindowMenus(QMainWindow& window, const WindowParts& parts, const WindowDocks& docks,
                         SessionFiles& files)
    : QObject(&window), window_(window), parts_(parts), docks_(docks), files_(files) {
  buildFileMenu();
  buildEditMenu();
  buildAnnotateMenu();
  buildRunMenu();
  buildGoMenu();
  buildViewMenu();
  buildHelpMenu();
}

void WindowMenus::buildFileMenu() {
  QMenu& menu = *window_.menuBar()->addMenu(tr("&File"));
  addAction(menu, tr("&New from files..."), QKeySequence::New,
            tr("Make a session from a dataset, or from an image, a camera, a mesh and a seed"),
            &files_, &SessionFiles::askForFiles);
  addAction(menu, tr("&Open session..."), QKeySequence::Open, tr("Open a session"), &files_,
            &SessionFiles::askForSession);
  recent_menu_ = menu.addMenu(tr("Open &recent"));
  connect(recent_menu_, &QMenu::aboutToShow, this, &WindowMenus::showRecent);
  menu.addSeparator();
  save_ = addAction(menu, tr("&Save"), QKeySequence::Save, tr("Save the session"), &files_,
                    &SessionFiles::save);
  save_as_ = addAction(menu, tr("Save &as..."), QKeySequence::SaveAs,
                       tr("Save the session under another name"), &files_, &SessionFiles::saveAs);
  menu.addSeparator();
  auto* poses = new PoseExport(window_, parts_.document, parts_.state, parts_.tasks);
  poses->addTo(*menu.addMenu(tr("&Export")));
  connect(poses, &PoseExport::noted, this,
          [this](const QString& message) { window_.statusBar()->showMessage(message); });
  menu.addSeparator();
  addAction(menu, tr("&Quit"), QKeySequence::Quit, tr("Close the program"), &window_,
            &QWidget::close);
}

void WindowMenus::buildEditMenu() {
  QMenu& menu = *window_.menuBar()->addMenu(tr("&Edit"));
  undo_ = addAction(menu, tr("&Undo"), QKeySequence::Undo, tr("Take back the last change"), this,
                    &WindowMenus::undo);
  redo_ = addAction(menu, tr("&Redo"), QKeySequence::Redo, tr("Make the change again"), this,
                    &WindowMenus::redo);
  connect(&parts_.document, &Document::changed, this, [this] {
    // An undo is no longer the last change.
    if (window_.statusBar()->currentMessage() == shown_change_) window_.statusBar()->clearMessage();
  });
  menu.addSeparator();
  buildMaskMenu(*menu.addMenu(tr("Ignore &mask")));
}

void WindowMenus::buildMaskMenu(QMenu& menu) {
  MaskEditor* editor = &docks_.maskEditor();
  const auto toggle = [editor](MaskTool tool) {
    return [editor, tool] { editor->setTool(editor->tool() == tool ? MaskTool::kNone : tool); };
  };
  addAction(menu, tr("&Brush"), keys("Shift+B"), tr("Draw on the image what runs shall ignore"),
            editor, toggle(MaskTool::kBrush));
  addAction(menu, tr("&Polygon"), keys("Shift+P"),
            tr("Click the corners of what runs shall ignore"), editor, toggle(MaskTool::kPolygon));
  addAction(menu, tr("&Erase"), keys("Shift+E"),
            tr("Trust what is drawn again, or ignore it again"), editor,
            [editor] { editor->setErase(!editor->erases()); });
  addAction(menu, tr("&Smaller brush"), Qt::Key_BracketLeft, tr("A smaller brush"), editor,
            [editor] { editor->setRadius(editor->radius_px() / kBrushStep); });
  addAction(menu, tr("&Larger brush"), Qt::Key_BracketRight, tr("A larger brush"), editor,
            [editor] { editor->setRadius(editor->radius_px() * kBrushStep); });
  addAction(menu, tr("Sa&turated pixels"), keys("Shift+S"),
            tr("Ignore the pixels of the chosen gray value or more"), &docks_.mask(),
            &MaskPanel::askForSaturated);
  addAction(menu, tr("&Clear"), {}, tr("Ignore no pixel at all"), &docks_.mask(),
            &MaskPanel::clearAll);
  mask_actions_ = menu.actions();
}

void WindowMenus::addMode(QMenu& menu, const QString& text, const QKeySequence& keys,
                          const QString& tip, PlaceMode mode) {
  AnnotationController& annotation = parts_.annotation;
  QAction* made = addAction(menu, text, keys, tip, this, [this, mode](bool on) {
    docks_.maskEditor().setTool(MaskTool::kNone);  // one tool at a time
    parts_.annotation.setMode(on ? mode : PlaceMode::kOff);
    if (on) docks_.raise(QStringLiteral("annotation"));
  });
  made->setCheckable(true);
  connect(&annotation, &AnnotationController::modeChanged, made,
          [made, mode, &annotation] { made->setChecked(annotation.mode() == mode); });
}

void WindowMenus::buildAnnotateMenu() {
  QMenu& menu = *window_.menuBar()->addMenu(tr("&Annotate"));
  AnnotationController* annotation = &parts_.annotation;
  AnnotationPanel* panel = &docks_.annotation();
  addMode(menu, tr("&Points"), Qt::Key_F2,
          tr("Mark points on the image and the station, in either order"), PlaceMode::kPoint);
  addMode(menu, tr("&Lines"), Qt::Key_F3,
          tr("Mark an edge by two places of the image and an edge of the station"),
          PlaceMode::kLine);
  addAction(menu, tr("&Remove the chosen mark"), keys("Ctrl+Del"), tr("Take the chosen mark away"),
            annotation, [annotation] { annotation->remove(annotation->selected()); });
  connect(&docks_.maskEditor(), &MaskEditor::changed, this, [this] {
    if (docks_.maskEditor().tool() != MaskTool::kNone) parts_.annotation.setMode(PlaceMode::kOff);
  });
  menu.addSeparator();
  addAction(menu, tr("Use as &truth"), {}, tr("The annotated pose becomes the truth"), annotation,
            &AnnotationController::useAsTruth);
  addAction(menu, tr("Put aside, begin a &blind pass..."), {},
            tr("Keep these marks and begin anew without seeing them"), panel,
            &AnnotationPanel::askForName);
  menu.addSeparator();
  menu.addAction(tr("&Import marks..."), panel, &AnnotationPanel::importRequested);
  menu.addAction(tr("&Export marks..."), panel, &AnnotationPanel::exportRequested);
  annotation_actions_ = menu.actions();
  menu.addSeparator();
  addLoupeActions(menu, docks_.imageAnnotation());
}

void WindowMenus::buildRunMenu() {
  QMenu& menu = *window_.menuBar()->addMenu(tr("&Run"));
  CaseController* cases = &parts_.cases;
  const auto advance = [cases](sessions::StepUntil until) {
    return [cases, until] { cases->advance(until); };
  };
  run_to_end_ = addAction(menu, tr("&Run"), Qt::Key_F5, tr("Run to the end"), cases,
                          advance(sessions::StepUntil::kEnd));
  run_together_ = addAction(menu, tr("Run with the other &views"), keys("F4"), {}, cases,
                            &CaseController::runTogether);
  step_iteration_ = addAction(menu, tr("Step an &iteration"), Qt::Key_F6, tr("Run one iteration"),
                              cases, advance(sessions::StepUntil::kIteration));
  step_stage_ = addAction(menu, tr("Step a s&tage"), Qt::Key_F7,
                          tr("Run one stage: render, templates, match, pose or refinement"), cases,
                          advance(sessions::StepUntil::kStage));
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

/// The steps of the scrubber: its buttons name and enable them, the menu gives them their keys.
void WindowMenus::buildGoMenu() {
  using Step = RunScrubber::Step;
  struct Key {
    Step step;
    const char* keys;
  };
  static constexpr Key kKeys[] = {
      {Step::kPrevious, "Ctrl+Left"},
      {Step::kNext, "Ctrl+Right"},
      {Step::kPreviousStage, "Ctrl+Shift+Left"},
      {Step::kNextStage, "Ctrl+Shift+Right"},
      {Step::kFirst, "Ctrl+Home"},
      {Step::kLast, "Ctrl+End"},
  };
  const auto* scrubber = window_.findChild<RunScrubber*>();
  if (!scrubber) return;
  QMenu* menu = window_.menuBar()->addMenu(tr("&Go"));
  for (const Key& each : kKeys) {
    QAction* go = scrubber->action(each.step);
    go->setShortcut(QKeySequence(QString::fromLatin1(each.keys)));
    setTip(*go, go->toolTip());
    menu->addAction(go);
  }
}

void WindowMenus::buildViewMenu() {
  QMenu& menu = *window_.menuBar()->addMenu(tr("&View"));
  buildLayersMenu(*menu.addMenu(tr("&Layers")));
  ImagePanel* image = &docks_.image();
  addAction(menu, tr("&Blink the layers"), Qt::Key_B, tr("Layers on and off"), image,
            &ImagePanel::toggleBlink);
  addAction(menu, tr("&Swipe"), Qt::Key_V, tr("Layers only left of a line"), image,
            &ImagePanel::toggleSwipe);
  addAction(menu, tr("What the &core sees"), Qt::Key_C, tr("The 8-bit image"), image,
            &ImagePanel::toggleCoreView);
  addAction(menu, tr("Re&view the pose"), Qt::Key_F9,
            tr("Where the shown case stands, the checks of its pose, the decision"), this,
            [this] { docks_.raise(QStringLiteral("review")); });
  QueueLinks::addActions(*menu.addMenu(tr("&Queue")), docks_);
  menu.addSeparator();
  for (QDockWidget* each : docks_.all()) menu.addAction(each->toggleViewAction());
  menu.addSeparator();
  addAction(menu, tr("A&rrange the panels anew"), {},
            tr("Put every panel back where it was at the first start"), this,
            [this] { docks_.arrange(); });
}

void WindowMenus::buildLayersMenu(QMenu& menu) {
  for (int i = 0; i < kLayerCount; ++i) {
    const LayerInfo& info = layerInfo(static_cast<LayerId>(i));
    addAction(menu, tr(info.name), keys(info.key), tr(info.help), this, [this, id = info.id] {
      LayerStyle style = docks_.image().style(id);
      style.visible = !style.visible;
      docks_.image().setStyle(id, style);
    });
  }
}

void WindowMenus::buildHelpMenu() {
  QMenu& menu = *window_.menuBar()->addMenu(tr("&Help"));
  auto* help = new ManualHelp(window_);
  addAction(menu, tr("&Manual"), keys("Shift+F1"),
            tr("The manual, at the panel that has the focus"), help, &ManualHelp::showHere);
  addAction(menu, tr("&Keys"), Qt::Key_F1, tr("Every key of this window"), this, [this, help] {
    ShortcutSheet sheet(window_);
    connect(&sheet, &ShortcutSheet::manualRequested, help, &ManualHelp::showHere);
    sheet.exec();
  });
  addAction(menu, tr("&About Boresight"), {}, tr("Version"), this, &WindowMenus::showAbout);
}

void WindowMenus::showAbout() {
  QMessageBox::about(&window_, tr("Boresight"),
                     tr("<b>Boresight %1</b><p>Localization of a station in one image by salient "
                        "edges and Weighted Hamming Similarity, as it runs in flight.</p>")
                         .arg(QString::fromUtf8(sessions::kVersion)));
}

void WindowMenus::undo() {
  docks_.poses().nudgeController().finishGesture();  // what is under way is undone first
  parts_.annotation.finishMove();
  const sessions::Session before = parts_.document.session();
  const QString text = parts_.document.undoText();
  if (parts_.document.undo()) showChange(before, tr("Undone: %1").arg(text));
}

void WindowMenus::redo() {
  const sessions::Session before = parts_.document.session();
  const QString text = parts_.document.redoText();
  if (parts_.document.redo()) showChange(before, tr("Done again: %1").arg(text));
}

void WindowMenus::showChange(const sessions::Session& before, const QString& told) {
  const auto changed = sessions::changedCases(before, parts_.document.session());
  const std::string shown = parts_.cases.caseId().toStdString();
  QString message = told;
  if (!changed.empty() && std::find(changed.begin(), changed.end(), shown) == changed.end()) {
    const QString other = QString::fromStdString(changed.front());
    message = tr("%1, in %2, which is shown now").arg(told, other);
    parts_.cases.chooseCase(other);
  }
  window_.statusBar()->showMessage(message);
  shown_change_ = message;
}

void WindowMenus::showRecent() {
  recent_menu_->clear();
  const QStringList files = recentFiles();
  for (const QString& file : files) {
    QAction* each = recent_menu_->addAction(file);
    connect(each, &QAction::triggered, this, [this, file] {
      if (files_.mayLeave()) files_.open(file.toStdString());
    });
  }
  if (files.isEmpty()) recent_menu_->addAction(tr("None yet"))->setEnabled(false);
}

void WindowMenus::update() {
  const Document& document = parts_.document;
  const bool open = document.isOpen();
  const bool editable = open && document.readOnlyReason().isEmpty();
  const bool working = parts_.run.state() == RunState::kWorking || parts_.cases.batch();
  const bool has_case = parts_.state.currentCase() != nullptr;
  save_->setEnabled(editable && (document.isModified() || document.isUntitled() ||
                                 !parts_.cases.unstoredRuns().isEmpty()));
  save_as_->setEnabled(open);
  undo_->setEnabled(editable && document.canUndo());
  redo_->setEnabled(editable && document.canRedo());
  undo_->setText(document.canUndo() ? tr("&Undo: %1").arg(document.undoText()) : tr("&Undo"));
  redo_->setText(document.canRedo() ? tr("&Redo: %1").arg(document.redoText()) : tr("&Redo"));
  for (QAction* each : {run_to_end_, step_iteration_, step_stage_})
    each->setEnabled(has_case && !working);
  rerun_->setEnabled(has_case && !working && parts_.state.snapshot());
  updateTogether(has_case && !working);
  stop_->setEnabled(working);
  reset_->setEnabled(has_case && !working && parts_.state.snapshot());
  for (QAction* each : mask_actions_) each->setEnabled(editable && has_case);
  for (QAction* each : annotation_actions_) each->setEnabled(editable && has_case);
  const bool replayed = parts_.onboard.showsOnboard();
  load_record_->setEnabled(editable && has_case);
  show_other_run_->setEnabled(parts_.onboard.review() && !working);
  rerun_record_->setEnabled(parts_.onboard.review() && !working);
  first_difference_->setEnabled(parts_.onboard.comparison() &&
                                parts_.onboard.comparison()->first.has_value());
  rerun_->setEnabled(rerun_->isEnabled() && !replayed);
  run_all_->setEnabled(open && !working && !document.session().cases.empty());
}

}  // namespace boresight::ui
