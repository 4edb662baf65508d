// SPDX-License-Identifier: Apache-2.0
#include "ui/review/quality_controller.h"

#include <utility>

#include "ui/run/task_runner.h"
#include "ui/state/document.h"

namespace boresight::ui {
namespace {

/// Whether a run is of the case as it is now: another camera or mesh would give it another quality.
bool isOfTheCase(const sessions::LocalizationTrace& run, const Document& document,
                 const ViewState& state) {
  const sessions::SessionCase* shown = shownCase(document, state);
  if (!shown) return false;
  const sessions::RunRecord* record = sessions::findRun(document.session(), shown->id, run.digest);
  return !record || record->inputs_sha256 == sessions::inputsDigest(*shown);
}

}  // namespace

QualityController::QualityController(Document& document, ViewState& state, TaskRunner& tasks)
    : document_(document), state_(state), tasks_(tasks) {
  connect(&document_, &Document::changed, this, &QualityController::follow);
  state_.onChange(ViewChange::kCase | ViewChange::kSnapshot, this, &QualityController::follow);
  follow();
}

void QualityController::follow() {
  Question question;
  const ViewState::SnapshotPtr& run = state_.snapshot();
  if (state_.currentCase() && run && run->finished && run->converged() &&
      isOfTheCase(*run, document_, state_))
    question = {state_.currentCase(), run, document_.session().review};
  if (question == question_) return;
  question_ = std::move(question);
  quality_.reset();
  tasks_.cancel(measuring_);
  Q_EMIT changed();
  if (!question_.run) return;
  tasks_.replace(
      measuring_,
      [session = document_.session(), asked = question_](const std::stop_token&) {
        return sessions::runQuality(session, asked.loaded, *asked.run);
      },
      [this](sessions::PoseQuality quality) {
        quality_ = std::move(quality);
        Q_EMIT changed();
      },
      reportTo(this, &QualityController::failed));
}

}  // namespace boresight::ui
