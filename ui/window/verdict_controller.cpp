// SPDX-License-Identifier: Apache-2.0
#include "ui/window/verdict_controller.h"

#include <algorithm>

#include <QtWidgets>

#include "sessions/checks/checks.h"
#include "sessions/trace/doubtful_pose.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/models/text.h"
#include "ui/panels/case/cases_panel.h"
#include "ui/panels/run/nudge_box.h"
#include "ui/panels/run/nudge_gizmo.h"
#include "ui/panels/run/pose_panel.h"
#include "ui/review/onboard_panel.h"
#include "ui/review/quality_controller.h"
#include "ui/review/queue_panel.h"
#include "ui/review/review_panel.h"
#include "ui/state/document.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/views/mask_editor.h"
#include "ui/widgets/widgets.h"
#include "ui/window/case_controller.h"
#include "ui/window/change_input.h"
#include "ui/window/input_findings.h"
#include "ui/window/session_files.h"
#include "ui/window/window_docks.h"
#include "ui/workspaces/remedies_panel.h"
#include "ui/workspaces/uncertainty_dialog.h"
#include "ui/workspaces/verdict_bar.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

/// Cases whose decision is looked at for the next case, as their rows do not state it yet.
constexpr int kMostAsked = 64;

QString decisionText(const sessions::ReviewStatus& status) {
  if (!status.holds()) return {};
  const sessions::Decision& decision = *status.decision;
  const QString time = fromText(decision.time).mid(11, 5);
  QString text = VerdictController::tr("by %1, %2 UTC.").arg(fromText(decision.by), time);
  if (status.awaits_approval) text += VerdictController::tr(" A second person must approve.");
  if (status.state == sessions::ReviewState::kRejected && !decision.comment.empty())
    text =
        VerdictController::tr("by %1: %2").arg(fromText(decision.by), fromText(decision.comment));
  return text;
}

}  // namespace

VerdictController::VerdictController(WindowParts& parts, const WindowDocks& docks,
                                     Workspaces& workspaces, SessionFiles& files,
                                     InputFindings& findings, VerdictBar& bar, QWidget& window)
    : QObject(&window),
      parts_(parts),
      docks_(docks),
      workspaces_(workspaces),
      files_(files),
      findings_(findings),
      bar_(bar),
      window_(window) {
  soon_.setSingleShot(true);
  soon_.setInterval(0);
  // After an edit of all cases their rows are made again in the background.
  connect(&docks_.cases.model(), &QAbstractItemModel::dataChanged, this, [this] {
    if (!has_next_) soon_.start();
  });
  connect(&soon_, &QTimer::timeout, this, &VerdictController::update);
  connect(&bar_, &VerdictBar::stepRequested, this, &VerdictController::performShown);
  follow();
  update();
}

void VerdictController::follow() {
  const auto soon = [this] { soon_.start(); };
  parts_.state.onChange(ViewChange::kAll, this, soon);
  connect(&parts_.document, &Document::left, this, [this] { taken_.clear(); });
  connectEach(parts_.document, this, soon, &Document::opened, &Document::changed);
  connectEach(parts_.cases, this, soon, &CaseController::batchChanged,
              &CaseController::stalenessChanged, &CaseController::failed);
  connectEach(parts_.annotation, this, soon, &AnnotationController::solutionChanged,
              &AnnotationController::annotationsChanged);
  ReviewController& review = docks_.review.controller();
  connectEach(review, this, soon, &ReviewController::checksChanged,
              &ReviewController::reviewStatusChanged, &ReviewController::convergenceChanged);
  connect(&parts_.run, &RunController::stateChanged, this, soon);
  connect(&parts_.onboard, &OnboardController::changed, this, soon);
  connect(&parts_.quality, &QualityController::changed, this, soon);
  connect(&workspaces_, &Workspaces::changed, this, soon);
  // The bar is green only once the checks have passed.
  const auto follow_runs = [this, &review] {
    // Annotating changes their inputs again and again.
    review.setFollowsRuns(workspaces_.current() != Workspace::kAnnotate);
  };
  connect(&workspaces_, &Workspaces::changed, this, follow_runs);
  follow_runs();
  // Of a failed run the first thing to see is what may help.
  connect(&workspaces_, &Workspaces::changed, this, [this](Workspace workspace) {
    const auto& run = parts_.state.snapshot();
    if (workspace == Workspace::kDiagnose && run && run->finished && !run->converged())
      workspaces_.reveal(QStringLiteral("remedies"));
  });
  connect(&files_, &SessionFiles::collectedChanged, this, soon);
  connect(&findings_, &InputFindings::changed, this, soon);
}

