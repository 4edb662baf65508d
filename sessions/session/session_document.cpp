// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_document.h"

#include <unistd.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/created_folder.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/files/link_target.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/log/program_log.h"
#include "sessions/session/session_change.h"
#include "sessions/session/session_file.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

/// Options are kept in the order in which they are read back.
Session ordered(Session session) {
  std::ranges::stable_sort(session.options, {}, &OptionList::value_type::first);
  return session;
}

std::logic_error differsWhenRead() {
  return std::logic_error("a written session differs when read back");
}

/// The change as JSON. OutputError unless it is UTF-8; InputError and std::logic_error unless it
/// gives the same session when it is read.
std::string changeText(const Session& before, const Session& after, const fs::path& journal) {
  std::string text;
  try {
    const nlohmann::ordered_json change = sessionChange(before, after, journal);
    text = change.dump();
    (void)prettyJson(change);  // throws for a number that is not finite
  } catch (const nlohmann::json::exception&) {
    throw OutputError(journal, "a name or comment in the session is not UTF-8 text");
  }
  const JsonDocument written(journal, text);
  if (!(withChange(before, written.root()) == after)) throw differsWhenRead();
  return text;
}

/// A file that versions before 1.1 wrote next to a session NAME without .json: NAME.journal,
/// NAME.lock. Empty for other names, and where the file may belong to a session NAME.json.
std::optional<fs::path> formerCompanion(const fs::path& session_file, const char* extension) {
  if (session_file.extension() == ".json") return std::nullopt;
  fs::path owner = session_file;
  owner += ".json";
  std::error_code error;
  if (fs::exists(fs::symlink_status(owner, error))) return std::nullopt;
  fs::path name = session_file;
  return name += extension;
}

std::optional<fs::path> formerJournalOf(const fs::path& session_file) {
  const auto file = formerCompanion(session_file, ".journal");
  return file && isJournal(*file) ? file : std::nullopt;
}

std::optional<fs::path> formerLockOf(const fs::path& session_file) {
  const auto file = formerCompanion(session_file, ".lock");
  return file && readLockFile(*file) ? file : std::nullopt;
}

/// The journal of a session, or else that of a former version.
fs::path journalNextTo(const fs::path& session_file) {
  const fs::path own = journalFileOf(session_file);
  std::error_code error;
  if (fs::exists(own, error)) return own;
  return formerJournalOf(session_file).value_or(own);
}

bool isOpenInAProgram(const fs::path& session_file) {
  const auto isHeld = [](const fs::path& lock) {
    const auto holder = readLockFile(lock);
    return holder && !hasEnded(*holder);
  };
  const auto former = formerLockOf(session_file);
  return isHeld(lockFileOf(session_file)) || (former && isHeld(*former));
}

fs::path asideName(const fs::path& journal) {
  for (int i = 1;; ++i) {
    fs::path name = journal;
    name += ".aside-" + std::to_string(i);
    std::error_code error;
    if (!fs::exists(fs::symlink_status(name, error))) return name;
  }
}

/// Where a session has the trace of a run: in its own folder, or where the run names it.
fs::path traceOf(const RunRecord& run, const fs::path& session_file) {
  std::error_code error;
  const fs::path own = runFileOf(session_file, run.digest);
  return fs::exists(own, error) ? own : run.file;
}

/// Traces are immutable, and replaced by renaming: a hard link is as good as a copy, and a copy
/// that is there already is right. A missing one is reported by checkInputs.
void copyTrace(const RunRecord& run, const fs::path& from_session, const fs::path& to_session) {
  std::error_code error;
  const fs::path trace = traceOf(run, from_session);
  const fs::path copy = runFileOf(to_session, run.digest);
  if (fs::exists(copy, error) || !fs::exists(trace, error)) return;
  const CreatedFolder folder(copy.parent_path());
  fs::create_hard_link(fs::canonical(trace, error), copy, error);
  if (!error) return;
  writeFileAtomically(copy, readFileBytes(trace, SIZE_MAX, FileUse::kRun), FileUse::kRun);
}

/// Ids of the cases that `session` has and `other` lacks.
std::set<std::string> casesMissingIn(const Session& other, const Session& session) {
  std::set<std::string> ids;
  const auto add = [&](std::size_t /*i*/, const SharedValue<SessionCase>& session_case) {
    if (other.findCase(session_case->id) == nullptr) ids.insert(session_case->id);
  };
  decltype(session.cases)::forEachDifference(
      other.cases, session.cases, add, [](std::size_t /*i*/) {}, add);
  return ids;
}

