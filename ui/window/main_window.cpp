// SPDX-License-Identifier: Apache-2.0
#include "ui/window/main_window.h"

#include <utility>

#include <QtWidgets>

#include "ui/annotation/annotation_panel.h"
#include "ui/annotation/image_annotation.h"
#include "ui/annotation/station_snapper.h"
#include "ui/panels/annotate/mask_panel.h"
#include "ui/panels/run/pose_panel.h"
#include "ui/panels/run/runs_panel.h"
#include "ui/review/pose_export.h"
#include "ui/review/queue_panel.h"
#include "ui/review/review_panel.h"
#include "ui/scene/scene_view.h"
#include "ui/views/image_panel.h"
#include "ui/widgets/input_guard.h"
#include "ui/widgets/widgets.h"
#include "ui/window/annotation_files.h"
#include "ui/window/input_findings.h"
#include "ui/window/job_controller.h"
#include "ui/window/log_hint.h"
#include "ui/window/mask_controller.h"
#include "ui/window/panel_links.h"
#include "ui/window/session_files.h"
#include "ui/window/verdict_controller.h"
#include "ui/window/window_docks.h"
#include "ui/window/window_frame.h"
#include "ui/window/window_menus.h"
#include "ui/workspaces/remedies.h"
#include "ui/workspaces/remedies_panel.h"
#include "ui/workspaces/run_bar.h"
#include "ui/workspaces/verdict_bar.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

constexpr const char* kGeometryKey = "window/geometry";
constexpr int kNote_ms = 15'000;  // that a remark stays in the status bar

/// What holds the docks, in its place before they are made: with a style sheet each change of
/// parent looks up the rules of all widgets below again.
QMainWindow* bodyIn(QMainWindow& window) {
  auto* centre = new QWidget(&window);
  auto* body = named(new QMainWindow(centre), "body");
  body->setWindowFlags(Qt::Widget);
  return body;
}

}  // namespace

MainWindow::MainWindow(QWidget* parent)
    : QMainWindow(parent),
      body_(bodyIn(*this)),
      docks_(std::make_unique<WindowDocks>(*body_, *this, parts_)),
      workspaces_(new Workspaces(*body_, docks_->all(), this)),
      files_(new SessionFiles(*this, parts_)),
      frame_(new WindowFrame(*this, *body_, parts_, *docks_, *workspaces_, *files_)),
      menus_(new WindowMenus(*this, parts_, *docks_, *workspaces_, frame_->runBar(), *files_)),
      findings_(new InputFindings(parts_, docks_->findings, *this)) {
  setObjectName(QStringLiteral("mainWindow"));
  setAcceptDrops(true);
  frame_->takeMenus();
  connectAll();
  resizeToScreen();
  showDocument();
}

/// Panels use the parts, which are destroyed before them, when they are hidden.
MainWindow::~MainWindow() { hide(); }

ImagePanel& MainWindow::image() { return docks_->image; }

QDockWidget* MainWindow::dock(const QString& name) const { return workspaces_->dock(name); }

/// The whole window is on the screen at the first start, with its title.
void MainWindow::resizeToScreen() {
  constexpr QSize kFirst(1280, 800);
  constexpr int kTitle = 40;
  const QScreen* screen = QGuiApplication::primaryScreen();
  const QSize room = screen ? screen->availableSize() - QSize(0, kTitle) : kFirst;
  resize(kFirst.boundedTo(room).expandedTo(minimumSizeHint().boundedTo(room)));
}

