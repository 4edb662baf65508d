// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sessions/io/dataset_file.h"
#include "sessions/run/runner.h"

namespace boresight::app {

/// Localizations of one kind of problem, one after the other.
struct LocalizationFigure {
  std::string name;
  Kernels kernels = Kernels::kPortable;
  int threads = 1;
  int width = 0, height = 0;
  int runs = 0;
  int converged = 0;
  sessions::StageSeconds mean_seconds;
  std::uint64_t arena_bytes = 0;
  std::string digest;  ///< of the first run

  double perSecond() const { return mean_seconds.total() > 0.0 ? 1.0 / mean_seconds.total() : 0.0; }
};

/// One case from its own seed, `repetitions` times, with the settings' kernels and threads.
/// InputError.
LocalizationFigure measureCase(const sessions::Dataset& dataset, const sessions::Case& one,
                               const LocalizerOptions& options, int repetitions,
                               const sessions::RunSettings& settings);

/// The same scene as a household camera sees it: the image brought to 640 x 480, from `seeds` seeds
/// up to 3 cm and 10 deg off. Needs the case's truth. InputError.
LocalizationFigure measureHouseholdScale(const sessions::Dataset& dataset,
                                         const sessions::Case& one, const LocalizerOptions& options,
                                         int seeds, const sessions::RunSettings& settings);

}  // namespace boresight::app
