// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/annotation_controller.h"

#include <exception>
#include <utility>

#include "core/geometry/mesh.h"
#include "sessions/annotation/annotations.h"
#include "sessions/decision/check_limits.h"
#include "ui/models/text.h"
#include "ui/state/document.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

using sessions::Annotations;
using sessions::LinePair;
using sessions::PointPair;

RoundAnswer answerOf(const sessions::AnnotationRound& round, const AnnotationQuestion& asked) {
  RoundAnswer round_answer = {round.by, round.time, {}, {}};
  if (asked.blind) return round_answer;
  const sessions::AnnotatedView& at_work = asked.annotations.views.front();
  round_answer.repeatability = sessions::repeatability(round.annotations, at_work.annotations);
  sessions::AnnotatedView view = at_work;
  view.camera_from_rig = Pose();
  view.annotations = round.annotations;
  sessions::SolveAnnotationsOptions options;
  options.robust = asked.annotations.robust;
  options.rig_from_station_guess = asked.camera_from_station_guess;
  const sessions::AnnotationsResult result = sessions::solveAnnotations({&view, 1}, options);
  if (result.solution)
    round_answer.camera_from_station = result.solution->camera_from_station.front();
  return round_answer;
}

AnnotationAnswer solve(const AnnotationQuestion& asked) {
  AnnotationAnswer answer;
  answer.blind = asked.blind;
  for (const sessions::AnnotationRound& round : asked.rounds)
    answer.rounds.push_back(answerOf(round, asked));
  if (asked.blind) return answer;
  const MeshView mesh = asked.one->scene.view();
  auto solution = std::make_shared<sessions::CaseAnnotationsSolution>(
      sessions::solveCaseAnnotations(asked.annotations, asked.camera_from_station_guess,
                                     sessions::boxCorners(matchedBounds(mesh))));
  if (const auto pose = solution->camera_from_station()) {
    const sessions::AnnotatedView& view = solution->annotations.views.front();
    answer.covariance = solution->covariance();
    answer.proposals = sessions::proposeAnnotations(asked.landmarks, view.annotations, mesh,
                                                    view.camera, *pose, &*answer.covariance);
  }
  answer.quality = sessions::annotationQuality(asked.one, *solution, asked.annotations.sigmas);
  answer.concern = sessions::annotationConcern(*solution, *answer.quality);
  answer.solution = std::move(solution);
  return answer;
}

}  // namespace

AnnotationController::AnnotationController(Document& document, ViewState& state, QObject* parent)
    : QObject(parent), document_(document), state_(state) {
  pause_.setSingleShot(true);
  pause_.setInterval(kPause_ms);
  connect(&pause_, &QTimer::timeout, this, &AnnotationController::finishMove);
  connect(&document_, &Document::aboutToChange, this, &AnnotationController::finishMove);
  connect(&document_, &Document::opened, this, &AnnotationController::documentOpened);
  connect(&document_, &Document::changed, this, &AnnotationController::showDocument);
  connect(&state_, &ViewState::aboutToSetCase, this, &AnnotationController::leaveCase);
  state_.onChange(ViewChange::kCase, this, &AnnotationController::showDocument);
  showDocument();
}

const PointPair* AnnotationController::selectedPoint() const {
  return sessions::findPoint(annotations_, selected_);
}

const LinePair* AnnotationController::selectedLine() const {
  return sessions::findLine(annotations_, selected_);
}

std::optional<Eigen::Vector2d> AnnotationController::selectedPixel(int end) const {
  if (const PointPair* point = selectedPoint()) return point->pixel;
  const LinePair* line = selectedLine();
  if (!line || !line->line) return std::nullopt;
  return end == 0 ? line->line->start : line->line->end;
}

std::optional<Pose> AnnotationController::solvedPose() const {
  return answer_.solution ? answer_.solution->camera_from_station() : std::nullopt;
}

/// A move under way is of another session, even where the case has the same name.
void AnnotationController::documentOpened() {
  moving_ = false;
  pause_.stop();
  showDocument();
}

void AnnotationController::leaveCase(const std::string& next_id) {
  if (next_id != case_id_) endMove();
}

/// Nudges are finished steps; a drag whose button is still down is none.
void AnnotationController::endMove() {
  if (pause_.isActive())
    finishMove();
  else
    cancelMove();
}

