// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "tests/core/geometry/planetary_cameras.h"
#include "tests/support/not_finite.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

class EveryPlanetaryCamera : public ::testing::TestWithParam<PlanetaryCamera> {
 protected:
  void SetUp() override {
    ASSERT_EQ(cameraFromCahv(GetParam().cahv, GetParam().width, GetParam().height, camera_,
                             camera_from_reference_),
              Status::kOk);
  }
  Camera camera_;
  Pose camera_from_reference_;
};
INSTANTIATE_TEST_SUITE_P(Cahv, EveryPlanetaryCamera, ::testing::ValuesIn(planetaryCameras()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(EveryPlanetaryCamera, AgreesWithTheFiftyDigitReference) {
  for (const PlanetaryCamera::Sight& sight : GetParam().sights) {
    const Eigen::Vector2d pixel = pixelOf(camera_, camera_from_reference_ * sight.point_m);
    EXPECT_LT((pixel - sight.pixel).norm(), 1e-9) << sight.pixel.transpose();
    const Ray ray = rayOf(camera_, sight.pixel);
    const Eigen::Vector3d direction = camera_from_reference_.rotation * sight.direction;
    EXPECT_LT((ray.direction.normalized() - direction).norm(), 1e-13);
    EXPECT_LT((ray.origin_m - camera_from_reference_ * sight.origin_m).norm(), 1e-14);
  }
}

/// On the axis the angle's direction is not defined; the derivatives are.
TEST_P(EveryPlanetaryCamera, JacobianIsSmoothThroughTheOpticalAxis) {
  const Eigen::Vector3d on_axis = 0.7 * camera_.cahv.optical_axis;
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> on_axis_jacobian;
  ASSERT_TRUE(projectWithJacobian(camera_, on_axis, pixel, on_axis_jacobian));
  for (const double off : {0.0, 1e-300, 1e-12, 1e-9, 1e-7, 0.69e-4, 0.71e-4}) {
    Eigen::Matrix<double, 2, 3> off_axis_jacobian;
    ASSERT_TRUE(projectWithJacobian(camera_, on_axis + Eigen::Vector3d(off, -off, 0.0), pixel,
                                    off_axis_jacobian));
    EXPECT_LT((off_axis_jacobian - on_axis_jacobian).norm(),
              (1e-9 + 20.0 * off) * on_axis_jacobian.norm())
        << off;
    expectDerivatives(camera_, on_axis + Eigen::Vector3d(off, -off, 0.0), off_axis_jacobian, 1e-6,
                      1e-6 * on_axis_jacobian.norm());
  }
}

TEST_P(EveryPlanetaryCamera, SeenFromPupil_LiesInTheDirectionOfThePixel) {
  Random random = randomFor("CahvSeen" + GetParam().name);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector2d at = randomPixel(camera_, random);
    const Ray ray = rayOf(camera_, at);
    const double depth_m = random.uniform(0.15, 3.0);
    const Eigen::Vector3d seen = seenFromPupil(camera_, ray.at(depth_m));
    EXPECT_LT((seen - depth_m * ray.direction).norm(), 1e-7 * depth_m) << at.transpose();
    if (!pupilMoves(camera_)) {
      EXPECT_EQ(seen, ray.at(depth_m));
    }
    const double pupil_m = camera_.cahv.optical_axis.dot(ray.origin_m);
    EXPECT_GE(pupil_m, camera_.cahv.pupil_low_m);
    EXPECT_LE(pupil_m, camera_.cahv.pupil_high_m);
  }
}

TEST_P(EveryPlanetaryCamera, CahvVectors_RoundTripThroughTheReferenceFrame) {
  const CahvModel again = cahvFromCamera(camera_, camera_from_reference_);
  const CahvModel& cahv = GetParam().cahv;
  EXPECT_LT((again.c_m - cahv.c_m).norm(), 1e-15);
  EXPECT_LT((again.a - cahv.a).norm(), 1e-15);
  EXPECT_LT((again.h_px - cahv.h_px).norm(), 1e-12 * cahv.h_px.norm());
  EXPECT_LT((again.v_px - cahv.v_px).norm(), 1e-12 * cahv.v_px.norm());
  EXPECT_EQ(again.r, cahv.r);
  EXPECT_EQ(again.e_m, cahv.e_m);
  if (cahv.model != CameraModel::kCahv) {
    EXPECT_LT((again.o - cahv.o).norm(), 1e-15);
  }
}

/// Anything that projects, wherever it lands, is on the ray of the pixel where it does: nothing
/// folds back.
TEST_P(EveryPlanetaryCamera, ProjectedPoints_LieOnTheRayOfTheirPixel) {
  Random random = randomFor("CahvFolds" + GetParam().name);
  int projected = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d point(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0),
                                random.uniform(0.3, 1.5));
    Eigen::Vector2d pixel;
    if (!project(camera_, point, pixel)) continue;
    ++projected;
    const Ray ray = rayOf(camera_, pixel);
    const double depth_m = point.z() - ray.origin_m.z();
    EXPECT_LT((ray.at(depth_m) - point).norm(), 1e-7 * point.norm()) << point.transpose();
  }
  EXPECT_GT(projected, 100);
}

