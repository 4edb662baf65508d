// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/restart_grid.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/schedule.h"

namespace boresight {
namespace {

constexpr double kSame = 1e-9;  ///< rounding, where spacings divide a range

/// The odd number of intervals of at most `spacing` that tile [-range, range].
int oddTiles(double range, double spacing, int most) {
  int count = 1;
  while (count + 2 <= most && count * spacing < 2.0 * range - kSame) count += 2;
  return count;
}

Eigen::Vector3d turnAxis(const Pose& camera_from_station, const Eigen::Vector3d& middle_in_camera_m,
                         TurnAxis axis) {
  if (axis == TurnAxis::kView) {
    const double distance_m = middle_in_camera_m.norm();
    if (!(distance_m > 0.0)) return Eigen::Vector3d::UnitZ();
    return middle_in_camera_m / distance_m;
  }
  const int column = static_cast<int>(axis) - static_cast<int>(TurnAxis::kStationX);
  return camera_from_station.matrix().col(column);
}

}  // namespace

RestartGrid::RestartGrid(const LocalizationProblem& problem, const BoundingBox& scene,
                         const WideOptions& options)
    : camera_from_station_seed_(problem.camera_from_station_seed),
      seed_(problem.uncertainty),
      middle_in_camera_m_(problem.camera_from_station_seed * scene.centre()),
      axis_in_camera_(
          turnAxis(problem.camera_from_station_seed, middle_in_camera_m_, options.rotation_axis)),
      about_view_(options.rotation_axis == TurnAxis::kView) {
  for (int i = 0; i < 3; ++i) reach_m_[i] = std::max(seed_.translation_m[i], options.translation_m);
  // Never closer to the camera than a tenth of the depth.
  reach_m_[2] = std::max(seed_.translation_m.z(),
                         std::min(reach_m_[2], 0.9 * std::max(0.0, middle_in_camera_m_.z())));
  if (options.translation_m > 0.0 && middle_in_camera_m_.z() > 0.0) {
    depths_ = oddTiles(reach_m_[2], options.depth_spacing * middle_in_camera_m_.z(),
                       options.max_restarts);
  }
  depth_m_ = 2.0 * reach_m_[2] / depths_;
  const double declared_rad = about_view_ ? seed_.rotation_rad.z() : 0.0;
  layOutTurns(std::max(declared_rad, options.rotation_rad), options);
}

void RestartGrid::layOutTurns(double range_rad, const WideOptions& options) {
  const int most = std::max(1, options.max_restarts / depths_);
  const double spacing_rad = options.rotation_spacing_rad;
  if (2.0 * range_rad + spacing_rad > 2.0 * kPi) {
    while (turns_ < most && turns_ * spacing_rad < 2.0 * kPi - kSame) ++turns_;
    turn_rad_ = 2.0 * kPi / turns_;
  } else {
    turns_ = oddTiles(range_rad, spacing_rad, most);
    turn_rad_ = 2.0 * range_rad / turns_;
  }
}

double RestartGrid::turnOf_rad(int restart) const { return rollOf(restart % turns_, turn_rad_); }

double RestartGrid::depthOffsetOf_m(int restart) const {
  return rollOf(restart / turns_, depth_m_);
}

Pose RestartGrid::poseOf(int restart) const {
  Pose made = camera_from_station_seed_;
  if (restart % turns_ != 0) {  // not turned, the pose keeps its bits
    const Eigen::Quaterniond turn = rotationExp(axis_in_camera_ * turnOf_rad(restart));
    made.rotation = (turn * made.rotation).normalized();
    made.translation_m = turn * (made.translation_m - middle_in_camera_m_) + middle_in_camera_m_;
  }
  made.translation_m.z() += depthOffsetOf_m(restart);
  return made;
}

SeedUncertainty RestartGrid::movedTo(const Pose& camera_from_station,
                                     SeedUncertainty uncertainty) const {
  if (seed_.pivot_in_camera_m.squaredNorm() > 0.0) {
    uncertainty.pivot_in_camera_m =
        camera_from_station * (camera_from_station_seed_.inverse() * seed_.pivot_in_camera_m);
  }
  return uncertainty;
}

SeedUncertainty RestartGrid::uncertaintyOf(int restart) const {
  SeedUncertainty made = seed_;
  made.translation_m = {reach_m_[0], reach_m_[1], 0.5 * depth_m_};
  if (about_view_) made.rotation_rad.z() = 0.0;  // the turns cover it
  for (int i = 0; i < 3; ++i) {
    made.rotation_rad[i] =
        std::min(kPi, made.rotation_rad[i] + 0.5 * turn_rad_ * std::abs(axis_in_camera_[i]));
  }
  return movedTo(poseOf(restart), made);
}

SeedUncertainty RestartGrid::uncertaintyAfter(const Pose& camera_from_station) const {
  SeedUncertainty made = uncertaintyOf(0);
  made.translation_m = {0.5 * reach_m_[0], 0.5 * reach_m_[1], 0.5 * reach_m_[2]};
  return movedTo(camera_from_station, made);
}

double excessNats(double count, double share, double chance) {
  constexpr double kLeast = 1e-6;
  const double p = std::clamp(chance, kLeast, 1.0 - kLeast);
  const double q = std::clamp(share, 0.0, 1.0);
  if (!(q > p) || !(count > 0.0)) return 0.0;
  const double rest = q < 1.0 ? (1.0 - q) * naturalLogarithm((1.0 - q) / (1.0 - p)) : 0.0;
  return count * (q * naturalLogarithm(q / p) + rest);
}

namespace {

/// Share of the search windows that lies within the threshold of a place.
double chanceOfInlier(const Iteration& iteration) {
  const double radius_px = iteration.threshold_px / static_cast<double>(1 << iteration.level);
  const double disc_px = kPi * radius_px * radius_px;
  double sum = 0.0;
  std::int32_t searched = 0;
  for (std::int32_t i = 0; i < iteration.matches.count; ++i) {
    const Match& match = iteration.matches.matches[static_cast<std::size_t>(i)];
    if (!match.searched) continue;
    const double window_px =
        static_cast<double>(match.window.width()) * static_cast<double>(match.window.height());
    sum += std::min(1.0, disc_px / std::max(1.0, window_px));
    ++searched;
  }
  return searched > 0 ? sum / searched : 1.0;
}

}  // namespace

Evidence evidenceOf(const Iteration& iteration, const EdgeSupport& support) {
  constexpr double kOverlap = 4.0;  ///< templates that share their surroundings
  constexpr double kAlong = 8.0;    ///< edge pixels that go together
  constexpr int kFreedom = 3;       ///< matches that any pose may meet
  Evidence made;
  const int count = iteration.correspondence_count - kFreedom;
  const int inliers = iteration.pnp.inlier_count - kFreedom;
  if (count > 0) {
    made.inliers = excessNats(count / kOverlap, static_cast<double>(inliers) / count,
                              chanceOfInlier(iteration));
  }
  made.edges =
      excessNats(support.rendered / kAlong, support.coverage(), support.chanceCoverage()) +
      excessNats(support.seen / kAlong, support.explanation(), support.chanceExplanation());
  return made;
}

int chooseFinalists(std::span<const HypothesisSummary> restarts, const BoundingBox& scene,
                    const Camera& camera, double distinct_px, std::span<std::int32_t> chosen) {
  int count = 0;
  const auto isNear = [&](const HypothesisSummary& one, std::int32_t other) {
    return displacementBetween_px(restarts[static_cast<std::size_t>(other)].camera_from_station,
                                  one.camera_from_station, scene, camera) < distinct_px;
  };
  const auto isChosen = [&](std::int32_t index) {
    return std::find(chosen.begin(), chosen.begin() + count, index) != chosen.begin() + count;
  };
  while (count < static_cast<int>(chosen.size())) {
    std::int32_t best = -1;
    for (std::size_t i = 0; i < restarts.size(); ++i) {
      const HypothesisSummary& one = restarts[i];
      const bool better =
          best < 0 || one.evidence() > restarts[static_cast<std::size_t>(best)].evidence();
      if (!one.solved || !better || isChosen(static_cast<std::int32_t>(i))) continue;
      if (std::any_of(chosen.begin(), chosen.begin() + count,
                      [&](std::int32_t other) { return isNear(one, other); }))
        continue;
      best = static_cast<std::int32_t>(i);
    }
    if (best < 0) break;
    chosen[static_cast<std::size_t>(count++)] = best;
  }
  return count;
}

}  // namespace boresight
