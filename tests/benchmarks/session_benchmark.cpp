// SPDX-License-Identifier: Apache-2.0
// Time that a session of many cases takes: an edit, a stored run, an undo, opening, saving, listing
// its queue. The cases share two images; each has a seed and a run of its own.
//
//     session_benchmark sessions/examples/stations/dataset.json
#include <cstdio>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

#include "sessions/io/files/file_bytes.h"
#include "sessions/review/queue.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_maker.h"
#include "tests/support/many_cases.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace boresight;  // NOLINT

/// The same session with the seed of a case moved.
sessions::Session withMovedSeed(const sessions::Session& session, const std::string& id) {
  return sessions::withChanged(session, id, [](sessions::SessionCase& changed) {
    changed.camera_from_station_seed.translation_m.y() += 1e-7;
  });
}

/// An open session on the disk.
struct OpenSession {
  test::TemporaryFolder folder;
  sessions::SessionDocument document;
  sessions::SessionHistory history{document};
  std::int64_t cases = 0;
  std::int64_t edits = 0;

  explicit OpenSession(const sessions::Session& session)
      : document(sessions::SessionDocument::create(folder.path() / "s.boresight.json", session)),
        cases(static_cast<std::int64_t>(session.cases.size())) {}

  /// The cases in turn, far apart.
  std::string nextCase() { return "case-" + std::to_string(++edits * 7919 % cases); }
  void edit() { history.perform(withMovedSeed(document.session(), nextCase()), "Move the seed"); }
};

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
                                   const sessions::Session session = test::manyCases(
                                       sessions::makeSession(dataset), state.range(0));
                                   work(state, session);
                                 })
        ->Arg(2000)
        ->Arg(30000)
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
  each("edit", [](benchmark::State& state, const sessions::Session& session) {
    OpenSession open(session);
    for (auto _ : state) open.edit();
  });
  each("undo and redo", [](benchmark::State& state, const sessions::Session& session) {
    OpenSession open(session);
    open.edit();
    for (auto _ : state) open.history.canUndo() ? open.history.undo() : open.history.redo();
  });
  each("store a run", [](benchmark::State& state, const sessions::Session& session) {
    OpenSession open(session);
    for (auto _ : state) {
      const std::string id = open.nextCase();
      open.document.apply(
          sessions::withRun(open.document.session(), test::runWithoutFile(id, open.edits)), "Run");
    }
  });
  each("save after an edit", [](benchmark::State& state, const sessions::Session& session) {
    OpenSession open(session);
    for (auto _ : state) {
      open.edit();
      open.document.save();
    }
  });
  each("recover 100 edits", [](benchmark::State& state, const sessions::Session& session) {
    OpenSession open(session);
    for (int i = 0; i < 100; ++i) open.edit();
    for (auto _ : state)
      benchmark::DoNotOptimize(
          sessions::SessionDocument::open(open.document.file(), sessions::Access::kReadOnly)
              .recovery()
              .has_value());
  });
  each("queue", [](benchmark::State& state, const sessions::Session& session) {
    for (auto _ : state) benchmark::DoNotOptimize(sessions::queueRows(session).size());
  });
  benchmark::RunSpecifiedBenchmarks();
}