void MainWindow::connectAll() {
  const auto note = [this](const QString& message) { statusBar()->showMessage(message, kNote_ms); };
  const auto show_failures_of = [this]<class... Senders>(Senders&... senders) {
    (connect(&senders, &Senders::failed, this, &MainWindow::showMessage), ...);
  };
  new InputGuard(this);
  auto* links = new PanelLinks(parts_, *docks_, this);
  connect(links, &PanelLinks::warningsChanged, &frame_->verdict(), &VerdictBar::setWarnings);
  auto* verdicts = new VerdictController(parts_, *docks_, *workspaces_, *files_, *findings_,
                                         frame_->verdict(), *this);
  connect(&docks_->remedies, &RemediesPanel::stepRequested, verdicts, &VerdictController::perform);
  connect(menus_, &WindowMenus::verdictStepRequested, &frame_->verdict(),
          [this, verdicts] { verdicts->performShown(frame_->verdict().verdict().step); });
  connect(verdicts, &VerdictController::exportRequested, this, [this](Step step) {
    step == Step::kReport ? menus_->poses().askForReport() : menus_->poses().askForPose();
  });
  connectDecisions(*verdicts);
  connect(&frame_->jobs(), &JobStrip::stepRequested, verdicts, &VerdictController::perform);
  auto* jobs = new JobController(parts_, docks_->review.controller(), frame_->jobs(), this);
  connect(menus_, &WindowMenus::stopRequested, jobs, &JobController::stop);
  connect(&parts_.document, &Document::opened, this, &MainWindow::showFittingWorkspace);
  connect(files_, &SessionFiles::caseAdded, this, &MainWindow::showFittingWorkspace);
  new QueueLinks(parts_, *docks_, this);
  auto* levels = new LevelsController(parts_, docks_->levels, this);
  connect(levels, &LevelsController::noted, this, note);
  new MaskController(parts_, docks_->mask_editor, docks_->mask, image(), this);
  auto* annotation_files = new AnnotationFiles(*this, parts_, docks_->annotation);
  connect(annotation_files, &AnnotationFiles::noted, this, note);
  connect(findChild<QAction*>(QStringLiteral("importAnnotations")), &QAction::triggered,
          annotation_files, &AnnotationFiles::importAnnotations);
  connect(findChild<QAction*>(QStringLiteral("exportAnnotations")), &QAction::triggered,
          annotation_files, &AnnotationFiles::exportAnnotations);
  connect(&parts_.onboard, &OnboardController::rerunRequested, &parts_.cases,
          &CaseController::runPlan);
  connect(&parts_.onboard, &OnboardController::told, this, note);
  connect(&parts_.annotation, &AnnotationController::told, this, note);
  connect(&parts_.cases, &CaseController::noted, this, note);
  show_failures_of(*annotation_files, parts_.onboard, parts_.quality, docks_->snapper, *links,
                   *findings_, *files_, parts_.document, parts_.cases, parts_.store,
                   parts_.of_document, parts_.exports, *verdicts, *levels, image(),
                   docks_->image_annotation, docks_->scene, docks_->mask, docks_->poses,
                   docks_->annotation, docks_->review.controller(), *findChild<RunsPanel*>(),
                   menus_->poses());
  connect(findings_, &InputFindings::changed, this, &MainWindow::showHint);
  connect(files_, &SessionFiles::queueWanted, this,
          [this] { workspaces_->reveal(QStringLiteral("queue")); });
  connect(files_, &SessionFiles::noted, this, [this](const QString& message) {
    statusBar()->showMessage(message, kNote_ms);
    if (parts_.state.currentCase()) return;
    message.isEmpty() ? showHint() : image().setHint(message);  // where the operator looks
  });
  connect(&parts_.document, &Document::opened, this, &MainWindow::showDocument);
  connect(&parts_.document, &Document::changed, this, &MainWindow::showState);
  const auto offer_elsewhere = [this](const QString& message) {
    last_message_ = message;
    if (!quiet_) files_->offerSavingElsewhere(message);
  };
  connect(&parts_.document, &Document::writeFailed, this, offer_elsewhere);
  connect(&parts_.document, &Document::changedElsewhere, this, [this](const QString& message) {
    last_message_ = message;
    if (!quiet_) files_->offerReadingAgain(message);
  });
  connect(&parts_.store, &RunStore::storeFailed, this, [this, offer_elsewhere](const QString& m) {
    showState();  // it can be saved now
    offer_elsewhere(m);
  });
  connect(&parts_.cases, &CaseController::batchChanged, this, &MainWindow::showState);
  connect(&parts_.run, &RunController::stateChanged, this, &MainWindow::showState);
  connect(&parts_.run, &RunController::stateChanged, this, [this] {
    if (parts_.run.state() == RunState::kWorking)
      statusBar()->clearMessage();  // of what was before
  });
  parts_.state.onChange(ViewChange::kCase, this, &MainWindow::showState);
  parts_.state.onChange(ViewChange::kCase, this, &MainWindow::showHint);
}

