// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/annotated_seed.h"

#include "core/base/math.h"
#include "sessions/checks/pose_uncertainty.h"
#include "sessions/evaluation/pose_error.h"

namespace boresight::sessions {
namespace {

constexpr double kMeasuredSeedSigmas = 3.0;
constexpr double kLeastSeed_mm = 1.0;
constexpr double kLeastSeed_deg = 0.2;

}  // namespace

SessionCase withMeasuredSeed(SessionCase session_case, const MeshView& mesh,
                             const Pose& camera_from_station, const Matrix6d& picture_covariance) {
  setSeed(session_case, camera_from_station);
  const Pose at_centre{Eigen::Quaterniond::Identity(),
                       camera_from_station * matchedBounds(mesh).centre()};
  const auto sigma =
      poseSigma(poseCovariance(session_case, mesh, camera_from_station, picture_covariance).total(),
                at_centre);
  if (!sigma) return session_case;
  DeclaredUncertainty& uncertainty = session_case.uncertainty;
  uncertainty.pivot = UncertaintyPivot::kStation;
  uncertainty.translation_m =
      1e-3 * (kMeasuredSeedSigmas * sigma->translation_mm).cwiseMax(kLeastSeed_mm);
  uncertainty.rotation_deg =
      (1e-3 / kDegree_rad * kMeasuredSeedSigmas * sigma->rotation_mrad).cwiseMax(kLeastSeed_deg);
  return session_case;
}

}  // namespace boresight::sessions
