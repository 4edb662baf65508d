// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "sessions/run/runner.h"
#include "tests/support/example_case.h"

namespace boresight::test {

/// The whole run of an example's station with these options.
inline std::shared_ptr<const sessions::LocalizationTrace> runOfExample(
    const std::string& station, const LocalizerOptions& options = defaultProfile()) {
  const ExampleCase example(station);
  sessions::Runner run(example.problem(), options);
  run.advance(sessions::StepUntil::kEnd);
  return std::make_shared<const sessions::LocalizationTrace>(run.trace());
}

/// The same, run once per program: the station "os" with the default options.
inline std::shared_ptr<const sessions::LocalizationTrace> exampleRun() {
  static const auto result = runOfExample("os");
  return result;
}

/// The same from the seed alone, without a search.
inline std::shared_ptr<const sessions::LocalizationTrace> exampleRunOfSeed() {
  static const auto result = [] {
    LocalizerOptions options = defaultProfile();
    options.search.enabled = false;
    return runOfExample("os", options);
  }();
  return result;
}

/// The same as a value.
inline const sessions::LocalizationTrace& exampleTrace() { return *exampleRun(); }

/// Changes a copy of an iteration in place of the iteration.
template <class Change>
void editIteration(sessions::LocalizationTrace& trace, std::size_t index, Change change) {
  auto edited = std::make_shared<sessions::IterationTrace>(*trace.iterations.at(index));
  change(*edited);
  trace.iterations[index] = std::move(edited);
}

/// A run as it was after its first `count` iterations.
inline std::shared_ptr<const sessions::LocalizationTrace> firstIterations(
    const sessions::LocalizationTrace& whole, std::size_t count) {
  auto result = std::make_shared<sessions::LocalizationTrace>(whole);
  result->iterations.resize(count);
  result->status = LocalizationStatus::kRunning;
  result->finished = false;
  return result;
}

}  // namespace boresight::test
