// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <filesystem>
#include <optional>
#include <utility>

#include <QObject>
#include <QString>
#include <QStringList>

#include "sessions/session/session_document.h"
#include "sessions/session/session_edit.h"

namespace boresight::ui {

/// Whether the unsaved changes of the session that is left are kept in its journal, or dropped for
/// good; an untitled session is then deleted with its runs.
enum class Former { kKeep, kDiscard };

/// The open session of the window: its value, its undo history, and signals when either changes.
/// Every edit is in the journal before `changed` is emitted. A failure emits `failed` with one
/// sentence for the operator and has no other effect.
class Document : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;

  bool isOpen() const { return document_.has_value(); }
  /// An empty session when none is open.
  const sessions::Session& session() const;
  std::filesystem::path file() const;
  bool isModified() const { return document_ && document_->modified(); }
  /// Whether it was created by dropping files and never saved under a name.
  bool isUntitled() const { return untitled_; }
  /// Why it cannot be edited, or empty.
  QString readOnlyReason() const;
  bool isEditable() const { return isOpen() && readOnlyReason().isEmpty(); }
  /// Unsaved edits of a program that was killed, waiting for a decision.
  const std::optional<sessions::Recovery>* recovery() const;

  /// Sentences for the operator about its opening, once: a journal that was set aside, a lock that
  /// a killed program left.
  QStringList takeNotices() { return std::exchange(notices_, {}); }

  /// Each of these returns whether it succeeded; else the open session is as it was. The session
  /// that is open already is read again, unless its changes are kept.
  bool open(const std::filesystem::path& file, Former former = Former::kKeep);
  bool create(const std::filesystem::path& file, const sessions::Session& session);
  /// Creates a session in untitledFolder(); saveAs() names it.
  bool createUntitled(const sessions::Session& session, Former former = Former::kKeep);
  bool save();
  bool saveAs(const std::filesystem::path& file);
  /// Number of sessions opened and closed so far: a dialog about one of them is not about another.
  int openings() const { return openings_; }
  bool close(Former former = Former::kKeep);
  bool acceptRecovery();
  bool declineRecovery();

  /// One edit, to be undone as one. Returns whether it is in effect: performed here, or, where it
  /// cannot be written and the receiver of `writeFailed` calls saveAs(), performed and saved there.
  bool edit(const sessions::Session& after, const QString& text);
  /// Records an event that is not an edit (a run that ended, the shown case): in the journal, but
  /// not undoable. Without a change `changed` is not emitted.
  bool note(const sessions::SessionEdit& event, const QString& text);
  bool undo();
  bool redo();
  bool canUndo() const { return history_ && history_->canUndo(); }
  bool canRedo() const { return history_ && history_->canRedo(); }
  QString undoText() const;
  QString redoText() const;
  /// Of all edits, the undone ones last; the first editsDone() are in effect.
  std::size_t editCount() const { return history_ ? history_->commands().size() : 0; }
  QString editText(std::size_t i) const;
  std::size_t editsDone() const { return history_ ? history_->done() : 0; }
  /// Undoes or redoes until this number of edits is in effect, as far as they can be written.
  bool goToEdit(std::size_t done);

  /// The folder of sessions without a name.
  static std::filesystem::path untitledFolder();
  /// The newest session without a name that no program has open, or empty.
  static std::optional<std::filesystem::path> leftUntitled();
  /// Removes such a session with its runs, unless a program has it open.
  static bool removeUntitled(const std::filesystem::path& file);

 Q_SIGNALS:
  /// It is about to be saved, left, or changed by its history: gestures under way become edits now.
  void aboutToChange();
  /// The session that was open, if any, is left; `opened` follows. A session whose edits are
  /// recovered or declined, or whose file is read again, is not left.
  void left();
  void opened();   ///< another document is open, or none
  void changed();  ///< its value, or whether it is saved, has changed
  void failed(const QString& message);
  /// Writing in the session's folder failed (a full disk, a read-only folder); one sentence. The
  /// data is not lost: saveAs() writes it elsewhere.
  void writeFailed(const QString& message);
  /// It was not saved: another program has changed the file; one sentence. saveAs() keeps the
  /// changes, open() of the same file with Former::kDiscard reads it again.
  void changedElsewhere(const QString& message);

 private:
  using Signal = void (Document::*)();

  /// Emits `done` (unless nullptr) once the action has been done.
  template <class Action>
  bool attempt(Signal done, Action&& action);
  void report(const std::exception& error);
  bool editElsewhere(const sessions::SessionEdit& refused, const QString& text,
                     const std::exception& error);
  void become(sessions::SessionDocument&& document, bool untitled, Former former);
  void leave(Former former);
  bool readAgain(Former former);

  std::optional<sessions::SessionDocument> document_;
  std::optional<sessions::SessionHistory> history_;
  sessions::Session empty_;
  bool untitled_ = false;
  QStringList notices_;
  int openings_ = 0;
  int saved_as_ = 0;  ///< number of saveAs() so far
};

}  // namespace boresight::ui