/// One form decides, for the case that is shown; the queue only asks it.
void MainWindow::connectDecisions(VerdictController& verdicts) {
  DecisionForm& form = docks_->review.decision();
  form.setNext([&verdicts] { return verdicts.nextCase(); });
  connect(&form, &DecisionForm::nextRequested, &parts_.cases, &CaseController::chooseCase);
  connect(&form, &DecisionForm::decided, this,
          [this](const QString& what) { statusBar()->showMessage(what, kNote_ms); });
  connect(&form, &DecisionForm::questionEnded, this, [this] {
    if (docks_->queue.isInSight()) docks_->queue.focusList();
  });
  connect(&docks_->review, &ReviewPanel::checkShowRequested, &verdicts,
          [&verdicts](const std::string& id) { verdicts.perform(stepOfCheck(id)); });
  connect(&docks_->queue, &QueuePanel::validationRequested, &verdicts,
          [&verdicts] { verdicts.askForDecision(ReviewController::Act::kValidate); });
  connect(&docks_->queue, &QueuePanel::rejectionRequested, &verdicts,
          [&verdicts] { verdicts.askForDecision(ReviewController::Act::kReject); });
}

/// In the middle, where the operator looks for the image: why it is not there, and what to do.
void MainWindow::showHint() {
  QString hint;
  if (parts_.document.isOpen() && !parts_.cases.caseId().isEmpty()) {
    hint = findings_->adviceFor(parts_.cases.caseId());
    if (hint.isEmpty()) hint = parts_.cases.loadProblem();
    if (hint.isEmpty()) hint = tr("Reading the files of %1 ...").arg(parts_.cases.caseId());
  }
  image().setHint(hint);
}

void MainWindow::showMessage(const QString& message) {
  last_message_ = message;
  statusBar()->clearMessage();  // of what was under way, and has failed
  showHint();
  if (quiet_) return;
  QMessageBox box(QMessageBox::Warning, tr("Boresight"), message, QMessageBox::Ok, this);
  box.setTextInteractionFlags(Qt::TextSelectableByMouse);
  noteInLog(box);
  box.exec();
}

bool MainWindow::openSession(const std::filesystem::path& file) { return files_->open(file); }

void MainWindow::takeFiles(const std::vector<std::filesystem::path>& files) { files_->take(files); }

/// What closing would end, a sentence each.
QStringList MainWindow::jobsUnderWay() const {
  QStringList jobs;
  const QString id = parts_.cases.caseId();
  if (const auto& batch = parts_.cases.batch())
    jobs << tr("Cases are run, %1 of %2 so far: these runs are kept, the others can be run later.")
                .arg(batch->done)
                .arg(batch->of);
  if (parts_.run.state() == RunState::kWorking || parts_.cases.runsSoon())
    jobs << tr("%1 is run: without its end this run is not kept.").arg(id);
  if (parts_.sequence.isRunning())
    jobs << tr("A sequence is run: its frames so far are kept, its next start continues it.");
  if (docks_->review.controller().isConvergenceTestRunning())
    jobs << tr("A convergence test of %1 is run: it is not kept.").arg(id);
  if (parts_.exports.isBusy())
    jobs << tr("%n file(s) are written, now: %1. They are not complete.", "",
               parts_.exports.count())
                .arg(parts_.exports.job().name);
  return jobs;
}

