// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include "core/base/digest.h"
#include "tests/core/localizer/rail_scene.h"

namespace boresight::test {
namespace {

/// The beginning of a run's digest.
std::string runDigest(const Case& scene, const LocalizerOptions& options = {}) {
  OwnedRun run(scene.problem(), options);
  EXPECT_GT(run.finish(), 0);
  return std::string(hexText(run.localizer.digest()).data()).substr(0, 16);
}

/// Every machine, compiler and optimization level must give these bits: a digest that changes
/// means that localizations recorded before can no longer be reproduced.
TEST(SameBits, OfLocalizations) {
  EXPECT_EQ(runDigest(stationCase(4, true)), "0e5dc36da0c70076");
  EXPECT_EQ(runDigest(stationCase(1), withoutSearch()), "48f17ab653555f82");
  EXPECT_EQ(runDigest(railCase(Ends::kOutside, 0.0, 1.7, 3)), "5517bbddf33da5f2");

  Case masked = occludedCase(4);
  Mask mask(512, 512);
  mask.fill(150, 100, 300, 220);
  masked.ignore = &mask.bits;
  masked.uncertainty.rotation_rad.z() = 0.6;  // several rolled renders
  EXPECT_EQ(runDigest(masked, paperProfile()), "95ab33602de1fe49");

  Case turned = stationCase(2);
  turned.uncertainty.rotation_rad.z() = kPi;
  turned.seed.rotation = rotationExp({0.0, 0.0, 2.0}) * turned.seed.rotation;
  EXPECT_EQ(runDigest(turned), "4cb3657d3b03dccf");

  Case other = stationCase(3);
  other.solid = railMesh(5, true);
  EXPECT_EQ(runDigest(other), "75a5d05588be00fc");
}

}  // namespace
}  // namespace boresight::test