/// The session in `file` after an undo or redo to `target`. Runs and view state are not edits: they
/// are kept from `current`, except for cases that only `target` has (its runs are used) or lacks
/// (no runs).
Session keepingRuns(const Session& target, const Session& current, const fs::path& file) {
  Session kept = target;
  kept.runs = current.runs;
  for (const std::string& id : casesMissingIn(target, current))
    kept.runs.eraseIf(id, [](const RunRecord& /*run*/) { return true; });
  for (const std::string& id : casesMissingIn(current, target))
    for (const RunRecord* run : target.runs.findAll(id)) {
      RunRecord restored = *run;
      restored.file = traceOf(*run, file);  // it was saved under another name since
      kept.runs.push_back(std::move(restored));
    }
  kept.view = current.view;
  if (kept.findCase(kept.view.case_id) == nullptr) kept.view = {};
  return kept;
}

}  // namespace

SessionDocument::SessionDocument(const fs::path& file)
    : file_(linkTarget(fs::absolute(file).lexically_normal())) {}

SessionDocument SessionDocument::open(const fs::path& file, Access access) {
  SessionDocument document(file);
  // No lock file without a session file.
  (void)readBeginning(document.file_, 1);
  document.journals_ = access == Access::kEdit;
  if (access != Access::kReadOnly)
    document.takeLock();
  else
    document.read_only_reason_ = "it was opened for reading only";
  SavedSession saved = readSessionFile(document.file_);
  document.file_sha256_ = saved.file_sha256;
  document.file_bytes_ = saved.size_bytes;
  document.session_ = document.saved_ = std::move(saved.session);
  document.readJournalBeside();
  return document;
}

SessionDocument SessionDocument::create(const fs::path& file, const Session& session) {
  if (file.empty()) throw OutputError("(no name)", "a file name is empty");
  SessionDocument document(file);
  document.takeLock();
  std::error_code error;
  if (fs::exists(fs::symlink_status(document.file_, error)))
    throw OutputError(file, "the file exists");
  requireWritable(document.file_);
  document.requireEditable();
  const Session wanted = ordered(session);
  const std::string text = sessionFileText(wanted, document.file_);
  const JsonDocument written(document.file_, text);
  if (!(readSession(written.root()) == wanted)) throw differsWhenRead();
  document.begin(wanted, text, "it belonged to a former session of this name");
  return document;
}

/// Until a journal of this name is set aside, it is recognized as one of another state of the file.
void SessionDocument::begin(Session session, const std::string& text, const std::string& former) {
  writeFileAtomically(file_, text, FileUse::kSession);
  file_sha256_ = sha256Text(text);
  file_bytes_ = text.size();
  session_ = saved_ = std::move(session);
  std::error_code error;
  if (!fs::exists(journalFileOf(file_), error)) return;
  try {
    setJournalAside(former);
  } catch (const OutputError& failed) {
    notice("the journal of another session of this name is still there: " + failed.reason());
  }
}

