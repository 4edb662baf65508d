// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "sessions/run/record.h"
#include "sessions/run/stepped_run.h"
#include "tests/support/example_case.h"

namespace boresight::test {

/// The whole run of an example's station with these options.
inline std::shared_ptr<const sessions::RunSnapshot> runOfExample(
    const std::string& station, const LocalizerOptions& options = defaultProfile()) {
  const ExampleCase example(station);
  sessions::SteppedRun run(example.problem(), options);
  run.advance(sessions::StepUntil::kEnd);
  return std::make_shared<const sessions::RunSnapshot>(run.snapshot());
}

/// The same, run once per program: the station "os" with the default options.
inline std::shared_ptr<const sessions::RunSnapshot> exampleRun() {
  static const auto made = runOfExample("os");
  return made;
}

/// The same as a full trace, with the score maps' inputs.
inline const sessions::LocalizationTrace& exampleTrace() {
  static const sessions::LocalizationTrace made = [] {
    const ExampleCase example("os");
    return sessions::localize(example.problem(), defaultProfile(), sessions::RecordLevel::kFull);
  }();
  return made;
}

/// A run as it was after its first `count` iterations.
inline std::shared_ptr<const sessions::RunSnapshot> firstIterations(
    const sessions::RunSnapshot& whole, std::size_t count) {
  auto made = std::make_shared<sessions::RunSnapshot>(whole);
  made->iterations.resize(count);
  made->status = LocalizationStatus::kRunning;
  made->finished = false;
  return made;
}

}  // namespace boresight::test
