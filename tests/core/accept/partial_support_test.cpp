// SPDX-License-Identifier: Apache-2.0
// Objects that are hidden in part.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/accept/edge_support.h"
#include "core/localizer/run_digest.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

constexpr int kDisplacements[4][2] = {{11, 0}, {0, 11}, {-11, 0}, {0, -11}};

struct Supports {
  EdgeSupport whole;
  PartialSupport partial;
};

Supports supportsAt(const Case& scene, const Pose& pose, int level = 0) {
  std::vector<std::byte> memory(std::size_t{8} << 20);
  Arena arena(memory);
  EdgeMap edges;
  EXPECT_EQ(detectEdges(scene.picture->view(), scene.ignore, {}, arena, edges), Status::kOk);
  const Rendering rendering = renderEdges(scene.solid, cameraAtLevel(scene.camera, level), pose);
  Supports made;
  made.whole = measureEdgeSupport(rendering.edges, level, edges, scene.picture->view(),
                                  scene.ignore, {}, &made.partial);
  return made;
}

/// The picture with a flat gray thing before everything right of a column of the edges' box.
Picture hiddenFrom(const Case& scene, double share) {
  const Rendering rendering = renderEdges(scene.solid, scene.camera, scene.truth);
  int left = 1 << 20;
  int right = 0;
  for (int i = 0; i < rendering.edges.pixel_count; ++i) {
    const int x = rendering.edges.pixels[static_cast<std::size_t>(i)].x;
    left = std::min(left, x);
    right = std::max(right, x);
  }
  Picture made = *scene.picture;
  const int from = right - static_cast<int>(share * (right - left));
  for (int y = 0; y < made.height; ++y)
    for (int x = from; x < made.width; ++x)
      made.gray[static_cast<std::size_t>(y * made.width + x)] = 120;
  return made;
}

/// What a place of the render finds: nothing, an edge, or one that is near.
enum class Seen { kIgnored, kNothing, kFar, kNear };

Seen lookAt(const Case& scene, const EdgePixel& pixel, const int by[2], double scale) {
  const SupportOptions options;
  const Eigen::Vector2d normal(pixel.normal_x / 127.0, pixel.normal_y / 127.0);
  const Eigen::Vector2d at =
      Eigen::Vector2d(pixel.x + by[0], pixel.y + by[1]) + 0.01 * pixel.offset * normal;
  const Eigen::Vector2d place = at * scale + Eigen::Vector2d::Constant(0.5 * (scale - 1.0));
  const int x = std::clamp(static_cast<int>(std::lround(place.x())), 0, scene.picture->width - 1);
  const int y = std::clamp(static_cast<int>(std::lround(place.y())), 0, scene.picture->height - 1);
  if (scene.ignore != nullptr && scene.ignore->get(x, y)) return Seen::kIgnored;
  const EdgePeak peak =
      EdgeSearch(options.derivative_sigma_px)
          .find(scene.picture->view(), scene.ignore, place, normal, 4.0 * scale, 4.0);
  if (peak.gradient == 0.0) return Seen::kNothing;
  return std::abs(peak.offset_px) <= scale ? Seen::kNear : Seen::kFar;
}

/// The same cell by cell, each looked through on its own.
PartialSupport counted(const Case& scene, const Pose& pose, int level) {
  const Rendering rendering = renderEdges(scene.solid, cameraAtLevel(scene.camera, level), pose);
  const auto pixels =
      rendering.edges.pixels.first(static_cast<std::size_t>(rendering.edges.pixel_count));
  const auto along = [&](auto of) {
    const auto [least, most] =
        std::minmax_element(pixels.begin(), pixels.end(),
                            [of](const EdgePixel& a, const EdgePixel& b) { return of(a) < of(b); });
    return std::array<int, 2>{of(*least), of(*most) - of(*least) + 1};
  };
  const auto x = along([](const EdgePixel& pixel) { return static_cast<int>(pixel.x); });
  const auto y = along([](const EdgePixel& pixel) { return static_cast<int>(pixel.y); });
  PartialSupport made;
  for (int cell = 0; cell < 64; ++cell) {
    int looked[2] = {0, 0};
    int near[2] = {0, 0};
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if ((pixels[i].x - x[0]) * 8 / x[1] != cell % 8) continue;
      if ((pixels[i].y - y[0]) * 8 / y[1] != cell / 8) continue;
      for (const int displaced : {0, 1}) {
        const int* by = kDisplacements[i % 4];
        const int still[2] = {0, 0};
        const Seen seen = lookAt(scene, pixels[i], displaced != 0 ? by : still, 1 << level);
        if (seen == Seen::kIgnored) continue;
        const int found = seen == Seen::kNothing ? 0 : 1;
        ++looked[displaced];
        near[displaced] += seen == Seen::kNear ? 1 : 0;
        (displaced != 0 ? made.displaced_found : made.found) += found;
      }
    }
    made.rendered += looked[0];
    made.covered += near[0];
    made.displaced_covered += near[1];
    if (looked[0] < 8) continue;
    ++made.cells;
    const double chance = looked[1] > 0 ? static_cast<double>(near[1]) / looked[1] : 0.0;
    if (static_cast<double>(near[0]) / looked[0] < chance + 0.35 * (1.0 - chance)) continue;
    ++made.visible_cells;
    made.visible += looked[0];
  }
  return made;
}

