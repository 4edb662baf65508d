// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_document.h"

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/log/program_log.h"
#include "sessions/session/session_file.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/utc_time.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

/// Options are kept in the order in which they are read back.
Session ordered(Session session) {
  std::ranges::stable_sort(session.options, {}, &OptionList::value_type::first);
  return session;
}

/// Proves that the text of a session can be opened again and is then the same.
void requireReadable(const Session& session, const fs::path& file, const std::string& text) {
  if (!(readSession(JsonDocument(file, text).root()) == session))
    throw std::logic_error("a written session differs when read back");
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

constexpr const char* kJournalFormat = "boresight-journal";
constexpr int kJournalVersion = 1;

Recovery readRecovery(const JsonReader& json) {
  Recovery recovery;
  recovery.base_sha256 = json.at("base_sha256").text();
  recovery.time = json.at("time").text();
  for (const JsonReader& edit : json.at("edits").elements()) recovery.edits.push_back(edit.text());
  recovery.session = readSession(json.at("session"));
  return recovery;
}

/// The session after an undo or redo to `target`. Runs and view state are not edits: they are kept
/// from `current`, except for cases that only `target` has (its runs are used) or lacks (no runs).
Session keepingRuns(const Session& target, const Session& current) {
  Session kept = target;
  kept.runs.eraseIf([&](const RunRecord& run) { return current.findCase(run.case_id) != nullptr; });
  for (const RunRecord& run : current.runs)
    if (kept.findCase(run.case_id) != nullptr) kept.runs.push_back(run);
  kept.view = current.view;
  if (kept.findCase(kept.view.case_id) == nullptr) kept.view = {};
  return kept;
}

}  // namespace

void writeJournal(const std::filesystem::path& file, const Journal& journal,
                  const std::string& session_text) {
  const nlohmann::ordered_json header = {{"format", kJournalFormat},
                                         {"version", kJournalVersion},
                                         {"base_sha256", journal.base_sha256},
                                         {"time", journal.time},
                                         {"edits", journal.edits}};
  std::string text = header.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  text.pop_back();  // the closing brace
  writeFileAtomically(file, text + ",\n\"session\": " + session_text + "}\n", FileUse::kSession);
}

Recovery readJournal(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = readFileBytes(file, 2 * kMaxJsonBytes, FileUse::kSession);
  return JsonDocument(file, asText(bytes)).read(kJournalFormat, kJournalVersion, readRecovery);
}

SessionDocument::SessionDocument(const fs::path& file)
    : file_(fs::absolute(file).lexically_normal()) {}

SessionDocument SessionDocument::open(const fs::path& file, Access access) {
  SessionDocument document(file);
  // No lock file without a session file.
  (void)readFileBytes(document.file_, SIZE_MAX, FileUse::kSession);
  if (access == Access::kEdit)
    document.takeLock();
  else
    document.read_only_reason_ = "it was opened for reading only";
  SavedSession saved = readSessionFile(document.file_);
  document.file_sha256_ = saved.file_sha256;
  document.session_ = document.saved_ = std::move(saved.session);
  document.readJournalBeside();
  return document;
}

SessionDocument SessionDocument::create(const fs::path& file, const Session& session) {
  if (file.empty()) throw OutputError("(no name)", "a file name is empty");
  SessionDocument document(file);
  std::error_code error;
  if (fs::exists(fs::symlink_status(document.file_, error)))
    throw OutputError(file, "the file exists");
  requireWritable(document.file_);
  document.takeLock();
  document.requireEditable();
  const Session wanted = ordered(session);
  requireReadable(wanted, document.file_, sessionText(wanted, document.file_));
  if (fs::exists(journalFileOf(document.file_), error))
    document.setJournalAside("it belonged to a former session of this name");
  document.file_sha256_ = writeSessionFile(document.file_, wanted);
  document.session_ = document.saved_ = wanted;
  return document;
}

