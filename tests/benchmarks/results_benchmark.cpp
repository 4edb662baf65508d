// SPDX-License-Identifier: Apache-2.0
// What a results file of many runs takes: to read it for tables, to make them, to list its queue.
// The file repeats the runs of a given one, with their tags and iterations, under further seeds.
//
//     results_benchmark results.sqlite
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/run_rows.h"
#include "sessions/review/queue.h"
#include "sessions/tables/method_tables.h"
#include "sessions/tables/results_set.h"
#include "sessions/tables/strata_table.h"
#include "sessions/text/plain_text.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace boresight;  // NOLINT

constexpr std::int64_t kRuns = 100000;

std::int64_t numberOf(sessions::SqlDatabase& database, const std::string& sql) {
  return sessions::integerOf(database.value(sql));
}

/// The columns of a table; of `shifted` plus `text` where it is one of them.
std::string columnsPlus(sessions::SqlDatabase& database, const std::string& table,
                        const std::string& shifted, const std::string& text) {
  std::vector<std::string> names = database.columns(table);
  for (std::string& name : names)
    if (name == shifted) name += text;
  return sessions::joined(names);
}

/// Repeats all rows until there are about `runs` runs. Further copies have seeds and ids of their
/// own.
void repeatRuns(const std::filesystem::path& file, std::int64_t runs) {
  sessions::SqlDatabase database(file, sessions::SqlAccess::kWrite);
  const std::int64_t copies = runs / numberOf(database, "SELECT count(*) FROM run") - 1;
  const auto shift = [](std::int64_t step) { return " + k * " + std::to_string(step); };
  const std::string id = shift(numberOf(database, "SELECT max(id) FROM run"));
  const std::string seed = shift(numberOf(database, "SELECT max(reseed) + 1 FROM run"));
  const std::string numbers = " FROM (WITH RECURSIVE n(k) AS (SELECT 1 UNION ALL SELECT k + 1 FROM "
                              "n WHERE k < " + std::to_string(copies) + ") SELECT k FROM n), ";
  sessions::SqlTransaction transaction(database);
  for (const char* table : {"run", "tag", "iteration"})
    database.execute(std::string("CREATE TEMP TABLE former_") + table + " AS SELECT * FROM " + table);
  std::string columns = columnsPlus(database, "run", "reseed", seed);
  columns.replace(0, 2, "id" + id);
  database.execute("INSERT INTO run SELECT " + columns + numbers + "former_run");
  database.execute("INSERT INTO tag SELECT " + columnsPlus(database, "tag", "run", id) + numbers +
                   "former_tag");
  database.execute("INSERT INTO iteration SELECT " +
                   columnsPlus(database, "iteration", "run", id) + numbers + "former_iteration");
  transaction.commit();
}

void makeTables(std::span<const sessions::RunResult> runs) {
  benchmark::DoNotOptimize(sessions::errorTable(runs, false));
  benchmark::DoNotOptimize(sessions::successTable(runs, false));
  benchmark::DoNotOptimize(sessions::strataTable(runs));
  benchmark::DoNotOptimize(sessions::toleranceTable(runs));
  benchmark::DoNotOptimize(sessions::timeTable(runs));
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s [--benchmark_...] results.sqlite\n", argv[0]);
    return 2;
  }
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "r.sqlite";
  std::filesystem::copy_file(argv[1], file);
  repeatRuns(file, kRuns);
  const auto each = [](const char* name, auto work) {
    benchmark::RegisterBenchmark(name, [work](benchmark::State& state) {
      for (auto _ : state) work();
    })->Unit(benchmark::kMillisecond);
  };
  each("read for tables", [&] { benchmark::DoNotOptimize(sessions::readResultsSet({file})); });
  const sessions::ResultsSet set = sessions::readResultsSet({file});
  each("tables", [&] { makeTables(set.runs); });
  each("queue",
       [&] { benchmark::DoNotOptimize(sessions::queueText(sessions::resultsQueue(file))); });
  benchmark::RunSpecifiedBenchmarks();
}
