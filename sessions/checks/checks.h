// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "sessions/checks/review_subject.h"
#include "sessions/decision/check.h"
#include "sessions/decision/check_limits.h"
#include "sessions/session/case_run.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

struct LookedPlace;
struct PredictedEdges;

/// Number of further seeds that detects a competing pose within a few seconds.
inline constexpr int kConvergenceSeeds = 8;

/// Another answer to the same image.
struct ConvergedPose {
  Pose camera_from_station;
  bool mirrored = false;  ///< of the station's mirror image about a plane through its box's middle
  double coverage = 0.0;  ///< share of the edges that it predicts which the image shows, 0 to 1
};

/// Where further seeds around the case's lead, and what speaks for it.
struct ConvergenceResult {
  int seeds = 0;
  int converged = 0;
  int returned = 0;       ///< converged to the pose in question, within the requirement
  double coverage = 0.0;  ///< of the pose in question
  std::vector<ConvergedPose> competing;  ///< other poses, and the mirror images' wherever they lie
};

/// Runs the case's localization from `seeds` further seeds, drawn evenly in its uncertainty, and
/// of the station's three mirror images from the pose in question. Deterministic. A stop leaves
/// what was done by then; as many seeds as it counts give the same result again. `after_each` is
/// told what was found so far.
ConvergenceResult convergenceTest(
    const ReviewSubject& subject, int seeds, const std::stop_token& stop = {},
    const std::function<void(const ConvergenceResult&)>& after_each = {});

/// What became of other seeds: enough lead back, and none to another pose.
bool isConvergenceCheck(const std::string& check_id);
void addConvergenceChecks(const std::optional<ConvergenceResult>& convergence,
                          const CheckLimits& limits, std::vector<Check>& checks);

/// The same case with its station mirrored in the plane through the middle of its matched box.
std::unique_ptr<const LoadedCase> mirrorImageOf(const LoadedCase& loaded, int axis);

/// All checks of a pose, always the same ones in the same order; what cannot be asked is not
/// applicable. `convergence` is what was measured of it, if it was.
std::vector<Check> checkPose(const ReviewSubject& subject, const CheckLimits& limits,
                             const std::optional<ConvergenceResult>& convergence = {});

/// What a run says of itself: that it converged, that its corrections shrink, and its last
/// matching iteration's inliers, their spread, window borders and margins. Always the same checks
/// in the same order; not applicable to a pose from annotations.
void addRunChecks(const ReviewSubject& subject, const CheckLimits& limits,
                  std::vector<Check>& checks);

/// Whether the run on the ground is the one that ran onboard, where the case has its record.
void addOnboardCheck(const ReviewSubject& subject, std::vector<Check>& checks);

/// Inliers of the last matching iteration; 0 when there was none.
std::int32_t lastInliers(const LocalizationTrace& run);

/// Index of the iteration to look at first: the last one that failed when the run did not converge,
/// else the last one; -1 when there is none.
int iterationToOpen(const LocalizationTrace& run);

/// How widely points spread compared with others, in the direction in which they do least: the
/// smallest ratio of both standard deviations over all directions (a generalized eigenvalue). 1
/// when both spread alike, near 0 when the points lie on a line across which the others spread.
/// Both deviations are increased by `floor_px` (squares add), so that others on a line ask for no
/// spread across it. Nothing when there are fewer than two points of either.
std::optional<double> leastSpread(std::span<const Eigen::Vector2d> points_px,
                                  std::span<const Eigen::Vector2d> others_px, double floor_px);

/// Standard deviation; 0 for fewer than two values.
double deviationOf(std::span<const double> values);

/// The value in the middle, the lower of two; values must not be empty.
double medianOf(std::span<const double> values);

/// Whether the image can carry a pose where the station is: saturation and range of gray levels
/// (ImageQuality).
void addImageChecks(const ReviewSubject& subject, const CheckLimits& limits,
                    std::vector<Check>& checks);

/// What the image's edges say of the final pose, measured again, independent of the run's
/// acceptance test: coverage, clutter and fall-off kept apart, and whether they ask for another
/// camera.
void addEdgeChecks(const ReviewSubject& subject, const CheckLimits& limits,
                   const PredictedEdges& edges, std::vector<Check>& checks);

/// What the edges say of the camera when its focal length and principal point are left free
/// together with the pose.
struct CameraFit {
  double focal_px = 0.0;   ///< change of the focal length that the edges ask for
  double centre_px = 0.0;  ///< length of the principal point's change
  double focal_sigma_px = 0.0;
  double centre_sigma_px = 0.0;  ///< along the change
};

/// Least squares over the distances along the normals with Tukey's weights, linear about the pose.
/// The sigmas allow for edges that are off together (a bevel, a shadow): square tiles of the image
/// count as one observation each (cluster-robust covariance, Liang and Zeger 1986). Nothing with
/// fewer than 60 edges found or when these do not determine all nine.
std::optional<CameraFit> fitCamera(std::span<const LookedPlace> looked, const Camera& camera,
                                   const Pose& camera_from_station);

/// How far the pose is from what else is known: the case's annotations, its truth, the other
/// cameras of its rig (the one that is farthest off).
void addAgreementChecks(const ReviewSubject& subject, const CheckLimits& limits,
                        std::vector<Check>& checks);

/// Whether a pose lies within everything that a requirement names of another one.
bool withinRequirement(const ReviewSubject& subject, const Pose& camera_from_station);

/// The pose's covariance, mesh scale and calibration included, against each thing that the
/// requirement names: translations at the end effector, or at the camera where that is not known.
void addPrecisionChecks(const ReviewSubject& subject, const CheckLimits& limits,
                        std::vector<Check>& checks);

}  // namespace boresight::sessions
