// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/localizer/localizer.h"
#include "sessions/trace/run_plan.h"

namespace boresight::sessions {

/// A packed binary image that owns its words.
struct BitMap {
  std::vector<std::uint64_t> words;
  std::int32_t width = 0;
  std::int32_t height = 0;

  /// For the core's functions; the view of a const map must not be written through.
  BitImage view() const;
};

/// A render for the core's functions, with its own edge pixels.
struct RenderView {
  std::vector<PackedEdgePixel> pixels;
  EdgeRender render;  ///< points to `pixels` and to the trace

  RenderView() = default;
  RenderView(RenderView&&) = default;
  RenderView& operator=(RenderView&&) = default;
  operator const EdgeRender&() const { return render; }
};

/// Copy of the core's EdgeRender.
struct RenderTrace {
  BitMap edges;
  BitMap mask;
  std::vector<EdgePixel> pixels;        ///< raster order
  std::vector<std::int32_t> row_begin;  ///< height + 1 indices into pixels
  Camera camera;                        ///< at the level of the render
  Pose camera_from_station;

  /// For the core's functions; must not be written through.
  RenderView view() const;
};

/// Copy of the core's EdgeMap.
struct EdgeMapTrace {
  std::array<BitMap, kPyramidLevels> level;
  double low_threshold = 0.0;
  double high_threshold = 0.0;
  std::int32_t edge_count = 0;
};

/// Copy of the core's PnpSolution.
struct PnpTrace {
  Pose camera_from_station;
  std::vector<std::uint8_t> inlier;  ///< one per correspondence
  std::vector<double> residual_px;
  std::int32_t inlier_count = 0;
  double rms_px = 0.0;
  Matrix6d covariance = Matrix6d::Zero();
  std::int32_t samples = 0;
};

/// Copy of the core's RefinementResult.
struct RefinementTrace {
  Pose camera_from_station;
  Matrix6d covariance = Matrix6d::Zero();
  std::vector<EdgeSample> samples;
  std::int32_t sample_count = 0;  ///< also when the samples themselves were not kept
  std::int32_t found_count = 0;
  std::int32_t used_count = 0;
  double rms_px = 0.0;
};

/// Seconds of wall time per group of stages, as the paper counts them. Not part of the digest.
struct StageSeconds {
  double initialization = 0.0;  ///< construction, test edges and search
  double rendering = 0.0;
  double matching = 0.0;  ///< templates and their search
  double pose = 0.0;
  double refinement = 0.0;  ///< refinement on edges, and edge support

  double total() const { return initialization + rendering + matching + pose + refinement; }
  void add(Stage stage, double seconds);
  StageSeconds& operator+=(const StageSeconds& other);
};

/// Memory of a run, in bytes. Not part of the digest.
struct MemoryTrace {
  MemoryUse use;           ///< of the localizer's block, as its options require
  std::size_t inputs = 0;  ///< image, ignore mask and mesh
  std::size_t limit = 0;   ///< for both together; 0: there was none

  std::size_t total() const { return inputs + use.total(); }
};

/// Scores of a match in an onboard record, which does not hold the counts behind them.
struct RecordedScore {
  double score = 0.0;  ///< WHS in [0, 2]
  std::optional<double> second_score;
};

/// Outcome of one of several views that were solved together.
struct ViewOutcome {
  std::string case_id;
  /// localizationStatusText(); "converged" when it took part in the pose.
  std::string status;

  bool tookPart() const;
  bool operator==(const ViewOutcome&) const = default;
};

/// How much of an iteration is copied.
enum class RecordLevel {
  kSummary,  ///< numbers
  kFull,     ///< everything
  kStages,   ///< everything, and the iteration under way after each of its stages
};

/// One iteration up to the stage that it reached: owning copies of the data of the core's
/// `Iteration`. With RecordLevel::kSummary the vectors stay empty and the counts remain.
struct IterationTrace {
  std::int32_t index =
      0;  ///< as the core counts; one that failed before its pose shares the next's
  std::int32_t attempt = 0;  ///< a failed run may restart from its seed
  IterationKind kind = IterationKind::kMatch;
  std::int32_t level = 0;
  Stage reached = Stage::kRender;  ///< the last stage that was worked on
  LocalizationStatus status = LocalizationStatus::kRunning;
  double threshold_px = 0.0;  ///< of the full image; the search radius when refining
  Pose camera_from_station_before;
  SeedUncertainty uncertainty;

