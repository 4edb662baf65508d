// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/matching_method.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sessions/run/runner.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

constexpr double kDistance_m = 1.0, kHalf_m = 0.1;

/// Two squares of side 0.1 m next to each other in the plane z = 0, facing the camera at z = -1 m.
struct TwoPlates {
  std::vector<Eigen::Vector3f> vertices = {{-0.1F, -0.1F, 0.0F}, {0.0F, -0.1F, 0.0F},
                                           {0.0F, 0.1F, 0.0F},   {-0.1F, 0.1F, 0.0F},
                                           {0.1F, -0.1F, 0.0F},  {0.1F, 0.1F, 0.0F}};
  std::vector<Face> faces = {{{0, 2, 1}}, {{0, 3, 2}}, {{1, 5, 4}}, {{1, 2, 5}}};
  std::vector<std::uint16_t> part_of_face = {0, 0, 1, 1};
  std::vector<ScenePart> parts = std::vector<ScenePart>(2);
  MeshView view() const { return {vertices, faces, part_of_face, parts}; }
};

/// Keeps the first render that it gets at full resolution, and matches nothing.
class Keeper final : public MatchingMethod {
 public:
  void match(const MatchQuery& query, std::vector<SuppliedMatch>&) override {
    if (!kept.empty() || query.iteration.level != 0) return;
    for (int y = 0; y < query.intensity.height; ++y)
      for (int x = 0; x < query.intensity.width; ++x) kept.push_back(query.intensity.at(x, y));
  }
  std::vector<std::uint8_t> kept;
};

std::vector<std::uint8_t> renderOf(const Camera& camera, std::span<const double> albedo_of_part) {
  const TwoPlates plates;
  std::vector<std::uint8_t> gray(static_cast<std::size_t>(camera.width * camera.height));
  for (std::size_t i = 0; i < gray.size(); ++i) gray[i] = i / 37 % 2 == 0 ? 40 : 200;
  LocalizationProblem problem;
  problem.image = {gray.data(), camera.width, camera.height, camera.width};
  problem.camera = camera;
  problem.mesh = plates.view();
  problem.camera_from_station_seed.translation_m = {0.0, 0.0, kDistance_m};
  Keeper keeper;
  RunSettings settings;
  settings.method = &keeper;
  settings.albedo_of_part = albedo_of_part;
  localize(problem, paperProfile(), settings);
  return keeper.kept;
}

TEST(OutsideMatching, RendersFlatPartsByTheirAlbedo) {
  const Camera camera = test::makePinhole(300, 200, 500.0);
  const double albedo[] = {0.1, 0.4};
  const std::vector<std::uint8_t> render = renderOf(camera, albedo);
  ASSERT_EQ(render.size(), 300u * 200u);
  int compared = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const double ray_x = (x - camera.cx) / camera.fx, ray_y = (y - camera.cy) / camera.fy;
      const double edge_px = 1.5 / camera.fx;
      const double outside = std::max(std::abs(ray_x), std::abs(ray_y)) * kDistance_m - kHalf_m;
      if (std::abs(outside) < edge_px || std::abs(ray_x) < edge_px) continue;
      // Lambert with the light at the camera; the brightest part has the whole range.
      const double shade = 30.0 + 225.0 / std::sqrt(1.0 + ray_x * ray_x + ray_y * ray_y);
      const double expected = outside > 0.0 ? 0.0 : shade * (ray_x < 0.0 ? 0.25 : 1.0);
      EXPECT_NEAR(render[static_cast<std::size_t>(y * camera.width + x)], expected, 1.0);
      ++compared;
    }
  }
  EXPECT_GT(compared, 50000);
}

TEST(OutsideMatching, RendersPartsOfOneAlbedoAsThoseWithoutAndABlackPartApartFromTheBackground) {
  const Camera camera = test::makePinhole(300, 200, 500.0);
  const double alike[] = {0.3, 0.3}, black[] = {0.0, 0.4};
  EXPECT_EQ(renderOf(camera, alike), renderOf(camera, {}));
  const std::vector<std::uint8_t> render = renderOf(camera, black);
  ASSERT_EQ(render.size(), 300u * 200u);
  EXPECT_EQ(render[100 * 300 + 125], 1);
  EXPECT_EQ(render[100 * 300 + 50], 0);
}

}  // namespace
}  // namespace boresight::sessions
