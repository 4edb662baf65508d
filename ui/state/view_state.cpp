// SPDX-License-Identifier: Apache-2.0
#include "ui/state/view_state.h"

#include <algorithm>
#include <utility>

namespace boresight::ui {

ViewState::ViewState(QObject* parent) : QObject(parent) {}

int ViewState::lastIteration() const {
  return snapshot_ ? static_cast<int>(snapshot_->iterations.size()) - 1 : -1;
}

const sessions::IterationTrace* ViewState::iteration() const {
  if (cursor_.iteration < 0 || cursor_.iteration > lastIteration()) return nullptr;
  return snapshot_->iterations[static_cast<std::size_t>(cursor_.iteration)].get();
}

Pose ViewState::shownPose() const {
  if (nudged_) return *nudged_;
  if (const sessions::IterationTrace* shown = iteration()) {
    const bool solved = cursor_.stage >= Stage::kPose;
    return solved ? shown->camera_from_station : shown->camera_from_station_before;
  }
  return case_ ? case_->source.camera_from_station_seed : Pose();
}

void ViewState::setCase(CasePtr one) {
  case_ = std::move(one);
  snapshot_.reset();
  cursor_ = {};
  selected_template_ = -1;
  nudged_.reset();
  annotated_.reset();
  alternative_.reset();
  Q_EMIT caseChanged();
  Q_EMIT snapshotChanged();
  Q_EMIT cursorChanged();
  Q_EMIT templateSelected(-1);
  Q_EMIT nudgedPoseChanged();
  Q_EMIT annotatedPoseChanged();
  Q_EMIT alternativeChanged();
}

void ViewState::replaceCase(CasePtr one) {
  case_ = std::move(one);
  Q_EMIT caseChanged();
  Q_EMIT cursorChanged();
  if (nudged_) Q_EMIT nudgedPoseChanged();
}

void ViewState::setSnapshot(SnapshotPtr snapshot) {
  const bool follows = cursor_.iteration == lastIteration();
  snapshot_ = std::move(snapshot);
  // A new run is shorter than the one before: the cursor is inside it before anybody looks.
  cursor_.iteration = follows ? lastIteration() : std::min(cursor_.iteration, lastIteration());
  if (follows) cursor_.stage = Stage::kFinished;
  selected_template_ = -1;
  const bool had_alternative = alternative_.has_value();
  alternative_.reset();
  Q_EMIT snapshotChanged();
  Q_EMIT cursorChanged();
  Q_EMIT templateSelected(-1);
  if (had_alternative) Q_EMIT alternativeChanged();
}

void ViewState::setCursor(const RunCursor& cursor) {
  RunCursor next = cursor;
  next.iteration = std::clamp(next.iteration, -1, lastIteration());
  if (next == cursor_) return;
  const bool other_iteration = next.iteration != cursor_.iteration;
  cursor_ = next;
  if (other_iteration) selected_template_ = -1;
  Q_EMIT cursorChanged();
  if (other_iteration) Q_EMIT templateSelected(-1);
}

void ViewState::selectTemplate(int index) {
  const sessions::IterationTrace* shown = iteration();
  const int count = shown ? static_cast<int>(shown->templates.size()) : 0;
  const int next = index >= 0 && index < count ? index : -1;
  if (next == selected_template_) return;
  selected_template_ = next;
  Q_EMIT templateSelected(next);
}

void ViewState::setNudgedPose(const std::optional<Pose>& camera_from_station) {
  nudged_ = camera_from_station;
  Q_EMIT nudgedPoseChanged();
}

void ViewState::setAnnotatedPose(const std::optional<Pose>& camera_from_station) {
  annotated_ = camera_from_station;
  Q_EMIT annotatedPoseChanged();
}

void ViewState::setAlternative(const std::optional<sessions::Alternative>& alternative) {
  if (!alternative && !alternative_) return;
  alternative_ = alternative;
  Q_EMIT alternativeChanged();
}

}  // namespace boresight::ui
