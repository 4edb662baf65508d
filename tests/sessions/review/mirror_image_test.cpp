// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/checks.h"

#include <gtest/gtest.h>

#include "sessions/session/session_maker.h"
#include "tests/support/example_case.h"

namespace boresight::sessions {
namespace {

/// Six times the signed volume between the faces and the middle of their box: faces that look the
/// other way change its sign, whether or not they are closed.
double sixfoldVolume(const SceneMesh& scene) {
  double sum = 0.0;
  const Eigen::Vector3d middle_m = matchedBounds(scene.view()).centre();
  const auto at = [&](std::int32_t i) -> Eigen::Vector3d {
    return scene.vertices_in_station_m[static_cast<std::size_t>(i)].cast<double>() - middle_m;
  };
  for (const Face& face : scene.faces)
    sum += at(face.vertex[0]).dot(at(face.vertex[1]).cross(at(face.vertex[2])));
  return sum;
}

std::shared_ptr<const LoadedCase> example() {
  const Session session = makeSession(test::exampleFolder() / "dataset.json");
  return loadCase(*session.cases.front());
}

TEST(MirrorImage, KeepsTheBoxAndTheOutwardSide) {
  const auto loaded = example();
  for (int axis = 0; axis < 3; ++axis) {
    const auto image = mirrorImageOf(*loaded, axis);
    const BoundingBox was = matchedBounds(loaded->scene.view());
    const BoundingBox is = matchedBounds(image->scene.view());
    EXPECT_LT((is.minimum_m - was.minimum_m).norm(), 1e-6);
    EXPECT_LT((is.maximum_m - was.maximum_m).norm(), 1e-6);
    const double volume = sixfoldVolume(loaded->scene);
    EXPECT_NEAR(sixfoldVolume(image->scene), volume, 1e-3 * std::abs(volume));
    EXPECT_EQ(image->image.pixels, loaded->image.pixels);
  }
}

TEST(MirrorImage, MirrorsOneCoordinateAndTwiceIsNothing) {
  const auto loaded = example();
  const double middle_m = matchedBounds(loaded->scene.view()).centre()(1);
  const auto image = mirrorImageOf(*loaded, 1);
  SceneMesh twice = image->scene;
  mirrorScene(twice, 1, middle_m);
  for (std::size_t i = 0; i < twice.vertices_in_station_m.size(); ++i) {
    const Eigen::Vector3f& was = loaded->scene.vertices_in_station_m[i];
    const Eigen::Vector3f& is = image->scene.vertices_in_station_m[i];
    EXPECT_EQ(is.x(), was.x());
    EXPECT_EQ(is.z(), was.z());
    EXPECT_NEAR(is.y(), 2.0 * middle_m - was.y(), 1e-6);
    EXPECT_LT((twice.vertices_in_station_m[i] - was).norm(), 1e-6F);
  }
  for (std::size_t i = 0; i < twice.faces.size(); ++i)
    EXPECT_EQ(twice.faces[i].vertex, loaded->scene.faces[i].vertex);
}

}  // namespace
}  // namespace boresight::sessions
