// SPDX-License-Identifier: Apache-2.0
#include "ui/window/main_window.h"

#include <algorithm>

#include <QAction>
#include <QApplication>
#include <QCloseEvent>
#include <QDockWidget>
#include <QFileDialog>
#include <QInputDialog>
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QMimeData>
#include <QPushButton>
#include <QSettings>
#include <QStatusBar>
#include <QToolBar>
#include <QUrl>

#include "sessions/io/mesh_file.h"
#include "sessions/session/input_sheet.h"
#include "sessions/version.h"
#include "ui/panels/cases_panel.h"
#include "ui/panels/configuration_panel.h"
#include "ui/panels/input_sheet_panel.h"
#include "ui/panels/iterations_panel.h"
#include "ui/panels/match_inspector_panel.h"
#include "ui/panels/pose_panel.h"
#include "ui/run/pose_renderer.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/views/layers_panel.h"
#include "ui/vtk/scene_view.h"
#include "ui/window/case_rows.h"
#include "ui/window/shortcut_sheet.h"

namespace boresight::ui {
namespace {

constexpr int kRecentFiles = 10;

QString text(const std::filesystem::path& file) { return QString::fromStdString(file.string()); }

std::filesystem::path path(const QString& file) { return file.toStdString(); }

QString stateText(RunState state) {
  switch (state) {
    case RunState::kEmpty:
    case RunState::kReady:
      return MainWindow::tr("Ready");
    case RunState::kWorking:
      return MainWindow::tr("Running...");
    case RunState::kHalted:
      return MainWindow::tr("Halted");
    case RunState::kFinished:
      return MainWindow::tr("Finished");
  }
  return {};
}

}  // namespace

MainWindow::MainWindow(QWidget* parent)
    : QMainWindow(parent), cases_(document_, state_, run_, tasks_) {
  setObjectName(QStringLiteral("mainWindow"));
  setAcceptDrops(true);
  setDockOptions(AnimatedDocks | AllowNestedDocks | AllowTabbedDocks);
  image_ = new ImagePanel(state_, tasks_);
  setCentralWidget(image_);
  buildDocks();
  buildMenus();
  buildStatusBar();
  connect(&document_, &Document::opened, this, &MainWindow::showDocument);
  connect(&document_, &Document::changed, this, &MainWindow::updateActions);
  connect(&document_, &Document::failed, this, &MainWindow::showMessage);
  connect(&cases_, &CaseController::failed, this, &MainWindow::showMessage);
  connect(&tasks_, &TaskRunner::failed, this, &MainWindow::showMessage);
  connect(&run_, &RunController::stateChanged, this, &MainWindow::showRunState);
  connect(&state_, &ViewState::caseChanged, this, &MainWindow::updateActions);
  resize(1280, 800);
  const QSettings settings;
  restoreGeometry(settings.value(QStringLiteral("window/geometry")).toByteArray());
  restoreState(settings.value(QStringLiteral("window/state")).toByteArray());
  showDocument();
}

MainWindow::~MainWindow() = default;

QDockWidget* MainWindow::dock(const QString& name) const { return findChild<QDockWidget*>(name); }

QDockWidget* MainWindow::addDock(const QString& name, const QString& title, QWidget* widget,
                                 Qt::DockWidgetArea area) {
  auto* made = new QDockWidget(title, this);
  made->setObjectName(name);
  made->setWidget(widget);
  addDockWidget(area, made);
  return made;
}

void MainWindow::buildDocks() {
  cases_panel_ = new CasesPanel;
  configuration_ = new ConfigurationPanel(state_);
  inputs_ = new InputSheetPanel;
  poses_ = new PosePanel(state_);
  nudged_ = new PoseRenderer(this);
  addDock(QStringLiteral("cases"), tr("Cases"), cases_panel_, Qt::LeftDockWidgetArea);
  QDockWidget* layers = addDock(QStringLiteral("layers"), tr("Layers"), new LayersPanel(*image_),
                                Qt::RightDockWidgetArea);
  QDockWidget* configuration = addDock(QStringLiteral("configuration"), tr("Configuration"),
                                       configuration_, Qt::RightDockWidgetArea);
  QDockWidget* inputs =
      addDock(QStringLiteral("inputs"), tr("Inputs"), inputs_, Qt::RightDockWidgetArea);
  QDockWidget* poses = addDock(QStringLiteral("pose"), tr("Pose"), poses_, Qt::RightDockWidgetArea);
  QDockWidget* scene =
      addDock(QStringLiteral("scene"), tr("Scene"), new SceneView(state_), Qt::RightDockWidgetArea);
  QDockWidget* iterations = addDock(QStringLiteral("iterations"), tr("Iterations"),
                                    new IterationsPanel(state_), Qt::BottomDockWidgetArea);
  QDockWidget* inspector = addDock(QStringLiteral("inspector"), tr("Match inspector"),
                                   new MatchInspectorPanel(state_), Qt::BottomDockWidgetArea);
  for (QDockWidget* each : {configuration, inputs, poses, scene}) tabifyDockWidget(layers, each);
  tabifyDockWidget(iterations, inspector);
  layers->raise();
  iterations->raise();
  connectCases();
  connectConfiguration();
  connectPoses();
}

void MainWindow::connectCases() {
  connect(cases_panel_, &CasesPanel::openRequested, &cases_, &CaseController::chooseCase);
  connect(cases_panel_, &CasesPanel::runRequested, this,
          [this](const QString& id) { cases_.runAll({id}); });
  connect(cases_panel_, &CasesPanel::runAllRequested, &cases_, &CaseController::runAll);
  connect(&cases_, &CaseController::caseChosen, this, [this](const QString& id) {
    showCases();
    cases_panel_->setCurrent(id);
  });
  connect(&document_, &Document::opened, this, &MainWindow::showCases);
  connect(&document_, &Document::changed, this, &MainWindow::showCases);
  connect(&run_, &RunController::stateChanged, this, &MainWindow::showCases);
  connect(&state_, &ViewState::caseChanged, this, &MainWindow::showInputs);
}

void MainWindow::connectConfiguration() {
  connect(configuration_, &ConfigurationPanel::optionsEdited, &cases_, &CaseController::setOptions);
  connect(configuration_, &ConfigurationPanel::runAgainRequested, this, [this] {
    cases_.reset();
    cases_.advance(sessions::StepUntil::kEnd);
  });
  connect(&document_, &Document::opened, this, &MainWindow::showConfiguration);
  connect(&document_, &Document::changed, this, &MainWindow::showConfiguration);
}

void MainWindow::connectPoses() {
  connect(poses_, &PosePanel::useAsSeedRequested, &cases_, &CaseController::useAsSeed);
  connect(&state_, &ViewState::caseChanged, this, [this] {
    const ViewState::CasePtr& one = state_.currentCase();
    nudged_->setCase(one);
    PoseJudgement judgement;
    if (one) {
      judgement.requirement = one->source.requirement;
      judgement.camera_from_end_effector = one->source.camera_from_end_effector;
    }
    poses_->setJudgement(judgement);
  });
  connect(&state_, &ViewState::nudgedPoseChanged, this, [this] {
    if (state_.nudgedPose()) {
      nudged_->setPose(*state_.nudgedPose());
    } else {
      nudged_->clear();
      image_->setNudgedRender(nullptr, 0);
    }
  });
  connect(nudged_, &PoseRenderer::rendered, image_, &ImagePanel::setNudgedRender);
}

void MainWindow::showCases() {
  const bool working = run_.state() == RunState::kWorking;
  cases_panel_->setRows(caseRows(document_.session(), working ? cases_.caseId() : QString()));
  cases_panel_->setRunnable(!working);
}

void MainWindow::showConfiguration() {
  try {
    const sessions::Session& session = document_.session();
    configuration_->setOptions(QString::fromStdString(session.profile),
                               sessions::sessionOptions(session, document_.file()));
    const ViewState::CasePtr& one = state_.currentCase();
    configuration_->setCaseFeatureSize(one ? one->source.feature_size_m.value_or(0.0) : 0.0);
  } catch (const std::exception& error) {
    showMessage(QString::fromUtf8(error.what()));
  }
}

/// Figures of the inputs take a look at every pixel and face: off this thread.
void MainWindow::showInputs() {
  const ViewState::CasePtr one = state_.currentCase();
  inputs_->setSheet(std::nullopt);
  showConfiguration();
  if (!one) return;
  tasks_.start(
      QStringLiteral("input sheet"),
      [one](const std::stop_token&) { return sessions::inputSheet(*one); },
      [this, one](sessions::InputSheet sheet) {
        if (one == state_.currentCase()) inputs_->setSheet(std::move(sheet));
      });
}

QAction* MainWindow::action(const QString& text_of_action, const QKeySequence& keys,
                            const QString& tip) {
  auto* made = new QAction(text_of_action, this);
  made->setShortcut(keys);
  made->setToolTip(
      keys.isEmpty() ? tip
                     : QStringLiteral("%1 (%2)").arg(tip, keys.toString(QKeySequence::NativeText)));
  made->setStatusTip(tip);
  return made;
}

void MainWindow::buildMenus() {
  buildFileMenu();
  buildEditMenu();
  buildRunMenu();
  buildViewMenu();
  buildHelpMenu();
}

void MainWindow::buildFileMenu() {
  QMenu* menu = menuBar()->addMenu(tr("&File"));
  QAction* open = action(tr("&Open session..."), QKeySequence::Open, tr("Open a session"));
  QAction* add = action(tr("&New from files..."), QKeySequence::New,
                        tr("Make a session from a dataset, or from an image, a camera, a mesh and "
                           "a seed"));
  save_ = action(tr("&Save"), QKeySequence::Save, tr("Save the session"));
  save_as_ =
      action(tr("Save &as..."), QKeySequence::SaveAs, tr("Save the session under another name"));
  QAction* quit = action(tr("&Quit"), QKeySequence::Quit, tr("Close the program"));
  connect(open, &QAction::triggered, this, &MainWindow::askForSession);
  connect(add, &QAction::triggered, this, &MainWindow::askForFiles);
  connect(save_, &QAction::triggered, this, &MainWindow::saveSession);
  connect(save_as_, &QAction::triggered, this, &MainWindow::saveSessionAs);
  connect(quit, &QAction::triggered, this, &QWidget::close);
  menu->addAction(add);
  menu->addAction(open);
  recent_menu_ = menu->addMenu(tr("Open &recent"));
  connect(recent_menu_, &QMenu::aboutToShow, this, &MainWindow::showRecent);
  menu->addSeparator();
  menu->addAction(save_);
  menu->addAction(save_as_);
  menu->addSeparator();
  menu->addAction(quit);
}

void MainWindow::buildEditMenu() {
  QMenu* menu = menuBar()->addMenu(tr("&Edit"));
  undo_ = action(tr("&Undo"), QKeySequence::Undo, tr("Take back the last change"));
  redo_ = action(tr("&Redo"), QKeySequence::Redo, tr("Make the change again"));
  connect(undo_, &QAction::triggered, &document_, &Document::undo);
  connect(redo_, &QAction::triggered, &document_, &Document::redo);
  menu->addAction(undo_);
  menu->addAction(redo_);
}

void MainWindow::buildRunMenu() {
  QMenu* menu = menuBar()->addMenu(tr("&Run"));
  run_to_end_ = action(tr("&Run"), Qt::Key_F5, tr("Run to the end"));
  step_iteration_ = action(tr("Step an &iteration"), Qt::Key_F6, tr("Run one iteration"));
  step_stage_ = action(tr("Step a s&tage"), Qt::Key_F7,
                       tr("Run one stage: render, templates, match, pose or refinement"));
  stop_ = action(tr("&Stop"), Qt::Key_F8, tr("Stop; the run can go on from here"));
  reset_ = action(tr("R&eset"), QKeySequence(QStringLiteral("Ctrl+R")),
                  tr("Drop the run and begin anew"));
  run_all_ = action(tr("Run &all cases"), QKeySequence(QStringLiteral("Ctrl+F5")),
                    tr("Run every case to its end"));
  connect(run_to_end_, &QAction::triggered, this,
          [this] { cases_.advance(sessions::StepUntil::kEnd); });
  connect(step_iteration_, &QAction::triggered, this,
          [this] { cases_.advance(sessions::StepUntil::kIteration); });
  connect(step_stage_, &QAction::triggered, this,
          [this] { cases_.advance(sessions::StepUntil::kStage); });
  connect(stop_, &QAction::triggered, &cases_, &CaseController::stop);
  connect(reset_, &QAction::triggered, &cases_, &CaseController::reset);
  connect(run_all_, &QAction::triggered, this, [this] {
    QStringList ids;
    for (const auto& one : document_.session().cases) ids << QString::fromStdString(one->id);
    cases_.runAll(ids);
  });
  QToolBar* bar = addToolBar(tr("Run"));
  bar->setObjectName(QStringLiteral("runBar"));
  bar->setToolButtonStyle(Qt::ToolButtonTextOnly);
  for (QAction* each : {run_to_end_, step_iteration_, step_stage_, stop_, reset_}) {
    menu->addAction(each);
    bar->addAction(each);
  }
  menu->addSeparator();
  menu->addAction(run_all_);
}

void MainWindow::buildViewMenu() {
  view_menu_ = menuBar()->addMenu(tr("&View"));
  QMenu* layers = view_menu_->addMenu(tr("&Layers"));
  for (int i = 0; i < kLayerCount; ++i) {
    const LayerInfo& info = layerInfo(static_cast<LayerId>(i));
    QAction* toggle =
        action(tr(info.name), QKeySequence(QString::fromLatin1(info.key)), tr(info.help));
    connect(toggle, &QAction::triggered, this, [this, id = info.id] {
      LayerStyle style = image_->style(id);
      style.visible = !style.visible;
      image_->setStyle(id, style);
    });
    layers->addAction(toggle);
  }
  QAction* blink = action(tr("&Blink the layers"), Qt::Key_B, tr("Layers on and off"));
  QAction* swipe = action(tr("&Swipe"), Qt::Key_V, tr("Layers only left of a line"));
  QAction* core = action(tr("What the &core sees"), Qt::Key_C, tr("The 8-bit image"));
  connect(blink, &QAction::triggered, image_, &ImagePanel::toggleBlink);
  connect(swipe, &QAction::triggered, image_, &ImagePanel::toggleSwipe);
  connect(core, &QAction::triggered, image_, &ImagePanel::toggleCoreView);
  view_menu_->addActions({blink, swipe, core});
  view_menu_->addSeparator();
  for (QDockWidget* each : findChildren<QDockWidget*>())
    view_menu_->addAction(each->toggleViewAction());
}

void MainWindow::buildHelpMenu() {
  QMenu* menu = menuBar()->addMenu(tr("&Help"));
  QAction* keys = action(tr("&Keys"), Qt::Key_F1, tr("Every key of this window"));
  connect(keys, &QAction::triggered, this, [this] { ShortcutSheet(*this).exec(); });
  QAction* about = action(tr("&About Boresight"), {}, tr("Version"));
  connect(about, &QAction::triggered, this, [this] {
    QMessageBox::about(this, tr("Boresight"),
                       tr("<b>Boresight %1</b><p>Localization of a station in one image by salient "
                          "edges and Weighted Hamming Similarity, as it runs in flight.</p>")
                           .arg(QString::fromUtf8(sessions::kVersion)));
  });
  menu->addAction(keys);
  menu->addAction(about);
}

void MainWindow::buildStatusBar() {
  place_label_ = new QLabel;
  run_label_ = new QLabel;
  place_label_->setObjectName(QStringLiteral("place"));
  statusBar()->addWidget(place_label_, 1);
  statusBar()->addPermanentWidget(run_label_);
  connect(image_, &ImagePanel::placeText, place_label_, &QLabel::setText);
}

void MainWindow::showMessage(const QString& message) {
  last_message_ = message;
  if (quiet_) return;
  QMessageBox box(QMessageBox::Warning, tr("Boresight"), message, QMessageBox::Ok, this);
  box.setTextInteractionFlags(Qt::TextSelectableByMouse);
  box.exec();
}

bool MainWindow::openSession(const std::filesystem::path& file) {
  if (!document_.open(file)) return false;
  noteRecent(file);
  return true;
}

void MainWindow::askForSession() {
  if (!mayClose()) return;
  const QString file = QFileDialog::getOpenFileName(this, tr("Open a session"), {},
                                                    tr("Sessions (*.json);;All files (*)"));
  if (!file.isEmpty()) openSession(path(file));
}

void MainWindow::askForFiles() {
  const QStringList files = QFileDialog::getOpenFileNames(
      this, tr("A dataset, or an image, a camera, a mesh and a seed"), {},
      tr("All (*.json *.png *.jpg *.jpeg *.tif *.tiff *.ply *.obj *.stl *.gltf *.glb)"));
  std::vector<std::filesystem::path> paths;
  for (const QString& file : files) paths.push_back(path(file));
  if (!paths.empty()) takeFiles(paths);
}

void MainWindow::takeFiles(const std::vector<std::filesystem::path>& files) {
  const DroppedFiles dropped = classify(files, collected_);
  for (const std::string& problem : dropped.problems) showMessage(QString::fromStdString(problem));
  if (dropped.session) {
    if (mayClose()) openSession(*dropped.session);
    return;
  }
  collected_ = dropped;
  if (!dropped.dataset && !dropped.isCase()) {
    if (dropped.problems.empty())
      statusBar()->showMessage(
          tr("Taken. Still missing: %1").arg(QString::fromStdString(dropped.missing())));
    return;
  }
  try {
    sessions::Session session = document_.session();
    if (dropped.dataset) {
      if (!mayClose()) return;
      session = sessions::makeSession(*dropped.dataset);
      document_.createUntitled(session);
    } else {
      if (!askForUnits(collected_.one)) return;
      sessions::MadeCase made = sessions::makeCase(collected_.one);
      const QString id = QString::fromStdString(made.made.id);
      session = sessions::withCase(session, std::move(made.made));
      if (document_.isOpen() && document_.readOnlyReason().isEmpty()) {
        if (document_.edit(session, tr("Add %1").arg(id))) cases_.chooseCase(id);
      } else {
        document_.createUntitled(session);
      }
    }
    collected_ = {};
  } catch (const std::exception& error) {
    collected_ = {};
    showMessage(QString::fromUtf8(error.what()));
  }
}

bool MainWindow::askForUnits(sessions::CaseFiles& files) {
  for (sessions::PartSource& part : files.parts) {
    if (!part.mesh_unit.empty()) continue;
    const std::string extension = part.mesh.extension().string();
    if (extension == ".gltf" || extension == ".glb") continue;  // metres by their definition
    bool chosen = false;
    const QString unit = QInputDialog::getItem(
        this, tr("Unit of the mesh"),
        tr("%1 states no unit. Its coordinates are in").arg(text(part.mesh.filename())),
        {QStringLiteral("m"), QStringLiteral("mm"), QStringLiteral("cm"), QStringLiteral("in"),
         QStringLiteral("ft")},
        0, false, &chosen);
    if (!chosen) return false;
    part.mesh_unit = unit.toStdString();
  }
  return true;
}

bool MainWindow::saveSession() {
  if (document_.isUntitled()) return saveSessionAs();
  return document_.save();
}

bool MainWindow::saveSessionAs() {
  const QString file = QFileDialog::getSaveFileName(this, tr("Save the session"), {},
                                                    tr("Sessions (*.boresight.json)"));
  if (file.isEmpty() || !document_.saveAs(path(file))) return false;
  noteRecent(path(file));
  return true;
}

bool MainWindow::mayClose() {
  if (!document_.isModified()) return true;
  QMessageBox box(QMessageBox::Question, tr("Boresight"),
                  tr("Save the changes of %1?").arg(text(document_.file().filename())),
                  QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, this);
  box.setInformativeText(
      tr("Changes that are not saved stay in the journal and are offered when "
         "the session is opened again."));
  const int answer = box.exec();
  if (answer == QMessageBox::Save) return saveSession();
  return answer == QMessageBox::Discard;
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!mayClose()) {
    event->ignore();
    return;
  }
  cases_.stop();
  QSettings settings;
  settings.setValue(QStringLiteral("window/geometry"), saveGeometry());
  settings.setValue(QStringLiteral("window/state"), saveState());
  event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  std::vector<std::filesystem::path> files;
  for (const QUrl& url : event->mimeData()->urls())
    if (url.isLocalFile()) files.push_back(path(url.toLocalFile()));
  event->acceptProposedAction();
  if (!files.empty()) takeFiles(files);
}

