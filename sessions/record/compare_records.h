// SPDX-License-Identifier: Apache-2.0
// Whether two runs were the same: one on board and one on the ground, or two of either.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sessions/record/onboard_record.h"

namespace boresight::sessions {

/// Parts of a run, in the order in which a run produces them.
enum class RunPart {
  kPixels,
  kMask,
  kScene,
  kCamera,
  kSeed,
  kOptions,
  kEdges,
  kRender,
  kTemplates,
  kMatches,
  kInliers,
  kPose,
  kSupport,
  kEnd,
  kDigest,
};
/// "pixels", "mask", ... for display.
const char* runPartText(RunPart part);

/// The first bitwise difference between two runs.
struct FirstDifference {
  RunPart part = RunPart::kPixels;
  int iteration = -1;       ///< index over all attempts, or -1
  int template_index = -1;  ///< of the iteration, or -1
  std::string text;         ///< one sentence with the values of both
};

/// Limits within which two runs on different pixels (a compressed downlink) count as equivalent.
struct ComparisonLimits {
  double found_px = 1.0;  ///< a template found within this counts as found alike, px at its level
  double found_share = 0.8;   ///< of the templates that both searched at one place
  double inlier_share = 0.7;  ///< of the inliers of either run among these, share common to both
  double pose_sigmas = 3.0;   ///< distance of the final poses, in sigmas of the first pose
  /// The pose that counts as the same as `pose`, by a symmetry of the station, and is nearest to
  /// another; empty: no symmetries.
  std::function<Pose(const Pose& pose, const Pose& nearest_to)> equivalent = {};
};

/// One iteration of both runs. Templates are compared where both took one at the same pixel.
struct IterationComparison {
  int index = 0;
  int templates = 0;    ///< at the same pixel, searched by both
  int found_alike = 0;  ///< of these
  int inliers_either = 0;
  int inliers_both = 0;
  double translation_mm = 0.0;  ///< between the poses after it, at the camera
  double rotation_mrad = 0.0;
};

enum class RunVerdict {
  kEqual,         ///< all recorded bits are equal; both records are whole or have the same digest
  kWithinLimits,  ///< other pixels or a truncated record, within the limits
  kDifferent,
  kUndecided,  ///< no part of a run is in both records
};

struct RecordComparison {
  RunVerdict verdict = RunVerdict::kDifferent;
  std::optional<FirstDifference> first;
  std::vector<IterationComparison> iterations;  ///< those that both have
  bool inputs_compared = false;                 ///< both have the hashes of inputs, and options
  bool ends_compared = false;                   ///< both have status and final pose
  double translation_mm = 0.0;                  ///< between the final poses, if compared
  double rotation_mrad = 0.0;
  bool by_symmetry = false;           ///< the final poses are compared by a symmetry of the station
  std::optional<double> pose_sigmas;  ///< empty when one has no final pose or no covariance
  std::vector<std::string> beyond;    ///< which limits are exceeded, sentences
  std::vector<std::string> missing;   ///< data that either record lacks

  /// Whether inputs and ends show that the runs agree; a cut record may agree as far as it reaches,
  /// and show nothing.
  bool showsAgreement() const {
    return verdict == RunVerdict::kEqual ||
           (verdict == RunVerdict::kWithinLimits && inputs_compared && ends_compared);
  }
};

/// Compares the data that both records have. Runs on the same inputs must be equal bit for bit: any
/// difference makes them different. Runs on other pixels are compared by the limits.
RecordComparison compareRecords(const OnboardRecord& record, const OnboardRecord& other,
                                const ComparisonLimits& limits = {});

/// The comparison as text.
std::string comparisonText(const RecordComparison& comparison);

}  // namespace boresight::sessions
