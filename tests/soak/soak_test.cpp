// SPDX-License-Identifier: Apache-2.0
// Many localizations in one process, each with everything around it: inputs read, threads made, the
// run traced and noted as on board, trace and record written and read back. Whatever one of them
// left behind would add up. 24 of them; 1000 with BORESIGHT_ALL set; any number with
// BORESIGHT_SOAK=N. Nothing is timed.
#include <gtest/gtest.h>

#include <malloc.h>
#include <unistd.h>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "sessions/evaluation/reseed.h"
#include "sessions/record/onboard_record.h"
#include "sessions/run/runner.h"
#include "sessions/trace/trace_file.h"
#include "tests/support/example_case.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

/// What the operating system says that this process holds; -1 where it does not say.
struct ProcessFigures {
  std::int64_t resident_bytes = -1;
  std::int64_t open_files = -1;
  std::int64_t threads = -1;
  /// Handed out by the allocator and not given back; 0 under a sanitizer, which brings its own.
  std::int64_t heap_bytes = -1;
};

std::int64_t entriesOf(const char* folder) {
  std::error_code error;
  const auto entries = std::filesystem::directory_iterator(folder, error);
  return error ? -1 : std::distance(begin(entries), end(entries));
}

std::int64_t residentBytes() {
  std::ifstream statistics("/proc/self/statm");
  std::int64_t whole_pages = 0;
  std::int64_t resident_pages = 0;
  if (!(statistics >> whole_pages >> resident_pages)) return -1;
  return resident_pages * sysconf(_SC_PAGESIZE);
}

/// Of the process that calls, now.
ProcessFigures processFigures() {
  const struct mallinfo2 heap = mallinfo2();
  return {.resident_bytes = residentBytes(),
          .open_files = entriesOf("/proc/self/fd"),
          .threads = entriesOf("/proc/self/task"),
          .heap_bytes = static_cast<std::int64_t>(heap.uordblks + heap.hblkhd)};
}

/// Runs until every code path has run once: each seed of each station.
constexpr int kSeeds = 4;
constexpr int kStations = 2;
constexpr int kRound = kSeeds * kStations;

/// What an allocator keeps of freed memory, and hands back, goes up and down by some 14 MB from run
/// to run: peaks are compared, and this is what they may differ by. 900 leaks of 3 kB are more.
constexpr std::int64_t kResidentSlack_bytes = 2'500'000;
/// First uses of what the libraries keep for later, and per run what the allocator's rounding adds:
/// 125 to 270 bytes, while no block of an earlier run is left.
constexpr std::int64_t kHeapSlack_bytes = 4'000;
constexpr std::int64_t kHeapSlackPerRun_bytes = 300;

int wantedRuns() {
  if (const char* runs = std::getenv("BORESIGHT_SOAK")) return std::atoi(runs);
  return std::getenv("BORESIGHT_ALL") != nullptr ? 1000 : 3 * kRound;
}

constexpr bool underSanitizer() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return true;
#elif defined(__has_feature)
  return __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
  return false;
#endif
}

/// One localization as the programs run it; its digest.
std::string runOnce(const TemporaryFolder& folder, int number) {
  const std::string station = number % kStations == 0 ? "os" : "bc";
  const ExampleCase example(station);
  LocalizationProblem problem = example.problem();
  const int seed = number / kStations % kSeeds;
  problem.camera_from_station_seed = sessions::seedForOffset(
      example.truth.camera_from_station,
      sessions::drawOffset(example.seed.uncertainty.value(), 1.0, station, seed),
      sessions::UncertaintyPivot::kStation, matchedBounds(example.scene.view()).centre());

  sessions::RunSettings settings;
  settings.threads = 2;
  std::vector<std::uint8_t> bytes(65536);
  RecordWriter onboard(bytes);
  settings.onboard_record = &onboard;
  const sessions::LocalizationTrace run = sessions::localize(problem, defaultProfile(), settings);
  EXPECT_TRUE(sessions::parseRecord("run.whsr", onboard.bytes()).whole());
  sessions::saveTrace(folder / "run.trace", run);
  return sessions::loadTrace(folder / "run.trace").digest;
}

void print(int runs, const ProcessFigures& figures) {
  std::printf("after %4d runs: resident %.1f MB, heap %.3f MB, %lld open files, %lld threads\n",
              runs, 1e-6 * static_cast<double>(figures.resident_bytes),
              1e-6 * static_cast<double>(figures.heap_bytes),
              static_cast<long long>(figures.open_files), static_cast<long long>(figures.threads));
  std::fflush(stdout);
}

}  // namespace

TEST(Soak, LocalizationsLeaveNothingBehind) {
  const TemporaryFolder folder;
  const int runs = wantedRuns();
  // The allocator takes its last pages in the second round; peaks are the same from there on.
  const int settled = std::max(2 * kRound, runs / 10);
  ASSERT_GT(runs, settled) << "BORESIGHT_SOAK is too small a number";
  std::vector<std::string> digests;
  ProcessFigures first;
  std::int64_t first_peak_bytes = 0;  // resident, of the first runs and of as many last ones
  std::int64_t last_peak_bytes = 0;
  for (int run = 0; run < runs; ++run) {
    const std::string digest = runOnce(folder, run);
    if (run < kRound) digests.push_back(digest);
    ASSERT_EQ(digest, digests[static_cast<std::size_t>(run % kRound)]) << "run " << run;
    const ProcessFigures current = processFigures();
    if (run < settled) first_peak_bytes = std::max(first_peak_bytes, current.resident_bytes);
    if (run >= runs - settled) last_peak_bytes = std::max(last_peak_bytes, current.resident_bytes);
    if (run + 1 == settled) first = current;
    if ((run + 1) % settled == 0) print(run + 1, current);
  }
  const ProcessFigures last = processFigures();
  print(runs, last);
  std::printf("resident at most %.1f MB in the first %d runs, %.1f MB in the last\n",
              1e-6 * static_cast<double>(first_peak_bytes), settled,
              1e-6 * static_cast<double>(last_peak_bytes));

  EXPECT_EQ(last.open_files, first.open_files);
  EXPECT_EQ(last.threads, first.threads);
  EXPECT_EQ(folder.fileCount(), 1u);
  if (underSanitizer()) return;  // these keep freed memory for a while, and look for leaks
  EXPECT_LE(last.heap_bytes,
            first.heap_bytes + kHeapSlack_bytes + kHeapSlackPerRun_bytes * (runs - settled));
  EXPECT_LE(last_peak_bytes, first_peak_bytes + kResidentSlack_bytes);
}

}  // namespace boresight::test
