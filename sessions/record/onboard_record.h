// SPDX-License-Identifier: Apache-2.0
// The record that the flight side downlinks (core/record/FORMAT.md), read on the ground.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/record/problem_bytes.h"
#include "core/record/record_hashes.h"
#include "core/record/record_writer.h"
#include "sessions/trace/run_plan.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// An option as stored in the record, also if unknown to this program.
struct RecordedOption {
  std::string name;
  OptionKind kind = OptionKind::kReal;
  std::uint64_t bits = 0;  ///< bits of a real; otherwise a signed integer

  double value() const;
  bool operator==(const RecordedOption&) const = default;
};

struct RecordedOptions {
  std::int32_t first_iteration = 0;  ///< they apply from this iteration on
  std::vector<RecordedOption> options;

  bool operator==(const RecordedOptions&) const = default;
};

struct RecordedInputs {
  RecordInputs sha256;
  std::int32_t width = 0;  ///< px
  std::int32_t height = 0;
  Pose camera_from_station_seed;
  SeedUncertainty uncertainty;
  Eigen::Vector3d end_effector_in_camera_m = Eigen::Vector3d::Zero();  ///< zero: not used
};

struct RecordedTemplate {
  int x = 0, y = 0;  ///< centre, px at the iteration's level
  bool searched = false;
  bool at_border = false;
  bool inlier = false;
  float found_x = 0.0F, found_y = 0.0F;  ///< px at the level
  float score = 0.0F;                    ///< WHS in [0, 2]
  std::optional<float> second_score;

  bool operator==(const RecordedTemplate&) const = default;
};

/// The image's edges, by a hash and figures.
struct RecordedEdges {
  RecordHash sha256{};  ///< of every level (core/record/record_hashes.h)
  double low_threshold = 0.0;
  double high_threshold = 0.0;
  std::int32_t edge_count = 0;  ///< of the full image
};

struct RecordedIteration {
  /// The figures of the iteration. When read from a record, its lists are empty, and of hypotheses
  /// that were not chosen only the roll is known.
  IterationTrace trace;
  std::optional<RecordHash> render_sha256;                 ///< zeros: it failed; empty: not known
  std::optional<std::vector<RecordedTemplate>> templates;  ///< empty: none, or not in the record
  std::optional<EdgeSupport> support;  ///< of an iteration whose pose was judged by it
};

struct RecordedEnd {
  LocalizationStatus status = LocalizationStatus::kRunning;
  Status fault = Status::kOk;
  std::int32_t iterations = 0;
  std::int32_t attempts = 0;
  Pose camera_from_station;
  Matrix6d covariance = Matrix6d::Zero();
  std::string digest;  ///< 64 hexadecimal digits
};

/// The content of a record before its first damage.
struct OnboardRecord {
  std::optional<RecordedInputs> inputs;
  std::vector<RecordedOptions> options;  ///< those at the start, then changes
  std::optional<RecordedEdges> edges;
  std::vector<RecordedIteration> iterations;
  std::optional<RecordedEnd> end;
  std::vector<std::string> missing;  ///< sentences; empty: the record is whole

  bool whole() const { return missing.empty(); }
};

/// Reads a record; any bytes are allowed. InputError (`file` names them) unless they begin like a
/// record of this version.
OnboardRecord parseRecord(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);
/// The same of a file; InputError.
OnboardRecord readRecord(const std::filesystem::path& file);

/// The onboard record that the flight side would have written for a run that was traced here, field
/// for field. `given` is the input of the run: nullptr when only the trace is left; the hashes of
/// the inputs are then missing. `missing` also names edges, renders and templates that a summary
/// does not have, and the end of a run that was halted.
OnboardRecord recordOf(const LocalizationTrace& run, const LocalizationProblem* given);

/// An onboard run in the form of a local run, for all views. Poses, counts, templates, where they
/// were found, inliers, support and end are the record's. Data that is not in the record is
/// computed by the core from the ground's inputs, with the record's options and at the record's
/// poses: the image's edges, renders, the templates' points, search windows; residuals are those of
/// the recorded poses. Edge places of refinements, covariances except the last, and the counts
/// behind matching scores stay empty (`recorded_scores` has the scores).
///
/// `ground` is the input of a run on the ground. `remarks` states whether it differs from the
/// onboard input, and whether the record is truncated or of another program. With the same inputs
/// the replay equals the ground's run in all data that both have. A stop leaves the iterations done
/// so far.
LocalizationTrace replayRecord(const OnboardRecord& record, const LocalizationProblem& ground,
                               const std::stop_token& stop = {});

/// The options of an onboard run as read by this program.
struct RecordedPlan {
  RunPlan plan;
  /// Differences from the onboard options, sentences: unknown options, rejected values, and options
  /// that the record lacks. All of these have their default.
  std::vector<std::string> remarks;
  bool has_options = false;  ///< false: the record has none, and all have their default
};
RecordedPlan planOf(const OnboardRecord& record);

}  // namespace boresight::sessions
