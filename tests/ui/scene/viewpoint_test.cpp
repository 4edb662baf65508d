// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/viewpoint.h"

#include <gtest/gtest.h>

#include "tests/support/box_mesh.h"
#include "tests/support/random_pose.h"

namespace boresight::ui {
namespace {

const QSizeF kViewport(640.0, 480.0);

const Eigen::Vector3d kHalf_m(0.2, 0.1, 0.06);

BoundingBox someBox() {
  const Eigen::Vector3d centre_m(0.1, 0.15, 0.04);
  BoundingBox box;
  box.minimum_m = centre_m - kHalf_m;
  box.maximum_m = centre_m + kHalf_m;
  return box;
}

OrbitCamera framed() {
  OrbitCamera orbit;
  orbit.frame(someBox());
  return orbit;
}

QPointF place(const Viewpoint& view, const Eigen::Vector3d& at_m) {
  return view.toCanvas(at_m).value();
}

TEST(OrbitCamera, KeepsTheStationUprightHoweverItIsTurned) {
  Random random = test::randomFor("KeepsTheStationUpright");
  OrbitCamera orbit = framed();
  for (int i = 0; i < 100; ++i) {
    orbit.orbit({random.uniform(-300, 300), random.uniform(-300, 300)}, kViewport.height());
    const Viewpoint view = orbit.viewpoint(kViewport);
    const QPointF base = place(view, orbit.target_m());
    const QPointF above = place(view, orbit.target_m() + Eigen::Vector3d(0, 0, 0.05));
    EXPECT_NEAR(above.x(), base.x(), 1e-6);
    EXPECT_LE(above.y(), base.y() + 1e-6);
    EXPECT_NEAR(view.view_from_station.rotation.norm(), 1.0, 1e-12);
  }
}

TEST(OrbitCamera, RollTurnsThePictureAboutItsMiddle) {
  OrbitCamera orbit = framed();
  const QPointF middle = place(orbit.viewpoint(kViewport), orbit.target_m());
  const auto above = [&] {
    const Eigen::Vector3d above_m = orbit.target_m() + Eigen::Vector3d(0, 0, 0.05);
    return place(orbit.viewpoint(kViewport), above_m) - middle;
  };
  const QPointF before = above();
  orbit.roll(1.5707963267948966);
  EXPECT_LT((place(orbit.viewpoint(kViewport), orbit.target_m()) - middle).manhattanLength(), 1e-6);
  EXPECT_NEAR(above().x(), -before.y(), 1e-6) << "clockwise";
  EXPECT_NEAR(above().y(), before.x(), 1e-6);
  orbit.lookFrom(StandardView::kFront);
  EXPECT_EQ(orbit.roll_rad(), 0.0);
}

TEST(OrbitCamera, FramesTheWholeBoxFromEverywhere) {
  Random random = test::randomFor("FramesTheWholeBox");
  for (const QSizeF canvas : {QSizeF(640, 480), QSizeF(200, 600)}) {
    OrbitCamera orbit = framed();
    for (int i = 0; i < 50; ++i) {
      orbit.orbit({random.uniform(-300, 300), random.uniform(-300, 300)}, canvas.height());
      const Viewpoint view = orbit.viewpoint(canvas);
      for (int corner = 0; corner < 8; ++corner) {
        const QPointF at = place(view, someBox().centre() + test::boxCorner(kHalf_m, corner));
        EXPECT_TRUE(QRectF(QPointF(0, 0), canvas).contains(at)) << at.x() << ' ' << at.y();
      }
    }
  }
}

TEST(OrbitCamera, LooksAlongTheAxesThatTheViewsName) {
  OrbitCamera orbit = framed();
  const std::pair<StandardView, Eigen::Vector3d> directions[] = {
      {StandardView::kTop, {0, 0, -1}},  {StandardView::kBottom, {0, 0, 1}},
      {StandardView::kFront, {0, 1, 0}}, {StandardView::kBack, {0, -1, 0}},
      {StandardView::kLeft, {1, 0, 0}},  {StandardView::kRight, {-1, 0, 0}},
  };
  for (const auto& [view, forward] : directions) {
    orbit.lookFrom(view);
    const Eigen::Quaterniond turn = orbit.viewpoint(kViewport).view_from_station.rotation;
    EXPECT_TRUE((turn.conjugate() * Eigen::Vector3d::UnitZ()).isApprox(forward, 1e-9));
  }
}

TEST(OrbitCamera, PansSoThatTheTargetFollowsTheMouse) {
  OrbitCamera orbit = framed();
  const Eigen::Vector3d before_m = orbit.target_m();
  const QPointF was = place(orbit.viewpoint(kViewport), before_m);
  orbit.pan({37.0, -21.0}, kViewport.height());
  const QPointF is = place(orbit.viewpoint(kViewport), before_m);
  EXPECT_NEAR(is.x() - was.x(), 37.0, 1e-6);
  EXPECT_NEAR(is.y() - was.y(), -21.0, 1e-6);
}

TEST(Viewpoint, SendsRaysThroughWhatItProjects) {
  Random random = test::randomFor("SendsRays");
  OrbitCamera orbit = framed();
  orbit.orbit({100.0, 40.0}, kViewport.height());
  const Viewpoint view = orbit.viewpoint(kViewport);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d at_m = someBox().centre() + test::randomVector(random, 0.1);
    const double depth_m = (view.view_from_station * at_m).z();
    const Eigen::Vector3d ray = view.rayInStation(place(view, at_m));
    EXPECT_LT((view.eyeInStation_m() + depth_m * ray - at_m).norm(), 1e-12);
  }
}

TEST(ThroughCamera, PutsEveryPointWhereTheImageHasIt) {
  Random random = test::randomFor("ThroughCamera");
  Camera camera = test::randomCamera(random, CameraModel::kPinhole);  // principal point off centre
  const Pose pose = test::randomCameraFromStation(random, 0.5);
  ViewTransform image;
  image.fit(QSizeF(camera.width, camera.height), kViewport);
  image.zoomAt({100.0, 60.0}, 1.7 * image.scale());
  const Viewpoint view = throughCamera(camera, pose, image, kViewport);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d at_m = test::randomVector(random, 0.05);
    Eigen::Vector2d pixel;
    ASSERT_TRUE(project(camera, pose * at_m, pixel));
    const QPointF expected = image.toWidget(QPointF(pixel.x(), pixel.y())) - QPointF(0.5, 0.5);
    const QPointF at = place(view, at_m);
    EXPECT_NEAR(at.x(), expected.x(), 1e-9);
    EXPECT_NEAR(at.y(), expected.y(), 1e-9);
  }
}

}  // namespace
}  // namespace boresight::ui
