// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/results_database.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <memory>

#include "sessions/io/errors.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

/// The cells of a query, row by row, separated by '|'; NULL as "NULL".
std::string query(const std::filesystem::path& file, const char* sql) {
  sqlite3* raw = nullptr;
  EXPECT_EQ(sqlite3_open_v2(file.c_str(), &raw, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
  const std::unique_ptr<sqlite3, int (*)(sqlite3*)> database(raw, sqlite3_close);
  std::string text;
  const auto add = [](void* out, int count, char** cells, char**) {
    for (int i = 0; i < count; ++i)
      *static_cast<std::string*>(out) += std::string(cells[i] != nullptr ? cells[i] : "NULL") + "|";
    return 0;
  };
  char* error = nullptr;
  EXPECT_EQ(sqlite3_exec(raw, sql, add, &text, &error), SQLITE_OK) << error;
  sqlite3_free(error);
  return text;
}

RunResult sampleRun() {
  RunResult run;
  run.case_id = "bc-1";
  run.reseed = 2;
  run.station = "bc";
  run.method = "whs";
  run.status = "converged";
  run.message = "it's \"quoted\"";
  run.tags = {"far", "low_sun"};
  run.completed = true;
  run.success = true;
  run.matches = 96;
  run.inliers = 88;
  run.edge_support = 0.5;
  run.error = PoseError{};
  run.error->lateral_mm = 0.25;
  run.seconds.matching = 1.5;
  run.digest = "abc";
  return run;
}

TEST(ResultsDatabase, HoldsEveryRun) {
  const test::TemporaryFolder folder;
  RunResult blind;
  blind.case_id = "bc-2";
  writeResultsDatabase(folder / "r.sqlite", std::vector<RunResult>{sampleRun(), blind},
                       {{"version", "1"}});
  EXPECT_EQ(query(folder / "r.sqlite",
                  "SELECT id, case_id, reseed, station, method, status, message, completed, "
                  "success, matches, inliers, edge_support, lateral_mm, projection_px, "
                  "s_matching, s_total, digest FROM run ORDER BY id"),
            "1|bc-1|2|bc|whs|converged|it's \"quoted\"|1|1|96|88|0.5|0.25|NULL|1.5|1.5|abc|"
            "2|bc-2|0|||||0|NULL|0|0|0.0|NULL|NULL|0.0|0.0||");
  EXPECT_EQ(query(folder / "r.sqlite", "SELECT name, value FROM fact"), "version|1|");
  EXPECT_EQ(query(folder / "r.sqlite",
                  "SELECT tag, case_id FROM tag JOIN run ON run.id = run_id ORDER BY tag"),
            "far|bc-1|low_sun|bc-1|");
  EXPECT_EQ(query(folder / "r.sqlite", "PRAGMA integrity_check"), "ok|");
}

TEST(ResultsDatabase, ReplacesAnOlderFileWhole) {
  const test::TemporaryFolder folder;
  folder.write("r.sqlite", "something else");
  writeResultsDatabase(folder / "r.sqlite", {}, {});
  EXPECT_EQ(query(folder / "r.sqlite", "SELECT count(*) FROM run"), "0|");
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(ResultsDatabase, SaysWhenItCannotBeWritten) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(writeResultsDatabase(folder / "no/such/r.sqlite", {}, {}), OutputError);
}

}  // namespace
}  // namespace boresight::sessions