void SessionDocument::takeLock() {
  try {
    lock_ = std::make_unique<FileLock>(lockFileOf(file_));
  } catch (const OutputError& error) {
    read_only_reason_ = "nothing can be written next to it (" + error.reason() + ")";
    return;
  }
  if (!lock_->held())
    read_only_reason_ =
        "it is open already: " +
        (lock_->other() ? lock_->other()->text() : std::string("by another program"));
  else if (lock_->stale())
    notice("the last program did not close it: " + lock_->stale()->text());
}

void SessionDocument::readJournalBeside() {
  const fs::path file = journalFileOf(file_);
  std::error_code error;
  if (!fs::exists(file, error)) return;
  if (lock_ && !lock_->held()) return;  // it is in use: its edits are not left over
  try {
    Recovery left = readJournal(file);
    // A program may end between saving the edits and removing the journal.
    if (sha256Text(sessionText(left.session, file_)) == file_sha256_) {
      if (!readOnly()) fs::remove(file, error);
    } else if (left.base_sha256 == file_sha256_) {
      recovery_ = std::move(left);
      logEvent(LogLevel::kInfo, [this] {
        return file_.string() + ": " + countText(recovery_->edits.size(), "unsaved edit") +
               " of an earlier program, last at " + recovery_->time;
      });
    } else {
      setJournalAside("it belongs to another state of the file");
    }
  } catch (const InputError& wrong) {
    setJournalAside("it is damaged, or from another version of the program (" + wrong.reason() +
                    ")");
  }
}

void SessionDocument::notice(const std::string& text) {
  notices_.push_back(text);
  logEvent(LogLevel::kInfo, [&] { return file_.string() + ": " + text; });
}

void SessionDocument::setJournalAside(const std::string& why) {
  const fs::path file = journalFileOf(file_);
  if (readOnly()) {
    notice("the journal " + file.string() + " was not used: " + why);
    return;
  }
  const fs::path aside = asideName(file);
  std::error_code error;
  fs::rename(file, aside, error);
  if (error) throw OutputError(aside, error.message());
  notice("the journal was set aside as " + aside.string() + ": " + why);
}

void SessionDocument::requireEditable() const {
  if (readOnly()) throw OutputError(file_, read_only_reason_);
  if (recovery_)
    throw OutputError(file_, "unsaved edits of an earlier program must be recovered or declined");
}

void SessionDocument::acceptRecovery() {
  if (!recovery_) return;
  if (readOnly()) throw OutputError(file_, read_only_reason_);
  Journal journal = *recovery_;
  journal.edits = {"Recover " + countText(recovery_->edits.size(), "edit")};
  writeJournal(journalFileOf(file_), journal, sessionText(recovery_->session, file_));
  journal_ = std::move(journal);
  session_ = std::move(recovery_->session);
  recovery_.reset();
  logEvent(LogLevel::kInfo,
           [this] { return file_.string() + ": recovered the edits of an earlier program"; });
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
  if (wanted == session_) return;
  const std::string session_text = sessionText(wanted, file_);
  requireReadable(wanted, file_, session_text);
  Journal journal = journal_.value_or(Journal{file_sha256_, {}, {}});
  journal.time = utcNowText();
  journal.edits.push_back(text);
  writeJournal(journalFileOf(file_), journal, session_text);
  journal_ = std::move(journal);
  session_ = wanted;
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

void SessionDocument::discardChanges() {
  requireEditable();
  std::error_code error;
  fs::remove(journalFileOf(file_), error);
  if (error) throw OutputError(journalFileOf(file_), error.message());
  journal_.reset();
  session_ = saved_;
}

void SessionDocument::readAgain() {
  SavedSession saved = readSessionFile(file_);
  discardChanges();
  file_sha256_ = saved.file_sha256;
  session_ = saved_ = std::move(saved.session);
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
  other.session_ = other.saved_ = std::move(session);
  if (journal_) fs::remove(journalFileOf(file_), error);  // its edits are in the new file
  *this = std::move(other);
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
