// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/edge_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sessions/trace/scene_render.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

/// A flat polygon with many sides around the origin, in the plane z = 0.
struct Disc {
  explicit Disc(int sides, double radius_m) {
    vertices.emplace_back(0.0F, 0.0F, 0.0F);
    for (int i = 0; i < sides; ++i) {
      const double angle = 6.283185307179586 * i / sides;
      vertices.emplace_back(static_cast<float>(radius_m * std::cos(angle)),
                            static_cast<float>(radius_m * std::sin(angle)), 0.0F);
      faces.push_back({{0, 1 + i, 1 + (i + 1) % sides}});
      part_of_face.push_back(0);
    }
  }
  MeshView view() const { return {vertices, faces, part_of_face, parts}; }

  std::vector<Eigen::Vector3f> vertices;
  std::vector<Face> faces;
  std::vector<std::uint16_t> part_of_face;
  std::vector<ScenePart> parts = std::vector<ScenePart>(1);
};

Pose tilted(double tilt_rad) {
  return {Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d(0.8, 0.6, 0.0)) *
              Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()),
          {0.013, -0.007, 1.0}};
}

double distance(const Eigen::Vector2d& place, const Eigen::Vector2d& from,
                const Eigen::Vector2d& to) {
  const Eigen::Vector2d way = to - from;
  const double share = std::clamp((place - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (place - from - share * way).norm();
}

using Segment = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

/// Where the sides of the disc project.
std::vector<Segment> outline(const Disc& disc, const Camera& camera, const Pose& pose) {
  std::vector<Eigen::Vector2d> corners;
  for (std::size_t i = 1; i < disc.vertices.size(); ++i) {
    Eigen::Vector2d pixel;
    EXPECT_TRUE(project(camera, pose * disc.vertices[i].cast<double>(), pixel));
    corners.push_back(pixel);
  }
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < corners.size(); ++i)
    segments.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
  return segments;
}

std::vector<Segment> segmentsOf(const EdgeLines& lines) {
  std::vector<Segment> segments;
  for (const EdgeLine& line : lines)
    for (std::size_t i = 1; i < line.places_px.size(); ++i)
      segments.emplace_back(line.places_px[i - 1], line.places_px[i]);
  return segments;
}

double distance(const Eigen::Vector2d& place, const std::vector<Segment>& segments) {
  double nearest = 1e9;
  for (const auto& [from, to] : segments) nearest = std::min(nearest, distance(place, from, to));
  return nearest;
}

/// Largest distance of places a quarter of a pixel apart along some segments from others.
double farthest(const std::vector<Segment>& along, const std::vector<Segment>& from) {
  double most = 0.0;
  for (const auto& [start, end] : along) {
    const int steps = std::max(1, static_cast<int>(std::ceil((end - start).norm() / 0.25)));
    for (int i = 0; i <= steps; ++i)
      most = std::max(most, distance(start + (end - start) * i / steps, from));
  }
  return most;
}

/// Discs of several shapes seen from several directions.
TEST(EdgeLines, LieWithinATenthOfAPixelOfTheGeometryAndCoverItWithFewLines) {
  const Camera camera = test::makePinhole(400, 300, 900.0);
  for (const int sides : {4, 5, 12, 90})
    for (const double tilt_rad : {0.0, 0.3, 0.8}) {
      SCOPED_TRACE(std::to_string(sides) + " sides, " + std::to_string(tilt_rad));
      const Disc disc(sides, 0.1);
      const Pose pose = tilted(tilt_rad);
      RenderTrace render;
      ASSERT_EQ(renderScene(camera, disc.view(), pose, render), Status::kOk);
      const EdgeLines lines = edgeLines(render, 0);
      const std::vector<Segment> expected = outline(disc, camera, pose);
      EXPECT_LT(farthest(segmentsOf(lines), expected), 0.1);
      EXPECT_LT(farthest(expected, segmentsOf(lines)), 0.5);
      EXPECT_LE(lines.size(), 4u) << "a pattern of dashes needs long lines";
      for (const EdgeLine& line : lines) {
        ASSERT_GE(line.places_px.size(), 2u);
        for (const Eigen::Vector2d& place : line.places_px)
          EXPECT_TRUE(line.box_px.contains(place));
      }
    }
  EXPECT_TRUE(edgeLines(RenderTrace(), 0).empty());
}

TEST(EdgeLines, OfALevelAreInPixelsOfTheFullImage) {
  const Camera camera = test::makePinhole(400, 300, 900.0);
  const Disc disc(5, 0.1);
  const Pose pose = tilted(0.3);
  RenderTrace render;
  ASSERT_EQ(renderScene(cameraAtLevel(camera, 1), disc.view(), pose, render), Status::kOk);
  EXPECT_LT(farthest(segmentsOf(edgeLines(render, 1)), outline(disc, camera, pose)), 0.2);
}

TEST(EdgeLines, LengthWithin_CountsTheSegmentsOfABox) {
  EdgeLine line;
  line.places_px = {{0.0, 0.0}, {3.0, 4.0}, {3.0, 14.0}, {30.0, 14.0}};
  for (const Eigen::Vector2d& place : line.places_px) line.box_px.extend(place);
  const auto within = [&](double last) {
    return lengthWithin(
        {line}, Eigen::AlignedBox2d(Eigen::Vector2d(-1.0, -1.0), Eigen::Vector2d(last, last)));
  };
  EXPECT_DOUBLE_EQ(within(100.0), 5.0 + 10.0 + 27.0);
  EXPECT_DOUBLE_EQ(within(5.0), 5.0 + 1.0) << "the second segment leaves it, the last is outside";
  EXPECT_DOUBLE_EQ(within(-0.5), 0.0);
}

}  // namespace
}  // namespace boresight::sessions
