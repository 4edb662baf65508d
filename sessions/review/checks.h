// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "sessions/io/scene_mesh.h"
#include "sessions/review/review_subject.h"
#include "sessions/session/case_run.h"
#include "sessions/session/check.h"
#include "sessions/session/check_limits.h"

namespace boresight::sessions {

/// So many further seeds tell a second answer from none, and take a few seconds.
inline constexpr int kBasinSeeds = 8;

/// Another answer to the same image.
struct RivalPose {
  Pose camera_from_station;
  bool mirrored = false;  ///< of the station's mirror image about a plane through its box's middle
  double coverage = 0.0;  ///< share of the edges that it predicts which the image shows, 0 to 1
};

/// Where further seeds around the case's lead, and what speaks for it.
struct BasinResult {
  int seeds = 0;
  int converged = 0;
  int returned = 0;               ///< converged to the pose in question, within the requirement
  double coverage = 0.0;          ///< of the pose in question
  std::vector<RivalPose> rivals;  ///< other poses, and the mirror images' wherever they lie
};

/// Runs the case's localization from `seeds` further seeds, drawn evenly in its uncertainty, and
/// of the station's three mirror images from the pose in question. Deterministic. A stop leaves
/// what was done by then; as many seeds as it counts give the same result again. `after_each` is
/// told what was found so far.
BasinResult basinTest(const ReviewSubject& subject, int seeds, const std::stop_token& stop = {},
                      const std::function<void(const BasinResult&)>& after_each = {});

/// What became of other seeds: enough lead back, and none to another pose.
bool isBasinCheck(const std::string& check_id);
void addBasinChecks(const std::optional<BasinResult>& basin, const CheckLimits& limits,
                    std::vector<Check>& checks);

/// Mirrors a station in the plane across this axis of its frame (0 to 2) at `plane_m`. Faces keep
/// their outward side.
void mirrorScene(SceneMesh& scene, int axis, double plane_m);

/// The same case with its station mirrored in the plane through the middle of its matched box.
std::unique_ptr<const LoadedCase> mirrorImageOf(const LoadedCase& loaded, int axis);

/// All checks of a pose, always the same ones in the same order; what cannot be asked is not
/// applicable. `basin` is what was measured of it, if it was.
std::vector<Check> checkPose(const ReviewSubject& subject, const CheckLimits& limits,
                             const std::optional<BasinResult>& basin = {});

}  // namespace boresight::sessions
