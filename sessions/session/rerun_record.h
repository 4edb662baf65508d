// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/json_reader.h"
#include "sessions/io/option_value.h"
#include "sessions/run/run_plan.h"

namespace boresight::sessions {

/// Options by what differs from the default profile, in the order of the alphabet.
struct RecordedChange {
  std::int32_t iteration = 0;  ///< the first one with them, from 0
  OptionList options;

  bool operator==(const RecordedChange&) const = default;
};

/// What a session notes of a run that went on from an iteration of another one with other options,
/// or had other options than the session from its start (those of an onboard record): enough to run
/// it again, even when the other one is gone.
struct RerunRecord {
  std::string
      from;  ///< digest of the run whose first iterations it has; empty: one that was halted
  OptionList options;
  std::vector<RecordedChange> changes;  ///< none: the options held from start to end

  bool operator==(const RerunRecord&) const = default;
};

RerunRecord rerunRecord(const std::string& from, const RunPlan& plan);
/// InputError (`file` names the session) for options that do not exist or cannot have their values.
RunPlan planOf(const RerunRecord& record, const std::filesystem::path& file);

nlohmann::ordered_json toJson(const RerunRecord& record);
/// InputError, also for a plan that cannot be run.
RerunRecord readRerun(const JsonReader& json);

}  // namespace boresight::sessions
