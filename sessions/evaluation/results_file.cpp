// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/results_file.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <unordered_map>
#include <utility>

#include "sessions/evaluation/run_rows.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/link_target.h"
#include "sessions/log/program_log.h"
#include "sessions/text/utc_time.h"

namespace boresight::sessions {
namespace {

std::int64_t versionOf(SqlDatabase& database) {
  return integerOf(database.value("PRAGMA user_version"));
}

std::string schema(std::int64_t version) {
  return "CREATE TABLE fact (name TEXT PRIMARY KEY, value TEXT NOT NULL);"
         "CREATE TABLE method (" +
         methodTable().sql() + ");CREATE TABLE batch_run (id INTEGER PRIMARY KEY, " +
         batchRunTable().sql() +
         ");CREATE TABLE run (id INTEGER PRIMARY KEY, batch_run INTEGER NOT NULL REFERENCES "
         "batch_run(id), " +
         runTableOf(version).sql() +
         ", UNIQUE (case_id, reseed, method));"
         "CREATE INDEX run_order ON run (dataset_index, reseed, method);"
         "CREATE TABLE tag (run INTEGER NOT NULL REFERENCES run(id), tag TEXT NOT NULL, "
         "PRIMARY KEY (run, tag)) WITHOUT ROWID;"
         "CREATE INDEX tag_name ON tag (tag);"
         "CREATE TABLE iteration (run INTEGER NOT NULL REFERENCES run(id), " +
         stepTableOf(version).sql() +
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
  SqlDatabase model({}, SqlAccess::kWrite);
  model.execute(schema(versionOf(database)));
  const auto wanted = objectsOf(model);
  const auto found = objectsOf(database);
  // The first of `objects` that is not among `others`, as `table "run"`.
  const auto firstOther = [](const auto& objects, const auto& others) {
    for (const auto& object : objects)
      if (std::ranges::find(others, object) == others.end())
        return textOf(object[0]) + " \"" + textOf(object[1]) + "\"";
    return std::string();
  };
  const std::string extra = firstOther(found, wanted);
  const std::string lost = firstOther(wanted, found);
  const std::string remedy = "; it was changed by another program: evaluate again into a new file";
  if (!extra.empty()) database.fail("its " + extra + " is not from whs evaluate" + remedy);
  if (!lost.empty()) database.fail("it lacks the " + lost + remedy);
}

/// All rows of a table.
template <class Row>
std::vector<Row> readRows(SqlDatabase& database, const RowTable<Row>& table,
                          const std::string& from_and_order) {
  SqlStatement statement(database, "SELECT " + joined(table.names()) + from_and_order);
  std::vector<Row> rows;
  while (statement.step()) rows.push_back(table.read(statement, database.file()));
  return rows;
}

/// The tags of all runs, by the runs' ids: one query for all of them.
std::unordered_map<std::int64_t, std::vector<std::string>> readTags(SqlDatabase& database) {
  SqlStatement statement(database, "SELECT run, tag FROM tag ORDER BY run, tag");
  std::unordered_map<std::int64_t, std::vector<std::string>> tags;
  while (statement.step()) tags[integerOf(statement.cell(0))].push_back(textOf(statement.cell(1)));
  return tags;
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
  database.run(insertSql(name, table.names()), table.values(row));
}

/// Throws what the database's access calls for, unless it is a results file of a known version with
/// the tables and indexes of one and nothing else.
void requireResultsFile(SqlDatabase& database) {
  if (integerOf(database.value("PRAGMA application_id")) != kResultsApplication) {
    if (!database.columns("run").empty() && !database.columns("fact").empty())
      database.fail("it has the format of an older version; evaluate again into a new file");
    database.fail("it is not a results file of whs evaluate");
  }
  const std::int64_t version = versionOf(database);
  if (version < kOldestResultsVersion || version > kResultsVersion)
    database.fail("it is a results file of version " + std::to_string(version) +
                  ", this program reads the versions " + std::to_string(kOldestResultsVersion) +
                  " to " + std::to_string(kResultsVersion));
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
  facts.format_version = versionOf(database);
  const auto fact = [&database](const char* name) {
    return textOf(database.value("SELECT value FROM fact WHERE name = ?1", {name}));
  };
  facts.dataset = {fact("dataset"), fact("dataset_sha256"), std::atoll(fact("cases").c_str()),
                   fact("version")};
  facts.methods = readRows(database, methodTable(), " FROM method ORDER BY method");
  facts.batch_runs = readRows(database, batchRunTable(), " FROM batch_run ORDER BY id");
  return facts;
}

std::int64_t steadyNow_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// The methods of the file that ran with deliberately wrong meshes.
std::set<std::string> negativeTests(SqlDatabase& database) {
  std::set<std::string> names;
  for (const MethodFacts& method : readRows(database, methodTable(), " FROM method"))
    if (method.wrongMesh()) names.insert(method.method);
  return names;
}

void readRuns(SqlDatabase& database, const std::function<void(RunResult&&)>& take) {
  auto tags = readTags(database);
  const std::set<std::string> negative = negativeTests(database);
  const RowTable<RunResult>& table = runTableOf(versionOf(database));
  const std::vector<std::string> names = table.names();
  SqlStatement statement(
      database,
      "SELECT " + joined(names) + ", id FROM run ORDER BY dataset_index, case_id, reseed, method");
  while (statement.step()) {
    RunResult run = table.read(statement, database.file());
    run.wrong_mesh = negative.contains(run.method);
    run.tags = std::move(tags[integerOf(statement.cell(static_cast<int>(names.size())))]);
    take(std::move(run));
  }
}

}  // namespace

std::unique_ptr<FileLock> lockResults(const std::filesystem::path& file) {
  std::filesystem::path lock_file = linkTarget(file);  // the same by all names of the file
  lock_file += ".lock";
  auto lock = std::make_unique<FileLock>(lock_file);
  if (!lock->held())
    throw OutputError(file, "another run is writing it" +
                                (lock->other() ? " (" + lock->other()->text() + ")" : ""));
  return lock;
}

void makeResultsTables(SqlDatabase& database, const DatasetFacts& dataset) {
  SqlTransaction transaction(database);
  database.execute("PRAGMA application_id = " + std::to_string(kResultsApplication));
  database.execute("PRAGMA user_version = " + std::to_string(kResultsVersion));
  database.execute(schema(kResultsVersion));
  const std::vector<std::pair<std::string, std::string>> facts = {
      {"dataset", dataset.dataset},
      {"dataset_sha256", dataset.dataset_sha256},
      {"cases", std::to_string(dataset.cases)},
      {"version", dataset.version}};
  for (const auto& [name, value] : facts)
    database.run(insertSql("fact", {"name", "value"}), {name, value});
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

void readSteps(const std::filesystem::path& file, std::span<RunResult* const> runs) {
  SqlDatabase database = openedToRead(file);
  const RowTable<RunStep>& table = stepTableOf(versionOf(database));
  SqlStatement statement(database,
                         "SELECT " + joined(table.names()) +
                             " FROM iteration WHERE run = (SELECT id FROM run WHERE "
                             "case_id = ?1 AND reseed = ?2 AND method = ?3) ORDER BY step");
  for (RunResult* run : runs) {
    statement.bind({run->case_id, std::int64_t{run->reseed}, run->method});
    run->steps.clear();
    while (statement.step()) run->steps.push_back(table.read(statement, file));
  }
}

Results readResults(const std::filesystem::path& file) {
  SqlDatabase database(file, SqlAccess::kRead);
  Results results{factsOf(database), {}};
  readRuns(database, [&results](RunResult&& run) { results.runs.push_back(std::move(run)); });
  return results;
}

ResultsWriter::ResultsWriter(const std::filesystem::path& file, const DatasetFacts& dataset)
    : lock_(lockResults(file)), database_(file, SqlAccess::kWrite) {
  database_.execute("PRAGMA synchronous = FULL");
  if (integerOf(database_.value("SELECT count(*) FROM sqlite_master")) == 0) {
    makeResultsTables(database_, dataset);
  } else {
    const ResultsFacts held = factsOf(database_);
    if (const auto wrong = contradiction(held.dataset, dataset))
      throw OutputError(file, *wrong + "; name another file");
    if (held.format_version != kResultsVersion)
      throw OutputError(file, "it is a results file of version " +
                                  std::to_string(held.format_version) +
                                  ", which is read but not continued; name another file");
    if (held.dataset.cases != dataset.cases)  // a sequence has grown
      database_.run("UPDATE fact SET value = ?1 WHERE name = 'cases'",
                    {std::to_string(dataset.cases)});
  }
}

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
  insertRow(database_, "batch_run", batchRunTable(), batch_run_);
  batch_run_id_ = database_.lastId();
  began_ns_ = steadyNow_ns();
}

std::optional<std::string> ResultsWriter::inputsOf(const std::string& method,
                                                   const std::string& case_id,
                                                   std::int32_t reseed) const {
  SqlStatement statement(database_,
                         "SELECT inputs_sha256 FROM run WHERE case_id = ?1 AND reseed = ?2 AND "
                         "method = ?3 AND status <> 'input_error'");
  statement.bind({case_id, std::int64_t{reseed}, method});
  return statement.step() ? std::optional(textOf(statement.cell(0))) : std::nullopt;
}

void ResultsWriter::add(const RunResult& run) {
  if (inputsOf(run.method, run.case_id, run.reseed)) return;
  SqlTransaction transaction(database_);
  insert(run);
  ++batch_run_.runs;
  batch_run_.seconds = 1e-9 * static_cast<double>(steadyNow_ns() - began_ns_);
  noteBatchRun();
  transaction.commit();
  logEvent(LogLevel::kInfo, [&] {
    return database_.file().string() + ": stored run of " + run.case_id + ", seed " +
           std::to_string(run.reseed) + ", method " + run.method + ": " + run.status +
           (run.digest.empty() ? "" : ", digest " + run.digest) +
           (run.message.empty() ? "" : ", " + run.message);
  });
}

void ResultsWriter::insert(const RunResult& run) {
  const std::vector<SqlValue> key = {run.case_id, std::int64_t{run.reseed}, run.method};
  const std::string refused =
      " FROM run WHERE case_id = ?1 AND reseed = ?2 AND method = ?3 AND status = 'input_error'";
  database_.run("DELETE FROM tag WHERE run IN (SELECT id" + refused + ")", key);
  database_.run("DELETE" + refused, key);
  database_.run(insertSql("run", runTable().names({"batch_run"})),
                runTable().values(run, {batch_run_id_}));
  const std::int64_t id = database_.lastId();
  for (const std::string& tag : run.tags)
    database_.run("INSERT OR IGNORE INTO tag (run, tag) VALUES (?1, ?2)", {id, tag});
  SqlStatement add_step(database_, insertSql("iteration", stepTable().names({"run"})));
  SqlStatement add_match(database_, insertSql("match", matchTable().names({"run", "step"})));
  for (const RunStep& step : run.steps) {
    add_step.run(stepTable().values(step, {id}));
    for (const MatchDetails& match : step.details)
      add_match.run(matchTable().values(match, {id, std::int64_t{step.index}}));
  }
}

void ResultsWriter::noteBatchRun() {
  database_.run("UPDATE batch_run SET runs = ?2, seconds = ?3, ended = ?4 WHERE id = ?1",
                {batch_run_id_, batch_run_.runs, batch_run_.seconds, batch_run_.ended});
}

void ResultsWriter::end() {
  batch_run_.ended = utcNowText();
  noteBatchRun();
}

}  // namespace boresight::sessions
