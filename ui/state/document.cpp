// SPDX-License-Identifier: Apache-2.0
#include "ui/state/document.h"

#include <algorithm>
#include <exception>
#include <new>
#include <system_error>
#include <utility>
#include <vector>

#include <QtWidgets>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_lock.h"
#include "sessions/session/session_file.h"

namespace boresight::ui {
namespace {

/// The entries of a folder; those that can be read.
std::vector<std::filesystem::path> entriesOf(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> entries;
  std::error_code ignored;
  for (std::filesystem::directory_iterator entry(folder, ignored), end; entry != end;
       entry.increment(ignored))
    entries.push_back(entry->path());
  return entries;
}

bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  return std::filesystem::equivalent(a, b, ignored);
}

/// A session's file with its journal and runs. The file goes first: without it nothing is opened.
void removeWithCompanions(const std::filesystem::path& file) {
  const std::filesystem::path lock = sessions::lockFileOf(file);
  const std::string stem = file.stem().string();  // "untitled-....boresight"
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  for (const std::filesystem::path& entry : entriesOf(file.parent_path()))
    if (entry != lock && entry.filename().string().starts_with(stem + "."))
      std::filesystem::remove_all(entry, ignored);
}

QString sentenceOf(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr)
    return Document::tr("There is not enough memory.");
  const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error);
  if (file == nullptr) return QString::fromUtf8(error.what());
  return QStringLiteral("%1: %2").arg(QString::fromStdString(file->path1().string()),
                                      QString::fromStdString(file->code().message()));
}

}  // namespace

const sessions::Session& Document::session() const {
  return document_ ? document_->session() : empty_;
}

std::filesystem::path Document::file() const {
  return document_ ? document_->file() : std::filesystem::path();
}

QString Document::readOnlyReason() const {
  return document_ ? QString::fromStdString(document_->readOnlyReason()) : QString();
}

const std::optional<sessions::Recovery>* Document::recovery() const {
  return document_ && document_->recovery() ? &document_->recovery() : nullptr;
}

void Document::report(const std::exception& error) {
  const QString sentence = sentenceOf(error);
  if (dynamic_cast<const sessions::FileChangedError*>(&error) != nullptr)
    Q_EMIT changedElsewhere(sentence);
  else if (dynamic_cast<const sessions::OutputError*>(&error) != nullptr)
    Q_EMIT writeFailed(sentence);
  else
    Q_EMIT failed(sentence);
}

template <class Action>
bool Document::attempt(Signal done, Action&& action) {
  try {
    action();
  } catch (const std::exception& error) {
    report(error);
    return false;
  }
  if (done) Q_EMIT(this->*done)();
  return true;
}

/// While its lock is held; afterwards another program may have it open.
void Document::leave(Former former) {
  if (former == Former::kKeep || !document_) return;
  if (untitled_)
    removeWithCompanions(file());
  else
    document_->discardChanges();
}

void Document::become(sessions::SessionDocument&& document, bool untitled, Former former) {
  leave(former);
  ++openings_;
  history_.reset();  // it points to the document
  document_.emplace(std::move(document));
  history_.emplace(*document_);
  untitled_ = untitled;
  notices_.clear();
  for (const std::string& text : document_->notices())
    notices_ << tr("%1: %2.").arg(QString::fromStdString(document_->file().filename().string()),
                                  QString::fromStdString(text));
  Q_EMIT left();
}

/// The open session: this program holds its lock already.
bool Document::readAgain(Former former) {
  return attempt(&Document::opened, [&] {
    if (document_->recovery() || (isModified() && former == Former::kKeep)) return;
    document_->readAgain();
    history_.emplace(*document_);
  });
}

bool Document::open(const std::filesystem::path& file, Former former) {
  Q_EMIT aboutToChange();
  if (isEditable() && isSameFile(file, this->file())) return readAgain(former);
  return attempt(&Document::opened, [&] {
    const std::filesystem::path parent = std::filesystem::absolute(file).parent_path();
    become(sessions::SessionDocument::open(file), parent == untitledFolder(), former);
  });
}

bool Document::create(const std::filesystem::path& file, const sessions::Session& session) {
  Q_EMIT aboutToChange();
  return attempt(&Document::opened, [&] {
    become(sessions::SessionDocument::create(file, session), false, Former::kKeep);
  });
}

bool Document::createUntitled(const sessions::Session& session, Former former) {
  Q_EMIT aboutToChange();
  return attempt(&Document::opened, [&] {
    const std::filesystem::path folder = untitledFolder();
    std::filesystem::create_directories(folder);
    const QString stamp =
        QDateTime::currentDateTimeUtc().toString(QStringLiteral("yyyyMMdd-hhmmss-zzz"));
    const std::string name = "untitled-" + stamp.toStdString() + ".boresight.json";
    become(sessions::SessionDocument::create(folder / name, session), true, former);
  });
}