/// The document's annotations are shown, unless a gesture is about to replace them.
void AnnotationController::showDocument() {
  const std::string id = shownCaseId(document_, state_);
  const bool other_case = id != case_id_;
  if (other_case) {
    case_id_ = id;
    moving_ = false;
    pause_.stop();
    setMode(PlaceMode::kOff);
    selected_.clear();
    answer_ = {};
    asked_.reset();
    runner_.cancel(solving_);
  }
  const auto& annotations = document_.session().annotations;
  const auto found = annotations.find(id);
  const Annotations current = found == annotations.end() ? Annotations() : *found->second;
  const bool differs = !moving_ && !(current == annotations_);
  if (differs) annotations_ = current;
  if (!sessions::hasAnnotation(annotations_, selected_)) selected_.clear();
  showLandmarks();
  if (other_case || differs) {
    Q_EMIT annotationsChanged();
    Q_EMIT selectionChanged();
  }
  if (other_case) Q_EMIT solutionChanged();
  askIfChanged(other_case);
}

void AnnotationController::showLandmarks() {
  const sessions::SessionCase* session_case = document_.session().findCase(case_id_);
  const auto file = session_case ? session_case->landmarks : std::nullopt;
  if (file == landmarks_file_) return;
  landmarks_file_ = file;
  landmarks_.clear();
  try {
    if (file) landmarks_ = sessions::readLandmarks(*file);
  } catch (const std::exception& error) {
    Q_EMIT told(QString::fromUtf8(error.what()));
  }
}

/// Solves what the annotations, the rig, the landmarks and the rounds are now, if that is news.
void AnnotationController::askIfChanged(bool anyway) {
  if (case_id_.empty()) return;
  AnnotationQuestion current;
  try {
    current.annotations = sessions::caseAnnotations(document_.session(), case_id_, together_);
  } catch (const std::exception& error) {
    Q_EMIT told(QString::fromUtf8(error.what()));
    return;
  }
  current.annotations.views.front().annotations = annotations_;
  current.one = state_.currentCase();
  current.camera_from_station_guess =
      document_.session().findCase(case_id_)->camera_from_station_seed;
  current.landmarks = landmarks_;
  current.rounds = roundsOfCase();
  current.blind = sessions::isBlind(current.rounds, annotations_);
  if (!anyway && asked_ == current) return;
  asked_ = current;
  stale_ = true;
  if (current.blind && !answer_.blind) {  // at once: what is shown predicts places
    answer_ = {};
    answer_.blind = true;
    state_.setAnnotatedPose(std::nullopt);
    state_.setBlind(true);
  }
  Q_EMIT solutionChanged();
  runner_.replace(
      solving_, [question = std::move(current)](const std::stop_token&) { return solve(question); },
      [this](const AnnotationAnswer& answer) { take(answer); },
      reportTo(this, &AnnotationController::told));
}

void AnnotationController::take(const AnnotationAnswer& answer) {
  answer_ = answer;
  stale_ = false;
  state_.setAnnotatedPose(solvedPose());
  state_.setBlind(answer_.blind);
  Q_EMIT solutionChanged();
}

void AnnotationController::setMode(PlaceMode mode) {
  if (mode == mode_) return;
  endMove();
  mode_ = mode;
  Q_EMIT modeChanged();
}

void AnnotationController::select(const std::string& id) {
  if (id == selected_) return;
  finishMove();
  selected_ = sessions::hasAnnotation(annotations_, id) ? id : std::string();
  Q_EMIT selectionChanged();
}

bool AnnotationController::robust() const { return document_.session().robust_annotations; }

void AnnotationController::setRobust(bool robust) {
  sessions::Session next = document_.session();
  next.robust_annotations = robust;
  if (!document_.edit(next, robust ? tr("Less weight for outliers") : tr("Equal weights")))
    Q_EMIT solutionChanged();  // the tick is as before
}

void AnnotationController::setTogether(bool together) {
  together_ = together;
  askIfChanged(false);
}

void AnnotationController::setSigma(double sigma_px) {
  if (sigma_px > 0.0) sigma_px_ = sigma_px;
}

bool AnnotationController::commit(const Annotations& annotations, const QString& text) {
  if (case_id_.empty()) return false;
  moving_ = false;
  pause_.stop();
  return document_.edit(sessions::withAnnotations(document_.session(), case_id_, annotations),
                        text);
}

}  // namespace boresight::ui
