// SPDX-License-Identifier: Apache-2.0
#include "ui/review/onboard_controller.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "sessions/session/case_run.h"
#include "sessions/session/input_check.h"
#include "sessions/session/pose_comparer.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"

namespace boresight::ui {

OnboardController::OnboardController(Document& document, ViewState& state, TaskRunner& tasks)
    : document_(document), state_(state), tasks_(tasks) {
  state_.onChange(ViewChange::kOtherCase, this, [this] {
    ground_.reset();
    ground_case_.reset();
  });
  state_.onChange(ViewChange::kCase, this, &OnboardController::readAgain);
  state_.onChange(ViewChange::kSnapshot, this, &OnboardController::snapshotChanged);
}

std::filesystem::path OnboardController::file() const {
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  return loaded_case && loaded_case->source.onboard_record
             ? loaded_case->source.onboard_record->file
             : std::filesystem::path();
}

bool OnboardController::showsOnboard() const {
  return state_.snapshot() && state_.snapshot()->replayed;
}

/// Reads the record after any edit of the case, since the replay depends on all of its inputs.
void OnboardController::readAgain() {
  const ViewState::CasePtr loaded_case = state_.currentCase();
  tasks_.cancel(comparing_);
  comparison_.reset();
  const auto attached = loaded_case ? loaded_case->source.onboard_record : std::nullopt;
  const bool another = read_ != attached;
  read_ = attached;
  if (another || !attached) {
    review_.reset();
    problem_.clear();
    if (showsOnboard()) showGround();
  }
  Q_EMIT changed();
  if (!attached) return tasks_.cancel(reading_);
  tasks_.replace(
      reading_,
      [loaded_case, file = *attached](const std::stop_token& stop) -> ReviewPtr {
        return sessions::reviewRecord(file.file, file.sha256, loaded_case->problem(), stop);
      },
      [this, loaded_case](ReviewPtr review) { takeReview(loaded_case, std::move(review), {}); },
      [this, loaded_case](const QString& problem) { takeReview(loaded_case, nullptr, problem); });
}

void OnboardController::takeReview(const ViewState::CasePtr& loaded_case, ReviewPtr review,
                                   const QString& problem) {
  if (loaded_case != state_.currentCase()) return;
  review_ = std::move(review);
  problem_ = problem;
  if (showsOnboard() && review_)
    state_.setSnapshot(review_->replay);
  else if (showsOnboard())
    showGround();
  Q_EMIT changed();
  compareAgain();
}

void OnboardController::snapshotChanged() {
  const ViewState::SnapshotPtr& shown = state_.snapshot();
  if (!shown || !shown->replayed) {
    ground_ = shown;
    ground_case_ = state_.currentCase();
    compareAgain();
  }
  Q_EMIT changed();
}

/// Compares hashes of the inputs: that of a stored run, or of the case when the run was taken.
bool OnboardController::groundIsOfTheCase() const {
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  if (!loaded_case || !ground_) return false;
  const std::string inputs = sessions::inputsDigest(loaded_case->source);
  if (const sessions::RunRecord* stored =
          sessions::findRun(document_.session(), loaded_case->source.id, ground_->digest))
    return stored->inputs_sha256 == inputs;
  return ground_case_ && sessions::inputsDigest(ground_case_->source) == inputs;
}

QString OnboardController::whyNotCompared() const {
  if (!review_ || comparison_) return {};
  if (!ground_) return tr("No comparison: the case has no run on the ground.");
  if (!ground_->finished) return tr("The run on the ground has not ended.");
  if (!groundIsOfTheCase())
    return tr("The inputs have changed since the run on the ground: run the case again.");
  return tr("Comparing ...");
}

void OnboardController::compareAgain() {
  tasks_.cancel(comparing_);
  comparison_.reset();
  if (!review_ || !ground_ || !ground_->finished || !groundIsOfTheCase()) return;
  tasks_.replace(
      comparing_,
      [review = review_, run = ground_, one = state_.currentCase()](const std::stop_token&) {
        return std::make_shared<const sessions::RecordComparison>(sessions::compareWithGround(
            *review, *run, one->problem(), sessions::comparisonLimits(*one)));
      },
      [this](ComparisonPtr comparison_ptr) {
        comparison_ = std::move(comparison_ptr);
        Q_EMIT changed();
      },
      reportTo(this, &OnboardController::failed));
}

void OnboardController::attachAs(std::optional<sessions::InputFile> record, const QString& text) {
  const sessions::SessionCase* session_case = shownCase(document_, state_);
  if (!session_case) return Q_EMIT failed(tr("Open the case that the record belongs to first."));
  const auto attach = [&record](sessions::SessionCase& changed) {
    changed.onboard_record = std::move(record);
  };
  document_.edit(sessions::withChanged(document_.session(), session_case->id, attach),
                 text.arg(QString::fromStdString(session_case->id)));
}

void OnboardController::attach(const std::filesystem::path& file) {
  try {
    const std::filesystem::path absolute = std::filesystem::absolute(file).lexically_normal();
    (void)sessions::readRecord(absolute);  // that it is one
    attachAs(sessions::InputFile{absolute, sessions::inputSha256(absolute)},
             tr("Attach an onboard record to %1"));
  } catch (const std::exception& error) {
    Q_EMIT failed(QString::fromUtf8(error.what()));
  }
}

void OnboardController::detach() {
  attachAs(std::nullopt, tr("Remove the onboard record from %1"));
}

void OnboardController::showOnboard() {
  if (!review_) return;
  state_.setSnapshot(review_->replay);
  Q_EMIT told(tr("Every view shows the onboard run, replayed from its record."));
}

void OnboardController::showGround() {
  state_.setSnapshot(ground_);
  Q_EMIT told(ground_ ? tr("Every view shows the run on the ground.")
                      : tr("The case has no run on the ground."));
}

void OnboardController::rerun() {
  if (!review_) return;
  if (!review_->plan.has_options)
    return Q_EMIT failed(tr("The record has no options, so that its run cannot be repeated."));
  Q_EMIT rerunRequested(review_->plan.plan);
}

void OnboardController::goToFirstDifference() {
  if (!comparison_ || !comparison_->first) return;
  const sessions::FirstDifference& first = *comparison_->first;
  if (first.iteration < 0) return;
  if (!state_.snapshot()) showOnboard();
  const auto& iterations = state_.snapshot()->iterations;
  const auto found = std::ranges::find(iterations, first.iteration,
                                       [](const auto& iteration) { return iteration->index; });
  if (found == iterations.end()) return;
  state_.setCursor({static_cast<int>(found - iterations.begin()), Stage::kFinished});
  if (first.template_index >= 0) state_.selectTemplate(first.template_index);
}

}  // namespace boresight::ui