  RenderTrace render;
  std::int32_t edge_pixel_count = 0;
  std::vector<Template> templates;
  std::int32_t template_count = 0;
  std::int32_t template_side_px = 0;
  std::vector<Match> matches;  ///< one per template
  /// Of a replayed onboard record, whose matches have no counts: one per match, else empty. Not in
  /// files of traces.
  std::vector<RecordedScore> recorded_scores;
  std::int32_t searched_count = 0;
  double best_score = 0.0;  ///< WHS in [0, 2], over the searched templates
  double mean_score = 0.0;
  std::vector<Correspondence> correspondences;
  std::vector<std::int32_t> template_of;  ///< template of each correspondence
  std::int32_t correspondence_count = 0;
  PnpTrace pnp;
  RefinementTrace refinement;
  std::vector<HypothesisSummary> hypotheses;
  std::int32_t chosen_hypothesis = 0;

  Pose camera_from_station;  ///< after; as before when no pose came out
  double correction_translation_m = 0.0;
  double correction_rotation_rad = 0.0;
  double correction_image_px = 0.0;
  StageSeconds seconds;

  /// Inliers of a match iteration, edge places used of a refinement.
  std::int32_t support() const;
  double rms_px() const;
};

/// A run so far: its inputs, all intermediate results, and its end. Cheap to copy: iterations are
/// shared by all copies and never change.
struct LocalizationTrace {
  std::string version;       ///< of the program that made it
  LocalizerOptions options;  ///< that it started with
  std::vector<OptionChange> changes;
  Camera camera;
  Pose camera_from_station_seed;
  SeedUncertainty uncertainty;

  std::shared_ptr<const EdgeMapTrace> edges;  ///< nullptr until the test edges are complete
  /// Of all attempts, in order; the last one may be under way (`IterationTrace::reached`).
  std::vector<std::shared_ptr<const IterationTrace>> iterations;
  std::int32_t attempts = 1;
  std::vector<PoseCandidate> candidates;       ///< of the search, the most evidence first
  std::vector<PoseHypothesis> hypotheses;      ///< refined and compared, of runs that search
  std::int32_t best_hypothesis = -1;           ///< index of the one with the best score
  std::int32_t competitor = -1;                ///< index of the best hypothesis that is a distinct
                                               ///< pose
  double gap = 0.0;                            ///< between the scores of these two
  std::vector<CompetingPose> competing_poses;  ///< of the pose that converged
  EdgeSupport support;
  PoseEvidence evidence;     ///< of the same pose, of runs that search
  double probability = 0.0;  ///< that it is correct, of runs that search
  EdgeWidth edge_width;      ///< where the same pose has its edges, of runs that search
  FocalFit focal;            ///< at the same pose, of runs that search
  LocalizationStatus status = LocalizationStatus::kRunning;  ///< kRunning: it was stopped
  Status fault = Status::kOk;
  Pose camera_from_station;  ///< best estimate; the seed unless converged
  Matrix6d covariance = Matrix6d::Zero();
  std::string digest;  ///< 64 hexadecimal digits; empty until the run has finished
  StageSeconds seconds;
  std::uint64_t arena_bytes = 0;
  MemoryTrace memory;

  // Not in files of traces.
  bool last_under_way = false;
  bool finished = false;
  Stage stage = Stage::kEdges;  ///< the last one that was worked on
  bool replayed = false;        ///< from an onboard record (sessions/record/onboard_record.h)
  /// Of a replayed run, sentences: unknown values, and differences between ground and onboard.
  std::vector<std::string> remarks;
  /// For a view that was solved together with others: all of them, the reference view first.
  std::vector<ViewOutcome> views;
  std::size_t own_view = 0;  ///< index of this run's view

  bool converged() const { return status == LocalizationStatus::kConverged; }
  /// The result, or the pose that a failed run ended at: that of its last iteration.
  const Pose& lastPose() const {
    return converged() || iterations.empty() ? camera_from_station
                                             : iterations.back()->camera_from_station;
  }
  RunPlan plan() const { return {options, changes}; }
  const LocalizerOptions& lastOptions() const {
    return changes.empty() ? options : changes.back().options;
  }
  /// Number of iterations that are complete.
  std::size_t complete() const { return iterations.size() - (last_under_way ? 1 : 0); }
};

}  // namespace boresight::sessions
