// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/results_database.h"

#include <sqlite3.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "sessions/io/atomic_file.h"
#include "sessions/io/json_writer.h"

namespace boresight::sessions {
namespace {

constexpr const char* kSchema = R"(
CREATE TABLE fact (name TEXT PRIMARY KEY, value TEXT);
CREATE TABLE run (
  id INTEGER PRIMARY KEY, case_id TEXT NOT NULL, reseed INTEGER NOT NULL, station TEXT NOT NULL,
  method TEXT NOT NULL, status TEXT NOT NULL, message TEXT NOT NULL,
  completed INTEGER NOT NULL, success INTEGER, false_positive INTEGER NOT NULL,
  gross_false_positive INTEGER NOT NULL,
  iterations INTEGER, matches INTEGER, inliers INTEGER, edge_support REAL,
  normal_mm REAL, lateral_mm REAL, rotation_mrad REAL, in_plane_mrad REAL, geodesic_mrad REAL,
  projection_px REAL,
  seed_normal_mm REAL, seed_lateral_mm REAL, seed_rotation_mrad REAL, seed_in_plane_mrad REAL,
  seed_geodesic_mrad REAL, seed_projection_px REAL,
  s_initialization REAL, s_rendering REAL, s_matching REAL, s_pose REAL, s_refinement REAL,
  s_total REAL, camera_from_station TEXT, camera_from_station_seed TEXT, digest TEXT);
CREATE TABLE tag (run_id INTEGER NOT NULL REFERENCES run(id), tag TEXT NOT NULL);
CREATE INDEX run_case ON run (case_id, reseed, method);
CREATE INDEX tag_name ON tag (tag);
)";

/// A database in memory: it becomes a file when it is whole.
class Database {
 public:
  Database() {
    sqlite3* handle = nullptr;
    const int code = sqlite3_open(":memory:", &handle);
    handle_.reset(handle);
    require(code);
  }
  void execute(const char* sql) {
    require(sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr));
  }
  void require(int code) const {
    if (code != SQLITE_OK && code != SQLITE_DONE)
      throw std::runtime_error(std::string("results database: ") + sqlite3_errmsg(handle_.get()));
  }
  void writeTo(const std::filesystem::path& file) const {
    sqlite3_int64 size = 0;
    const std::unique_ptr<unsigned char, void (*)(void*)> bytes(
        sqlite3_serialize(handle_.get(), "main", &size, 0), sqlite3_free);
    if (bytes == nullptr) throw std::bad_alloc();
    writeFileAtomically(file,
                        std::span<const std::uint8_t>(bytes.get(), static_cast<std::size_t>(size)));
  }
  sqlite3* handle() const { return handle_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* handle) const { sqlite3_close(handle); }
  };
  std::unique_ptr<sqlite3, Close> handle_;
};

/// An INSERT whose values are bound one after the other.
class Insertion {
 public:
  Insertion(const Database& database, const std::string& table, int columns) : database_(database) {
    std::string sql = "INSERT INTO " + table + " VALUES (?";
    for (int i = 1; i < columns; ++i) sql += ",?";
    sqlite3_stmt* statement = nullptr;
    database.require(
        sqlite3_prepare_v2(database.handle(), (sql + ")").c_str(), -1, &statement, nullptr));
    statement_.reset(statement);
  }
  void add(std::int64_t value) { check(sqlite3_bind_int64(statement_.get(), ++column_, value)); }
  void add(double value) { check(sqlite3_bind_double(statement_.get(), ++column_, value)); }
  void add(const std::string& value) {
    check(sqlite3_bind_text(statement_.get(), ++column_, value.c_str(),
                            static_cast<int>(value.size()), SQLITE_TRANSIENT));
  }
  template <class T>
  void add(const std::optional<T>& value) {
    if (value) {
      add(*value);
    } else {
      addNull();
    }
  }
  void addFlag(bool value) { add(std::int64_t{value ? 1 : 0}); }
  void addNull() { check(sqlite3_bind_null(statement_.get(), ++column_)); }
  void insert() {
    check(sqlite3_step(statement_.get()));
    check(sqlite3_reset(statement_.get()));
    column_ = 0;
  }

 private:
  void check(int code) const { database_.require(code); }
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  const Database& database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int column_ = 0;
};

void addError(const std::optional<PoseError>& error, Insertion& row) {
  if (!error) {
    for (int i = 0; i < 6; ++i) row.addNull();
    return;
  }
  for (const double value : {error->normal_mm, error->lateral_mm, error->rotation_mrad,
                             error->in_plane_mrad, error->geodesic_mrad})
    row.add(value);
  row.add(error->projection_px);
}

void addRun(std::int64_t id, const RunResult& run, Insertion& row) {
  row.add(id);
  row.add(run.case_id);
  row.add(std::int64_t{run.reseed});
  row.add(run.station);
  row.add(run.method);
  row.add(run.status);
  row.add(run.message);
  row.addFlag(run.completed);
  if (run.success) {
    row.addFlag(*run.success);
  } else {
    row.addNull();
  }
  row.addFlag(run.false_positive);
  row.addFlag(run.gross_false_positive);
  for (const std::int32_t value : {run.iterations, run.matches, run.inliers})
    row.add(std::int64_t{value});
  row.add(run.edge_support);
  addError(run.error, row);
  addError(run.seed_error, row);
  const StageSeconds& seconds = run.seconds;
  for (const double value : {seconds.initialization, seconds.rendering, seconds.matching,
                             seconds.pose, seconds.refinement, seconds.total()})
    row.add(value);
  row.add(toJson(run.camera_from_station).dump());
  row.add(toJson(run.camera_from_station_seed).dump());
  row.add(run.digest);
  row.insert();
}

}  // namespace

void writeResultsDatabase(const std::filesystem::path& file, std::span<const RunResult> results,
                          const BatchFacts& facts) {
  Database database;
  database.execute(kSchema);
  database.execute("BEGIN");
  Insertion fact_row(database, "fact", 2);
  for (const auto& [name, value] : facts) {
    fact_row.add(name);
    fact_row.add(value);
    fact_row.insert();
  }
  Insertion run_row(database, "run", 36);
  Insertion tag_row(database, "tag", 2);
  std::int64_t id = 0;
  for (const RunResult& run : results) {
    addRun(++id, run, run_row);
    for (const std::string& tag : run.tags) {
      tag_row.add(id);
      tag_row.add(tag);
      tag_row.insert();
    }
  }
  database.execute("COMMIT");
  database.writeTo(file);
}

}  // namespace boresight::sessions