TEST(PartialSupport, IsThatOfACountCellByCell) {
  Case scene = stationCase(1);
  const Picture hidden = hiddenFrom(scene, 0.35);
  Mask mask(512, 512);
  mask.fill(90, 110, 260, 300);
  for (const int level : {0, 1}) {
    for (const bool changed : {false, true}) {
      scene.ignore = changed ? &mask.bits : nullptr;
      if (changed) scene.picture = &hidden;
      const Pose pose = displacedSeed(scene.truth, scene.uncertainty, 0.01, 3);
      const PartialSupport expected = counted(scene, pose, level);
      const PartialSupport made = supportsAt(scene, pose, level).partial;
      // A place may fall between two pixels.
      EXPECT_NEAR(made.rendered, expected.rendered, 2);
      EXPECT_NEAR(made.found, expected.found, 2);
      EXPECT_NEAR(made.covered, expected.covered, 2);
      EXPECT_NEAR(made.displaced_found, expected.displaced_found, 2);
      EXPECT_NEAR(made.displaced_covered, expected.displaced_covered, 2);
      EXPECT_EQ(made.cells, expected.cells);
      EXPECT_EQ(made.visible_cells, expected.visible_cells);
      EXPECT_NEAR(made.visible, expected.visible, 2);
      EXPECT_GT(made.visible, 0);
      EXPECT_LT(made.visible, made.rendered);
    }
  }
}

TEST(PartialSupport, HiddenPartsTakeFromTheVisibleShareAndNotFromPrecision) {
  Case scene = stationCase(1);
  const Supports all = supportsAt(scene, scene.truth);
  EXPECT_GT(all.partial.visibleShare(), 0.8);
  for (const double share : {0.2, 0.35, 0.5}) {
    const Picture hidden = hiddenFrom(scene, share);
    Case half = scene;
    half.picture = &hidden;
    const Supports partly = supportsAt(half, half.truth);
    EXPECT_NEAR(partly.partial.visibleShare(), (1.0 - share) * all.partial.visibleShare(), 0.16);
    EXPECT_NEAR(partly.partial.precision(), all.partial.precision(), 0.06);
    EXPECT_LT(partly.whole.share(), all.whole.share());
  }
}

TEST(PartialSupport, DoesNotSufficeElsewhere) {
  for (const double share : {0.0, 0.3, 0.5}) {
    Case scene = stationCase(1);
    const Picture hidden = hiddenFrom(scene, share);
    scene.picture = &hidden;
    for (std::uint64_t seed = 1; seed <= 12; ++seed)
      EXPECT_FALSE(supportsAt(scene, stationCase(seed).seed).partial.suffices({})) << seed;
  }
}

TEST(PartialSupport, NothingIsSeenOfNothing) {
  const PartialSupport none;
  EXPECT_EQ(none.visibleShare(), 0.0);
  EXPECT_EQ(none.precision(), 0.0);
  EXPECT_FALSE(none.suffices({}));
}

LocalizationStatus endOf(const Case& scene, bool partial, Pose& camera_from_station) {
  LocalizerOptions options = withoutSearch();
  options.support.partial = partial;
  options.support.min_support = 0.75;  // these edges are crisper than a camera's
  OwnedRun run(scene.problem(), options);
  EXPECT_GT(run.finish(), 0);
  camera_from_station = run.localizer.workspace().camera_from_station;
  return run.localizer.workspace().status;
}

TEST(LocalizerPartial, AcceptsWhatIsPreciseWhereItIsVisible) {
  Case scene = stationCase(2);
  const Picture hidden = hiddenFrom(scene, 0.3);
  scene.picture = &hidden;
  Pose found;
  EXPECT_EQ(endOf(scene, false, found), LocalizationStatus::kNotSupported);
  ASSERT_EQ(endOf(scene, true, found), LocalizationStatus::kConverged);
  EXPECT_LT(meanDisplacement_px(scene.solid, scene.camera, scene.truth, found), 0.15);
}

TEST(LocalizerPartial, RefusesAnotherObject) {
  Case scene = stationCase(2);
  const Picture hidden = hiddenFrom(scene, 0.3);
  scene.picture = &hidden;
  for (const int axis : {0, 1}) {
    Case mirrored = scene;
    for (Eigen::Vector3f& vertex : mirrored.solid.vertices) vertex[axis] = -vertex[axis];
    for (Face& face : mirrored.solid.faces) std::swap(face.vertex[1], face.vertex[2]);
    Pose found;
    EXPECT_NE(endOf(mirrored, true, found), LocalizationStatus::kConverged) << axis;
  }
}

TEST(LocalizerPartial, IsHeardOfInTheDigestOnceItIsOn) {
  const auto digestOf = [](const LocalizerOptions& options) {
    DigestWriter writer;
    digestOptions(options, writer);
    return writer.digest();
  };
  LocalizerOptions options = defaultProfile();
  const auto plain = digestOf(options);
  options.support.partial = true;
  const auto on = digestOf(options);
  EXPECT_NE(on, plain);
  options.support.partial_visible = 0.8;
  EXPECT_NE(digestOf(options), on);
}

}  // namespace
}  // namespace boresight::test
