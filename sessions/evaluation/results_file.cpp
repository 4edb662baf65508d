// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/results_file.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <unordered_map>
#include <utility>

#include "sessions/evaluation/run_rows.h"
#include "sessions/io/files/errors.h"
#include "sessions/text/utc_time.h"

namespace boresight::sessions {
namespace {

std::string schema() {
  return "CREATE TABLE fact (name TEXT PRIMARY KEY, value TEXT NOT NULL);"
         "CREATE TABLE method (" +
         methodTable().sql() + ");CREATE TABLE batch_run (id INTEGER PRIMARY KEY, " +
         batchRunTable().sql() +
         ");CREATE TABLE run (id INTEGER PRIMARY KEY, batch_run INTEGER NOT NULL REFERENCES "
         "batch_run(id), " +
         runTable().sql() +
         ", UNIQUE (case_id, reseed, method));"
         "CREATE INDEX run_order ON run (dataset_index, reseed, method);"
         "CREATE TABLE tag (run INTEGER NOT NULL REFERENCES run(id), tag TEXT NOT NULL, "
         "PRIMARY KEY (run, tag)) WITHOUT ROWID;"
         "CREATE INDEX tag_name ON tag (tag);"
         "CREATE TABLE iteration (run INTEGER NOT NULL REFERENCES run(id), " +
         stepTable().sql() +
         ", PRIMARY KEY (run, step)) WITHOUT ROWID;"
         "CREATE TABLE match (run INTEGER NOT NULL REFERENCES run(id), step INTEGER NOT NULL, " +
         matchTable().sql() + ", PRIMARY KEY (run, step, template)) WITHOUT ROWID;";
}

/// Every object of a database, by type and name, with the SQL that created it.
std::vector<std::vector<SqlValue>> objectsOf(SqlDatabase& database) {
  SqlStatement statement(database,
                         "SELECT type, name, tbl_name, sql FROM sqlite_master ORDER BY type, name");
  std::vector<std::vector<SqlValue>> objects;
  while (statement.step()) objects.push_back(statement.row());
  return objects;
}

/// Throws what the access calls for when `database` holds other objects than a results file.
void requireOwnObjects(SqlDatabase& database) {
  SqlDatabase model(":memory:", SqlAccess::kWrite);
  model.execute(schema());
  const auto wanted = objectsOf(model);
  const auto found = objectsOf(database);
  const auto isIn = [](const auto& list) {
    return [&list](const auto& object) {
      return std::find(list.begin(), list.end(), object) != list.end();
    };
  };
  const auto extra = std::find_if_not(found.begin(), found.end(), isIn(wanted));
  const auto lost = std::find_if_not(wanted.begin(), wanted.end(), isIn(found));
  const std::string remedy = "; it was changed by another program: evaluate again into a new file";
  if (extra != found.end())
    database.fail("its " + textOf((*extra)[0]) + " \"" + textOf((*extra)[1]) +
                  "\" is not from whs evaluate" + remedy);
  if (lost != wanted.end())
    database.fail("it lacks the " + textOf((*lost)[0]) + " \"" + textOf((*lost)[1]) + "\"" +
                  remedy);
}

/// All rows of a table.
template <class Row>
std::vector<Row> readRows(SqlDatabase& database, const RowTable<Row>& table,
                          const std::string& from_and_order) {
  const std::vector<std::string> names = table.names();
  const RowReader<Row> reader(table, names);
  SqlStatement statement(database, "SELECT " + joined(names) + from_and_order);
  std::vector<Row> rows;
  while (statement.step()) rows.push_back(reader.read(statement, database.file()));
  return rows;
}

std::vector<BatchRun> readBatchRuns(SqlDatabase& database) {
  std::vector<BatchRun> batch_runs =
      readRows(database, batchRunTable(), " FROM batch_run ORDER BY id");
  SqlStatement ids(database, "SELECT id FROM batch_run ORDER BY id");
  for (BatchRun& batch_run : batch_runs)
    if (ids.step()) batch_run.id = integerOf(ids.cell(0));
  return batch_runs;
}

/// The tags of all runs, by the runs' ids: one query for all of them.
std::unordered_map<std::int64_t, std::vector<std::string>> readTags(SqlDatabase& database) {
  SqlStatement statement(database, "SELECT run, tag FROM tag ORDER BY run, tag");
  std::unordered_map<std::int64_t, std::vector<std::string>> tags;
  while (statement.step()) tags[integerOf(statement.cell(0))].push_back(textOf(statement.cell(1)));
  return tags;
}

void readRuns(SqlDatabase& database, const std::function<void(RunResult&&)>& take) {
  auto tags = readTags(database);
  const std::vector<std::string> names = runTable().names();
  const RowReader<RunResult> reader(runTable(), names);
  SqlStatement statement(
      database,
      "SELECT " + joined(names) + ", id FROM run ORDER BY dataset_index, case_id, reseed, method");
  while (statement.step()) {
    RunResult run = reader.read(statement, database.file());
    run.tags = std::move(tags[integerOf(statement.cell(static_cast<int>(names.size())))]);
    take(std::move(run));
  }
}

std::string stepsSql() {
  return "SELECT " + joined(stepTable().names(), "iteration.") +
         " FROM iteration JOIN run ON run.id = iteration.run WHERE case_id = ?1 AND reseed = ?2 "
         "AND run.method = ?3 ORDER BY step";
}

/// INSERT INTO table (names) VALUES (?1, ...).
std::string insertSql(const std::string& table, const std::vector<std::string>& names) {
  std::string places;
  for (std::size_t i = 1; i <= names.size(); ++i)
    places += (i > 1 ? ", ?" : "?") + std::to_string(i);
  return "INSERT INTO " + table + " (" + joined(names) + ") VALUES (" + places + ")";
}

template <class Row>
void insertRow(SqlDatabase& database, const std::string& name, const RowTable<Row>& table,
               const Row& row) {
  SqlStatement insertion(database, insertSql(name, table.names()));
  insertion.run(table.values(row));
}

/// Gives the batch run an id of this file.
void addBatchRun(SqlDatabase& database, BatchRun& batch_run) {
  insertRow(database, "batch_run", batchRunTable(), batch_run);
  batch_run.id = database.lastId();
}

bool isEmptyDatabase(SqlDatabase& database) {
  return integerOf(database.value("SELECT count(*) FROM sqlite_master")) == 0;
}

/// Throws what the database's access calls for, unless it is a results file of this version with
/// the tables and indexes of one and nothing else.
void requireResultsFile(SqlDatabase& database) {
  if (integerOf(database.value("PRAGMA application_id")) != kResultsApplication) {
    if (!database.columns("run").empty() && !database.columns("fact").empty())
      database.fail("it has the format of an older version; evaluate again into a new file");
    database.fail("it is not a results file of whs evaluate");
  }
  const std::int64_t version = integerOf(database.value("PRAGMA user_version"));
  if (version != kResultsVersion)
    database.fail("it is a results file of version " + std::to_string(version) +
                  ", this program reads version " + std::to_string(kResultsVersion));
  requireOwnObjects(database);
}

/// An opened results file. InputError.
SqlDatabase openedToRead(const std::filesystem::path& file) {
  SqlDatabase database(file, SqlAccess::kRead);
  requireResultsFile(database);
  return database;
}

ResultsFacts factsOf(SqlDatabase& database) {
  requireResultsFile(database);
  ResultsFacts facts;
  facts.file = database.file();
  SqlStatement statement(database, "SELECT name, value FROM fact");
  std::map<std::string, std::string> named;
  while (statement.step()) named[textOf(statement.cell(0))] = textOf(statement.cell(1));
  facts.dataset = {named["dataset"], named["dataset_sha256"], std::atoll(named["cases"].c_str()),
                   named["version"]};
  facts.methods = readRows(database, methodTable(), " FROM method ORDER BY method");
  facts.batch_runs = readBatchRuns(database);
  return facts;
}

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

std::string joined(const std::vector<std::string>& names, const std::string& prefix) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + prefix + name;
  return text;
}

void makeResultsTables(SqlDatabase& database, const DatasetFacts& dataset) {
  SqlTransaction transaction(database);
  database.execute("PRAGMA application_id = " + std::to_string(kResultsApplication));
  database.execute("PRAGMA user_version = " + std::to_string(kResultsVersion));
  database.execute(schema());
  SqlStatement insertion(database, insertSql("fact", {"name", "value"}));
  const std::vector<std::pair<std::string, std::string>> facts = {
      {"dataset", dataset.dataset},
      {"dataset_sha256", dataset.dataset_sha256},
      {"cases", std::to_string(dataset.cases)},
      {"version", dataset.version}};
  for (const auto& [name, value] : facts) {
    const SqlValue row[] = {name, value};
    insertion.run(row);
  }
  transaction.commit();
}

void addMethodFacts(SqlDatabase& database, const MethodFacts& method) {
  insertRow(database, "method", methodTable(), method);
}

ResultsFacts readResultsFacts(const std::filesystem::path& file) {
  SqlDatabase database(file, SqlAccess::kRead);
  return factsOf(database);
}

void forEachRun(const std::filesystem::path& file, const std::function<void(RunResult&&)>& take) {
  SqlDatabase database = openedToRead(file);
  readRuns(database, take);
}

StepReader::StepReader(const std::filesystem::path& file)
    : database_(openedToRead(file)),
      reader_(stepTable(), stepTable().names()),
      statement_(database_, stepsSql()) {}

std::vector<RunStep> StepReader::stepsOf(const RunResult& run) {
  const SqlValue key[] = {run.case_id, std::int64_t{run.reseed}, run.method};
  statement_.bind(key);
  std::vector<RunStep> steps;
  while (statement_.step()) steps.push_back(reader_.read(statement_, database_.file()));
  return steps;
}

Results readResults(const std::filesystem::path& file) {
  SqlDatabase database(file, SqlAccess::kRead);
  Results results;
  results.facts = factsOf(database);
  readRuns(database, [&results](RunResult&& run) { results.runs.push_back(std::move(run)); });
  return results;
}

struct ResultsWriter::Insertions {
  explicit Insertions(SqlDatabase& database)
      : run(database, insertSql("run", withFirst<std::string>({"batch_run"}, runTable().names()))),
        tag(database, "INSERT OR IGNORE INTO tag (run, tag) VALUES (?1, ?2)"),
        step(database,
             insertSql("iteration", withFirst<std::string>({"run"}, stepTable().names()))),
        match(database,
              insertSql("match", withFirst<std::string>({"run", "step"}, matchTable().names()))),
        removal(database,
                "DELETE FROM run WHERE case_id = ?1 AND reseed = ?2 AND method = ?3 AND status = "
                "'input_error' RETURNING id"),
        tag_removal(database, "DELETE FROM tag WHERE run = ?1"),
        batch_run(database,
                  "UPDATE batch_run SET runs = ?2, seconds = ?3, ended = ?4 WHERE id = ?1") {}

  SqlStatement run;
  SqlStatement tag;
  SqlStatement step;
  SqlStatement match;
  SqlStatement removal;
  SqlStatement tag_removal;
  SqlStatement batch_run;
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

void ResultsWriter::begin(BatchRun batch_run) {
  batch_run_ = std::move(batch_run);
  addBatchRun(database_, batch_run_);
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
  ++batch_run_.runs;
  batch_run_.seconds = 1e-9 * static_cast<double>(steadyNow_ns() - began_ns_);
  noteBatchRun();
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
  insertions_->run.run(withFirst<SqlValue>({batch_run_.id}, runTable().values(run)));
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

void ResultsWriter::noteBatchRun() {
  const SqlValue row[] = {batch_run_.id, batch_run_.runs, batch_run_.seconds, batch_run_.ended};
  insertions_->batch_run.run(row);
}

void ResultsWriter::end() {
  batch_run_.ended = utcNowText();
  noteBatchRun();
}

}  // namespace boresight::sessions
