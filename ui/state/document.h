// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include <QObject>
#include <QString>
#include <QStringList>

#include "sessions/session/session_document.h"

namespace boresight::ui {

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

  /// Each of these returns whether it succeeded.
  bool open(const std::filesystem::path& file);
  bool create(const std::filesystem::path& file, const sessions::Session& session);
  /// Creates a session in untitledFolder(); saveAs() names it.
  bool createUntitled(const sessions::Session& session);
  bool save();
  /// Also applies the last edit that could not be written, if any.
  bool saveAs(const std::filesystem::path& file);
  void close();
  /// Removes an untitled session with its runs; nothing is open afterwards.
  void discardUntitled();
  /// Permanently drops all changes since the session was saved.
  bool discardChanges();
  bool acceptRecovery();
  bool declineRecovery();

  /// One edit, to be undone as one.
  bool edit(const sessions::Session& after, const QString& text);
  /// Records an event that is not an edit (a run that ended, the shown case): in the journal, but
  /// not undoable.
  bool note(const sessions::Session& after, const QString& text);
  bool undo();
  bool redo();
  bool canUndo() const { return history_ && history_->canUndo(); }
  bool canRedo() const { return history_ && history_->canRedo(); }
  QString undoText() const;
  QString redoText() const;
  /// All edits, the undone ones last; the first editsDone() are in effect.
  QStringList editTexts() const;
  std::size_t editsDone() const { return history_ ? history_->done() : 0; }
  /// Undoes or redoes until this number of edits is in effect.
  bool goToEdit(std::size_t done);

  /// The folder of sessions without a name.
  static std::filesystem::path untitledFolder();
  /// The newest session without a name that no program has open, or empty.
  static std::optional<std::filesystem::path> leftUntitled();
  /// Removes such a session with its runs.
  static void removeUntitled(const std::filesystem::path& file);

 Q_SIGNALS:
  /// It is about to be saved, left, or changed by its history: gestures under way become edits now.
  void aboutToChange();
  void opened();   ///< another document is open, or none
  void changed();  ///< its value, or whether it is saved, has changed
  void failed(const QString& message);
  /// Writing in the session's folder failed (a full disk, a read-only folder); one sentence. The
  /// data is not lost: saveAs() writes it elsewhere.
  void writeFailed(const QString& message);

 private:
  /// An edit that could not be written to the journal; the next saveAs() applies it.
  struct Refused {
    sessions::Session after;
    QString text;
  };

  using Signal = void (Document::*)();

  /// Emits `done` (unless nullptr) once the action has been done.
  template <class Action>
  bool attempt(Signal done, Action&& action);
  void become(sessions::SessionDocument&& document, bool untitled);

  std::optional<sessions::SessionDocument> document_;
  std::optional<sessions::SessionHistory> history_;
  sessions::Session empty_;
  bool untitled_ = false;
  std::optional<Refused> refused_;
};

}  // namespace boresight::ui
