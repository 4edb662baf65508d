// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/geometry_meter.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/base/symmetric_eigen.h"

namespace boresight::sessions {
namespace {

constexpr int kUnknowns = 6;
constexpr int kFewestPoints = 4;
constexpr double kFewestOfDepth = 0.02;  ///< of the mean distance
constexpr double kFewestOfImage = 0.25;  ///< of the station's extent in the image, each way

std::vector<Eigen::Vector3d> annotatedPlaces(std::span<const AnnotatedView> views) {
  std::vector<Eigen::Vector3d> places;
  for (const AnnotatedView& view : views) {
    for (const PointPair& point : view.annotations.points)
      if (point.used()) places.push_back(*point.point_in_station_m);
    for (const LinePair& line : view.annotations.lines) {
      if (!line.used()) continue;
      places.push_back(line.edge->start_in_station_m);
      places.push_back(line.edge->end_in_station_m);
    }
  }
  return places;
}

/// Widths of the smallest upright box around the places that the camera sees.
Eigen::Vector2d extentInImage(const AnnotatedView& view, const Pose& camera_from_station,
                              std::span<const Eigen::Vector3d> places_m) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& place : places_m) {
    Eigen::Vector2d pixel;
    if (project(view.camera, camera_from_station * place, pixel)) box.extend(pixel);
  }
  return box.isEmpty() ? Eigen::Vector2d(0.0, 0.0) : Eigen::Vector2d(box.sizes());
}

/// Measurements, and the most points of one view.
struct Counts {
  int measurements = 0;
  int most_points = 0;
};

Counts countAnnotations(std::span<const AnnotatedView> views) {
  Counts counts;
  counts.measurements = 2 * static_cast<int>(usedAnnotations(views).size());
  for (const AnnotatedView& view : views) {
    const auto points =
        std::count_if(view.annotations.points.begin(), view.annotations.points.end(),
                      [](const PointPair& point) { return point.used(); });
    counts.most_points = std::max(counts.most_points, static_cast<int>(points));
  }
  return counts;
}

void warnOfCounts(const Counts& counts, bool guessed, std::vector<GeometryWarning>& warnings) {
  const int missing = (kUnknowns - counts.measurements + 1) / 2;
  if (missing > 0) {
    warnings.push_back({GeometryWeakness::kTooFew, true,
                        "too few annotations: add " + std::to_string(missing) +
                            (missing == 1 ? " more pair" : " more pairs")});
  } else if (!guessed && counts.most_points < kFewestPoints) {
    warnings.push_back({GeometryWeakness::kTooFew, true,
                        "too few points: without an initial pose one image needs at least " +
                            std::to_string(kFewestPoints)});
  } else if (counts.measurements == kUnknowns) {
    warnings.push_back(
        {GeometryWeakness::kFew, false, "no redundancy: add an annotation to check the pose"});
  }
}

void warnOfDepth(std::span<const AnnotatedView> views, const Pose& rig_from_station,
                 std::span<const Eigen::Vector3d> places_m,
                 std::vector<GeometryWarning>& warnings) {
  if (views.size() != 1) return;  // several cameras see depth
  const Pose camera_from_station = views.front().camera_from_rig * rig_from_station;
  double nearest_m = 1e300;
  double farthest_m = -1e300;
  for (const Eigen::Vector3d& place : places_m) {
    const double depth_m = (camera_from_station * place).z();
    nearest_m = std::min(nearest_m, depth_m);
    farthest_m = std::max(farthest_m, depth_m);
  }
  if (farthest_m - nearest_m > kFewestOfDepth * 0.5 * (farthest_m + nearest_m)) return;
  warnings.push_back(
      {GeometryWeakness::kOneDepth, false,
       "all annotations have the same depth, so that the tilt is weak: add one nearer or farther"});
}

}  // namespace

AnnotatedSpread annotatedSpread(std::span<const AnnotatedView> views) {
  const std::vector<Eigen::Vector3d> places = annotatedPlaces(views);
  AnnotatedSpread spread;
  spread.places = static_cast<int>(places.size());
  if (places.empty()) return spread;
  const double count = static_cast<double>(places.size());
  for (const Eigen::Vector3d& place : places) spread.middle_in_station_m += place / count;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& place : places) {
    const Eigen::Vector3d from_middle = place - spread.middle_in_station_m;
    scatter += from_middle * from_middle.transpose() / count;
  }
  const SymmetricEigen<3> eigen(scatter);
  for (int i = 0; i < 3; ++i) {
    spread.axes_in_station.col(i) = eigen.vectors.col(2 - i);
    spread.deviation_m[i] = std::sqrt(std::max(0.0, eigen.values[2 - i]));
  }
  return spread;
}

std::vector<GeometryWarning> geometryWarnings(std::span<const AnnotatedView> views,
                                              const Pose* guess,
                                              std::span<const Eigen::Vector3d> station_m) {
  std::vector<GeometryWarning> warnings;
  warnOfCounts(countAnnotations(views), guess != nullptr, warnings);
  if (!warnings.empty() && warnings.back().prevents) return warnings;
  const AnnotatedSpread spread = annotatedSpread(views);
  if (spread.collinear()) {
    warnings.push_back({GeometryWeakness::kCollinear, true,
                        "all annotations lie on one line: add one off the line"});
    return warnings;
  }
  if (spread.coplanar()) {
    warnings.push_back(
        {GeometryWeakness::kCoplanar, false,
         "all annotations lie in one plane: two poses may fit; add one off the plane"});
  }
  if (guess == nullptr) return warnings;
  const std::vector<Eigen::Vector3d> places = annotatedPlaces(views);
  warnOfDepth(views, *guess, places, warnings);
  bool covered = station_m.empty();
  for (const AnnotatedView& view : views) {
    const Pose camera_from_station = view.camera_from_rig * *guess;
    const Eigen::Vector2d annotated = extentInImage(view, camera_from_station, places);
    const Eigen::Vector2d whole = extentInImage(view, camera_from_station, station_m);
    covered = covered || (annotated.array() >= kFewestOfImage * whole.array()).all();
  }
  if (!covered) {
    warnings.push_back(
        {GeometryWeakness::kClustered, false,
         "the annotations cover little of the station: add some far from the others"});
  }
  return warnings;
}

GeometryWarning imprecisionWarning(double sigmas, const std::string& excess) {
  std::ostringstream text;
  text << sigmas << " sigma: " << excess << "; place annotations more precisely and farther apart";
  return {GeometryWeakness::kImprecise, false, text.str()};
}

}  // namespace boresight::sessions
