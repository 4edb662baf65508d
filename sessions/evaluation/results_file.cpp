// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/results_file.h"

#include <algorithm>
#include <map>

#include "sessions/evaluation/run_rows.h"

namespace boresight::sessions {
namespace {

const std::vector<std::string> kMethodColumns = {
    "method", "profile", "options", "options_sha256", "reseed_scale", "mesh_of", "mirror", "note"};
const std::vector<std::string> kSittingColumns = {
    "began", "ended",   "version", "machine", "processor", "system", "command", "folder",
    "jobs",  "threads", "kernels", "shard",   "reseeds",   "runs",   "seconds"};

std::string schema() {
  return "CREATE TABLE fact (name TEXT PRIMARY KEY, value TEXT NOT NULL);"
         "CREATE TABLE method (method TEXT PRIMARY KEY, profile TEXT NOT NULL, options TEXT NOT "
         "NULL, options_sha256 TEXT NOT NULL, reseed_scale REAL NOT NULL, mesh_of TEXT NOT NULL, "
         "mirror TEXT NOT NULL, note TEXT NOT NULL);"
         "CREATE TABLE sitting (id INTEGER PRIMARY KEY, began TEXT NOT NULL, ended TEXT NOT NULL, "
         "version TEXT NOT NULL, machine TEXT NOT NULL, processor TEXT NOT NULL, system TEXT NOT "
         "NULL, command TEXT NOT NULL, folder TEXT NOT NULL, jobs INTEGER NOT NULL, threads "
         "INTEGER NOT NULL, kernels TEXT NOT NULL, shard TEXT NOT NULL, reseeds INTEGER NOT NULL, "
         "runs INTEGER NOT NULL, seconds REAL NOT NULL);"
         "CREATE TABLE run (id INTEGER PRIMARY KEY, sitting INTEGER NOT NULL REFERENCES "
         "sitting(id), " +
         runColumnsSql() +
         ", UNIQUE (case_id, reseed, method));"
         "CREATE INDEX run_order ON run (place, reseed, method);"
         "CREATE TABLE tag (run INTEGER NOT NULL REFERENCES run(id), tag TEXT NOT NULL, "
         "PRIMARY KEY (run, tag)) WITHOUT ROWID;"
         "CREATE INDEX tag_name ON tag (tag);"
         "CREATE TABLE iteration (run INTEGER NOT NULL REFERENCES run(id), " +
         stepColumnsSql() +
         ", PRIMARY KEY (run, step)) WITHOUT ROWID;"
         "CREATE TABLE match (run INTEGER NOT NULL REFERENCES run(id), step INTEGER NOT NULL, " +
         matchColumnsSql() + ", PRIMARY KEY (run, step, template)) WITHOUT ROWID;";
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
                  "\" is not one that whs evaluate makes" + remedy);
  if (lost != wanted.end())
    database.fail("it lacks the " + textOf((*lost)[0]) + " \"" + textOf((*lost)[1]) + "\"" +
                  remedy);
}

std::vector<MethodFacts> readMethods(SqlDatabase& database) {
  SqlStatement statement(database,
                         "SELECT " + joined(kMethodColumns) + " FROM method ORDER BY method");
  std::vector<MethodFacts> methods;
  while (statement.step())
    methods.push_back({textOf(statement.cell(0)), textOf(statement.cell(1)),
                       textOf(statement.cell(2)), textOf(statement.cell(3)),
                       realOf(statement.cell(4)).value_or(1.0), textOf(statement.cell(5)),
                       textOf(statement.cell(6)), textOf(statement.cell(7))});
  return methods;
}

std::vector<Sitting> readSittings(SqlDatabase& database) {
  SqlStatement statement(database,
                         "SELECT id, " + joined(kSittingColumns) + " FROM sitting ORDER BY id");
  std::vector<Sitting> sittings;
  while (statement.step()) {
    const auto text = [&statement](int i) { return textOf(statement.cell(i)); };
    const auto number = [&statement](int i) { return integerOf(statement.cell(i)); };
    sittings.push_back({number(0), text(1), text(2), text(3), text(4), text(5), text(6), text(7),
                        text(8), number(9), number(10), text(11), text(12), number(13), number(14),
                        realOf(statement.cell(15)).value_or(0.0)});
  }
  return sittings;
}

/// The tags of all runs, by the runs' ids: one query for all of them.
std::map<std::int64_t, std::vector<std::string>> readTags(SqlDatabase& database) {
  SqlStatement statement(database, "SELECT run, tag FROM tag ORDER BY run, tag");
  std::map<std::int64_t, std::vector<std::string>> tags;
  while (statement.step()) tags[integerOf(statement.cell(0))].push_back(textOf(statement.cell(1)));
  return tags;
}

void readRuns(SqlDatabase& database, const std::function<void(const RunResult&)>& take) {
  auto tags = readTags(database);
  const std::vector<std::string> names = runColumnNames();
  SqlStatement statement(database, "SELECT " + joined(names) +
                                       ", id FROM run ORDER BY place, case_id, reseed, method");
  while (statement.step()) {
    const std::vector<SqlValue> row = statement.row();
    RunResult run = runFromRow(database.file(), names, row);
    run.tags = std::move(tags[integerOf(row.back())]);
    take(run);
  }
}

}  // namespace