bool Document::save() {
  Q_EMIT aboutToChange();
  return document_ && attempt(&Document::changed, [&] { document_->save(); });
}

bool Document::saveAs(const std::filesystem::path& file) {
  Q_EMIT aboutToChange();
  const std::filesystem::path former = this->file();
  if (!document_ || !attempt(nullptr, [&] { history_->saveAs(file); })) return false;
  if (std::exchange(untitled_, false) && former != this->file()) removeUntitled(former);
  ++saved_as_;
  Q_EMIT changed();
  return true;
}

bool Document::close(Former former) {
  Q_EMIT aboutToChange();
  return attempt(&Document::opened, [&] {
    leave(former);
    ++openings_;
    history_.reset();
    document_.reset();
    untitled_ = false;
    Q_EMIT left();
  });
}

bool Document::removeUntitled(const std::filesystem::path& file) {
  try {
    const sessions::FileLock lock(sessions::lockFileOf(file));
    if (lock.held()) removeWithCompanions(file);
    return lock.held();
  } catch (const std::exception&) {  // the folder is read-only
    return false;
  }
}

std::optional<std::filesystem::path> Document::leftUntitled() {
  std::vector<std::filesystem::path> files = entriesOf(untitledFolder());
  std::erase_if(files, [](const std::filesystem::path& file) {
    return file.extension() != ".json" || sessions::isLocked(sessions::lockFileOf(file));
  });
  const auto newest = std::max_element(files.begin(), files.end());  // names hold the time
  return newest == files.end() ? std::nullopt : std::optional(*newest);
}

bool Document::acceptRecovery() {
  return document_ && attempt(&Document::opened, [&] { document_->acceptRecovery(); });
}

bool Document::declineRecovery() {
  return document_ && attempt(&Document::opened, [&] { document_->declineRecovery(); });
}

bool Document::edit(const sessions::Session& after, const QString& text) {
  if (!history_) return false;
  try {
    history_->perform(after, text.toStdString());
  } catch (const sessions::OutputError& error) {
    return editElsewhere(sessions::editBetween(session(), after), text, error);
  } catch (const std::exception& error) {
    report(error);
    return false;
  }
  Q_EMIT changed();
  return true;
}

/// Reports why an edit was refused. It is performed on the session as it is after the report, which
/// may take long and in which runs end, if the session was saved elsewhere meanwhile; else dropped.
bool Document::editElsewhere(const sessions::SessionEdit& refused, const QString& text,
                             const std::exception& error) {
  const int openings = openings_;
  const int saved_as = saved_as_;
  report(error);
  if (openings != openings_ || saved_as == saved_as_) return false;
  bool performed = false;
  attempt(nullptr, [&] { performed = edit(refused(session()), text); });
  if (performed) save();
  return performed;
}

bool Document::note(const sessions::SessionEdit& event, const QString& text) {
  bool differs = false;
  const bool noted = document_ && attempt(nullptr, [&] {
                       const sessions::Session after = event(session());
                       differs = !(after == session());
                       if (differs) document_->apply(after, text.toStdString());
                     });
  if (noted && differs) Q_EMIT changed();
  return noted;
}

bool Document::undo() {
  Q_EMIT aboutToChange();
  return canUndo() && attempt(&Document::changed, [&] { history_->undo(); });
}

bool Document::redo() {
  Q_EMIT aboutToChange();
  return canRedo() && attempt(&Document::changed, [&] { history_->redo(); });
}

QString Document::undoText() const {
  return history_ ? QString::fromStdString(history_->undoText()) : QString();
}

QString Document::redoText() const {
  return history_ ? QString::fromStdString(history_->redoText()) : QString();
}

QString Document::editText(std::size_t i) const {
  return QString::fromStdString(history_->commands()[i].text);
}

bool Document::goToEdit(std::size_t done) {
  Q_EMIT aboutToChange();
  if (!history_ || done == history_->done()) return false;
  const std::size_t before = history_->done();
  return attempt(&Document::changed, [&] {
    try {
      while (history_->done() > done) history_->undo();
      while (history_->done() < done && history_->canRedo()) history_->redo();
    } catch (const std::exception&) {
      if (history_->done() != before) Q_EMIT changed();  // then the failure is reported
      throw;
    }
  });
}

std::filesystem::path Document::untitledFolder() {
  const QString data = QStandardPaths::writableLocation(QStandardPaths::AppDataLocation);
  return std::filesystem::path(data.toStdString()) / "untitled";
}

}  // namespace boresight::ui
