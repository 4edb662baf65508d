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

/// A competing pose for the same image.
struct ConvergedPose {
  Pose camera_from_station;
  bool mirrored = false;  ///< of the station's mirror image about a plane through its box's middle
  double coverage = 0.0;  ///< share of its predicted edges that the image shows, 0 to 1
};

/// Poses reached from further seeds around the case's seed, with their edge coverage.
struct ConvergenceResult {
  int seeds = 0;
  int converged = 0;
  int returned = 0;       ///< converged to the pose in question, within the requirement
  double coverage = 0.0;  ///< of the pose in question
  std::vector<ConvergedPose> competing;  ///< other poses; of mirror images all poses
  bool symmetric = false;  ///< poses that differ by a declared symmetry have returned, too
};

/// Runs the case's localization from `seeds` further seeds, drawn evenly in its uncertainty, and of
/// the station's three mirror images from the pose in question; 0 seeds: runs nothing.
/// Deterministic. A stop returns the result so far; a repetition with its number of seeds gives the
/// same result. `after_each` receives the result so far.
ConvergenceResult convergenceTest(
    const ReviewSubject& subject, int seeds, const std::stop_token& stop = {},
    const std::function<void(const ConvergenceResult&)>& after_each = {});

/// Whether the check belongs to the convergence test.
bool isConvergenceCheck(const std::string& check_id);
/// Checks of the convergence test: enough seeds return to the pose, and none converges to another.
/// Not applicable without seeds.
void addConvergenceChecks(const ConvergenceResult& convergence, const CheckLimits& limits,
                          std::vector<Check>& checks);

/// The same case with its station mirrored in the plane through the middle of its matched box.
std::unique_ptr<const LoadedCase> mirrorImageOf(const LoadedCase& loaded, int axis);

/// All checks of a pose, always the same ones in the same order; checks without the data they need
/// are not applicable.
std::vector<Check> checkPose(const ReviewSubject& subject, const CheckLimits& limits,
                             const ConvergenceResult& convergence = {});

/// Checks of the run itself: convergence, shrinking corrections, and of lastMatching() inliers,
/// their spread, window borders and margins. Always the same checks in the same order; not
/// applicable to a pose from annotations.
void addRunChecks(const ReviewSubject& subject, const CheckLimits& limits,
                  std::vector<Check>& checks);

/// Whether the run on the ground equals the onboard run, if the case has its onboard record.
void addOnboardCheck(const ReviewSubject& subject, std::vector<Check>& checks);

/// Inliers of lastMatching(), if there is one.
std::optional<std::int32_t> lastInliers(const LocalizationTrace& run);

/// Index of the iteration to open first: the last failed one of a run that did not converge, else
/// the last one; -1: none.
int iterationToOpen(const LocalizationTrace& run);

/// Spread of points relative to that of others: the smallest ratio of both standard deviations over
/// all directions (a generalized eigenvalue). 1 for equal spreads, near 0 for points on a line
/// across which the others spread. Both deviations are increased by `floor_px` (squares add), so
/// that others on a line require no spread across it. Empty with fewer than two points of either.
std::optional<double> leastSpread(std::span<const Eigen::Vector2d> points_px,
                                  std::span<const Eigen::Vector2d> others_px, double floor_px);

/// Standard deviation; 0 for fewer than two values.
double deviationOf(std::span<const double> values);

/// The median, the lower of the two middle values; values must not be empty.
double medianOf(std::span<const double> values);

/// Whether the image is usable where the station is: saturation and range of gray levels
/// (ImageQuality).
void addImageChecks(const ReviewSubject& subject, const CheckLimits& limits,
                    std::vector<Check>& checks);

/// Edge checks of the final pose, independent of the run's acceptance test: coverage, clutter,
/// edge-coverage sensitivity, and agreement of edges and camera.
void addEdgeChecks(const ReviewSubject& subject, const CheckLimits& limits,
                   const PredictedEdges& edges, std::vector<Check>& checks);

/// Changes of focal length and principal point when they are fitted to the edges together with the
/// pose.
struct CameraFit {
  double focal_px = 0.0;  ///< change of the focal length
  double focal_sigma_px = 0.0;
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  ///< the principal point's change
  Eigen::Matrix2d centre_covariance_px2 = Eigen::Matrix2d::Zero();

  double centreSigma_px() const;  ///< along the change
};

/// Least squares over the distances along the normals with Tukey's weights, linear about the pose.
/// The sigmas account for common errors of edges (a bevel, a shadow): square tiles of the image
/// count as one observation each. What the edges of a whole image share, as by light from one side,
/// is not in them: rendered stations are 1.4 to 2.2 sigma off (`resources/evidence/trust.md`).
/// Empty with fewer than 60 edges found, or when these do not determine all nine unknowns; the
/// pose keeps its place along `symmetric` motions.
std::optional<CameraFit> fitCamera(std::span<const LookedPlace> looked, const Camera& camera,
                                   const Pose& camera_from_station,
                                   const PoseMotions& symmetric = PoseMotions(6, 0));

/// Whether focal length and principal point are within the limits, by their fitted changes and the
/// case's sigmas of the calibration. An empty fit fails each parameter whose sigma is not stated.
void addCameraChecks(const std::optional<CameraFit>& fit, const SessionCase& session_case,
                     const CheckLimits& limits, std::vector<Check>& checks);

/// Distance of the pose from other references: the case's annotations, its truth, and the other
/// cameras of its rig (the farthest one).
void addAgreementChecks(const ReviewSubject& subject, const CheckLimits& limits,
                        std::vector<Check>& checks);

/// Whether a pose agrees with the subject's pose within all limits of the requirement.
bool withinRequirement(const ReviewSubject& subject, const Pose& camera_from_station);

/// The pose's covariance, mesh scale and calibration included, against each limit of the
/// requirement: translations at the end effector, or at the camera where that is not known.
void addPrecisionChecks(const ReviewSubject& subject, const CheckLimits& limits,
                        std::vector<Check>& checks);

}  // namespace boresight::sessions
