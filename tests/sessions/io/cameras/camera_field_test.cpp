// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/camera_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/io/files/errors.h"
#include "tests/core/geometry/example_cameras.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using enum CameraModel;

Camera withK1(double k1) {
  return makeCamera(kBrownConrady, 1024, 1024, 1552.5, {k1, 0.0, 0.0, 0.0});
}

TEST(CameraField, CoversTheImageOfRealCameras) {
  for (const NamedCamera& named : exampleCameras())
    EXPECT_EQ(sessions::fieldConcern(named.camera), "") << named.name;
}

TEST(CameraField, SaysWhereTheDistortionFoldsBack) {
  // r (1 - 5 r^2) rises up to r = 1 / sqrt(15): 14.5 deg, where it is 2/3 r, at 1552.5 px 267 px.
  EXPECT_THAT(sessions::fieldConcern(withK1(-5.0)),
              AllOf(HasSubstr("14.5 deg"), HasSubstr("267 px"), HasSubstr("% of the image")));
  EXPECT_THROW(sessions::requireField("c.json", "dist", withK1(-5.0)), sessions::InputError);
}

TEST(CameraField, IsAcceptedWhereOnlyCornersLieBeyondTheFoldAndWhereAFisheyesCircleEnds) {
  const Camera folding = withK1(-0.9);  // 630 px from the middle
  // The image of the fisheye is a circle in the middle of the sensor, and all else is dark.
  const Camera fisheye = makeCamera(kKannalaBrandt, 2000, 1000, 318.0, {0.0, 0.0, 0.0, 0.0});
  Eigen::Vector3d ray;
  ASSERT_FALSE(unproject(folding, Eigen::Vector2d(0.0, 0.0), ray));
  ASSERT_FALSE(unproject(fisheye, Eigen::Vector2d(300.0, 500.0), ray));
  for (const Camera& camera : {folding, fisheye}) EXPECT_EQ(sessions::fieldConcern(camera), "");
}

TEST(CameraField, IsRefusedWhereAFisheyeFoldsFarFromARightAngle) {
  const Camera camera = makeCamera(kKannalaBrandt, 1024, 1024, 700.0, {-2.0, 0.0, 0.0, 0.0});
  EXPECT_THAT(sessions::fieldConcern(camera), HasSubstr("folds back"));
}

}  // namespace
}  // namespace boresight::test
