// SPDX-License-Identifier: Apache-2.0
// What a session of many cases takes: to open, to describe each case's inputs, to list its queue.
// The cases share two images; each has a seed of its own.
//
//     session_benchmark sessions/examples/stations/dataset.json
#include <cstdio>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

#include "sessions/review/queue.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_maker.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace boresight;  // NOLINT

sessions::Session sessionOf(const std::filesystem::path& dataset, std::int64_t count) {
  const sessions::Session few = sessions::makeSession(dataset);
  sessions::Session many = few;
  many.cases.clear();
  for (std::int64_t i = 0; i < count; ++i) {
    sessions::SessionCase session_case = *few.cases[static_cast<std::size_t>(i) % few.cases.size()];
    session_case.id = "case-" + std::to_string(i);
    session_case.camera_from_station_seed.translation_m.x() += 1e-7 * static_cast<double>(i);
    many.cases.push_back(session_case);
  }
  return many;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s [--benchmark_...] dataset.json\n", argv[0]);
    return 2;
  }
  const std::filesystem::path dataset = argv[1];
  const auto each = [&](const char* name, auto work) {
    benchmark::RegisterBenchmark(name,
                                 [&dataset, work](benchmark::State& state) {
                                   const sessions::Session session =
                                       sessionOf(dataset, state.range(0));
                                   work(state, session);
                                 })
        ->Arg(2000)
        ->Arg(20000)
        ->Unit(benchmark::kMillisecond);
  };
  each("open", [](benchmark::State& state, const sessions::Session& session) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "s.boresight.json";
    { const auto document = sessions::SessionDocument::create(file, session); }
    for (auto _ : state)
      benchmark::DoNotOptimize(sessions::SessionDocument::open(file, sessions::Access::kReadOnly)
                                   .session()
                                   .cases.size());
  });
  each("queue", [](benchmark::State& state, const sessions::Session& session) {
    for (auto _ : state) benchmark::DoNotOptimize(sessions::queueRows(session).size());
  });
  benchmark::RunSpecifiedBenchmarks();
}
