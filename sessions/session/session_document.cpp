// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_document.h"

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/session/json_patch.h"
#include "sessions/session/session_file.h"
#include "sessions/session/session_json.h"

#include "sessions/text/utc_time.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string textSha256(std::string_view text) {
  return sha256Text({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string countText(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// Options are kept in the order in which they are read back.
Session ordered(Session session) {
  std::stable_sort(session.options.begin(), session.options.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return session;
}

/// What the file will say of `session`; proves that it can be opened again and is then the same.
json provenJson(const Session& session, const fs::path& file, const std::string& text) {
  json made = json::parse(text);
  if (!(readSession(JsonReader(file, made, "")) == session))
    throw std::logic_error("a session does not read back as it was written");
  return made;
}

fs::path asideName(const fs::path& journal) {
  for (int i = 1;; ++i) {
    fs::path name = journal;
    name += ".aside-" + std::to_string(i);
    std::error_code error;
    if (!fs::exists(fs::symlink_status(name, error))) return name;
  }
}

/// Traces are immutable: a copy that is there already is right.
void copyRuns(Session& session, const fs::path& to_session) {
  std::error_code error;
  if (!session.runs.empty()) fs::create_directories(runsFolderOf(to_session), error);
  if (error) throw OutputError(runsFolderOf(to_session), error.message());
  for (RunRecord& run : session.runs) {
    const fs::path copy = runFileOf(to_session, run.digest);
    if (!fs::exists(run.file, error)) continue;  // is reported by checkInputs
    if (!fs::exists(copy, error))
      writeFileAtomically(copy, readFileBytes(run.file, SIZE_MAX, FileUse::kRun), FileUse::kRun);
    run.file = copy;
  }
}

}  // namespace

SessionDocument::SessionDocument(const fs::path& file)
    : file_(fs::absolute(file).lexically_normal()) {}
SessionDocument::SessionDocument(SessionDocument&&) noexcept = default;
SessionDocument& SessionDocument::operator=(SessionDocument&&) noexcept = default;
SessionDocument::~SessionDocument() = default;

SessionDocument SessionDocument::open(const fs::path& file, Access access) {
  SessionDocument document(file);
  // No lock file beside what is not there.
  (void)readFileBytes(document.file_, SIZE_MAX, FileUse::kSession);
  if (access == Access::kEdit)
    document.takeLock();
  else
    document.read_only_reason_ = "it was opened for reading only";
  document.readSaved();
  document.readJournalBeside();
  return document;
}

SessionDocument SessionDocument::create(const fs::path& file, const Session& session) {
  if (file.empty()) throw OutputError("(no name)", "a file name is empty");
  SessionDocument document(file);
  std::error_code error;
  if (fs::exists(fs::symlink_status(document.file_, error)))
    throw OutputError(file, "there is a file of this name already");
  requireWritable(document.file_);
  document.takeLock();
  document.requireEditable();
  const Session wanted = ordered(session);
  (void)provenJson(wanted, document.file_, sessionText(wanted, document.file_));
  if (fs::exists(journalFileOf(document.file_), error))
    document.setJournalAside("it belonged to a former session of this name");
  document.file_sha256_ = writeSessionFile(document.file_, wanted);
  document.become(wanted);
  document.saved_ = document.session_;
  return document;
}

void SessionDocument::takeLock() {
  try {
    lock_ = std::make_unique<FileLock>(lockFileOf(file_));
  } catch (const OutputError& error) {
    read_only_reason_ = "nothing can be written beside it (" + error.reason() + ")";
    return;
  }
  if (!lock_->held())
    read_only_reason_ =
        "it is open already: " +
        (lock_->other() ? lock_->other()->text() : std::string("by another program"));
  else if (lock_->stale())
    notices_.push_back("the last program that had it open did not close it: " +
                       lock_->stale()->text());
}

void SessionDocument::readSaved() {
  SavedSession saved = readSessionFile(file_);
  file_sha256_ = saved.file_sha256;
  become(saved.session);
  saved_ = session_;
}

void SessionDocument::become(const Session& session) {
  session_ = session;
  json_.reset();
}

/// What an edit is compared with. Of a large session it takes longer to make than the session to
/// read, and who only looks never needs it.
const json& SessionDocument::sessionJson() const {
  if (!json_) json_ = std::make_unique<json>(json::parse(sessionText(session_, file_)));
  return *json_;
}

void SessionDocument::readJournalBeside() {
  const fs::path file = journalFileOf(file_);
  std::error_code error;
  if (!fs::exists(file, error)) return;
  if (lock_ && !lock_->held()) return;  // it is in use: its edits are not left over
  const JournalContents contents = readJournal(file);
  if (!contents.problem.empty()) return setJournalAside(contents.problem);
  // Where the saved file stands in the journal: a program may end between saving and dropping it.
  std::size_t first = contents.entries.size() + 1;
  if (contents.base_sha256 == file_sha256_) first = 0;
  for (std::size_t i = 0; i < contents.entries.size(); ++i)
    if (contents.entries[i].after_sha256 == file_sha256_) first = i + 1;
  if (first > contents.entries.size())
    return setJournalAside("it belongs to another state of the file");
  if (first < contents.entries.size()) return noteRecovery(contents, first);
  if (contents.lost_lines > 1)
    return setJournalAside(countText(contents.lost_lines, "line") + " of it are damaged");
  if (!readOnly()) fs::remove(file, error);
}

/// The session after the journal's entries `first` to `end`; nothing when they do not fit.
std::optional<Session> SessionDocument::replayed(const JournalContents& contents, std::size_t first,
                                                 std::size_t end) const {
  json value = sessionJson();
  for (std::size_t i = first; i < end; ++i)
    if (!applyJsonPatch(json::parse(contents.entries[i].patch), value)) return std::nullopt;
  try {
    Session session = readSession(JsonReader(file_, value, ""));
    if (textSha256(sessionText(session, file_)) != contents.entries[end - 1].after_sha256)
      return std::nullopt;
    return session;
  } catch (const FileError&) {
    return std::nullopt;
  }
}

void SessionDocument::noteRecovery(const JournalContents& contents, std::size_t first) {
  for (std::size_t end = contents.entries.size(); end > first; --end) {
    std::optional<Session> session = replayed(contents, first, end);
    if (!session) continue;
    Recovery recovery;
    recovery.session = std::move(*session);
    for (std::size_t i = first; i < end; ++i) recovery.edits.push_back(contents.entries[i].text);
    recovery.time = contents.entries[end - 1].time;
    recovery.lost_lines = contents.lost_lines + contents.entries.size() - end;
    recovery_ = std::move(recovery);
    return;
  }
  setJournalAside("its edits do not fit the file");
}

void SessionDocument::setJournalAside(const std::string& why) {
  const fs::path file = journalFileOf(file_);
  if (readOnly()) {
    notices_.push_back("the journal " + file.string() + " was not used: " + why);
    return;
  }
  const fs::path aside = asideName(file);
  std::error_code error;
  fs::rename(file, aside, error);
  if (error) throw OutputError(aside, error.message());
  notices_.push_back("the journal was set aside as " + aside.string() + ": " + why);
}

void SessionDocument::requireEditable() const {
  if (readOnly()) throw OutputError(file_, read_only_reason_);
  if (recovery_)
    throw OutputError(file_,
                      "unsaved edits of an earlier program wait to be recovered or declined");
}

void SessionDocument::acceptRecovery() {
  if (!recovery_) return;
  if (readOnly()) throw OutputError(file_, read_only_reason_);
  const fs::path file = journalFileOf(file_);
  if (recovery_->lost_lines > 1)
    writeFileAtomically(asideName(file), readFileBytes(file, SIZE_MAX, FileUse::kSession));
  const std::string text = sessionText(recovery_->session, file_);
  json after = json::parse(text);
  JournalEntry entry;
  entry.text = "Recover " + countText(recovery_->edits.size(), "edit");
  entry.time = recovery_->time;
  entry.after_sha256 = textSha256(text);
  entry.patch = jsonPatch(sessionJson(), after).dump();
  journal_ = std::make_unique<Journal>(file, file_sha256_, std::vector<JournalEntry>{entry});
  session_ = std::move(recovery_->session);
  *json_ = std::move(after);
  recovery_.reset();
}

void SessionDocument::declineRecovery() {
  if (!recovery_) return;
  if (readOnly()) throw OutputError(file_, read_only_reason_);
  setJournalAside(countText(recovery_->edits.size(), "unsaved edit") + " declined");
  recovery_.reset();
}

void SessionDocument::apply(const Session& next, const std::string& text) {
  requireEditable();
  const Session wanted = ordered(next);
  const std::string written = sessionText(wanted, file_);
  json after = provenJson(wanted, file_, written);
  const json patch = jsonPatch(sessionJson(), after);
  if (patch.empty()) return;
  JournalEntry entry;
  entry.text = text;
  entry.time = utcNowText();
  entry.after_sha256 = textSha256(written);
  entry.patch = patch.dump();
  if (journal_)
    journal_->append(entry);
  else
    journal_ = std::make_unique<Journal>(journalFileOf(file_), file_sha256_,
                                         std::vector<JournalEntry>{entry});
  session_ = wanted;
  *json_ = std::move(after);
}

void SessionDocument::save() {
  requireEditable();
  std::error_code error;
  if (fs::exists(file_, error) &&
      sha256Text(readFileBytes(file_, SIZE_MAX, FileUse::kSession)) != file_sha256_)
    throw OutputError(file_,
                      "another program has changed the file since it was opened; save under "
                      "another name");
  file_sha256_ = writeSessionFile(file_, session_);
  saved_ = session_;
  journal_.reset();
  fs::remove(journalFileOf(file_), error);  // one that stays is recognized when opened
}

void SessionDocument::saveAs(const fs::path& file) {
  SessionDocument other(file);
  if (other.file_ == file_) return save();
  if (recovery_) requireEditable();
  requireWritable(other.file_, FileUse::kSession);
  other.takeLock();
  other.requireEditable();
  other.notices_.clear();
  Session session = session_;
  copyRuns(session, other.file_);
  std::error_code error;
  if (fs::exists(journalFileOf(other.file_), error))
    other.setJournalAside("the session was replaced by another one");
  other.file_sha256_ = writeSessionFile(other.file_, session);
  other.become(session);
  other.saved_ = other.session_;
  if (journal_) fs::remove(journalFileOf(file_), error);  // its edits are in the new file
  *this = std::move(other);
}

}  // namespace boresight::sessions