void MainWindow::showDocument() {
  if (document_.recovery() && !quiet_) offerRecovery();
  const QString reason = document_.readOnlyReason();
  if (!reason.isEmpty() && !document_.recovery()) statusBar()->showMessage(reason);
  updateActions();
  showRunState();
}

void MainWindow::offerRecovery() {
  const sessions::Recovery& recovery = **document_.recovery();
  QMessageBox box(
      QMessageBox::Question, tr("Boresight"),
      tr("%1 has %n change(s) that were made but not saved, the last one at %2.", "",
         static_cast<int>(recovery.edits.size()))
          .arg(text(document_.file().filename()), QString::fromStdString(recovery.time)),
      QMessageBox::NoButton, this);
  QStringList edits;
  for (const std::string& edit : recovery.edits) edits << QString::fromStdString(edit);
  box.setDetailedText(edits.join(QLatin1Char('\n')));
  QAbstractButton* accept = box.addButton(tr("Recover them"), QMessageBox::AcceptRole);
  box.addButton(tr("Set them aside"), QMessageBox::DestructiveRole);
  box.exec();
  if (box.clickedButton() == accept) {
    document_.acceptRecovery();
  } else {
    document_.declineRecovery();
  }
}

void MainWindow::showRunState() {
  run_label_->setText(stateText(run_.state()));
  updateActions();
}

