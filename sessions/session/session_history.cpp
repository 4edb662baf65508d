// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_history.h"

#include <utility>

namespace boresight::sessions {

Session keepingRuns(const Session& target, const Session& now) {
  Session kept = target;
  kept.runs.clear();
  for (const RunRecord& run : now.runs)
    if (kept.findCase(run.case_id) != nullptr) kept.runs.push_back(run);
  kept.view = now.view;
  if (kept.findCase(kept.view.case_id) == nullptr) kept.view = {};
  return kept;
}

void SessionHistory::perform(const Session& after, const std::string& text) {
  SessionCommand command{text, document_->session(), after};
  if (command.before == command.after) return;
  document_->apply(after, text);
  commands_.resize(done_);
  commands_.push_back(std::move(command));
  ++done_;
}

void SessionHistory::undo() {
  if (!canUndo()) return;
  const SessionCommand& command = commands_[done_ - 1];
  document_->apply(keepingRuns(command.before, document_->session()), "Undo: " + command.text);
  --done_;
}

void SessionHistory::redo() {
  if (!canRedo()) return;
  const SessionCommand& command = commands_[done_];
  document_->apply(keepingRuns(command.after, document_->session()), "Redo: " + command.text);
  ++done_;
}

}  // namespace boresight::sessions
