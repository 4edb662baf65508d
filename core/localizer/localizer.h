// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/digest.h"
#include "core/localizer/localizer_options.h"
#include "core/localizer/problem.h"
#include "core/localizer/workspace.h"

namespace boresight {

enum class Stage : std::uint8_t {
  kEdges = 0,
  kRender,
  kTemplates,
  kMatch,
  kPose,
  kRefine,
  kSupport,
  kFinished,
};
const char* stageText(Stage stage);

/// What one step did.
struct StepReport {
  Stage stage = Stage::kEdges;  ///< the stage that was worked on
  bool stage_complete = false;
  bool iteration_complete = false;  ///< its record is whole, up to the stage that failed
  bool finished = false;
};

/// Render-and-compare localization (Pham 2025), one bounded slice per call. The flight loop, the
/// command line, a window's worker and a recorder are callers of the same `step()`; nothing in here
/// calls back, pauses, draws or logs. After construction nothing allocates.
class Localizer {
 public:
  /// Bytes of arena for a problem of this size, in a block aligned to Arena::kAlignment (one less
  /// aligned loses its first bytes); kInvalidOption for options out of range.
  static Status requiredBytes(const ProblemSize& size, const LocalizerOptions& options,
                              std::size_t& bytes);

  /// `memory` and everything `problem` points to must outlive the localizer. `status()` tells
  /// whether it can run: kInvalidOption, kInvalidImage (its size is not the camera's or the ignore
  /// mask's), kInvalidCamera (not prepared), kInvalidPose (not finite, a quaternion not of unit
  /// length, an uncertainty that is negative), kInvalidMesh, kArenaTooSmall. If not, the first step
  /// ends the run as a fault.
  Localizer(const LocalizationProblem& problem, const LocalizerOptions& options,
            std::span<std::byte> memory);

  Localizer(const Localizer&) = delete;
  Localizer& operator=(const Localizer&) = delete;

  Status status() const { return status_; }

  /// One slice; after `finished` it does nothing.
  StepReport step();

  /// Begins anew from another pose with other options, as a fresh localizer would. Memory is what
  /// it was: kArenaTooSmall when the new options ask for more.
  Status restart(const Pose& camera_from_station_seed, const LocalizerOptions& options);

  const Workspace& workspace() const { return workspace_; }
  const LocalizationProblem& problem() const { return problem_; }
  const LocalizerOptions& options() const { return options_; }
  std::size_t highWaterBytes() const { return arena_.highWater(); }
  /// SHA-256 over options, inputs and every intermediate up to now, whoever looks or not.
  std::array<std::uint8_t, 32> digest() const { return digest_.digest(); }

 private:
  void begin();
  Status build(const ProblemSize& size);
  Status buildLevels();
  void startIteration();
  void startHypothesis();
  StepReport stepEdges();
  StepReport stepRender();
  StepReport stepTemplates();
  StepReport stepMatch();
  StepReport stepPose();
  StepReport stepRefine();
  StepReport stepSupport();
  StepReport fail(Stage stage, LocalizationStatus status);
  void startAttempt();
  double templateFactor() const;
  StepReport faulted(Stage stage, Status fault);
  void finishMatch(int index);
  void collectCorrespondences();
  void noteHypothesis();
  StepReport finishHypothesis();
  StepReport finishIteration(Stage stage, const Pose& camera_from_station,
                             const Matrix6d& covariance);
  void finish(LocalizationStatus status);
  void measureCorrection(const Pose& before, const Pose& after);
  bool isSmall(const Iteration& iteration) const;
  double imageDisplacement(const Pose& before, const Pose& after) const;
  Pose pulledBack(const Pose& camera_from_station) const;
  const PosePrior* anchor() const;
  bool leftUncertainty(const Pose& camera_from_station) const;
  SeedUncertainty uncertaintyAt(int iteration, const Pose& camera_from_station) const;
  double shrinkAt(double factor, int iteration) const;
  int levelOf(IterationKind kind, int iteration) const;
  bool isRefinement(int iteration) const;
  int rolledHypotheses() const;
  double featureSize() const;

  LocalizationProblem problem_;
  LocalizerOptions options_;
  Arena arena_;
  Status status_ = Status::kOk;

  MeshAdjacency adjacency_;
  BoundingBox bounds_;
  EdgeDetector detector_;
  EdgeRenderer renderer_;
  TemplateSelector selector_;
  WhsSearch search_;
  PnpRansac ransac_;
  EdgeRefinement refinement_;
  std::array<RayGrid, kPyramidLevels> rays_;

  std::array<Iteration, 2> buffers_;  ///< the current hypothesis and the best of this iteration
  int current_ = 0;
  bool has_best_ = false;
  int hypothesis_ = 0;
  int match_index_ = 0;
  bool match_begun_ = false;

  Stage stage_ = Stage::kEdges;
  bool stage_begun_ = false;
  bool iteration_pending_ = false;
  bool hypothesis_pending_ = false;
  int attempt_ = 0;
  int iteration_ = 0;  ///< of this attempt
  int small_corrections_ = 0;
  int coarse_level_ = 0;
  int fine_level_ = 0;
  PosePrior anchor_;          ///< the seed with its uncertainty as a Gaussian
  PoseEstimate matched_;      ///< from the latest templates
  Pose camera_from_station_;  ///< the hypothesis
  Matrix6d covariance_ = Matrix6d::Zero();
  Workspace workspace_;
  DigestWriter digest_;
};

}  // namespace boresight
