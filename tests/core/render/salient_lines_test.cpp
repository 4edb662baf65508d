// SPDX-License-Identifier: Apache-2.0
// Position of the lines of salient edges: thin, unbiased, with the sub-pixel place recorded.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "tests/core/render/scenes.h"

namespace boresight::testing {
namespace {

/// The image of a straight line in space, through the camera's full model.
class ProjectedLine {
 public:
  /// The line begin + s * direction, s in [s_first, s_last], camera frame.
  ProjectedLine(const Camera& camera, const Eigen::Vector3d& begin,
                const Eigen::Vector3d& direction, double s_first, double s_last) {
    constexpr int kSamples = 2500;
    for (int i = 0; i <= kSamples; ++i) {
      const double s = s_first + (s_last - s_first) * i / kSamples;
      Eigen::Vector2d pixel;
      if (project(camera, begin + s * direction, pixel)) points_.push_back(pixel);
    }
  }

  /// Signed distance in px; positive on the right of the direction of travel (image axes, y down).
  /// `normal` points to that side.
  double signedDistance(const Eigen::Vector2d& pixel, Eigen::Vector2d& normal) const {
    // The nearest of every 50th point, then of the pieces around it.
    constexpr std::size_t kStride = 50;
    double best = 1e300;
    std::size_t near = 0;
    for (std::size_t i = 0; i < points_.size(); i += kStride)
      if ((points_[i] - pixel).norm() < best) {
        best = (points_[i] - pixel).norm();
        near = i;
      }
    best = 1e300;
    double signed_distance = 0.0;
    for (std::size_t i = near < 2 * kStride ? 0 : near - 2 * kStride;
         i + 1 < std::min(points_.size(), near + 2 * kStride); ++i) {
      const Eigen::Vector2d& a = points_[i];
      const Eigen::Vector2d along = points_[i + 1] - a;
      const double length = along.norm();
      if (!(length > 0.0)) continue;
      const double t = std::clamp((pixel - a).dot(along) / (length * length), 0.0, 1.0);
      const Eigen::Vector2d away = pixel - a - t * along;
      if (away.norm() >= best) continue;
      best = away.norm();
      normal = Eigen::Vector2d(-along.y(), along.x()) / length;
      signed_distance = away.dot(normal);
    }
    return signed_distance;
  }

