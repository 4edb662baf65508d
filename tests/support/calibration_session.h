// SPDX-License-Identifier: Apache-2.0
// Sessions with many images of one station, for calibrations.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sessions/session/session_maker.h"
#include "tests/support/example_case.h"
#include "tests/support/random_pose.h"

namespace boresight::test {

inline constexpr double kLongerFocalLength = 1.004;

/// Places of the camera all around the station, at several distances and rolled.
inline std::vector<Pose> placesOfTheCamera(int count) {
  Random random = randomFor("Calibrate");
  std::vector<Pose> places;
  for (int i = 0; i < count; ++i) {
    Vector6d turn = Vector6d::Zero();
    for (int axis = 0; axis < 3; ++axis) turn[axis] = random.uniform(-0.6, 0.6);
    Pose& place = places.emplace_back(perturbed(turn, Pose()));
    place.translation_m = {random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02),
                           random.uniform(0.25, 0.5)};
  }
  return places;
}

/// The case of the orbiting sample as often as wanted.
inline sessions::Session sessionOf(int count) {
  sessions::Session session =
      sessions::makeSession(exampleFolder() / "dataset.json", {"os-000038"});
  const sessions::SessionCase first = *session.cases.front();
  session.cases.clear();
  for (int i = 0; i < count; ++i) {
    sessions::SessionCase session_case = first;
    session_case.id = "c" + std::to_string(i);
    session.cases.push_back(session_case);
  }
  return session;
}

inline sessions::Annotations annotationsFrom(const Pose& camera_from_station,
                                             const Camera& camera) {
  sessions::Annotations annotations;
  Random random = randomFor("Calibrate.Points");
  for (int i = 0; i < 20; ++i) {
    sessions::PointPair point;
    point.id = "p" + std::to_string(i);
    point.point_in_station_m = randomVector(random, 0.05);
    Eigen::Vector2d pixel;
    if (!project(camera, camera_from_station * *point.point_in_station_m, pixel)) continue;
    point.pixel = pixel + 0.05 * Eigen::Vector2d(random.normal(), random.normal());
    point.sigma_px = 0.05;
    annotations.points.push_back(point);
  }
  return annotations;
}

/// Annotated through a lens that is longer than the session's camera says.
inline sessions::Session sessionOfALongerLens(int count) {
  sessions::Session session = sessionOf(count);
  Camera camera = session.cases.front()->camera;
  camera.fx *= kLongerFocalLength;
  camera.fy *= kLongerFocalLength;
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  const auto places = placesOfTheCamera(count);
  for (std::size_t i = 0; i < places.size(); ++i)
    session = withAnnotations(session, session.cases[i]->id, annotationsFrom(places[i], camera));
  return session;
}

}  // namespace boresight::test
