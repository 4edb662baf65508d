// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/accept/pose_evidence.h"
#include "core/base/status.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/localizer/localizer_options.h"
#include "core/localizer/pose_hypothesis.h"
#include "core/localizer/schedule.h"
#include "core/localizer/stage.h"
#include "core/localizer/workspace.h"
#include "core/refine/weak_directions.h"

// Interface between policies and passes: a policy plans a pass, the pass runs, and the policy rules
// on its outcome.
namespace boresight {

enum class PassKind : std::uint8_t {
  kEdges = 0,   ///< detects the edges of the image; once per run
  kNearSearch,  ///< refines the seed as a candidate of the search
  kSearch,      ///< searches the whole object over the seed's uncertainty, or continues that search
  kMatch,       ///< renders, selects templates, matches them, solves for the pose
  kRefine,      ///< renders, refines the pose on the edges of the image
  kEvidence,    ///< measures the image's evidence for the pose of the record
  kSupport,     ///< the same for the final pose, with the width of its edges and the focal length
  kCompare,     ///< compares the final pose with others that show about the same edges
  kMirror,      ///< compares the final pose with the mesh's mirror image
  kWider,       ///< compares the final pose with those within twice the seed's uncertainty
};

/// Input of a pass.
struct PassPlan {
  PassKind kind = PassKind::kEdges;  ///< kind of the pass
  int record = 0;                ///< 0 or 1: the record, and the render memory, that the pass fills
  std::int32_t attempt = 0;      ///< index of the attempt, from 0
  int level = 0;                 ///< pyramid level, 0 full resolution
  Pose camera_from_station;      ///< the hypothesis
  Pose rendered_from_station;    ///< pose of the render, before the roll
  double roll_rad = 0.0;         ///< turns the render about the ray through the scene's centre
  SeedUncertainty uncertainty;   ///< of the hypothesis; sizes the search windows
  double threshold_px = 0.0;     ///< inlier threshold or search radius, px of the full image
  double template_factor = 1.0;  ///< on the size of the templates
  /// A refinement keeps the last render of its level when that is from a pose nearer than this; px.
  double keep_render_px = 0.0;
  std::int32_t most_samples = 0;  ///< edge places of a refinement; 0: as many as the options allow
  bool anchored = false;          ///< whether `anchor` and `matched` constrain a refinement
  PosePrior anchor;               ///< the seed with its uncertainty as a Gaussian
  PoseEstimate matched;           ///< from the latest templates
  /// A refinement ends within `known_px` of any of these poses.
  std::span<const PoseHypothesis> known;
  double known_px = 0.0;  ///< of the full image
  /// Contours and regions of nearly the same pose as the record's; nullptr: to be measured.
  const PoseEvidence* evidence = nullptr;
};

/// Outcome of a pass. Its record (Iteration) holds the results; `status` there is kRunning when
/// there is a pose.
struct PassOutcome {
  Stage reached = Stage::kEdges;  ///< the last stage that ran
  Status fault = Status::kOk;     ///< the capacity that was exceeded
  WeakDirections weak;            ///< of a refined pose, with kEvidence and kSupport of a search
};

/// Number of matches that agree with a pose: of all views when several views share the pose.
struct Agreement {
  std::int32_t inliers = 0;          ///< of PnP, or edge places used
  std::int32_t correspondences = 0;  ///< all matches, inliers among them
};

/// Decision of a policy after a pass.
struct Ruling {
  /// Next action: another pass, a pose, or a failure.
  enum class Next : std::uint8_t { kPass = 0, kPose, kFailed };

  Next next = Next::kPass;                                   ///< another pass, a pose, or a failure
  LocalizationStatus status = LocalizationStatus::kRunning;  ///< why it failed
  Stage stage = Stage::kEdges;                               ///< the stage to report
  bool iteration_complete = false;                           ///< the shown record is complete
  int record = 0;                                            ///< the record to show

  /// Whether a pose was found.
  bool found() const { return next == Next::kPose; }
  /// Whether there is no pose.
  bool failed() const { return next == Next::kFailed; }
};

/// Data that does not change during a run, for all policies.
struct RunContext {
  const LocalizerOptions& options;                  ///< of the run
  const Camera& camera;                             ///< of the full image
  const BoundingBox& scene;                         ///< of the matched parts, station frame
  RunLevels levels;                                 ///< of the image pyramid
  const Eigen::Vector3d& end_effector_in_camera_m;  ///< of the problem
};

}  // namespace boresight