 private:
  std::vector<Eigen::Vector2d> points_;
};

/// Statistics of a render's edge pixels along one line.
struct LineStatistics {
  int pixels = 0;
  double mean_px = 0.0;          ///< signed distance of centres to the line
  double largest_px = 0.0;       ///< its largest magnitude
  double largest_excess_px = 0;  ///< |distance| - 0.5 max(|cos|, |sin|), the largest
  double offset_error_px = 0.0;  ///< recorded against true distance along the recorded normal
  double normal_error = 0.0;     ///< recorded against true normal, up to sign
  int doubled = 0;               ///< rows (steep lines) or columns with more than one pixel
  int missing = 0;               ///< rows or columns between the first and the last with none
};

/// Edge pixels at least `margin_px` within the image against a line that crosses it.
LineStatistics lineStatistics(const EdgeRender& render, const ProjectedLine& line, int margin_px) {
  LineStatistics statistics;
  std::map<int, int> rows;
  std::map<int, int> columns;
  double steepness = 0.0;
  for (const EdgePixel& pixel : pixelsOf(render)) {
    if (pixel.x < margin_px || pixel.y < margin_px || pixel.x >= render.camera.width - margin_px ||
        pixel.y >= render.camera.height - margin_px)
      continue;
    Eigen::Vector2d normal;
    const double distance = line.signedDistance(Eigen::Vector2d(pixel.x, pixel.y), normal);
    const Eigen::Vector2d recorded = Eigen::Vector2d(pixel.normal_x, pixel.normal_y).normalized();
    const double sign = recorded.dot(normal) < 0.0 ? -1.0 : 1.0;
    ++statistics.pixels;
    ++rows[pixel.y];
    ++columns[pixel.x];
    steepness += std::abs(normal.x()) - std::abs(normal.y());
    statistics.mean_px += distance;
    statistics.largest_px = std::max(statistics.largest_px, std::abs(distance));
    statistics.largest_excess_px =
        std::max(statistics.largest_excess_px,
                 std::abs(distance) - 0.5 * std::max(std::abs(normal.x()), std::abs(normal.y())));
    // The line lies at -distance along `normal` from the pixel's centre.
    statistics.offset_error_px =
        std::max(statistics.offset_error_px, std::abs(pixel.offset / 100.0 + sign * distance));
    statistics.normal_error = std::max(statistics.normal_error, (recorded - sign * normal).norm());
  }
  if (statistics.pixels == 0) return statistics;
  statistics.mean_px /= statistics.pixels;
  const std::map<int, int>& lanes = steepness > 0.0 ? rows : columns;
  for (const auto& [lane, count] : lanes) statistics.doubled += count > 1 ? 1 : 0;
  const int lane_count = lanes.rbegin()->first - lanes.begin()->first + 1;
  statistics.missing = lane_count - static_cast<int>(lanes.size());
  return statistics;
}

/// A straight line in space that crosses the image near its centre at an angle.
struct LineInSpace {
  Eigen::Vector3d begin, along, across;
  LineInSpace(double angle, double shift_m, double tilt)
      : begin(0, 0, 0.5),
        along(std::cos(angle), std::sin(angle), tilt),
        across(-std::sin(angle), std::cos(angle), 0.0) {
    begin += shift_m * across;
    along.normalize();
  }
  ProjectedLine projected(const Camera& camera) const {
    return ProjectedLine(camera, begin, along, -1.0, 1.0);
  }
};

enum class LineKind { kBorder, kOccluding, kCrease, kIntersection };

SceneMesh sceneOf(LineKind kind, const LineInSpace& line) {
  SceneMesh mesh;
  const Eigen::Vector3d a = line.begin - 3.0 * line.along;
  const Eigen::Vector3d b = line.begin + 3.0 * line.along;
  // A wide plate that ends at the line.
  const auto addHalfPlane = [&](const Eigen::Vector3d& away) {
    mesh.addQuad(a, b, b + 3.0 * away, a + 3.0 * away);
  };
  if (kind == LineKind::kBorder || kind == LineKind::kOccluding)
    addHalfPlane(-line.across + Eigen::Vector3d(0, 0, 0.1));
  if (kind == LineKind::kOccluding)
    mesh.addQuad({-3, -3, 0.7}, {3, -3, 0.7}, {3, 3, 0.7}, {-3, 3, 0.7});
  if (kind == LineKind::kCrease) {
    addHalfPlane(-line.across + Eigen::Vector3d(0, 0, 0.4));
    const Eigen::Vector3d away = 3.0 * (line.across + Eigen::Vector3d(0, 0, 0.5));
    const std::int32_t c = mesh.addVertex(b + away);
    const std::int32_t d = mesh.addVertex(a + away);
    mesh.addFace(1, 0, d);
    mesh.addFace(1, d, c);
  }
  if (kind == LineKind::kIntersection) {
    for (const double slope : {0.5, -0.4}) {
      const Eigen::Vector3d away = 0.9 * (line.across + Eigen::Vector3d(0, 0, slope));
      mesh.addQuad(a - away, b - away, b + away, a + away);
    }
  }
  return mesh;
}

class SalientLines : public ::testing::TestWithParam<LineKind> {};

TEST_P(SalientLines, ThinAndUnbiasedInEveryOrientation) {
  const Camera camera = pinholeCamera(200, 180, 220.0);
  double sum_of_means = 0.0;
  for (int i = 0; i < 36; ++i) {
    // Along the axes the distance is the same all along the line: lines at several places are one
    // sample.
    double mean = 0.0;
    for (int shift = 0; shift < 8; ++shift) {
      const LineInSpace line(2.0 * M_PI * i / 36.0, (0.013 + shift / 8.0) * 0.5 / 220.0, 0.1);
      const Rendered rendered = render(sceneOf(GetParam(), line), camera, Pose());
      const LineStatistics found = lineStatistics(rendered.edges, line.projected(camera), 2);
      EXPECT_GT(found.pixels, 100) << i;
      EXPECT_EQ(found.doubled, 0) << i;
      EXPECT_EQ(found.missing, 0) << i;
      EXPECT_LE(found.largest_excess_px, 1e-3) << i;
      EXPECT_LT(found.offset_error_px, 0.01) << i;
      EXPECT_LT(found.normal_error, 0.01) << i;
      mean += found.mean_px / 8.0;
    }
    EXPECT_LT(std::abs(mean), 0.05) << i;
    sum_of_means += mean;
  }
  EXPECT_LT(std::abs(sum_of_means) / 36.0, 0.005);
}

TEST_P(SalientLines, OnTheExactProjectionDespiteDistortion) {
  for (const Camera& camera :
       {brownCamera(400, 320, 380.0, -0.28), brownCamera(400, 320, 420.0, 0.2),
        fisheyeCamera(400, 320, 260.0), skewMirroredCamera(400, 320, 380.0),
        pupilCamera(400, 320, 260.0, 0.0)}) {
    for (int i = 0; i < 12; ++i) {
      const LineInSpace line(2.0 * M_PI * i / 12.0 + 0.1, 0.05 * (i % 4), 0.1);
      const Rendered rendered = render(sceneOf(GetParam(), line), camera, Pose());
      const LineStatistics found = lineStatistics(rendered.edges, line.projected(camera), 2);
      EXPECT_GT(found.pixels, 150) << i;
      EXPECT_EQ(found.missing, 0) << i;
      EXPECT_LT(std::abs(found.mean_px), 0.1) << i;
      EXPECT_LE(found.largest_px, 0.5 + 1e-3) << i;
      EXPECT_LT(found.offset_error_px, 0.015) << i;
      EXPECT_LT(found.normal_error, 0.015) << i;
    }
  }
}

/// The edges of a box of this half size, seen 0.5 m off and 30 deg off the axis: the largest
/// distance of a recorded line from the exact projection of the nearest edge, and of a pixel's
/// centre from it beyond half a pixel.
struct BoxErrors {
  int pixels = 0;
  double line_px = 0.0;
  double beyond_half_px = 0.0;
};
BoxErrors boxErrors(const Camera& camera, double half_m) {
  const Pose placed = poseOf({0.4, 0.3, 0.2}, {0.25, 0.08, 0.43});
  SceneMesh mesh;
  mesh.addBox(Eigen::Vector3d::Zero(), Eigen::Vector3d(half_m, 0.8 * half_m, 0.5 * half_m), placed);
  const Rendered rendered = render(mesh, camera, Pose());
  std::vector<ProjectedLine> lines;
  for (const Face& face : mesh.faces) {
    const Corners corner = mesh.corners(face);
    for (std::size_t i = 0; i < 3; ++i)
      lines.emplace_back(camera, corner[i], corner[(i + 1) % 3] - corner[i], 0.0, 1.0);
  }
  BoxErrors errors;
  errors.pixels = rendered.edges.pixel_count;
  for (const EdgePixel& pixel : pixelsOf(rendered.edges)) {
    Eigen::Vector2d position;
    Eigen::Vector3d point;
    EXPECT_TRUE(edgeLinePoint(rendered.edges, mesh.view(), pixel, position, point));
    double line_px = 1e9;
    double centre_px = 1e9;
    Eigen::Vector2d normal;
    for (const ProjectedLine& line : lines) {
      line_px = std::min(line_px, std::abs(line.signedDistance(position, normal)));
      centre_px = std::min(
          centre_px, std::abs(line.signedDistance(Eigen::Vector2d(pixel.x, pixel.y), normal)));
    }
    errors.line_px = std::max(errors.line_px, line_px);
    errors.beyond_half_px = std::max(errors.beyond_half_px, centre_px - 0.5);
  }
  return errors;
}

/// Where the entrance pupil moves, recorded places are within 0.05 px of the exact projection, of
/// faces that span up to 0.8 rad, too; which pixel is marked depends on their size, by the bend of
/// the pupil's place over a face.
TEST(SalientLines, OnTheExactProjectionDespiteAMovingPupil) {
  struct {
    double focal_px, entrance_m, half_m, most_beyond_px;
  } const cases[] = {{260.0, 0.002, 0.1, 0.02},   // a hazard camera of 1 Mpx at half size
                     {260.0, 0.026, 0.03, 0.02},  // the deepest pupil that is flown
                     {1040.0, 0.002, 0.03, 0.02}, {1040.0, 0.026, 0.03, 0.02},
                     {1040.0, 0.026, 0.1, 0.12},  {1040.0, 0.026, 0.2, 0.8}};
  for (const auto& at : cases) {
    const int width = static_cast<int>(1.6 * at.focal_px);
    const BoxErrors errors =
        boxErrors(pupilCamera(width, width, at.focal_px, at.entrance_m), at.half_m);
    std::printf("focal %.0f px, e0 %.0f mm, box %.0f mm: lines %.4f px, pixels %.4f px\n",
                at.focal_px, 1e3 * at.entrance_m, 2e3 * at.half_m, errors.line_px,
                errors.beyond_half_px);
    EXPECT_GT(errors.pixels, 50);
    EXPECT_LT(errors.line_px, 0.05);
    EXPECT_LT(errors.beyond_half_px, at.most_beyond_px);
  }
}

TEST_P(SalientLines, EveryPixelHasTheKindAndPointOfTheNearerSurface) {
  const Camera camera = brownCamera(200, 180, 220.0, -0.15);
  const Pose pose = poseOf(Eigen::Vector3d(0.2, -0.1, 0.3), Eigen::Vector3d(0.01, 0.02, -0.03));
  for (int i = 0; i < 9; ++i) {
    const LineInSpace line(2.0 * M_PI * i / 9.0, 0.01, 0.2);
    SceneMesh mesh = sceneOf(GetParam(), line);
    for (Eigen::Vector3f& vertex : mesh.vertices)
      vertex = (pose.inverse() * Eigen::Vector3d(vertex.cast<double>())).cast<float>();
    const Rendered rendered = render(mesh, camera, pose);
    ASSERT_GT(rendered.edges.pixel_count, 100);
    for (const EdgePixel& pixel : pixelsOf(rendered.edges)) {
      const int expected_kind = GetParam() == LineKind::kBorder      ? kEdgeOccluding | kEdgeBorder
                                : GetParam() == LineKind::kOccluding ? kEdgeOccluding
                                                                     : kEdgeCrease;
      EXPECT_EQ(pixel.kind & expected_kind, expected_kind);
      if (GetParam() == LineKind::kBorder || GetParam() == LineKind::kOccluding) {
        EXPECT_LT(pixel.face, 2);
        // From the plate to the other side.
        EXPECT_GT(pixel.normal_x * line.across.x() + pixel.normal_y * line.across.y(), 0.0);
      }
      // The recorded depth lies on the plane of the recorded face ...
      Eigen::Vector3d point;
      ASSERT_TRUE(edgePointInStation(rendered.edges, pixel, point));
      const auto [a, b, c] = mesh.corners(mesh.faces[static_cast<std::size_t>(pixel.face)]);
      const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
      EXPECT_NEAR(normal.dot(point - a), 0.0, 3e-7);
      // ... and the line's own place on the line in space.
      Eigen::Vector2d position;
      ASSERT_TRUE(edgeLinePoint(rendered.edges, mesh.view(), pixel, position, point));
      const Eigen::Vector3d from_line = pose * point - line.begin;
      EXPECT_LT((from_line - line.along * line.along.dot(from_line)).norm(), 6e-5);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, SalientLines,
                         ::testing::Values(LineKind::kBorder, LineKind::kOccluding,
                                           LineKind::kCrease, LineKind::kIntersection));

}  // namespace
}  // namespace boresight::testing
