// SPDX-License-Identifier: Apache-2.0
#include "ui/state/view_state.h"

#include <algorithm>
#include <utility>

#include "core/base/math.h"
#include "ui/state/document.h"

namespace boresight::ui {

using sessions::AlternativeKind;

std::optional<Pose> poseOf(const ViewState& state, PoseRole role) {
  if (!state.currentCase()) return std::nullopt;
  switch (role) {
    case PoseRole::kSeed:
      if (!state.snapshot() && !state.currentCase()->source.has_seed) return std::nullopt;
      return state.snapshot() ? state.snapshot()->camera_from_station_seed
                              : state.currentCase()->source.camera_from_station_seed;
    case PoseRole::kEstimate:
      return state.iterationPose();
    case PoseRole::kNudged:
      return state.nudgedPose();
    case PoseRole::kTruth:
      return state.currentCase()->source.camera_from_station_truth;
    case PoseRole::kAnnotated:
      return state.annotatedPose();
  }
  return std::nullopt;
}

QString leftText(const CaseOpening& left) {
  return ViewState::tr("%1 is no longer shown: nothing was changed.")
      .arg(QString::fromStdString(left.id));
}

const sessions::SessionCase* shownCase(const Document& document, const ViewState& state) {
  return state.currentCase() ? document.session().findCase(state.currentCase()->source.id)
                             : nullptr;
}

std::string shownCaseId(const Document& document, const ViewState& state) {
  const sessions::SessionCase* session_case = shownCase(document, state);
  return session_case ? session_case->id : std::string();
}

int ViewState::lastIteration() const {
  return snapshot_ ? static_cast<int>(snapshot_->iterations.size()) - 1 : -1;
}

std::shared_ptr<const sessions::IterationTrace> ViewState::iteration() const {
  if (cursor_.iteration < 0 || cursor_.iteration > lastIteration()) return nullptr;
  return snapshot_->iterations[static_cast<std::size_t>(cursor_.iteration)];
}

std::optional<Pose> ViewState::iterationPose() const {
  const auto shown = iteration();
  if (!shown) return std::nullopt;
  return cursor_.stage >= Stage::kPose ? shown->camera_from_station
                                       : shown->camera_from_station_before;
}

std::optional<Pose> ViewState::knownPose() const {
  if (blind_) return std::nullopt;
  if (nudged_) return nudged_;
  if (const auto of_iteration = iterationPose()) return of_iteration;
  if (case_ && case_->source.has_seed) return case_->source.camera_from_station_seed;
  return annotated_;
}

void ViewState::openCase(const std::string& id) { show(id, nullptr); }

void ViewState::setCase(CasePtr loaded_case) {
  const std::string id = loaded_case ? loaded_case->source.id : std::string();
  show(id, std::move(loaded_case));
}

void ViewState::show(const std::string& id, CasePtr loaded_case) {
  Q_EMIT aboutToSetCase(id);
  static std::uint64_t count = 0;
  const bool same = !id.empty() && id == opening_.id && loaded_case;
  if (!same) opening_ = {id, ++count};
  case_ = std::move(loaded_case);
  snapshot_.reset();
  missing_run_.reset();
  cursor_ = {};
  selected_template_ = -1;
  nudged_.reset();
  annotated_.reset();
  blind_ = false;
  alternative_.reset();
  Q_EMIT changed(same ? ViewChanges(ViewChange::kAll) & ~ViewChanges(ViewChange::kOtherCase)
                      : ViewChanges(ViewChange::kAll));
}

void ViewState::replaceCase(CasePtr loaded_case) {
  Q_EMIT aboutToSetCase(loaded_case ? loaded_case->source.id : std::string());
  case_ = std::move(loaded_case);
  const ViewChanges pose = nudged_ ? ViewChange::kNudgedPose : ViewChanges();
  Q_EMIT changed(ViewChange::kCase | ViewChange::kCursor | pose);
}

std::string ViewState::shownRun() const {
  if (snapshot_) return snapshot_->digest;
  return missing_run_ ? missing_run_->digest : std::string();
}

void ViewState::setMissingRun(const MissingRun& missing) {
  missing_run_ = missing;
  showSnapshot(nullptr);
}

void ViewState::setSnapshot(SnapshotPtr snapshot) {
  missing_run_.reset();
  showSnapshot(std::move(snapshot));
}

void ViewState::showSnapshot(SnapshotPtr snapshot) {
  const bool follows = cursor_.iteration == lastIteration();
  snapshot_ = std::move(snapshot);
  // A new run is shorter than the one before: the cursor is inside it before anybody looks.
  cursor_.iteration = follows ? lastIteration() : std::min(cursor_.iteration, lastIteration());
  if (follows) cursor_.stage = Stage::kFinished;
  selected_template_ = -1;
  const ViewChanges alternative = alternative_ ? ViewChange::kAlternative : ViewChanges();
  alternative_.reset();
  Q_EMIT changed(ViewChange::kSnapshot | ViewChange::kCursor | ViewChange::kTemplate | alternative);
}

void ViewState::setCursor(const RunCursor& cursor) {
  RunCursor next = cursor;
  next.iteration = std::clamp(next.iteration, -1, lastIteration());
  if (next == cursor_) return;
  ViewChanges what = ViewChange::kCursor;
  if (next.iteration != cursor_.iteration) {
    selected_template_ = -1;
    what |= ViewChange::kTemplate;
  }
  cursor_ = next;
  Q_EMIT changed(what);
}

void ViewState::selectTemplate(int index) {
  const auto shown = iteration();
  const int count = shown ? static_cast<int>(shown->templates.size()) : 0;
  const int next = index >= 0 && index < count ? index : -1;
  if (next == selected_template_) return;
  selected_template_ = next;
  Q_EMIT changed(ViewChange::kTemplate);
}

void ViewState::setNudgedPose(const std::optional<Pose>& camera_from_station) {
  nudged_ = camera_from_station;
  Q_EMIT changed(ViewChange::kNudgedPose);
}

void ViewState::setAnnotatedPose(const std::optional<Pose>& camera_from_station) {
  annotated_ = camera_from_station;
  Q_EMIT changed(ViewChange::kAnnotatedPose);
}

void ViewState::setBlind(bool blind) {
  if (std::exchange(blind_, blind) == blind) return;
  Q_EMIT changed(ViewChange::kAnnotatedPose | ViewChange::kNudgedPose);
}

void ViewState::setAlternative(const std::optional<sessions::Alternative>& alternative) {
  if (!alternative && !alternative_) return;
  alternative_ = alternative;
  Q_EMIT changed(ViewChange::kAlternative);
}

QString alternativeTitle(const sessions::Alternative& alternative) {
  if (alternative.mirrored) return ViewState::tr("Mirror image of the mesh");
  if (alternative.kind == AlternativeKind::kCompeting)
    return ViewState::tr("Competing pose %1").arg(alternative.number);
  if (alternative.kind == AlternativeKind::kCompared) switch (alternative.origin) {
      case HypothesisOrigin::kCandidate:
        return ViewState::tr("Candidate %1").arg(alternative.number);
      case HypothesisOrigin::kTemplates:
        return ViewState::tr("Templates");
      case HypothesisOrigin::kSeed:
        return ViewState::tr("Templates of the seed");
      case HypothesisOrigin::kRestart:
        return ViewState::tr("Restart %1").arg(alternative.number);
    }
  return ViewState::tr("Rolled by %1 deg")
      .arg(QString::asprintf("%+.1f", alternative.roll_rad / kDegree_rad));
}

QString chosenTitle(const sessions::Alternative& alternative) {
  return alternative.kind == AlternativeKind::kCompeting  ? ViewState::tr("Result of the run")
         : alternative.kind == AlternativeKind::kCompared ? ViewState::tr("Best pose")
                                                          : ViewState::tr("Chosen roll");
}

}  // namespace boresight::ui