TEST(Cahv, VectorsOfAPinhole_GiveThatPinhole) {
  Random random = randomFor("CahvPinhole");
  for (int k = 0; k < 20; ++k) {
    const Camera pinhole = randomCamera(random, CameraModel::kPinhole);
    const Pose camera_from_reference = randomPose(random);
    const Eigen::Matrix3d axes = camera_from_reference.matrix();
    CahvModel cahv;  // from the published relations, not from this program's own
    cahv.c_m = camera_from_reference.inverse().translation_m;
    cahv.a = axes.row(2).transpose();
    cahv.h_px = (pinhole.fx * axes.row(0) + pinhole.cx * axes.row(2)).transpose();
    cahv.v_px = (pinhole.fy * axes.row(1) + pinhole.cy * axes.row(2)).transpose();
    Camera camera;
    Pose found;
    ASSERT_EQ(cameraFromCahv(cahv, pinhole.width, pinhole.height, camera, found), Status::kOk);
    EXPECT_THAT(found, poseNear(camera_from_reference, 1e-12, 1e-12));
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d point(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                                  random.uniform(0.5, 3.0));
      EXPECT_LT((pixelOf(camera, point) - pixelOf(pinhole, point)).norm(), 1e-9);
    }
  }
}

TEST(Cahv, VectorsOfRoundedLengthGiveTheSamePixels) {
  const PlanetaryCamera mast = planetaryCameras().front();
  CahvModel longer = mast.cahv;
  longer.a *= 1.0004;  // (P - C).H / (P - C).A with these very vectors
  Camera camera;
  Pose camera_from_reference;
  ASSERT_EQ(cameraFromCahv(longer, mast.width, mast.height, camera, camera_from_reference),
            Status::kOk);
  for (const PlanetaryCamera::Sight& sight : mast.sights) {
    const Eigen::Vector3d d = sight.point_m - longer.c_m;
    const Eigen::Vector2d expected(d.dot(longer.h_px) / d.dot(longer.a),
                                   d.dot(longer.v_px) / d.dot(longer.a));
    const Eigen::Vector2d pixel = pixelOf(camera, camera_from_reference * sight.point_m);
    EXPECT_LT((pixel - expected).norm(), 1e-9);
  }
}

/// Two cameras give the same pixels over the image of the first.
void expectSamePixels(const Camera& expected_camera, const Camera& camera) {
  Random random = randomFor("CahvSamePixels");
  ASSERT_EQ(pupilMoves(expected_camera), false);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2d at = randomPixel(expected_camera, random);
    const Ray ray = rayOf(expected_camera, at);
    Eigen::Vector2d pixel, expected;
    Eigen::Matrix<double, 2, 3> jacobian, expected_jacobian;
    const Eigen::Vector3d point = ray.at(random.uniform(0.1, 2.0));
    ASSERT_TRUE(projectWithJacobian(expected_camera, point, expected, expected_jacobian));
    ASSERT_TRUE(projectWithJacobian(camera, point, pixel, jacobian));
    EXPECT_LT((pixel - expected).norm(), 1e-9) << at.transpose();
    EXPECT_LT((jacobian - expected_jacobian).norm(), 1e-9 * expected_jacobian.norm());
  }
}