/// Asks where work is under way; ends it where that is the answer.
bool MainWindow::mayEndJobs() {
  const QStringList jobs = jobsUnderWay();
  if (jobs.isEmpty()) return true;
  QMessageBox box(QMessageBox::Question, tr("Boresight"), tr("Stop what is under way, and close?"),
                  QMessageBox::NoButton, this);
  box.setInformativeText(jobs.join(QLatin1Char('\n')));
  QAbstractButton* end =
      named(box.addButton(tr("Stop and close"), QMessageBox::DestructiveRole), "endJobs");
  QPushButton* stay = named(box.addButton(tr("Stay"), QMessageBox::RejectRole), "stay");
  box.setDefaultButton(stay);
  box.exec();
  if (box.clickedButton() != end) return false;
  parts_.sequence.stop();
  docks_->review.controller().stopConvergenceTest();
  parts_.cases.stop();
  return true;
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!mayEndJobs()) return event->ignore();
  const std::optional<Former> former = files_->mayLeave();
  if (!former) return event->ignore();
  if (remembers_layout_) {  // before the session is closed: that changes the workspace
    QSettings settings;
    settings.setValue(QLatin1String(kGeometryKey), saveGeometry());
    workspaces_->save(settings);
  }
  if (*former == Former::kDiscard && !parts_.document.close(*former)) return event->ignore();
  parts_.cases.stop();
  event->accept();
}

void MainWindow::rememberLayout() {
  remembers_layout_ = true;
  const QSettings settings;
  restoreGeometry(settings.value(QLatin1String(kGeometryKey)).toByteArray());
  workspaces_->restore(settings);
}

void MainWindow::showEvent(QShowEvent* event) {
  QMainWindow::showEvent(event);
  workspaces_->windowResized();
  frame_->arrange();
}

/// Panels take sizes only once the window has its own.
void MainWindow::resizeEvent(QResizeEvent* event) {
  QMainWindow::resizeEvent(event);
  if (isVisible()) workspaces_->windowResized();
}

void MainWindow::showFittingWorkspace() {
  if (parts_.document.session().cases.empty())
    workspaces_->show(Workspace::kStart);
  else if (workspaces_->current() == Workspace::kStart)
    workspaces_->show(Workspace::kRun);
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  std::vector<std::filesystem::path> files;
  for (const QUrl& url : event->mimeData()->urls())
    if (url.isLocalFile()) files.emplace_back(url.toLocalFile().toStdString());
  event->acceptProposedAction();
  if (files.empty()) return;
  // The program that the files come from waits for the end of this event: no dialog in it.
  QTimer::singleShot(0, this, [this, files] { takeFiles(files); });
}

void MainWindow::showDocument() {
  const QString notices = parts_.document.takeNotices().join(QLatin1Char('\n'));
  if (parts_.document.recovery()) {
    if (!quiet_) files_->offerRecovery(notices);
  } else if (!notices.isEmpty()) {
    showMessage(notices);
  }
  const QString reason = parts_.document.readOnlyReason();
  if (!reason.isEmpty() && !parts_.document.recovery()) statusBar()->showMessage(reason);
  showState();
}

void MainWindow::showState() {
  menus_->update();
  const bool read_only = parts_.document.isOpen() && !parts_.document.readOnlyReason().isEmpty();
  const QString name = parts_.document.isUntitled() ? tr("Untitled")
                       : parts_.document.isOpen()
                           ? QString::fromStdString(parts_.document.file().filename().string())
                           : tr("No session");
  setWindowTitle(tr("%1[*]%2 - Boresight").arg(name, read_only ? tr(" (read only)") : QString()));
  setWindowModified(parts_.document.isModified() || parts_.document.isUntitled());
}

}  // namespace boresight::ui
