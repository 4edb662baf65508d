// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_lock.h"
#include "sessions/session/session.h"
#include "sessions/session/session_journal.h"

namespace boresight::sessions {

/// kEditAndSave: edits are not written to the journal. When save() fails, the session file and a
/// journal of recovered edits are as they were before the document was opened.
enum class Access { kEdit, kEditAndSave, kReadOnly };

/// The session's file is not as it was read or written here last: nothing was written.
class FileChangedError : public OutputError {
 public:
  explicit FileChangedError(const std::filesystem::path& file)
      : OutputError(file,
                    "another program has changed the file since it was opened; save under another "
                    "name") {}
};

/// An open session: its value, its file, and its journal and lock. An edit is on the disk before
/// `apply` returns, except with kEditAndSave; views show session(). Not thread-safe.
class SessionDocument {
 public:
  /// Opens a session file. To edit it the lock is taken; when that fails (another program has it,
  /// the folder is read-only) the document opens read-only with a reason. InputError when the file
  /// is not a session.
  static SessionDocument open(const std::filesystem::path& file, Access access = Access::kEdit);
  /// Writes a new session file and opens it. OutputError when there is a file of this name already,
  /// or nothing can be written.
  static SessionDocument create(const std::filesystem::path& file, const Session& session);

  const Session& session() const { return session_; }
  const std::filesystem::path& file() const { return file_; }  ///< absolute, no link
  bool modified() const { return !(session_ == saved_); }      ///< differs from the file
  bool readOnly() const { return !read_only_reason_.empty(); }
  const std::string& readOnlyReason() const { return read_only_reason_; }
  /// Notes on opening: a lock that a killed program left, a journal set aside.
  const std::vector<std::string>& notices() const { return notices_; }

  /// Unsaved edits of a program that was killed; they must be accepted or declined before anything
  /// can be edited or saved.
  const std::optional<Recovery>& recovery() const { return recovery_; }
  /// One sentence about these edits: how many there are and how to get them; "" when there are
  /// none.
  std::string unsavedText() const;
  /// InputError with unsavedText(): the file alone is not the session as it was edited.
  void requireNothingUnsaved() const;
  /// Takes the recovered session, not yet saved; of a read-only document for saveAs(), and its
  /// journal stays. OutputError.
  void acceptRecovery();
  /// Takes and saves the recovered session. OutputError; then file and journal are as before.
  void saveRecovery();
  /// Sets the journal aside under another name. OutputError.
  void declineRecovery();

  /// Makes `next` the session after it is written to the journal; `text` describes the edit.
  /// The cost grows with the edit, not with the session.
  /// OutputError when it cannot be written, the document is read-only, a recovery waits, or the
  /// session would be too large to be saved; InputError when `next` is not a session that a file
  /// could hold (two cases of one id, an option out of range). Then nothing has changed. A `next`
  /// equal to the current value is no edit.
  void apply(const Session& next, const std::string& text);

  /// Writes the file and drops the journal. OutputError; FileChangedError when another program has
  /// changed the file meanwhile. Then file and journal are unchanged.
  void save();
  /// Resets the session to the content of the file, with nothing left to recover but the journal
  /// of a read-only document. OutputError when a read-only document has no such edits.
  void discardChanges();
  /// Discards the changes and reads the file again, as another program may have left it.
  /// OutputError as above; InputError when the file is no longer a session. Then nothing has
  /// changed.
  void readAgain();
  /// Saves under another name, replacing an existing file, and continues there; traces of its runs
  /// are copied, and those of `restorable` runs, which it may name again. The former file stays as
  /// it was last saved. OutputError leaves the document unchanged.
  void saveAs(const std::filesystem::path& file, std::span<const RunRecord> restorable = {});

 private:
  explicit SessionDocument(const std::filesystem::path& file);
  void takeLock();
  void begin(Session session, const std::string& text, const std::string& former);
  void respectFormerLock();
  void adoptJournal(const std::filesystem::path& former);
  void readJournalBeside();
  void notice(const std::string& text);
  void setJournalAside(const std::string& why);
  /// A copy under an unused name. OutputError.
  std::filesystem::path copyJournalAside() const;
  void noticeKept(const std::filesystem::path& aside);
  void takeRecovery();
  void requireEditable() const;
  void writeJournalAgain();
  void dropJournal();
  /// Writes an edit from session_ to `next` to the journal; with kEditAndSave only checks it.
  void addToJournal(const Session& next, const std::string& text);

  std::filesystem::path file_;
  std::string file_sha256_;     ///< of the file as it was read or written last
  std::size_t file_bytes_ = 0;  ///< its size
  Session session_;
  Session saved_;
  std::unique_ptr<FileLock> lock_;
  bool journals_ = true;                  ///< false with kEditAndSave
  std::optional<JournalWriter> journal_;  ///< empty while there are no edits
  std::optional<Recovery> recovery_;
  std::string read_only_reason_;
  std::vector<std::string> notices_;
};

/// One edit for undo and redo: the whole values before and after, which share their cases.
struct SessionCommand {
  std::string text;  ///< "Move the seed of bc"
  Session before;
  Session after;
};

/// The undo stack of a document, of any length. Every step goes through SessionDocument::apply and
/// thus into the journal before it is shown; a step that throws has no effect.
class SessionHistory {
 public:
  /// The document must outlive the history.
  explicit SessionHistory(SessionDocument& document) : document_(&document) {}

  /// Performs an edit; undone edits can no longer be redone. An edit without changes is ignored.
  void perform(const Session& after, const std::string& text);
  void undo();  ///< no effect when there is nothing to undo
  void redo();
  /// SessionDocument::saveAs with the runs that undo and redo restore: the former session may be
  /// removed.
  void saveAs(const std::filesystem::path& file);

  bool canUndo() const { return done_ > 0; }
  bool canRedo() const { return done_ < commands_.size(); }
  /// Description of the edit that undo() or redo() would affect; "" when there is none.
  std::string undoText() const { return canUndo() ? commands_[done_ - 1].text : ""; }
  std::string redoText() const { return canRedo() ? commands_[done_].text : ""; }
  const std::vector<SessionCommand>& commands() const { return commands_; }
  std::size_t done() const { return done_; }  ///< commands before this one are in effect

 private:
  /// Runs of cases that an edit added or removed.
  std::vector<RunRecord> restorableRuns() const;

  SessionDocument* document_;
  std::vector<SessionCommand> commands_;
  std::size_t done_ = 0;
};

}  // namespace boresight::sessions
