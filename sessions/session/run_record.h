// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "sessions/trace/run_plan.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// The plan of a run that continued another run with other options, or that started with options
/// other than the session's. It suffices to repeat the run, even without the other run.
struct RerunRecord : RunPlan {
  std::string from;  ///< digest of the run whose first iterations it has; empty: a halted run

  bool operator==(const RerunRecord& other) const;
};

struct Session;

/// Record of a run that was solved together with other views of the case's rig; it suffices to
/// repeat all of them.
struct TogetherRecord {
  std::vector<ViewOutcome> views;  ///< in their order, this case's among them; the first is the
                                   ///< reference
  std::string inputs_sha256;       ///< viewsDigest when they ran

  bool operator==(const TogetherRecord&) const = default;
};

/// A run whose trace is a separate file next to the session.
struct RunRecord {
  std::string case_id;
  std::string digest;  ///< of the trace, which names its file
  std::filesystem::path file;
  std::string status;          ///< localizationStatusText()
  std::string version;         ///< of the program that ran it
  std::string time;            ///< UTC, when it ended
  std::string inputs_sha256;   ///< inputsDigest of the case that ran
  std::string options_sha256;  ///< optionsDigest of the options at the end of the run
  std::optional<RerunRecord> rerun = std::nullopt;  ///< of a run that changed options
  /// Of a run whose corrections were measured there (loop.correction_point): the end effector in
  /// the camera frame, of views in that of the first; runs by version 1.0 do not have it.
  std::optional<Eigen::Vector3d> end_effector_in_camera_m = std::nullopt;
  /// Of a run that was solved together with other views of the case's rig.
  std::optional<TogetherRecord> together = std::nullopt;

  bool operator==(const RunRecord&) const = default;
};

/// The cases of a record's views.
std::vector<std::string> casesOf(const TogetherRecord& record);

/// SHA-256 over all inputs of a run of these cases together: the inputs of each, with the seed of
/// the first alone, and the relative poses of the cameras. Empty when a case no longer exists or
/// has no rig.
std::string viewsDigest(const Session& session, const std::vector<std::string>& case_ids);

}  // namespace boresight::sessions
