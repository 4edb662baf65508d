// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/accept/contour_evidence.h"
#include "core/accept/edge_support.h"
#include "core/accept/edge_width.h"
#include "core/edges/edge_map.h"
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

/// Where a template was found.
struct Match {
  SearchWindow window;      ///< at the level; empty when the template could not be searched
  WhsNorms norms;           ///< edge and empty pixels of the template
  WhsPeak peak;             ///< the best place and the second
  double x = 0.0, y = 0.0;  ///< sub-pixel place at the level
  bool searched = false;    ///< the window was searched; otherwise there is no peak
  bool at_border = false;   ///< the peak lies on the window's border: the truth may lie beyond
};

/// Where the templates of an iteration were found.
struct MatchSet {
  std::span<Match> matches;   ///< one per template
  std::int32_t count = 0;     ///< templates looked for
  std::int32_t searched = 0;  ///< templates whose window could be searched
};

/// A correspondence that somebody else than the core found (Localizer::matchOutside): an item of
/// the render, and where the image shows it.
struct SuppliedMatch {
  Template item;              ///< one of the templates chosen, or another place of the render
  SearchWindow window;        ///< where it was looked for, at the level
  double x = 0.0, y = 0.0;    ///< where it was found, px at the level
  double score = 0.0;         ///< [0, 2], the higher the better; for people and records
  double second_score = 0.0;  ///< of the best other place
  bool has_second = false;    ///< there was another place
  bool found = false;         ///< it was found at all
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
  kFault,      ///< a capacity or the arena did not suffice; `Workspace::fault` says which
  kAmbiguous,  ///< another pose explains the image nearly as well: `Workspace::competing_poses`
  kBlurred,    ///< the image's edges are too wide for a pose: `Workspace::edge_width`
  kCameraMismatch,  ///< the image's edges ask for another focal length: `Workspace::focal`
};
inline constexpr LocalizationStatus kLastLocalizationStatus = LocalizationStatus::kCameraMismatch;
const char* localizationStatusText(LocalizationStatus status);

enum class IterationKind : std::uint8_t { kMatch = 0, kRefine = 1 };

/// One rolled render of an iteration, and what it yielded.
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

/// Everything of one iteration: the next stage's input, and what a trace keeps.
struct Iteration {
  std::int32_t index = 0;                      ///< over all attempts, without gaps
  std::int32_t attempt = 0;                    ///< 0 for the first
  IterationKind kind = IterationKind::kMatch;  ///< what the iteration does
  std::int32_t level = 0;                      ///< pyramid level, 0 full resolution
  double threshold_px = 0.0;  ///< of the full image; the search radius when refining
  /// What the render shows is this, rolled by the hypothesis chosen; a refinement's may be the last
  /// one's, from a pose less than loop.render_again_px away.
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

/// What a caller can look at between two steps.
struct Workspace {
  EdgeMap edges;  ///< levels finer than any render are gone when the first iteration has begun
  /// The latest; stages not yet reached hold old values. Its render and its samples are gone when
  /// competing poses were looked for.
  const Iteration* iteration = nullptr;
  std::span<const PoseCandidate> candidates;  ///< of the search, the most evidence first
  EdgeSupport support;                        ///< of the final pose
  ContourEvidence evidence;                   ///< of it, too
  double probability = 0.0;  ///< that it is right, by both; 0 where none was searched
  EdgeWidth edge_width;      ///< where that pose has its edges; empty where none was searched
  FocalFit focal;            ///< beside that pose; not determined where none was searched
  LocalizationStatus status = LocalizationStatus::kRunning;  ///< how the run stands
  Status fault = Status::kOk;                                ///< what did not suffice, with kFault
  Pose camera_from_station;  ///< best estimate; the seed unless converged
  /// Of camera_from_station, over (rotation rad, translation m), left perturbation.
  Matrix6d covariance = Matrix6d::Zero();
  std::int32_t iterations = 0;  ///< of all attempts, those that failed included
  std::int32_t attempts = 1;    ///< begun so far
  /// Other poses that show about the same edges as the final pose.
  std::span<const CompetingPose> competing_poses;
};

}  // namespace boresight
