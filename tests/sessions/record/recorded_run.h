// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "sessions/record/onboard_record.h"
#include "sessions/run/runner.h"
#include "tests/support/example_case.h"

namespace boresight::test {

/// A run of an example's station, noted as the flight side does and traced at once.
struct RecordedRun {
  std::vector<std::uint8_t> bytes;  ///< of the record
  sessions::OnboardRecord record;
  sessions::LocalizationTrace trace;
};

inline RecordedRun recordRun(const LocalizationProblem& problem, const sessions::RunPlan& plan,
                             std::size_t room = 65536) {
  RecordedRun recorded_run;
  recorded_run.bytes.resize(room);
  RecordWriter writer(recorded_run.bytes);
  sessions::RunSettings settings;
  settings.onboard_record = &writer;
  recorded_run.trace = sessions::localize(problem, plan, settings);
  recorded_run.bytes.resize(writer.bytes().size());
  recorded_run.record = sessions::parseRecord("run.whsr", recorded_run.bytes);
  return recorded_run;
}

/// The default options, for the small features of the station.
inline LocalizerOptions recordedOptions() {
  LocalizerOptions options = defaultProfile();
  options.templates.feature_size_m = 0.018;
  return options;
}

/// The run of the example "os" by recordedOptions.
struct ExampleRun {
  ExampleCase example{"os"};
  LocalizationProblem problem = example.problem();
  RecordedRun run = recordRun(problem, recordedOptions());
};
inline const ExampleRun& exampleRun() {
  static const ExampleRun run;
  return run;
}

}  // namespace boresight::test
