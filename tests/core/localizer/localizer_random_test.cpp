// SPDX-License-Identifier: Apache-2.0
// Whatever the options within their ranges, a run ends, within its memory, and always alike.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/localizer/localizer.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// The station before a small camera: a run takes a few milliseconds.
Case smallCase(const Picture& picture, const Camera& camera, std::uint64_t seed) {
  Case made = stationCase(seed);
  made.camera = camera;
  made.picture = &picture;
  return made;
}

Camera smallCamera() {
  Camera camera;
  camera.width = 131;
  camera.height = 97;
  camera.fx = camera.fy = 200.0;
  camera.cx = 66.0;
  camera.cy = 47.0;
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

/// Each option stays as it is, or becomes anything in its range; counts stay small.
LocalizerOptions randomOptions(Random& random) {
  LocalizerOptions options = random.below(3) == 0 ? paperProfile() : defaultProfile();
  const std::uint32_t stays = 1 + random.below(12);
  LocalizerOptions::visitFields(options, [&](const OptionInfo& info, auto& field) {
    using Field = std::remove_reference_t<decltype(field)>;
    if (random.below(stays + 1) != 0) return;
    const double exponent = random.uniform();
    const double span = std::min(info.maximum, 2000.0 + info.minimum) - info.minimum;
    const double value = info.minimum + span * exponent * exponent * exponent;
    if constexpr (std::is_same_v<Field, double>) {
      field = random.below(8) == 0 ? info.maximum : value;
    } else {
      field = static_cast<Field>(static_cast<std::int64_t>(std::floor(value + 0.5)));
    }
  });
  options.edges.aperture_px |= 1;
  options.loop.max_iterations = std::min(options.loop.max_iterations, 6);
  return options;
}

TEST(LocalizerRandom, EveryRunEndsWithinItsMemoryAndAlwaysAlike) {
  const Camera camera = smallCamera();
  const Picture picture = takePicture(stationMesh(), camera, truthPose());
  Mask mask(131, 97);
  mask.fill(0, 0, 50, 40);
  Random random(77);
  int ends[16] = {};
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const LocalizerOptions options = randomOptions(random);
    ASSERT_EQ(firstInvalidOption(options), nullptr) << firstInvalidOption(options);
    Case scene = smallCase(picture, camera, static_cast<std::uint64_t>(i));
    if (i % 4 == 0) scene.ignore = &mask.bits;
    OwnedRun run(scene.problem(), options);
    ASSERT_EQ(run.localizer.status(), Status::kOk);
    ASSERT_GT(run.finish(), 0);
    EXPECT_EQ(run.localizer.highWaterBytes(), run.memory.size());
    const Workspace& workspace = run.localizer.workspace();
    EXPECT_NE(workspace.status, LocalizationStatus::kRunning);
    EXPECT_TRUE(workspace.camera_from_station.isFinite());
    EXPECT_TRUE(workspace.covariance.allFinite());
    ++ends[static_cast<int>(workspace.status)];
    if (i % 3 != 0) continue;
    std::vector<std::byte> other(run.memory.size() + 48, std::byte{0xFF});
    Localizer again(scene.problem(), options, std::span(other).subspan(32));
    while (!again.step().finished) {
    }
    EXPECT_EQ(again.digest(), run.localizer.digest());
  }
  EXPECT_GT(ends[static_cast<int>(LocalizationStatus::kConverged)], 5);
  EXPECT_EQ(ends[static_cast<int>(LocalizationStatus::kFault)], 0);
}

}  // namespace
}  // namespace boresight::test