void SessionDocument::takeLock() {
  try {
    lock_ = std::make_unique<FileLock>(lockFileOf(file_));
    if (lock_->held()) respectFormerLock();
  } catch (const OutputError& error) {
    lock_.reset();
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

/// The lock of a program of a former version counts while that has the session open.
void SessionDocument::respectFormerLock() {
  const auto file = formerLockOf(file_);
  if (!file) return;
  auto former = std::make_unique<FileLock>(*file);
  if (!former->held())
    lock_ = std::move(former);
  else if (former->stale())
    notice("the last program did not close it: " + former->stale()->text());
}

/// Renames the session's journal of a former version.
void SessionDocument::adoptJournal(const fs::path& former) {
  const fs::path journal = journalFileOf(file_);
  std::error_code error;
  fs::rename(former, journal, error);
  if (error) throw OutputError(journal, error.message());
  notice("the journal " + former.string() + " of a former version was renamed " + journal.string());
}

void SessionDocument::readJournalBeside() {
  const fs::path file = journalNextTo(file_);
  std::error_code error;
  if (!fs::exists(file, error)) return;
  if (lock_ && !lock_->held()) return;  // it is in use: its edits are not left over
  try {
    Recovery left = readJournal(file, {saved_, file_sha256_, file_bytes_});
    if (!readOnly() && file != journalFileOf(file_)) adoptJournal(file);
    if (!left.damage.empty())
      notice("the journal " + journalNextTo(file_).string() + " is damaged: " + left.damage + "; " +
             countText(left.edits.size(), "edit") + " before it can be recovered");
    // Its edits may have been saved, or undone.
    const bool leaves_nothing = left.edits.empty() || left.session == saved_;
    if (!left.damage.empty() && left.edits.empty()) {
      setJournalAside("no edit of it can be recovered");
    } else if (!left.damage.empty() || !leaves_nothing) {
      recovery_ = std::move(left);
      logEvent(LogLevel::kInfo, [this] {
        return file_.string() + ": " + countText(recovery_->edits.size(), "unsaved edit") +
               " of an earlier program, last at " + recovery_->time;
      });
    } else if (!readOnly()) {
      fs::remove(journalFileOf(file_), error);
    }
  } catch (const InputError& wrong) {
    setJournalAside("it cannot be used: " + wrong.reason());
  }
}

void SessionDocument::notice(const std::string& text) {
  notices_.push_back(text);
  logEvent(LogLevel::kInfo, [&] { return file_.string() + ": " + text; });
}

void SessionDocument::setJournalAside(const std::string& why) {
  const fs::path file = journalNextTo(file_);
  if (readOnly() || file != journalFileOf(file_)) {
    notice("the journal " + file.string() + " was not used: " + why);
    return;
  }
  const fs::path aside = asideName(file);
  std::error_code error;
  fs::rename(file, aside, error);
  if (error) throw OutputError(aside, error.message());
  notice("the journal was set aside as " + aside.string() + ": " + why);
}

fs::path SessionDocument::copyJournalAside() const {
  const fs::path journal = journalFileOf(file_);
  const fs::path aside = asideName(journal);
  std::error_code error;
  fs::copy_file(journal, aside, error);
  if (!error) return aside;
  const std::string reason = error.message();
  fs::remove(aside, error);  // cut
  throw OutputError(aside, reason);
}

void SessionDocument::noticeKept(const fs::path& aside) {
  notice("the damaged journal is kept as " + aside.string());
}

void SessionDocument::requireEditable() const {
  if (readOnly()) throw OutputError(file_, read_only_reason_);
  if (recovery_)
    throw OutputError(file_, "unsaved edits of an earlier program must be recovered or declined");
}

std::string SessionDocument::unsavedText() const {
  if (!recovery_) return "";
  const std::size_t edits = recovery_->edits.size();
  const std::string count = countText(edits, "edit") + (edits == 1 ? " was" : " were");
  if (readOnly() && isOpenInAProgram(file_))
    return count + " not saved yet: save the session in the program that has it open";
  if (::access(file_.parent_path().c_str(), W_OK | X_OK) != 0)
    return count +
           " never saved, and the folder is read-only: recover in the desktop program and "
           "save in another folder (Save as)";
  return count +
         " never saved: recover with `whs decide --recover` or `whs run --recover`, or in the "
         "desktop program";
}

void SessionDocument::requireNothingUnsaved() const {
  if (recovery_) throw InputError(file_, unsavedText());
}

void SessionDocument::saveRecovery() {
  if (!recovery_) return;
  if (readOnly()) throw OutputError(file_, read_only_reason_);
  const Recovery left = *recovery_;
  const fs::path aside = copyJournalAside();
  // From this journal the next program knows whether a killed one has saved the edits.
  const bool journals = std::exchange(journals_, true);
  try {
    takeRecovery();
    save();
  } catch (...) {
    std::error_code error;
    fs::rename(aside, journalFileOf(file_), error);
    journal_.reset();
    recovery_ = left;
    session_ = saved_;
    journals_ = journals;
    throw;
  }
  journals_ = journals;
  std::error_code error;
  if (left.damage.empty())
    fs::remove(aside, error);  // its edits are in the file
  else
    noticeKept(aside);
}

void SessionDocument::acceptRecovery() {
  if (!recovery_) return;
  if (readOnly()) {
    session_ = std::move(recovery_->session);
    return recovery_.reset();
  }
  if (recovery_->damage.empty()) return takeRecovery();
  const fs::path aside = copyJournalAside();
  try {
    takeRecovery();
  } catch (...) {
    std::error_code error;
    fs::remove(aside, error);
    throw;
  }
  noticeKept(aside);
}

/// The edits become one edit of a journal that replaces the former one.
void SessionDocument::takeRecovery() {
  addToJournal(recovery_->session, "Recover " + countText(recovery_->edits.size(), "edit") + ": " +
                                       joined(recovery_->edits));
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
  Session wanted = ordered(next);
  if (wanted == session_) return;
  addToJournal(wanted, text);
  session_ = std::move(wanted);  // cannot fail: the edit is in the journal
  if (journals_ && session_ == saved_) dropJournal();
}

/// Another program has removed the journal: with all edits since the file was saved.
void SessionDocument::writeJournalAgain() {
  const fs::path journal = journalFileOf(file_);
  JournalWriter writer(journal, file_sha256_);
  writer.addEdit("Edits before the journal was removed", changeText(saved_, session_, journal));
  journal_ = std::move(writer);
  logEvent(LogLevel::kInfo,
           [&journal] { return journal.string() + ": removed by another program; written again"; });
}

/// There is nothing to recover.
void SessionDocument::dropJournal() {
  journal_.reset();
  std::error_code error;
  fs::remove(journalFileOf(file_), error);  // one that stays is recognized when opened
}

void SessionDocument::addToJournal(const Session& next, const std::string& text) {
  const fs::path journal = journalFileOf(file_);
  const std::string change = changeText(session_, next, journal);
  if (!journals_) return;
  std::error_code error;
  if (journal_ && !fs::exists(journal, error) && !error) writeJournalAgain();
  JournalWriter writer = journal_.value_or(JournalWriter(journal, file_sha256_));
  // The session file has a line for each member: at most twice as long as the change.
  if (file_bytes_ + 2 * (writer.size_bytes() + change.size()) > kMaxSessionBytes)
    throw OutputError(file_, "the session and its unsaved edits reach the limit of " +
                                 std::to_string(kMaxSessionBytes / kMegabyte) +
                                 " MB: save the session, then remove cases or runs");
  writer.addEdit(text, change);
  journal_ = std::move(writer);
}

void SessionDocument::save() {
  requireEditable();
  std::error_code error;
  if (fs::exists(file_, error) &&
      sha256Text(readFileBytes(file_, SIZE_MAX, FileUse::kSession)) != file_sha256_)
    throw FileChangedError(file_);
  const std::string text = sessionFileText(session_, file_);
  std::string sha256 = sha256Text(text);
  try {
    if (journal_) journal_->addSaved(sha256);
  } catch (const OutputError&) {
    // The file is what counts. A program that ends before the journal is removed sets it aside.
  }
  writeFileAtomically(file_, text, FileUse::kSession);
  file_sha256_ = std::move(sha256);
  file_bytes_ = text.size();
  saved_ = session_;
  dropJournal();
}

void SessionDocument::discardChanges() {
  if (readOnly() && modified()) {
    session_ = saved_;
    return;
  }
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
  file_bytes_ = saved.size_bytes;
  session_ = saved_ = std::move(saved.session);
}

void SessionDocument::saveAs(const fs::path& file, std::span<const RunRecord> restorable) {
  SessionDocument other(file);
  std::error_code error;
  if (other.file_.filename() == file_.filename() &&
      fs::equivalent(other.file_.parent_path(), file_.parent_path(), error))
    return save();
  if (recovery_) requireEditable();
  requireWritable(other.file_, FileUse::kSession);
  other.takeLock();
  other.requireEditable();
  other.notices_.clear();
  Session session = session_;
  for (const RunRecord& run : restorable) copyTrace(run, file_, other.file_);
  for (RunRecord& run : session.runs) {
    copyTrace(run, file_, other.file_);
    run.file = traceOf(run, other.file_);
  }
  syncFolder(runsFolderOf(other.file_));  // the names of links
  const std::string text = sessionFileText(session, other.file_);
  other.begin(std::move(session), text, "the session was replaced by another one");
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

std::vector<RunRecord> SessionHistory::restorableRuns() const {
  std::vector<RunRecord> runs;
  const auto addMissing = [&runs](const Session& other, const Session& session) {
    for (const std::string& id : casesMissingIn(other, session))
      for (const RunRecord* run : session.runs.findAll(id)) runs.push_back(*run);
  };
  for (const SessionCommand& command : commands_) {
    addMissing(command.after, command.before);
    addMissing(command.before, command.after);
  }
  return runs;
}

void SessionHistory::saveAs(const fs::path& file) { document_->saveAs(file, restorableRuns()); }

void SessionHistory::undo() {
  if (!canUndo()) return;
  SessionCommand& command = commands_[done_ - 1];
  const Session current = document_->session();
  const fs::path& file = document_->file();
  document_->apply(keepingRuns(command.before, current, file), "Undo: " + command.text);
  // With the runs of cases that are gone now.
  command.after = keepingRuns(command.after, current, file);
  --done_;
}

void SessionHistory::redo() {
  if (!canRedo()) return;
  SessionCommand& command = commands_[done_];
  const Session current = document_->session();
  const fs::path& file = document_->file();
  document_->apply(keepingRuns(command.after, current, file), "Redo: " + command.text);
  // With the runs of cases that are gone now.
  command.before = keepingRuns(command.before, current, file);
  ++done_;
}

}  // namespace boresight::sessions
