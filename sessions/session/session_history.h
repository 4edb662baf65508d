// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sessions/session/session.h"
#include "sessions/session/session_document.h"

namespace boresight::sessions {

/// One edit as undo and redo need it: the whole values before and after, which share their cases.
struct SessionCommand {
  std::string text;  ///< "Move the seed of bc"
  Session before;
  Session after;
};

/// What undo or redo makes of `target` now: runs and what is looked at are not edits and stay as
/// they are at present, except those of cases that `target` does not have.
Session keepingRuns(const Session& target, const Session& now);

/// The undo stack of a document, of any length. Every step goes through SessionDocument::apply and
/// so into the journal before it shows; a step that throws has not happened. A Qt undo command
/// needs no more than `keepingRuns` and `apply`.
class SessionHistory {
 public:
  /// The document must outlive the history.
  explicit SessionHistory(SessionDocument& document) : document_(&document) {}

  /// An edit; what was undone before it can no longer be redone. One that changes nothing is none.
  void perform(const Session& after, const std::string& text);
  void undo();  ///< nothing when there is nothing to undo
  void redo();

  bool canUndo() const { return done_ > 0; }
  bool canRedo() const { return done_ < commands_.size(); }
  /// What undo() or redo() would do, "" when nothing.
  std::string undoText() const { return canUndo() ? commands_[done_ - 1].text : ""; }
  std::string redoText() const { return canRedo() ? commands_[done_].text : ""; }
  const std::vector<SessionCommand>& commands() const { return commands_; }
  std::size_t done() const { return done_; }  ///< so many of the commands hold

 private:
  SessionDocument* document_;
  std::vector<SessionCommand> commands_;
  std::size_t done_ = 0;
};

}  // namespace boresight::sessions