AnnotationSituation VerdictController::annotationSituation() const {
  const AnnotationController& annotation = parts_.annotation;
  AnnotationSituation situation;
  const sessions::Annotations& annotations = annotation.annotations();
  for (const sessions::PointPair& point : annotations.points) {
    situation.pairs += point.used() ? 1 : 0;
    situation.unplaced += point.pixel ? 0 : 1;
  }
  for (const sessions::LinePair& line : annotations.lines) {
    situation.pairs += line.used() ? 1 : 0;
    situation.unplaced += line.line ? 0 : 1;
  }
  situation.has_pose = annotation.solvedPose().has_value();
  situation.blind = annotation.answer().blind;
  const auto& solution = annotation.solution();
  if (!solution || !solution->result.solution) return situation;
  situation.rms_px = solution->result.solution->rms_px;
  const sessions::AnnotationConcern& concern = annotation.answer().concern;
  situation.concern = fromText(concern.text);
  for (const std::string& id : concern.suspects) situation.suspects << fromText(id);
  situation.robust = concern.robust;
  for (const auto& [id, sigmas] : solution->outlierAnnotations())
    if (std::abs(sigmas) > situation.bad_sigmas) {
      situation.bad_pair = fromText(id);
      situation.bad_sigmas = std::abs(sigmas);
    }
  return situation;
}

ReviewSituation VerdictController::reviewSituation() const {
  const ReviewController& review = docks_.review.controller();
  ReviewSituation situation;
  situation.current = review.isCurrent();
  if (review.isCurrent())
    situation.failed = sessions::countOf(review.checks(), sessions::CheckState::kFailed);
  situation.testing = review.isConvergenceTestRunning();
  situation.seeds_done = review.convergenceSoFar().seeds;
  situation.seeds_returned = review.convergenceSoFar().returned;
  situation.tested = review.isCurrent() && !review.awaitsConvergenceTest() && !situation.testing;
  if (review.caseId().empty()) return situation;
  const sessions::ReviewStatus status = review.reviewStatus();
  situation.state = status.state;
  const auto run = parts_.state.snapshot();
  const bool of_shown_run = !run || !status.decision || status.decision->digest.empty() ||
                            status.decision->digest == run->digest;
  if (of_shown_run) situation.decision = decisionText(status);
  situation.outdated = fromText(status.outdated);
  situation.problem = review.problem();
  return situation;
}

Situation VerdictController::situation() const {
  Situation situation;
  const QString id = parts_.cases.caseId();
  situation.workspace = workspaces_.current();
  situation.files = files_.situation();
  situation.has_case = parts_.state.currentCase() != nullptr;
  situation.has_next = has_next_;
  if (const auto* shown = shownCase(parts_.document, parts_.state))
    situation.has_seed = shown->has_seed;
  situation.load_problem = parts_.cases.loadProblem();
  if (!id.isEmpty())
    situation.file_problem = findings_.adviceFor(id).section(QLatin1Char('\n'), 0, 0);
  if (const auto& concern = parts_.cases.inputConcern()) {
    situation.input_problem = fromText(concern->text);
    situation.input_step = concern->kind == sessions::InputKind::kMesh
                               ? tr("Unit of the mesh...")
                               : tr("Choose %1...").arg(inputName(concern->kind));
  }
  situation.run = parts_.run.state();
  situation.in_batch = parts_.cases.batch() && parts_.cases.batch()->case_id == id && !id.isEmpty();
  situation.in_batch |= situation.has_case && parts_.cases.runsSoon();
  if (!situation.has_case || parts_.cases.readsRun()) situation.reading = id;
  const auto& record = parts_.onboard.review();
  situation.can_repeat = record && record->plan.has_options;
  situation.trace = parts_.state.snapshot();
  if (const auto& missing = parts_.state.missingRun()) situation.run_problem = missing->problem;
  if (situation.trace) situation.tried = taken_.before(id.toStdString(), situation.trace->digest);
  situation.stale = parts_.cases.staleness();
  situation.quality = parts_.quality.quality();
  situation.annotation = annotationSituation();
  situation.review = reviewSituation();
  situation.comparison = parts_.onboard.comparison();
  situation.not_compared = parts_.onboard.whyNotCompared();
  return situation;
}

