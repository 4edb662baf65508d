// SPDX-License-Identifier: Apache-2.0
// Whatever the options within their ranges, a run ends, within its memory, and always alike.
#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/localizer/localizer.h"
#include "tests/core/localizer/random_options.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

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
