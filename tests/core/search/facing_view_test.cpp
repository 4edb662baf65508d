// SPDX-License-Identifier: Apache-2.0
#include "core/search/facing_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random_pose.h"

namespace boresight {
namespace {

constexpr int kWidth = 400;
constexpr int kHeight = 300;

/// Two faces of a square plate 0.3 m in front of the camera, its vertices in the given order.
struct Plate {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Face> faces;
  std::vector<std::uint16_t> part_of_face = {0, 0};
  std::vector<ScenePart> parts = std::vector<ScenePart>(1);

  explicit Plate(const std::array<int, 4>& order) : vertices(4) {
    const Eigen::Vector2f corner[] = {
        {-0.05F, -0.04F}, {0.05F, -0.04F}, {0.05F, 0.04F}, {-0.05F, 0.04F}};
    for (std::size_t i = 0; i < 4; ++i)
      vertices[static_cast<std::size_t>(order[i])] << corner[i], 0.3F;
    faces = {{{order[0], order[1], order[2]}}, {{order[0], order[2], order[3]}}};
  }
};

/// A ramp of 1.5 per px where the plate is shown: the mean of an area is the value in its middle.
double rampAt(double px) { return std::clamp(1.5 * (px - 190.0), 0.0, 255.0); }

/// Along x, or along y, where the middle of the image is elsewhere.
double rampAt(double x, double y, bool down) { return rampAt(down ? y + 50.0 : x); }

struct View {
  Plate plate;
  std::vector<std::uint8_t> gray = std::vector<std::uint8_t>(kWidth * kHeight);
  SearchProblem problem;
  FacingView view;

  explicit View(const std::array<int, 4>& order, double away_m = 0.0, bool down = false,
                double span_px = 120.0)
      : plate(order) {
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        gray[static_cast<std::size_t>(y * kWidth + x)] =
            static_cast<std::uint8_t>(rampAt(x, y, down) + 0.5);
    problem.image = {gray.data(), kWidth, kHeight, kWidth};
    problem.camera = test::makeCamera(CameraModel::kBrownConrady, kWidth, kHeight, 500.0, {-0.2});
    problem.mesh = {plate.vertices, plate.faces, plate.part_of_face, plate.parts};
    problem.scene = matchedBounds(problem.mesh);
    problem.camera_from_station_seed.translation_m.x() = away_m;
    const ViewSize size{.span_px = span_px, .margin_px = 12.0, .most_px = 300};
    EXPECT_TRUE(faceScene(problem, problem.camera_from_station_seed, size, view));
  }
  View(const View&) = delete;
  View& operator=(const View&) = delete;
};

TEST(FacingView, RowsShowTheImageWhereEachPixelProjects) {
  for (const auto& [down, span_px] :
       {std::pair{false, 120.0}, {true, 120.0}, {false, 60.0}, {true, 60.0}, {true, 30.0}}) {
    const View shown({0, 1, 2, 3}, 0.05, down, span_px);
    std::vector<std::uint8_t> value(300 * 300);
    std::vector<std::uint8_t> seen(300 * 300);
    SmallImage output;
    output.value = value;
    output.seen = seen;
    const Camera& camera = shown.view.camera;
    fillViewRows(shown.problem, shown.view, 0, camera.height, output);
    const Eigen::Matrix3d camera_from_view = shown.view.view_from_camera.matrix().transpose();
    int compared = 0;
    for (int y = 0; y < output.height; ++y)
      for (int x = 0; x < output.width; ++x) {
        const Eigen::Vector3d ray =
            camera_from_view *
            Eigen::Vector3d((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
        Eigen::Vector2d pixel;
        const auto at = static_cast<std::size_t>(y * output.width + x);
        if (seen[at] == 0 || !projectDirection(shown.problem.camera, ray, pixel)) continue;
        const double expected = rampAt(pixel.x(), pixel.y(), down);
        if (expected < 8.0 || expected > 247.0) continue;
        EXPECT_NEAR(value[at] + 0.5, expected, 1.1) << x << " " << y;
        ++compared;
      }
    EXPECT_GT(compared, 0.3 * span_px * span_px) << down << ' ' << span_px;
  }
}

TEST(FacingView, OrderOfTheVerticesDoesNotMatter) {
  const View expected({0, 1, 2, 3});
  std::array<int, 4> order = {0, 1, 2, 3};
  do {
    const View view(order);
    EXPECT_EQ(view.view.camera.width, expected.view.camera.width);
    EXPECT_EQ(view.view.camera.height, expected.view.camera.height);
    EXPECT_EQ(view.view.camera.fx, expected.view.camera.fx);
  } while (std::next_permutation(order.begin(), order.end()));
}

}  // namespace
}  // namespace boresight
