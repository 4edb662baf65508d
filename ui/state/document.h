// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include <QObject>
#include <QString>
#include <QStringList>

#include "sessions/session/session_document.h"

namespace boresight::ui {

/// The open session as the window knows it: its value, what can be undone, and signals when either
/// changes. Every edit is in the journal before `changed` is emitted. What fails is told by
/// `failed`, one sentence for the operator, and has not happened.
class Document : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;

  bool isOpen() const { return document_.has_value(); }
  /// An empty session when none is open.
  const sessions::Session& session() const;
  std::filesystem::path file() const;
  bool isModified() const { return document_ && document_->modified(); }
  /// Made by dropping files and never saved under a name of its own.
  bool isUntitled() const { return untitled_; }
  /// Why it cannot be edited, or empty.
  QString readOnlyReason() const;
  bool isEditable() const { return isOpen() && readOnlyReason().isEmpty(); }
  /// Unsaved edits of a program that was killed, waiting for a decision.
  const std::optional<sessions::Recovery>* recovery() const;

  /// Each of these returns whether it was done.
  bool open(const std::filesystem::path& file);
  bool create(const std::filesystem::path& file, const sessions::Session& session);
  /// In the folder for sessions without a name; `saveAs` gives it one.
  bool createUntitled(const sessions::Session& session);
  bool save();
  /// Also makes the edit that could not be written last, if any.
  bool saveAs(const std::filesystem::path& file);
  void close();
  /// Removes an untitled session with its runs; nothing is open afterwards.
  void discardUntitled();
  /// Drops what was changed since the session was saved, for good.
  bool discardChanges();
  bool acceptRecovery();
  bool declineRecovery();

  /// One edit, to be undone as one.
  bool edit(const sessions::Session& after, const QString& text);
  /// What happened rather than was edited (a run that ended, the case that is looked at): in the
  /// journal, but not to be undone.
  bool note(const sessions::Session& after, const QString& text);
  bool undo();
  bool redo();
  bool canUndo() const { return history_ && history_->canUndo(); }
  bool canRedo() const { return history_ && history_->canRedo(); }
  QString undoText() const;
  QString redoText() const;
  /// All edits, those that are undone last; the first `editsDone` are in effect.
  QStringList editTexts() const;
  std::size_t editsDone() const { return history_ ? history_->done() : 0; }
  /// Undoes or redoes until this number of edits is in effect.
  bool goToEdit(std::size_t done);

  /// Where sessions without a name are kept.
  static std::filesystem::path untitledFolder();
  /// The newest session without a name that no program has open, or nothing.
  static std::optional<std::filesystem::path> leftUntitled();
  /// Removes such a session with its runs.
  static void removeUntitled(const std::filesystem::path& file);

 Q_SIGNALS:
  void opened();   ///< another document, or none
  void changed();  ///< its value, or whether it is saved
  void failed(const QString& message);
  /// Nothing could be written where the session lies (a full disk, a read-only folder); one
  /// sentence. What was to be written is not lost: `saveAs` takes it elsewhere.
  void writeFailed(const QString& message);

 private:
  /// An edit that the journal could not take; the next `saveAs` makes it.
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