std::string joined(const std::vector<std::string>& names, const std::string& prefix) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + prefix + name;
  return text;
}

std::string insertSql(const std::string& table, const std::vector<std::string>& names) {
  std::string places;
  for (std::size_t i = 1; i <= names.size(); ++i)
    places += (i > 1 ? ", ?" : "?") + std::to_string(i);
  return "INSERT INTO " + table + " (" + joined(names) + ") VALUES (" + places + ")";
}

bool isEmptyDatabase(SqlDatabase& database) {
  return integerOf(database.value("SELECT count(*) FROM sqlite_master")) == 0;
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
  SqlStatement insertion(database, insertSql("method", kMethodColumns));
  const SqlValue row[] = {method.method,         method.profile,      method.options,
                          method.options_sha256, method.reseed_scale, method.mesh_of,
                          method.mirror,         method.note};
  insertion.run(row);
}

void addSitting(SqlDatabase& database, Sitting& sitting) {
  SqlStatement insertion(database, insertSql("sitting", kSittingColumns));
  const SqlValue row[] = {sitting.began,     sitting.ended,   sitting.version, sitting.machine,
                          sitting.processor, sitting.system,  sitting.command, sitting.folder,
                          sitting.jobs,      sitting.threads, sitting.kernels, sitting.shard,
                          sitting.reseeds,   sitting.runs,    sitting.seconds};
  insertion.run(row);
  sitting.id = database.lastId();
}

void requireResultsFile(SqlDatabase& database) {
  if (integerOf(database.value("PRAGMA application_id")) != kResultsApplication) {
    if (!database.columns("run").empty() && !database.columns("fact").empty())
      database.fail("an older version made it, of another form: evaluate again into a new file");
    database.fail("it is not a results file of whs evaluate");
  }
  const std::int64_t version = integerOf(database.value("PRAGMA user_version"));
  if (version != kResultsVersion)
    database.fail("it is a results file of version " + std::to_string(version) +
                  ", this program reads version " + std::to_string(kResultsVersion));
  requireOwnObjects(database);
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
  facts.methods = readMethods(database);
  facts.sittings = readSittings(database);
  return facts;
}

ResultsFacts readResultsFacts(const std::filesystem::path& file) {
  SqlDatabase database(file, SqlAccess::kRead);
  return factsOf(database);
}

void forEachRun(const std::filesystem::path& file,
                const std::function<void(const RunResult&)>& take) {
  SqlDatabase database(file, SqlAccess::kRead);
  requireResultsFile(database);
  readRuns(database, take);
}

std::vector<RunStep> readSteps(const std::filesystem::path& file, const RunResult& run) {
  SqlDatabase database(file, SqlAccess::kRead);
  requireResultsFile(database);
  const std::vector<std::string> names = stepColumnNames();
  SqlStatement statement(database, "SELECT " + joined(names, "iteration.") +
                                       " FROM iteration JOIN run ON run.id = iteration.run WHERE "
                                       "case_id = ?1 AND reseed = ?2 AND run.method = ?3 ORDER BY "
                                       "step");
  const SqlValue key[] = {run.case_id, std::int64_t{run.reseed}, run.method};
  statement.bind(key);
  std::vector<RunStep> steps;
  while (statement.step()) steps.push_back(stepFromRow(file, names, statement.row()));
  return steps;
}

Results readResults(const std::filesystem::path& file) {
  SqlDatabase database(file, SqlAccess::kRead);
  Results results;
  results.facts = factsOf(database);
  readRuns(database, [&results](const RunResult& run) { results.runs.push_back(run); });
  return results;
}

}  // namespace boresight::sessions
