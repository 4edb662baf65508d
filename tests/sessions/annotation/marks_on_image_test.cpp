// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/marks_on_image.h"

#include <gtest/gtest.h>

#include "tests/sessions/annotation/marked_scene.h"

namespace boresight::sessions {
namespace {

/// Least distance from a pixel to an edge's image, by looking at many places of a longer edge.
double distanceToEdge(const Camera& camera, const Pose& pose, const ModelEdge& edge,
                      const Eigen::Vector2d& pixel, Eigen::Vector2d& nearest) {
  double least = 1e9;
  for (int i = -20000; i <= 40000; ++i) {
    const double share = i / 20000.0;
    const Eigen::Vector3d point_m =
        (1.0 - share) * edge.start_in_station_m + share * edge.end_in_station_m;
    Eigen::Vector2d seen;
    if (!project(camera, pose * point_m, seen) || (seen - pixel).norm() >= least) continue;
    least = (seen - pixel).norm();
    nearest = seen;
  }
  return least;
}

TEST(IsInImage, EachPixelIsOneWideAboutItsCentre) {
  Camera camera;
  camera.width = 4;
  camera.height = 3;
  for (const Eigen::Vector2d& inside :
       {Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(3.49, 2.49), Eigen::Vector2d(1.0, 2.0)})
    EXPECT_TRUE(isInImage(camera, inside)) << inside.transpose();
  for (const Eigen::Vector2d& outside : {Eigen::Vector2d(-0.51, 1.0), Eigen::Vector2d(1.0, -0.51),
                                         Eigen::Vector2d(3.5, 1.0), Eigen::Vector2d(1.0, 2.5)})
    EXPECT_FALSE(isInImage(camera, outside)) << outside.transpose();
}

class MarksOnImageTest : public testing::TestWithParam<CameraModel> {};

TEST_P(MarksOnImageTest, AVectorLeadsFromWhereThePosePutsTheMarkToWhereItIs) {
  Random random = test::randomFor("MarksOnImage");
  MarkedView view;
  view.camera = test::annotatedCamera(GetParam());
  Pose truth;
  truth.rotation = rotationExp({0.2, -0.1, 0.3});
  truth.translation_m = {0.02, -0.01, 0.8};
  ASSERT_TRUE(test::addPoint(view, truth, {0.1, 0.05, 0.02}, 0.0, 1.0, random));
  ASSERT_TRUE(
      test::addLine(view, truth, {-0.15, -0.1, 0.0}, {0.15, -0.05, 0.05}, 0.0, 1.0, random));
  const ModelEdge edge = *view.marks.lines[0].edge;
  view.marks.points[0].enabled = false;
  PointPair half;
  half.id = "half";
  half.pixel = Eigen::Vector2d(1.0, 2.0);
  view.marks.points.push_back(half);

  const Pose moved =
      perturbed((Vector6d() << 4e-4, -3e-4, 5e-4, 3e-4, -2e-4, 5e-4).finished(), truth);
  const auto vectors = markVectors(view, moved);
  ASSERT_EQ(vectors.size(), 3u) << "a point that is off, and both ends of the line";
  Eigen::Vector2d pixel;
  ASSERT_TRUE(project(view.camera, moved * *view.marks.points[0].point_in_station_m, pixel));
  EXPECT_LT((vectors[0].predicted - pixel).norm(), 1e-9);
  EXPECT_EQ(vectors[0].seen, *view.marks.points[0].pixel);
  for (const MarkVector& vector : {vectors[1], vectors[2]}) {
    EXPECT_EQ(vector.id, view.marks.lines[0].id);
    Eigen::Vector2d nearest = Eigen::Vector2d::Zero();
    const double away = distanceToEdge(view.camera, moved, edge, vector.seen, nearest);
    EXPECT_GT(away, 0.05) << "the pose was moved";
    EXPECT_LT((vector.predicted - nearest).norm(), 0.02 * away + 0.002);
  }
}

TEST_P(MarksOnImageTest, AnEdgeIsDrawnAsTheCameraBendsIt) {
  const Camera camera = test::annotatedCamera(GetParam());
  Pose pose;
  pose.translation_m = {0.0, 0.0, 0.5};
  const ModelEdge edge{{-0.12, -0.1, 0.0}, {0.12, -0.1, 0.0}};
  const auto places = edgeOnImage(camera, pose, edge, 8);
  ASSERT_EQ(places.size(), 9u);
  for (std::size_t i = 0; i < places.size(); ++i) {
    Eigen::Vector2d pixel;
    const double share = static_cast<double>(i) / 8.0;
    ASSERT_TRUE(project(camera, pose * Eigen::Vector3d(-0.12 + 0.24 * share, -0.1, 0.0), pixel));
    EXPECT_LT((places[i] - pixel).norm(), 1e-9);
  }
  const ModelEdge behind{{-0.1, 0.0, -2.0}, {0.1, 0.0, -2.0}};
  EXPECT_TRUE(edgeOnImage(camera, pose, behind, 8).empty());
}

INSTANTIATE_TEST_SUITE_P(Models, MarksOnImageTest,
                         testing::Values(CameraModel::kPinhole, CameraModel::kBrownConrady,
                                         CameraModel::kKannalaBrandt));

}  // namespace
}  // namespace boresight::sessions