Camera changed(Camera camera, CameraModel model) {
  camera.model = model;
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

TEST(Cahvor, WithoutRadialTermsIsCahv) {
  Camera camera = planetaryCamera("Wide");
  camera.cahv.radial.setZero();
  expectSamePixels(changed(camera, CameraModel::kCahv), changed(camera, CameraModel::kCahvor));
}

/// k1 = r1 / (1 + r0), k2 = r2 / (1 + r0), and focal lengths times 1 + r0, when O is A.
TEST(Cahvor, AxisAlongZ_EqualsBrownsRadialModel) {
  Camera camera = planetaryCamera("Wide");
  camera.cahv.optical_axis = Eigen::Vector3d::UnitZ();
  camera.cahv.skew_px = 0.0;
  const Eigen::Vector3d r = camera.cahv.radial;
  Camera brown = camera;
  brown.cahv = CahvLens();
  brown.distortion = {r[1] / (1.0 + r[0]), r[2] / (1.0 + r[0])};
  brown.fx *= 1.0 + r[0];
  brown.fy *= 1.0 + r[0];
  expectSamePixels(changed(brown, CameraModel::kBrownConrady),
                   changed(camera, CameraModel::kCahvor));
}

TEST(Cahvore, FixedPupilPerspective_EqualsCahvor) {
  Camera camera = planetaryCamera("Wide");
  expectSamePixels(changed(camera, CameraModel::kCahvor), changed(camera, CameraModel::kCahvore));
}

/// theta (1 + r1 theta^2 + r2 theta^4): k1 = r1, k2 = r2.
TEST(Cahvore, FixedPupilFisheye_EqualsKannalaBrandt) {
  Camera camera = planetaryCamera("Fisheye");
  camera.cahv.optical_axis = Eigen::Vector3d::UnitZ();
  camera.cahv.entrance_m.setZero();
  camera.cahv.radial[0] = 0.0;
  camera.cahv.skew_px = 0.0;
  Camera fisheye = camera;
  fisheye.cahv = CahvLens();
  fisheye.distortion = {camera.cahv.radial[1], camera.cahv.radial[2]};
  expectSamePixels(changed(fisheye, CameraModel::kKannalaBrandt),
                   changed(camera, CameraModel::kCahvore));
}

TEST(Cahvore, LinearityIsContinuousAtTheFisheye) {
  Camera camera = planetaryCamera("Hazard");
  Camera zero = camera;
  camera.cahv.linearity = 1e-9;
  zero.cahv.linearity = 0.0;
  const Eigen::Vector2d pixel = pixelOf(changed(camera, CameraModel::kCahvore), {0.3, 0.4, 0.5});
  EXPECT_LT((pixel - pixelOf(changed(zero, CameraModel::kCahvore), {0.3, 0.4, 0.5})).norm(), 1e-5);
}

/// 1 + 3 r1 tau + 5 r2 tau^2 = 0.
TEST(Cahvor, ValidFieldEndsWhereTheRadiusStopsIncreasing) {
  Camera camera = planetaryCamera("Wide");
  camera.cahv.optical_axis = Eigen::Vector3d::UnitZ();
  camera.cahv.radial = {0.0, -0.3, 0.0};
  camera = changed(camera, CameraModel::kCahvor);
  EXPECT_NEAR(camera.valid_radius, 1.0 / std::sqrt(0.9), 1e-12);
  Eigen::Vector2d pixel = pixelOf(camera, {camera.valid_radius * 0.9999, 0.0, 1.0});
  EXPECT_FALSE(project(camera, {camera.valid_radius * 1.0001, 0.0, 1.0}, pixel));
}

TEST(Cahvore, ValidFieldEndsWhereTheGeneralModelDoes) {
  Camera camera = planetaryCamera("NegativeLinearity");
  camera.cahv.entrance_m.setZero();
  camera.cahv.radial.setZero();
  camera.cahv.optical_axis = Eigen::Vector3d::UnitZ();
  camera.cahv.linearity = -1.25;  // theta |L| reaches 90 deg at 72 deg
  camera = changed(camera, CameraModel::kCahvore);
  EXPECT_NEAR(camera.valid_radius, 72.0 * kDegree_rad, 1e-7);
  Eigen::Vector2d pixel = pixelOf(camera, {std::tan(71.9 * kDegree_rad), 0.0, 1.0});
  EXPECT_FALSE(project(camera, {std::tan(72.1 * kDegree_rad), 0.0, 1.0}, pixel));
}

/// So near to a deep pupil that rays cross, a point has no one pixel.
TEST(Cahvore, RefusesPointsWhereRaysCross) {
  const Camera camera = planetaryCamera("HazardDeepPupil");
  Eigen::Vector2d pixel;
  for (const double distance_m : {1e-4, 1e-6, 1e-30})
    EXPECT_FALSE(project(camera, Eigen::Vector3d(1.0, 0.5, 0.7) * distance_m, pixel));
  EXPECT_TRUE(project(camera, Eigen::Vector3d(1.0, 0.5, 0.7) * 0.1, pixel));
}

TEST(CameraFromCahv, RefusesInvalidVectors) {
  const PlanetaryCamera good = planetaryCameras().back();
  const auto status = [&good](auto&& change) {
    CahvModel cahv = good.cahv;
    change(cahv);
    Camera camera;
    Pose pose;
    return cameraFromCahv(cahv, good.width, good.height, camera, pose);
  };
  EXPECT_EQ(status([](CahvModel&) {}), Status::kOk);
  const auto refused = [&status](auto&& change) {
    EXPECT_EQ(status(change), Status::kInvalidCamera);
  };
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (const auto member : {&CahvModel::c_m, &CahvModel::a, &CahvModel::h_px, &CahvModel::v_px,
                              &CahvModel::o, &CahvModel::r, &CahvModel::e_m})
      refused([=](CahvModel& c) { (c.*member)[1] = bad; });
    refused([bad](CahvModel& c) { c.parameter = bad; });
  }
  refused([](CahvModel& c) { c.a *= 1.01; });
  refused([](CahvModel& c) { c.o *= 0.99; });
  refused([](CahvModel& c) { c.o = -c.o; });
  refused([](CahvModel& c) { c.h_px = 500.0 * c.a; });
  refused([](CahvModel& c) { c.v_px = c.h_px; });
  refused([](CahvModel& c) { c.r[0] = -1.0; });
  refused([](CahvModel& c) { c.type = 0; });
  refused([](CahvModel& c) { c.type = 4; });
  refused([](CahvModel& c) { c.model = CameraModel::kPinhole; });
}

}  // namespace
}  // namespace boresight::test
