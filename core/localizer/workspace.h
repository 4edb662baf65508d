// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/accept/edge_support.h"
#include "core/accept/edge_width.h"
#include "core/accept/pose_evidence.h"
#include "core/edges/edge_map.h"
#include "core/localizer/pose_hypothesis.h"
#include "core/match/whs.h"
#include "core/pnp/correspondence.h"
#include "core/pnp/pnp_ransac.h"
#include "core/refine/edge_refinement.h"
#include "core/refine/focal_fit.h"
#include "core/render/edge_render.h"
#include "core/search/competing_poses.h"
#include "core/search/pose_search.h"
#include "core/templates/template_selection.h"

namespace boresight {

/// Match of one template.
struct Match {
  SearchWindow window;      ///< at the level; empty when the template could not be searched
  WhsNorms norms;           ///< edge and empty pixels of the template
  WhsPeak peak;             ///< the best position and the second best
  double x = 0.0, y = 0.0;  ///< sub-pixel position at the level
  bool searched = false;    ///< the window was searched; otherwise there is no peak
  bool at_border = false;   ///< the peak lies on the window's border; the correct position may lie
                            ///< beyond
};

/// Matches of the templates of an iteration.
struct MatchSet {
  std::span<Match> matches;   ///< one per template
  std::int32_t count = 0;     ///< templates to be searched
  std::int32_t searched = 0;  ///< templates whose window could be searched
};

/// A correspondence found by a method outside core (Localizer::matchOutside): an item of the render
/// and its position in the image.
struct SuppliedMatch {
  Template item;              ///< one of the templates chosen, or another place of the render
  SearchWindow window;        ///< where it was looked for, at the level
  double x = 0.0, y = 0.0;    ///< where it was found, px at the level
  double score = 0.0;         ///< [0, 2], higher is better; for display and records
  double second_score = 0.0;  ///< of the best other position
  bool has_second = false;    ///< there was another position
  bool found = false;         ///< the item was found
};

/// Why a run, or an iteration, ended.
enum class LocalizationStatus : std::uint8_t {
  kRunning = 0,
  kConverged,
  kLeftUncertainty,
  kTooFewEdges,
  kTooFewTemplates,
  kTooFewMatches,
  kPnpFailed,
  kNotSupported,
  kIterationLimit,
  kFault,      ///< a capacity did not suffice or memory changed: `Workspace::fault`
  kAmbiguous,  ///< another pose explains the image nearly as well: `Workspace::competing_poses`
  kBlurred,    ///< the image's edges are too wide for a pose: `Workspace::edge_width`
  kCameraMismatch,  ///< the image's edges fit another focal length better: `Workspace::focal`
};
inline constexpr LocalizationStatus kLastLocalizationStatus = LocalizationStatus::kCameraMismatch;
const char* localizationStatusText(LocalizationStatus status);

enum class IterationKind : std::uint8_t { kMatch = 0, kRefine = 1 };

/// One rolled render of an iteration and its result.
struct HypothesisSummary {
  double roll_rad = 0.0;       ///< about the ray through the scene's middle
  std::int32_t templates = 0;  ///< chosen
  std::int32_t matches = 0;    ///< used for the pose
  std::int32_t inliers = 0;    ///< that agree with it
  double cost =
      0.0;  ///< truncated squared residuals over the correspondences, in thresholds squared
  Pose camera_from_station;  ///< the pose found
  bool solved = false;       ///< there is a pose
};
inline constexpr int kMaxHypotheses = 9;

/// Results of one iteration: the next stage's input and the content of a trace.
struct Iteration {
  std::int32_t index = 0;                      ///< over all attempts, without gaps
  std::int32_t attempt = 0;                    ///< 0 for the first
  IterationKind kind = IterationKind::kMatch;  ///< kind of the iteration
  std::int32_t level = 0;                      ///< pyramid level, 0 full resolution
  double threshold_px = 0.0;  ///< of the full image; the search radius when refining
  /// Pose of the render before the roll of the chosen hypothesis. A refinement may keep the render
  /// of the last one, whose pose is less than loop.render_again_px away; restarts share a render.
  Pose camera_from_station_before;
  SeedUncertainty uncertainty;                ///< how far the truth may be from that pose
  EdgeRender render;                          ///< the salient edges
  TemplateSet templates;                      ///< the templates chosen in it
  MatchSet matches;                           ///< where they were found
  std::span<Correspondence> correspondences;  ///< of the searched templates
  std::span<std::int32_t> template_of;        ///< template of each correspondence
  std::int32_t correspondence_count = 0;      ///< valid ones of the two above
  PnpSolution pnp;                            ///< of a match iteration
  RefinementResult refinement;                ///< of a refinement
  /// The first `hypothesis_count` are valid.
  std::array<HypothesisSummary, kMaxHypotheses> hypotheses;
  std::int32_t hypothesis_count = 0;      ///< renders tried
  std::int32_t chosen_hypothesis = 0;     ///< index of the one that is kept
  Pose camera_from_station;               ///< after
  double correction_translation_m = 0.0;  ///< from the pose before
  double correction_rotation_rad = 0.0;   ///< from the pose before
  double correction_image_px = 0.0;       ///< mean over the corners of the scene's box
  /// Why the iteration ended; kRunning when it did not fail.
  LocalizationStatus status = LocalizationStatus::kRunning;
};

/// State of a run, valid between two steps.
struct Workspace {
  EdgeMap edges;  ///< levels without renders are invalid once the first iteration has begun
  /// The latest iteration; stages not yet reached hold old values. Its render and its samples are
  /// invalid after the test of competing poses.
  const Iteration* iteration = nullptr;
  std::span<const PoseCandidate> candidates;  ///< of the search, the most evidence first
  EdgeSupport support;                        ///< of the latest pose that was measured
  PoseEvidence evidence;     ///< of the latest pose that was measured; empty without a search
  double probability = 0.0;  ///< that this pose is correct; 0 without a search
  /// Poses compared by the search. Valid until the run restarts.
  std::span<const PoseHypothesis> hypotheses;
  std::int32_t best_hypothesis = -1;  ///< index of the one with the best score
  std::int32_t competitor = -1;       ///< index of the best hypothesis that is a distinct pose
  /// Score of the best hypothesis minus that of the competitor, which counts as 0 when negative.
  double gap = 0.0;
  EdgeWidth edge_width;  ///< along the edges of the final pose; empty without a search
  FocalFit focal;        ///< estimated at the final pose; not determined without a search
  LocalizationStatus status = LocalizationStatus::kRunning;  ///< state of the run
  /// With kFault: the reason. Else a capacity that the renders of poses exceeded, which were left
  /// out of the comparison.
  Status fault = Status::kOk;
  Pose camera_from_station;  ///< best estimate; the seed unless converged
  /// Covariance of camera_from_station, over (rotation rad, translation m), left perturbation.
  Matrix6d covariance = Matrix6d::Zero();
  std::int32_t iterations = 0;  ///< of all attempts, those that failed included
  std::int32_t attempts = 1;    ///< begun so far
  /// Other poses that show about the same edges as the final pose.
  std::span<const CompetingPose> competing_poses;
};

}  // namespace boresight
