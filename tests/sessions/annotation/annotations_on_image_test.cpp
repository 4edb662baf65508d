// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/annotations_on_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sessions/annotation/annotated_scene.h"

namespace boresight::sessions {
namespace {

using test::AnnotatedScene;
using test::randomFor;
using test::randomScene;

constexpr CameraModel kModels[] = {CameraModel::kPinhole, CameraModel::kBrownConrady,
                                   CameraModel::kKannalaBrandt, CameraModel::kCahvor,
                                   CameraModel::kCahvore};

/// Least distance from a pixel to an edge's image, by looking at many places of a longer edge: at
/// first far apart, then about the nearest.
double distanceToEdge(const Camera& camera, const Pose& pose, const ModelEdge& edge,
                      const Eigen::Vector2d& pixel, Eigen::Vector2d& nearest) {
  double least = 1e9, about = 0.5, half = 1.5;
  for (int round = 0; round < 3; ++round, half /= 100.0) {
    const double middle = about;
    for (int i = -200; i <= 200; ++i) {
      const double share = middle + half * i / 200.0;
      const Eigen::Vector3d point_m =
          (1.0 - share) * edge.start_in_station_m + share * edge.end_in_station_m;
      Eigen::Vector2d seen;
      if (!project(camera, pose * point_m, seen) || (seen - pixel).norm() >= least) continue;
      least = (seen - pixel).norm();
      nearest = seen;
      about = share;
    }
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

class AnnotationsOnImageTest : public testing::TestWithParam<CameraModel> {};

TEST_P(AnnotationsOnImageTest, ResidualVector_PointsFromProjectionToAnnotation) {
  Random random = test::randomFor("MarksOnImage");
  AnnotatedView view;
  view.camera = test::annotatedCamera(GetParam());
  const Pose truth{rotationExp({0.2, -0.1, 0.3}), {0.02, -0.01, 0.8}};
  ASSERT_TRUE(test::addPoint(view, truth, {0.1, 0.05, 0.02}, 0.0, 1.0, random));
  ASSERT_TRUE(
      test::addLine(view, truth, {-0.15, -0.1, 0.0}, {0.15, -0.05, 0.05}, 0.0, 1.0, random));
  const ModelEdge edge = *view.annotations.lines[0].edge;
  view.annotations.points[0].enabled = false;
  view.annotations.points.push_back({"half", {}, Eigen::Vector2d(1, 2), 1.0, true, false, ""});
  const Pose moved =
      perturbed((Vector6d() << 4e-4, -3e-4, 5e-4, 3e-4, -2e-4, 5e-4).finished(), truth);
  const auto vectors = annotationVectors(view, moved);
  ASSERT_EQ(vectors.size(), 3u) << "a point that is off, and both ends of the line";
  Eigen::Vector2d pixel;
  ASSERT_TRUE(project(view.camera, moved * *view.annotations.points[0].point_in_station_m, pixel));
  EXPECT_LT((vectors[0].predicted - pixel).norm(), 1e-9);
  EXPECT_EQ(vectors[0].seen, *view.annotations.points[0].pixel);
  for (const AnnotationVector& vector : {vectors[1], vectors[2]}) {
    EXPECT_EQ(vector.id, view.annotations.lines[0].id);
    Eigen::Vector2d nearest = Eigen::Vector2d::Zero();
    const double away = distanceToEdge(view.camera, moved, edge, vector.seen, nearest);
    EXPECT_GT(away, 0.05) << "the pose was moved";
    EXPECT_LT((vector.predicted - nearest).norm(), 0.02 * away + 0.002);
  }
}

TEST_P(AnnotationsOnImageTest, Edge_IsDrawnWithLensDistortion) {
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

INSTANTIATE_TEST_SUITE_P(Models, AnnotationsOnImageTest,
                         testing::Values(CameraModel::kPinhole, CameraModel::kBrownConrady,
                                         CameraModel::kKannalaBrandt));

TEST(AnnotationEquations, ResidualsVanishAtTheTruthAndJacobiansAreTheirDifferences) {
  Random random = randomFor("MarkEquations.Jacobian");
  constexpr double kStep = 1e-6;
  for (const CameraModel model : kModels) {
    const AnnotatedScene scene = randomScene(random, model, 10, 10, 0.0);
    for (const AnnotationAddress& at : usedAnnotations(scene.views())) {
      const auto residualAt = [&](const Vector6d& xi) {
        return annotationResidual(scene.view, at, perturbed(xi, scene.camera_from_station));
      };
      const AnnotationResidual annotation =
          annotationResidual(scene.view, at, scene.camera_from_station);
      ASSERT_TRUE(annotation.valid);
      EXPECT_LT(annotation.residual_px.norm(), 1e-6);
      EXPECT_NEAR(annotation.depth_m, 0.5, 0.2);
      for (int i = 0; i < 6; ++i) {
        const Vector6d xi = kStep * Vector6d::Unit(i);
        const Eigen::Vector2d difference =
            (residualAt(-xi).residual_px - residualAt(xi).residual_px) / (2.0 * kStep);
        EXPECT_LT((difference - annotation.predicted_by_xi.col(i)).norm(),
                  1e-5 * (1.0 + difference.norm()));
      }
    }
  }
}

TEST(AnnotationEquations, ALinesResidualIsItsDistanceFromTheProjectedEdge) {
  Random random = randomFor("MarkEquations.Distance");
  for (const CameraModel model : kModels) {
    for (int trial = 0; trial < 20; ++trial) {
      const AnnotatedScene scene = randomScene(random, model, 0, 1, 0.5);
      const LinePair& pair = scene.view.annotations.lines[0];
      const AnnotationResidual annotation =
          annotationResidual(scene.view, {0, AnnotationKind::kLine, 0}, scene.camera_from_station);
      ASSERT_TRUE(annotation.valid);
      const Eigen::Vector2d ends[2] = {pair.line->start, pair.line->end};
      for (int end = 0; end < 2; ++end) {
        Eigen::Vector2d nearest;
        const double away_px = distanceToEdge(scene.view.camera, scene.camera_from_station,
                                              *pair.edge, ends[end], nearest);
        EXPECT_NEAR(std::abs(annotation.residual_px[end]), away_px, 0.01 * away_px + 2e-3);
      }
    }
  }
}

TEST(AnnotationEquations, UnprojectedAnnotation_IsLeftOut) {
  Random random = randomFor("MarkEquations.Missing");
  const AnnotatedScene scene = randomScene(random, CameraModel::kPinhole, 4, 2, 0.0);
  Pose behind = scene.camera_from_station;
  behind.translation_m.z() = -5.0;
  const NormalEquations equations =
      annotationEquations(scene.views(), usedAnnotations(scene.views()), {}, behind);
  EXPECT_EQ(equations.missing, 6);
  EXPECT_EQ(equations.projected, 0);
}

}  // namespace
}  // namespace boresight::sessions