void VerdictController::update() {
  told_ = parts_.state.opening();
  has_next_ = !nextCase().value_or(QString()).isEmpty();
  const Situation now = situation();
  docks_.remedies.setTried(now.tried);
  bar_.setVerdict(verdictOf(now));
}

void VerdictController::performShown(Step step) {
  if (told_ == parts_.state.opening()) perform(step);
}

void VerdictController::perform(Step step) {
  const auto& run = parts_.state.snapshot();
  if (run && run->finished && !run->converged())
    taken_.note(parts_.cases.caseId().toStdString(), run->digest, step);
  switch (step) {
    case Step::kNone:
      return;
    case Step::kChooseFiles:
      return files_.askForNext();
    case Step::kChangeInput:
      return changeInput();
    case Step::kFixFiles:
      return findings_.repair();
    case Step::kRun:
    case Step::kGoOn:
      return parts_.cases.advance(sessions::StepUntil::kEnd);
    case Step::kRunAgain:
      return parts_.cases.runAgain();
    case Step::kRunRest:
      return parts_.cases.runRest();
    case Step::kShowBatch:
      return workspaces_.reveal(QStringLiteral("queue"));
    case Step::kStop:
      return parts_.cases.stop();
    case Step::kReview:
      return workspaces_.reveal(QStringLiteral("review"));
    case Step::kWiderSearch:
      return parts_.cases.runWithWiderSearch();
    case Step::kNudgeSeed:
      return nudgeSeed();
    case Step::kMask:
      workspaces_.reveal(QStringLiteral("mask"));
      return docks_.mask_editor.setTool(MaskTool::kBrush);
    case Step::kUncertainty:
      return askForUncertainty();
    case Step::kAnnotate:
      workspaces_.show(Workspace::kAnnotate);
      return parts_.annotation.setMode(PlaceMode::kPoint);
    case Step::kAnnotateFromPose:
      return annotateFromPose();
    case Step::kInspect:
      return workspaces_.reveal(QStringLiteral("inspector"));
    case Step::kCompetingPoses:
      return workspaces_.reveal(QStringLiteral("hypotheses"));
    case Step::kInputs:
      return workspaces_.reveal(QStringLiteral("inputs"));
    case Step::kSeedFromAnnotation:
      parts_.annotation.useAsSeed();
      return workspaces_.show(Workspace::kRun);
    case Step::kDisablePair:
      return disablePair();
    case Step::kRobust:
      return parts_.annotation.setRobust(true);
    case Step::kConvergenceTest:
      return docks_.review.controller().startConvergenceTest(sessions::kConvergenceSeeds);
    case Step::kStopTest:
      return docks_.review.controller().stopConvergenceTest();
    case Step::kValidate:
      return askForDecision(ReviewController::Act::kValidate);
    case Step::kExportPose:
    case Step::kReport:
      return exportRequested(step);
    case Step::kNextCase:
      if (const auto next = nextCase(); next && !next->isEmpty()) parts_.cases.chooseCase(*next);
      return;
    case Step::kFirstDifference:
      workspaces_.show(Workspace::kOnboard);
      return parts_.onboard.goToFirstDifference();
    case Step::kRepeatRecord:
      return parts_.onboard.rerun();
    case Step::kLoadRecord:
      return askForOnboardRecord(parts_.onboard, &window_);
  }
}

