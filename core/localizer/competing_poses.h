// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/accept/self_similarity.h"
#include "core/localizer/attempt.h"
#include "core/localizer/pass_plan.h"
#include "core/localizer/workspace.h"
#include "core/search/twin_test.h"

namespace boresight {

/// Policy that tests, after a pose has converged, the poses under which the edge pattern of the
/// model repeats. An attempt is made from each of them, within a box that does not reach the next;
/// of two supported poses the one with more evidence is the best pose. The last iteration of the
/// best pose is repeated at the end, so that the run ends with its record. Off unless
/// options.ambiguity.enabled. Otherwise a run that searches is judged by the twins of its pose.
class CompetingPoses {
 public:
  /// What follows a pass of this policy.
  enum class Next : std::uint8_t {
    kCompare = 0,  ///< a self-similarity pass of the best pose
    kTry,          ///< the attempt of competitor()
    kReturn,       ///< the attempt of best(): its last iteration again
    kConclude,     ///< the run ends with the best pose, which the latest record shows
  };

  /// Competing poses are tried within this multiple of the seed's uncertainty: a seed may be off by
  /// more than was stated, and a clearly better pose outside then ends the run.
  static constexpr double kReach = 2.0;
  static constexpr int kMaxRivals = 8;  ///< tried at most; each costs about as much as the run
  /// Evidence by which the best pose must exceed a competing one, else the run is ambiguous: odds
  /// of 20000 to 1, since neighbouring edges share their errors.
  static constexpr double kMinMargin_nats = 10.0;

  /// Evidence by which the final pose must exceed a twin within the seed's uncertainty.
  static constexpr double kTwinMargin_nats = 3.0;
  /// The same of a twin outside, which the seed excludes: with a right mesh none is better,
  /// with a mirrored one the half turn is, by 12 to 45 nats.
  static constexpr double kOutsideMargin_nats = -2.0;

  CompetingPoses() = default;
  /// `poses` holds kMaxRivals entries and must outlive this; `seed` is the run's.
  CompetingPoses(std::span<Rival> poses, const Seed& seed) : poses_(poses), seed_(seed) {}

  /// Whether a competing pose is being tried.
  bool isTrying() const { return round_ == Round::kTrials; }
  /// Whether a converged pose was taken up.
  bool hasStarted() const { return round_ != Round::kNone; }
  /// Whether all poses were compared.
  bool hasEnded() const { return round_ == Round::kEnd; }

  /// A supported pose. `best_margin_nats` is the evidence of the best pose beyond it (not used for
  /// the first pose). `leads`: it is the best pose now, and its render must be kept.
  Next takePose(const Attempt& attempt, const Pose& camera_from_station_before,
                double best_margin_nats, const RunContext& run, bool& leads);
  /// The attempt of a competing pose failed.
  Next takeFailure(LocalizationStatus status);
  /// The displacements of the self-similarity pass.
  Next takeShifts(std::span<const SelfShift> shifts, const RunContext& run);

  /// The pass that compares a pose with the best one.
  PassPlan comparison() const;
  /// The attempt from the competing pose to try.
  Attempt competitor(int index, const RunContext& run) const;
  /// The attempt that repeats the last iteration of the best pose.
  Attempt best(int index, const LocalizerOptions& options) const;

  /// Notes the twins of the final pose.
  std::span<const Rival> takeTwins(std::span<const Twin> twins);
  /// kConverged, or kAmbiguous when a twin has about as much evidence.
  LocalizationStatus verdictOnTwins(const LocalizerOptions& options) const;

  /// The poses compared so far, with their evidence.
  std::span<const Rival> poses() const { return poses_.first(static_cast<std::size_t>(count_)); }
  /// kConverged, kAmbiguous, or kLeftUncertainty for a best pose outside the seed's uncertainty:
  /// that one must be clearly better than those inside, and the seed is wrong.
  LocalizationStatus verdict(const Pose& camera_from_station,
                             const LocalizerOptions& options) const;

 private:
  enum class Round : std::uint8_t { kNone = 0, kComparison, kTrials, kEnd };

  bool isInSeedsBox(const Pose& camera_from_station, const LocalizerOptions& options) const;
  bool isKnown(const Pose& camera_from_station, double within_px, const RunContext& run) const;
  void lead(const Attempt& attempt, const Pose& camera_from_station_before);
  Next next();

  Round round_ = Round::kNone;
  std::span<Rival> poses_;
  int count_ = 0;
  int trial_ = 0;        ///< index of the pose being tried
  int best_index_ = -1;  ///< of the best pose; -1: the first that converged
  Attempt best_;
  Pose best_before_;  ///< where the last iteration of the best pose started
  bool best_is_shown_ = false;
  Seed seed_;  ///< of the run
};

}  // namespace boresight
