// SPDX-License-Identifier: Apache-2.0
#include "ui/state/document.h"

#include <algorithm>
#include <exception>
#include <system_error>
#include <utility>
#include <vector>

#include <QtWidgets>

#include "sessions/io/files/errors.h"

namespace boresight::ui {
namespace {

/// A session's file with its journal, lock and runs.
void removeWithCompanions(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();  // "untitled-....boresight"
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(file.parent_path(), ignored))
    if (entry.path().filename().string().starts_with(stem + "."))
      std::filesystem::remove_all(entry.path(), ignored);
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

template <class Action>
bool Document::attempt(Signal done, Action&& action) {
  try {
    action();
  } catch (const sessions::OutputError& error) {
    Q_EMIT writeFailed(QString::fromUtf8(error.what()));
    return false;
  } catch (const std::exception& error) {
    refused_.reset();
    Q_EMIT failed(QString::fromUtf8(error.what()));
    return false;
  }
  if (done) Q_EMIT(this->*done)();
  return true;
}

void Document::become(sessions::SessionDocument&& document, bool untitled) {
  refused_.reset();
  history_.reset();  // it points to the document
  document_.emplace(std::move(document));
  history_.emplace(*document_);
  untitled_ = untitled;
}

bool Document::open(const std::filesystem::path& file) {
  Q_EMIT aboutToChange();
  return attempt(&Document::opened, [&] {
    const std::filesystem::path parent = std::filesystem::absolute(file).parent_path();
    become(sessions::SessionDocument::open(file), parent == untitledFolder());
  });
}

bool Document::create(const std::filesystem::path& file, const sessions::Session& session) {
  Q_EMIT aboutToChange();
  return attempt(&Document::opened,
                 [&] { become(sessions::SessionDocument::create(file, session), false); });
}

bool Document::createUntitled(const sessions::Session& session) {
  Q_EMIT aboutToChange();
  return attempt(&Document::opened, [&] {
    const std::filesystem::path folder = untitledFolder();
    std::filesystem::create_directories(folder);
    const QString stamp =
        QDateTime::currentDateTimeUtc().toString(QStringLiteral("yyyyMMdd-hhmmss-zzz"));
    const std::string name = "untitled-" + stamp.toStdString() + ".boresight.json";
    become(sessions::SessionDocument::create(folder / name, session), true);
  });
}

bool Document::save() {
  Q_EMIT aboutToChange();
  return document_ && attempt(&Document::changed, [&] { document_->save(); });
}

bool Document::saveAs(const std::filesystem::path& file) {
  Q_EMIT aboutToChange();
  const std::filesystem::path former = this->file();
  if (!document_ || !attempt(nullptr, [&] { document_->saveAs(file); })) return false;
  if (std::exchange(untitled_, false) && former != this->file()) removeWithCompanions(former);
  Q_EMIT changed();
  const std::optional<Refused> refused = std::exchange(refused_, std::nullopt);
  return !refused || (edit(refused->after, refused->text) && save());
}

void Document::close() {
  Q_EMIT aboutToChange();
  history_.reset();
  document_.reset();
  untitled_ = false;
  Q_EMIT opened();
}

void Document::discardUntitled() {
  if (!untitled_) return;
  const std::filesystem::path discarded = file();
  close();
  removeWithCompanions(discarded);
}

bool Document::discardChanges() {
  if (!document_) return false;
  history_.emplace(*document_);  // nothing of it can be redone
  return attempt(&Document::changed, [&] { document_->discardChanges(); });
}

void Document::removeUntitled(const std::filesystem::path& file) { removeWithCompanions(file); }

std::optional<std::filesystem::path> Document::leftUntitled() {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(untitledFolder(), ignored))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.rbegin(), files.rend());  // names hold the time
  for (const std::filesystem::path& file : files) try {
      if (!sessions::SessionDocument::open(file).readOnly()) return file;
    } catch (const std::exception&) {  // damaged: not offered
    }
  return std::nullopt;
}

bool Document::acceptRecovery() {
  return document_ && attempt(&Document::opened, [&] { document_->acceptRecovery(); });
}

bool Document::declineRecovery() {
  return document_ && attempt(&Document::opened, [&] { document_->declineRecovery(); });
}

bool Document::edit(const sessions::Session& after, const QString& text) {
  // Before the attempt: its failure is reported at once, and the answer is to save elsewhere.
  if (!history_) return false;
  refused_ = Refused{after, text};
  return attempt(&Document::changed, [&] {
    history_->perform(after, text.toStdString());
    refused_.reset();
  });
}

bool Document::note(const sessions::Session& after, const QString& text) {
  return document_ &&
         attempt(&Document::changed, [&] { document_->apply(after, text.toStdString()); });
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

QStringList Document::editTexts() const {
  QStringList texts;
  if (!history_) return texts;
  for (const sessions::SessionCommand& command : history_->commands())
    texts << QString::fromStdString(command.text);
  return texts;
}

bool Document::goToEdit(std::size_t done) {
  Q_EMIT aboutToChange();
  return history_ && done != history_->done() && attempt(&Document::changed, [&] {
           while (history_->done() > done) history_->undo();
           while (history_->done() < done && history_->canRedo()) history_->redo();
         });
}

std::filesystem::path Document::untitledFolder() {
  const QString data = QStandardPaths::writableLocation(QStandardPaths::AppDataLocation);
  return std::filesystem::path(data.toStdString()) / "untitled";
}

}  // namespace boresight::ui
