// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "sessions/annotation/annotations_on_image.h"
#include "sessions/annotation/mesh_snap.h"
#include "sessions/session/session_maker.h"
#include "tests/support/example_case.h"
#include "tests/support/random_pose.h"

namespace boresight::test {

/// A corner of the example's mesh and where the true pose shows it.
struct SeenCorner {
  Eigen::Vector3d in_station_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

/// Seen corners as far from each other in the image as a careful person would choose them: each
/// next one is the farthest from those before it.
inline std::vector<SeenCorner> spreadCorners(const ExampleCase& example, std::size_t count) {
  const MeshView mesh = example.scene.view();
  const Pose& pose = example.truth.camera_from_station;
  const sessions::MeshSnapper snapper(mesh);
  std::vector<SeenCorner> candidates;
  const std::size_t step = std::max<std::size_t>(1, snapper.edges().size() / 400);
  for (std::size_t i = 0; i < snapper.edges().size(); i += step) {
    const Eigen::Vector3d corner = snapper.edges()[i].start_in_station_m;
    const auto place = sessions::predictPlace(example.camera, pose, corner);
    if (place.valid && sessions::isInImage(example.camera, place.pixel) &&
        sessions::isSeen(example.camera, mesh, pose, corner))
      candidates.push_back({corner, place.pixel});
  }
  std::vector<SeenCorner> chosen;
  const auto distance = [&chosen](const SeenCorner& seen_corner) {
    double least = 1e9;
    for (const SeenCorner& other : chosen)
      least = std::min(least, (seen_corner.pixel - other.pixel).norm());
    return least;
  };
  while (chosen.size() < std::min(count, candidates.size()))
    chosen.push_back(*std::max_element(
        candidates.begin(), candidates.end(),
        [&](const SeenCorner& a, const SeenCorner& b) { return distance(a) < distance(b); }));
  return chosen;
}

/// These corners as an annotator would place them: with noise, or as they are with the sigma 0.2
/// px.
inline sessions::Annotations annotationsOf(const std::vector<SeenCorner>& corners, double noise_px,
                                           Random& random) {
  sessions::Annotations annotations;
  for (const SeenCorner& corner : corners) {
    sessions::PointPair point;
    point.id = sessions::unusedId(annotations, 'p');
    point.point_in_station_m = corner.in_station_m;
    const double x = random.normal();
    const double y = random.normal();
    point.pixel = corner.pixel + noise_px * Eigen::Vector2d(x, y);
    point.sigma_px = noise_px > 0.0 ? noise_px : 0.2;
    annotations.points.push_back(point);
  }
  return annotations;
}

/// The id of the case of a station.
inline std::string caseOfStation(const sessions::Session& session, const std::string& station) {
  for (const auto& session_case : session.cases)
    if (session_case->station == station) return session_case->id;
  return "";
}

/// A session of the example's two cases, ten corners of each annotated.
inline sessions::Session annotatedExample(double noise_px) {
  sessions::Session session = sessions::makeSession(exampleFolder() / "dataset.json");
  Random random = randomFor("markedExample");
  for (const char* station : {"bc", "os"})
    session =
        withAnnotations(session, caseOfStation(session, station),
                        annotationsOf(spreadCorners(ExampleCase(station), 10), noise_px, random));
  return session;
}

}  // namespace boresight::test
