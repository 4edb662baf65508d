// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/results_writer.h"

#include <chrono>
#include <utility>

#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/run_rows.h"
#include "sessions/io/errors.h"

#include "sessions/text/utc_time.h"

namespace boresight::sessions {
namespace {

std::string keyOf(const std::string& method, const std::string& case_id, std::int32_t reseed) {
  return method + '\n' + std::to_string(reseed) + '\n' + case_id;
}

std::unique_ptr<FileLock> locked(const std::filesystem::path& file) {
  std::filesystem::path lock_file = file;
  lock_file += ".lock";
  auto lock = std::make_unique<FileLock>(lock_file);
  if (!lock->held())
    throw OutputError(file, "another run is writing it" +
                                (lock->other() ? " (" + lock->other()->text() + ")" : ""));
  return lock;
}

template <class T>
std::vector<T> withFirst(std::vector<T> first, const std::vector<T>& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

std::int64_t steadyNow_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

}  // namespace

struct ResultsWriter::Insertions {
  explicit Insertions(SqlDatabase& database)
      : run(database, insertSql("run", withFirst<std::string>({"sitting"}, runTable().names()))),
        tag(database, "INSERT OR IGNORE INTO tag (run, tag) VALUES (?1, ?2)"),
        step(database,
             insertSql("iteration", withFirst<std::string>({"run"}, stepTable().names()))),
        match(database,
              insertSql("match", withFirst<std::string>({"run", "step"}, matchTable().names()))),
        removal(database,
                "DELETE FROM run WHERE case_id = ?1 AND reseed = ?2 AND method = ?3 AND status = "
                "'input_error' RETURNING id"),
        tag_removal(database, "DELETE FROM tag WHERE run = ?1"),
        sitting(database, "UPDATE sitting SET runs = ?2, seconds = ?3, ended = ?4 WHERE id = ?1") {}

  SqlStatement run;
  SqlStatement tag;
  SqlStatement step;
  SqlStatement match;
  SqlStatement removal;
  SqlStatement tag_removal;
  SqlStatement sitting;
};

ResultsWriter::ResultsWriter(const std::filesystem::path& file, const DatasetFacts& dataset)
    : lock_(locked(file)), database_(file, SqlAccess::kWrite) {
  database_.execute("PRAGMA synchronous = FULL");
  if (isEmptyDatabase(database_)) {
    makeResultsTables(database_, dataset);
  } else {
    const ResultsFacts held = factsOf(database_);
    if (const auto wrong = contradiction(held.dataset, dataset))
      throw OutputError(file, *wrong + "; name another file");
  }
  insertions_ = std::make_unique<Insertions>(database_);
  SqlStatement finished(database_,
                        "SELECT method, case_id, reseed FROM run WHERE status <> 'input_error'");
  while (finished.step())
    known_.insert(keyOf(textOf(finished.cell(0)), textOf(finished.cell(1)),
                        static_cast<std::int32_t>(integerOf(finished.cell(2)))));
}

ResultsWriter::~ResultsWriter() = default;

void ResultsWriter::admit(const MethodFacts& method) {
  for (const MethodFacts& held : factsOf(database_).methods) {
    if (held.method != method.method) continue;
    if (const auto wrong = contradiction(held, method))
      throw OutputError(database_.file(), *wrong + "; name another file");
    return;
  }
  addMethodFacts(database_, method);
}

void ResultsWriter::begin(Sitting sitting) {
  sitting_ = std::move(sitting);
  addSitting(database_, sitting_);
  began_ns_ = steadyNow_ns();
}

bool ResultsWriter::has(const std::string& method, const std::string& case_id,
                        std::int32_t reseed) const {
  return known_.count(keyOf(method, case_id, reseed)) > 0;
}

void ResultsWriter::add(const RunResult& run) {
  if (has(run.method, run.case_id, run.reseed)) return;
  SqlTransaction transaction(database_);
  insert(run);
  ++sitting_.runs;
  sitting_.seconds = 1e-9 * static_cast<double>(steadyNow_ns() - began_ns_);
  noteSitting();
  transaction.commit();
  if (!run.inputFailed()) known_.insert(keyOf(run.method, run.case_id, run.reseed));
}

void ResultsWriter::insert(const RunResult& run) {
  const SqlValue key[] = {run.case_id, std::int64_t{run.reseed}, run.method};
  insertions_->removal.bind(key);
  while (insertions_->removal.step()) {
    const SqlValue removed = insertions_->removal.cell(0);
    insertions_->tag_removal.run({&removed, 1});
  }
  insertions_->run.run(withFirst<SqlValue>({sitting_.id}, runTable().values(run)));
  const std::int64_t id = database_.lastId();
  for (const std::string& tag : run.tags) {
    const SqlValue row[] = {id, tag};
    insertions_->tag.run(row);
  }
  insertSteps(id, run);
}

void ResultsWriter::insertSteps(std::int64_t run_id, const RunResult& run) {
  for (const RunStep& step : run.steps) {
    insertions_->step.run(withFirst<SqlValue>({run_id}, stepTable().values(step)));
    for (const MatchDetails& match : step.details)
      insertions_->match.run(
          withFirst<SqlValue>({run_id, std::int64_t{step.index}}, matchTable().values(match)));
  }
}

void ResultsWriter::noteSitting() {
  const SqlValue row[] = {sitting_.id, sitting_.runs, sitting_.seconds, sitting_.ended};
  insertions_->sitting.run(row);
}

void ResultsWriter::end() {
  sitting_.ended = utcNowText();
  noteSitting();
}

}  // namespace boresight::sessions