void MainWindow::updateActions() {
  const bool open = document_.isOpen();
  const bool editable = open && document_.readOnlyReason().isEmpty();
  const RunState state = run_.state();
  const bool has_case = state_.currentCase() != nullptr;
  save_->setEnabled(editable && (document_.isModified() || document_.isUntitled()));
  save_as_->setEnabled(open);
  undo_->setEnabled(editable && document_.canUndo());
  redo_->setEnabled(editable && document_.canRedo());
  undo_->setText(document_.canUndo() ? tr("&Undo: %1").arg(document_.undoText()) : tr("&Undo"));
  redo_->setText(document_.canRedo() ? tr("&Redo: %1").arg(document_.redoText()) : tr("&Redo"));
  const bool working = state == RunState::kWorking;
  run_to_end_->setEnabled(has_case && !working);
  step_iteration_->setEnabled(has_case && !working);
  step_stage_->setEnabled(has_case && !working);
  stop_->setEnabled(working);
  reset_->setEnabled(has_case && !working && state_.snapshot());
  run_all_->setEnabled(open && !working && !document_.session().cases.empty());
  const QString name = open ? text(document_.file().filename()) : tr("No session");
  setWindowTitle(tr("%1[*]%2 - Boresight")
                     .arg(document_.isUntitled() ? tr("Untitled") : name,
                          open && !editable ? tr(" (read only)") : QString()));
  setWindowModified(document_.isModified());
}

void MainWindow::noteRecent(const std::filesystem::path& file) {
  QSettings settings;
  const QString name = text(std::filesystem::absolute(file));
  QStringList files = settings.value(QStringLiteral("recent")).toStringList();
  files.removeAll(name);
  files.prepend(name);
  while (files.size() > kRecentFiles) files.removeLast();
  settings.setValue(QStringLiteral("recent"), files);
}

void MainWindow::showRecent() {
  recent_menu_->clear();
  const QStringList files = QSettings().value(QStringLiteral("recent")).toStringList();
  for (const QString& file : files) {
    QAction* each = recent_menu_->addAction(file);
    connect(each, &QAction::triggered, this, [this, file] {
      if (mayClose()) openSession(path(file));
    });
  }
  if (files.isEmpty()) recent_menu_->addAction(tr("None yet"))->setEnabled(false);
}

}  // namespace boresight::ui