/// A mesh of an impossible size has the wrong unit, most often.
void VerdictController::changeInput() {
  const auto& concern = parts_.cases.inputConcern();
  if (!concern) return;
  if (concern->kind == sessions::InputKind::kMesh)
    askForMeshUnit(parts_, window_, parts_.cases.caseId());
  else
    askForInput(parts_, window_, parts_.cases.caseId(), concern->kind);
}

/// The seed is shown, nothing else moves, and the keys move it.
void VerdictController::nudgeSeed() {
  if (!parts_.state.currentCase()) return;
  if (workspaces_.current() != Workspace::kDiagnose) workspaces_.show(Workspace::kRun);
  parts_.state.setCursor({-1, Stage::kFinished});
  QAction& nudges = docks_.gizmo.action();
  if (!nudges.isChecked()) nudges.trigger();
}

/// The doubtful pose is the start of the overlay only: the solution depends on annotations and
/// seed.
void VerdictController::annotateFromPose() {
  const auto& run = parts_.state.snapshot();
  if (!run || !sessions::doubtfulPose(*run)) return;
  docks_.poses.nudgeController().drop();  // it would cover the doubtful pose
  parts_.state.setCursor({static_cast<int>(run->iterations.size()) - 1, Stage::kFinished});
  docks_.image.showLayer(LayerId::kIterationEdges, true);
  workspaces_.show(Workspace::kAnnotate);
  parts_.annotation.setMode(PlaceMode::kPoint);
}

void VerdictController::disablePair() {
  const std::string id = annotationSituation().bad_pair.toStdString();
  const sessions::Annotations& annotations = parts_.annotation.annotations();
  const auto found = [&id](const auto& pairs) {
    return std::ranges::find_if(pairs, [&id](const auto& pair) { return pair.id == id; });
  };
  const QString text = tr("Switch off %1").arg(fromText(id));
  if (const auto point = found(annotations.points); point != annotations.points.end()) {
    sessions::PointPair off = *point;
    off.enabled = false;
    parts_.annotation.replacePoint(id, off, text);
  } else if (const auto line = found(annotations.lines); line != annotations.lines.end()) {
    sessions::LinePair off = *line;
    off.enabled = false;
    parts_.annotation.replaceLine(id, off, text);
  }
}

void VerdictController::askForUncertainty() {
  const sessions::SessionCase* session_case = shownCase(parts_.document, parts_.state);
  if (!session_case) return;
  const CaseOpening seen = parts_.state.opening();
  UncertaintyDialog dialog(session_case->uncertainty, &window_);
  if (dialog.exec() != QDialog::Accepted) return;
  if (seen == parts_.state.opening())
    parts_.cases.runWithUncertainty(dialog.uncertainty());
  else
    Q_EMIT failed(leftText(seen));
}

std::optional<QString> VerdictController::nextCase() const {
  if (!docks_.queue.isInSight()) return nextUndecided();
  const QString open = docks_.queue.nextOpen();
  // An undecided case may be filtered out, or was not run.
  if (open.isEmpty() && nextUndecided() != QString()) return std::nullopt;
  return open;
}

/// By the list of cases, which is kept for each edit: of tens of thousands only some are asked for
/// their decision.
std::optional<QString> VerdictController::nextUndecided() const {
  const std::vector<CaseRow>& rows = docks_.cases.model().rows();
  const std::size_t count = rows.size();
  const int shown = docks_.cases.model().rowOf(parts_.cases.caseId());
  const std::size_t at = shown < 0 ? count : static_cast<std::size_t>(shown);
  int asked = 0;
  for (std::size_t i = 1; i < count; ++i) {
    const CaseRow& row = rows[(at + i) % count];
    if (row.state == CaseState::kValidated || row.state == CaseState::kRejected ||
        row.awaits_approval)
      continue;
    // Its row may not be known yet.
    if (!sessions::reviewStatusOf(parts_.document.session(), row.id.toStdString()).holds())
      return row.id;
    if (++asked == kMostAsked) return std::nullopt;
  }
  return QString();
}

void VerdictController::askForDecision(ReviewController::Act act) {
  if (!docks_.review.isVisible()) workspaces_.reveal(QStringLiteral("review"));
  docks_.review.decision().ask(act);
}

}  // namespace boresight::ui
