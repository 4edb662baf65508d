// SPDX-License-Identifier: Apache-2.0
// Methods other than WHS in the same loop, on images whose truth is known because the renderer made
// them: the shaded object before a noisy background.
#include "sessions/baselines/methods.h"

#include <gtest/gtest.h>

#include "sessions/trace/scene_render.h"
#include "tests/support/example_case.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using namespace sessions;

/// The example's orbiting sample, its photograph replaced by its own shaded render.
struct RenderedCase : ExampleCase {
  RenderedCase() : ExampleCase("os") {
    std::vector<std::uint8_t> shaded(image.pixels.size());
    SurfaceRender surfaces;
    surfaces.intensity = shaded;
    RenderTrace edges;
    EXPECT_EQ(renderScene(camera, scene.view(), truth.camera_from_station, edges, surfaces),
              Status::kOk);
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < shaded.size(); ++i) {
      state = state * 1664525u + 1013904223u;
      if (shaded[i] == 0) shaded[i] = static_cast<std::uint8_t>(60 + (state >> 24) / 4);
    }
    image.pixels = shaded;
  }

  /// Of the middle of the station, m.
  double errorOf(const Pose& camera_from_station) const {
    const Eigen::Vector3d middle = matchedBounds(scene.view()).centre();
    return (camera_from_station * middle - truth.camera_from_station * middle).norm();
  }
};

/// Matches alone decide.
LocalizerOptions matchesAlone() {
  LocalizerOptions options = defaultProfile();
  options.refinement.enabled = false;
  options.support.gate = false;
  options.templates.feature_size_m = 0.018;
  return options;
}

MethodSetup withMatcher(const std::string& what) {
  MethodSetup setup;
  setup.matcher = "'" BORESIGHT_TEST_MATCHER "' " + what;
  setup.options.external.timeout_s = what == "hang" ? 0.5 : 60.0;
  setup.options.external.start_timeout_s = 60.0;
  return setup;
}

TEST(Methods, KnowsTheirNames) {
  for (const char* name : {"whs", "ncc", "ssd", "orb", "external", "loftr-r", "loftr-s"}) {
    EXPECT_TRUE(isMethod(name)) << name;
    EXPECT_THAT(methodNames(), HasSubstr(name));
  }
  EXPECT_FALSE(isMethod("sift"));
  EXPECT_TRUE(needsMatcher("loftr-s"));
  EXPECT_FALSE(needsMatcher("ncc"));
}

TEST(Methods, WhsIsTheVerySame) {
  const LocalizationProblem problem = osExample().problem();
  const auto one = Methods({}).localize("whs", problem, defaultProfile(), {});
  const auto other = localize(problem, defaultProfile(), RecordLevel::kSummary);
  EXPECT_TRUE(one.converged());
  EXPECT_EQ(one.digest, other.digest);
}

TEST(Methods, FindTheTruthWhereTheImageIsARenderAndTheSameEveryTime) {
  const RenderedCase rendered;
  EXPECT_GT(rendered.errorOf(rendered.seed.camera_from_station), 2e-3);
  Methods methods({});
  for (const char* name : {"ncc", "ssd", "orb"}) {
    const auto trace = methods.localize(name, rendered.problem(), matchesAlone(), {});
    EXPECT_TRUE(trace.converged()) << name << ": " << localizationStatusText(trace.status);
    EXPECT_LT(rendered.errorOf(trace.camera_from_station), 1e-3) << name;
    const auto again = methods.localize(name, rendered.problem(), matchesAlone(), {});
    EXPECT_EQ(again.digest, trace.digest) << name;
  }
}

TEST(Methods, TakeTheOptionsOfTheirOwn) {
  const RenderedCase rendered;
  MethodSetup setup;
  setup.options.orb.features = 120;
  const auto trace = Methods(setup).localize("orb", rendered.problem(), matchesAlone(), {});
  EXPECT_EQ(trace.options.templates.count, 120);
  ASSERT_FALSE(trace.iterations.empty());
  for (const auto& iteration : trace.iterations) EXPECT_LE(iteration->template_count, 120);
}

TEST(ExternalMethod, MatchesThatDoNotMoveKeepTheSeed) {
  // Points, pixels and levels are right if a match at its own place means no correction.
  LocalizerOptions options = matchesAlone();
  options.loop.max_rolled_hypotheses = 1;
  for (const char* name : {"external", "loftr-s"}) {
    const auto trace =
        Methods(withMatcher("shift")).localize(name, osExample().problem(), options, {});
    EXPECT_TRUE(trace.converged()) << localizationStatusText(trace.status);
    const Pose& seed = osExample().seed.camera_from_station;
    EXPECT_LT((trace.camera_from_station.translation_m - seed.translation_m).norm(), 1e-6);
    ASSERT_FALSE(trace.iterations.empty());
    EXPECT_GT(trace.iterations.back()->pnp.inlier_count, 20) << name;
  }
}

TEST(ExternalMethod, OneThatFailsCostsItsRunAlone) {
  const LocalizationProblem problem = osExample().problem();
  for (const char* what : {"die", "hang", "babble"}) {
    Methods methods(withMatcher(what));
    for (int i = 0; i < 2; ++i)
      EXPECT_THROW(methods.localize("external", problem, matchesAlone(), {}), MethodError)
          << what << ": a new matcher is started, and fails again";
  }
}

}  // namespace
}  // namespace boresight::test
