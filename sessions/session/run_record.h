// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sessions/io/option_value.h"
#include "sessions/run/run_plan.h"
#include "sessions/run/view_outcome.h"

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

struct Session;

/// What a session notes of a run that was solved for together with other views of the case's rig:
/// enough to run all of them again.
struct TogetherRecord {
  std::vector<ViewOutcome> views;  ///< in their order, this case's among them; the first one led
  std::string inputs_sha256;       ///< viewsDigest of them when they ran

  bool operator==(const TogetherRecord&) const = default;
};

/// A run whose trace is a file of its own beside the session.
struct RunRecord {
  std::string case_id;
  std::string digest;  ///< of the trace, which names its file
  std::filesystem::path file;
  std::string status;          ///< as localizationStatusText says
  std::string version;         ///< of the program that ran it
  std::string time;            ///< UTC, when it ended
  std::string inputs_sha256;   ///< inputsDigest of the case that ran
  std::string options_sha256;  ///< optionsDigest of what ran, as it was at the end
  std::optional<RerunRecord> rerun =
      std::nullopt;  ///< of a run that took up other options on its way
  /// Of a run that was solved for together with other views of the case's rig.
  std::optional<TogetherRecord> together = std::nullopt;

  bool operator==(const RunRecord&) const = default;
};

/// The cases of a record's views.
std::vector<std::string> casesOf(const TogetherRecord& record);

/// SHA-256 over what a run of these cases together depends on: the inputs of each but for the seeds
/// of those that follow the first, and how the cameras lie to each other. Empty when a case is not
/// there any more, or is of no rig.
std::string viewsDigest(const Session& session, const std::vector<std::string>& case_ids);

}  // namespace boresight::sessions
