// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/pose.h"
#include "sessions/annotation/annotations.h"

namespace boresight::sessions {

struct SolveAnnotationsOptions {
  /// Tukey's weights instead of equal ones: outliers count little or nothing.
  bool robust = false;
  /// Start pose; needed when every view has fewer than four points.
  std::optional<Pose> rig_from_station_guess;
};

/// Number of standard deviations above which a residual is an outlier.
inline constexpr double kOutlierSigmas = 3.0;
/// Noise factor above which annotations do not belong to one pose, or their sigmas are wrong.
inline constexpr double kMostNoise = 3.0;

/// Residuals of an annotation under the solved pose.
struct SolvedAnnotation {
  AnnotationAddress address;
  bool projected = false;  ///< false: not projected; the other members are unset
  /// Observed minus predicted: x and y of a point, the distances of a line's ends across the edge.
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d residual_mm = Eigen::Vector2d::Zero();  ///< the same at the annotation's distance
  double weight = 1.0;                                    ///< 0 ... 1; 1 unless robust
  /// Norm of the residual in units of its own standard deviation, sigma_px times the noise factor
  /// reduced by the annotation's own influence on the pose (leverage).
  double normalized = 0.0;

  /// Whether the annotator should check this residual.
  bool isOutlier() const { return projected && normalized > kOutlierSigmas; }
};

/// How far the pose moves without an annotation.
struct LeftOut {
  AnnotationAddress address;
  bool determined = false;      ///< false: without it there is no pose
  double translation_mm = 0.0;  ///< of the middle of the annotated points
  double rotation_mrad = 0.0;
};

/// Another pose that explains coplanar annotations nearly as well (Schweighofer and Pinz 2006).
struct AmbiguousPose {
  Pose rig_from_station;
  double rms_px = 0.0;
};

struct AnnotationsSolution {
  Pose rig_from_station;
  std::vector<Pose> camera_from_station;  ///< by view
  /// Over xi = (rotation rad, translation m), left perturbation, rig frame:
  /// max(1, noise_factor)^2 (J' W J)^-1 with W = 1 / sigma_px^2. Small residuals of few annotations
  /// do not lower it: they are as likely chance.
  Matrix6d covariance = Matrix6d::Zero();
  /// Root of the weighted squares over the degrees of freedom: 1 when the annotations are as
  /// accurate as their sigmas state, and without redundancy.
  double noise_factor = 1.0;
  int degrees_of_freedom = 0;
  double rms_px = 0.0;                        ///< over both residuals of all annotations, weighted
  std::vector<SolvedAnnotation> annotations;  ///< in the order of usedAnnotations
  std::optional<AmbiguousPose> ambiguous;
};

/// A solution, or one sentence with the reason for its absence and a remedy.
struct AnnotationsResult {
  std::optional<AnnotationsSolution> solution;
  std::string reason;
};

/// The pose of the rig by least squares over all enabled annotations, weighted by sigma (optionally
/// robust), with the full camera models. It starts from firstPoses() where a view has four points,
/// and from the guess; the best result counts. Deterministic: the same annotations give the same
/// digits. Robust: iteratively reweighted least squares with Tukey's biweight, c = 4.685 (Huber and
/// Ronchetti 2009), its scale the median of the residuals' norms.
AnnotationsResult solveAnnotations(std::span<const AnnotatedView> views,
                                   const SolveAnnotationsOptions& options);

/// Solves again with each annotation left out in turn; equal or robust weights are kept.
std::vector<LeftOut> leaveOneOut(std::span<const AnnotatedView> views,
                                 const AnnotationsSolution& solution);

/// The covariance of a camera, in its own frame.
Matrix6d cameraCovariance(const AnnotationsSolution& solution, const AnnotatedView& view);

}  // namespace boresight::sessions
