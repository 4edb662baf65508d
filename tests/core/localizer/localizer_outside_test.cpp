// SPDX-License-Identifier: Apache-2.0
// Matches from outside core, in the same loop.
#include <gtest/gtest.h>

#include <limits>

#include "core/match/whs.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// WHS as an external matcher, built from parts of core.
class OutsideWhs {
 public:
  OutsideWhs(const Camera& camera, const LocalizerOptions& options)
      : options_(options), most_(std::max(camera.width, camera.height)) {
    Arena counter;
    EXPECT_EQ(search_.create(kMostSide, most_, Kernels::kPortable, counter), Status::kOk);
    memory_.resize(counter.highWater() + Arena::kAlignment);
    Arena arena(memory_);
    EXPECT_EQ(search_.create(kMostSide, most_, Kernels::kPortable, arena), Status::kOk);
  }

  std::vector<SuppliedMatch> match(const Workspace& workspace) {
    const Iteration& iteration = *workspace.iteration;
    std::vector<SuppliedMatch> found;
    for (std::int32_t i = 0; i < iteration.templates.count; ++i)
      found.push_back(find(workspace, iteration.templates.templates[static_cast<std::size_t>(i)]));
    return found;
  }

 private:
  static constexpr int kMostSide = 256;

  SuppliedMatch find(const Workspace& workspace, const Template& item) {
    const Iteration& iteration = *workspace.iteration;
    const BitImage& edges = workspace.edges.level[static_cast<std::size_t>(iteration.level)];
    const TemplateView view{&iteration.render.edges, &iteration.render.mask, item.center_x,
                            item.center_y, iteration.templates.side_px};
    SuppliedMatch match;
    match.item = item;
    match.window = searchWindow(iteration.render.camera,
                                iteration.camera_from_station_before * item.point_in_station_m,
                                iteration.uncertainty, iteration.templates.side_px);
    if (match.window.empty() ||
        search_.begin(view, edges, match.window, item.center_x, item.center_y,
                      kSecondPeakExclusion_px) != Status::kOk)
      return match;
    while (!search_.step()) {
    }
    subpixelPeak(view, edges, search_.peak(), match.x, match.y);
    match.score = whsScore(search_.peak().counts, search_.norms());
    match.found = true;
    return match;
  }

  LocalizerOptions options_;
  int most_;
  std::vector<std::byte> memory_;
  WhsSearch search_;
};

void expectSamePose(const Pose& first, const Pose& second) {
  EXPECT_EQ(first.rotation.coeffs(), second.rotation.coeffs());
  EXPECT_EQ(first.translation_m, second.translation_m);
}

TEST(LocalizerOutside, SameMatches_GiveTheSameBits) {
  for (const bool distorted : {false, true}) {
    const Case scene = stationCase(2, distorted);
    const LocalizerOptions options = withoutSearch();
    OwnedRun inside(scene.problem(), options);
    ASSERT_GT(inside.finish(), 0);
    ASSERT_EQ(inside.localizer.workspace().status, LocalizationStatus::kConverged);

    OwnedRun outside(scene.problem(), options);
    OutsideWhs whs(scene.camera, options);
    outside.localizer.matchOutside({});
    StepReport report;
    for (int steps = 0; !report.finished && steps < 1000000; ++steps) {
      if (outside.localizer.awaitsMatches()) {
        ASSERT_EQ(outside.localizer.supplyMatches(whs.match(outside.localizer.workspace())),
                  Status::kOk);
      }
      report = outside.localizer.step();
    }
    EXPECT_EQ(outside.localizer.workspace().status, LocalizationStatus::kConverged);
    expectSamePose(outside.localizer.workspace().camera_from_station,
                   inside.localizer.workspace().camera_from_station);
    EXPECT_EQ(outside.localizer.workspace().iterations, inside.localizer.workspace().iterations);
    EXPECT_NE(outside.localizer.digest(), inside.localizer.digest()) << "WHS did not make these";
  }
}

/// A run that waits for matches.
struct WaitingRun {
  Case scene = stationCase(2);
  std::vector<std::uint8_t> intensity;
  OwnedRun run{scene.problem(), defaultProfile()};

  WaitingRun() {
    const auto pixels = static_cast<std::size_t>(scene.camera.width) *
                        static_cast<std::size_t>(scene.camera.height);
    intensity.resize(pixels);
    SurfaceRender surfaces;
    surfaces.intensity = intensity;
    run.localizer.matchOutside(surfaces);
    for (int steps = 0; !run.localizer.awaitsMatches() && steps < 1000000; ++steps)
      run.localizer.step();
  }
  std::vector<SuppliedMatch> everyTemplate() const {
    const TemplateSet& templates = run.localizer.workspace().iteration->templates;
    std::vector<SuppliedMatch> all(static_cast<std::size_t>(templates.count));
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i].item = templates.templates[i];
      all[i].x = templates.templates[i].center_x;
      all[i].y = templates.templates[i].center_y;
      all[i].score = 1.25;
      all[i].found = true;
    }
    return all;
  }
};

TEST(LocalizerOutside, WithoutMatches_StepWaits) {
  WaitingRun waiting;
  Localizer& localizer = waiting.run.localizer;
  ASSERT_TRUE(localizer.awaitsMatches());
  EXPECT_EQ(localizer.tasks(), 0);
  for (int i = 0; i < 3; ++i) {
    const StepReport report = localizer.step();
    EXPECT_EQ(report.stage, Stage::kMatch);
    EXPECT_FALSE(report.stage_complete);
  }
  const Iteration& iteration = *localizer.workspace().iteration;
  const EdgePixel pixel = iteration.render.pixel(0);
  EXPECT_GT(*std::max_element(waiting.intensity.begin(), waiting.intensity.end()), 30)
      << "the shaded render came with the edges, around " << pixel.x;
  ASSERT_EQ(localizer.supplyMatches(waiting.everyTemplate()), Status::kOk);
  EXPECT_FALSE(localizer.awaitsMatches());
  EXPECT_EQ(localizer.supplyMatches(waiting.everyTemplate()), Status::kInvalidOption);
  EXPECT_TRUE(localizer.step().stage_complete);
  EXPECT_EQ(iteration.matches.searched, iteration.templates.count);
  EXPECT_DOUBLE_EQ(
      whsScore(iteration.matches.matches[0].peak.counts, iteration.matches.matches[0].norms), 1.25);
}

TEST(LocalizerOutside, TooManyMatches_ExceedTheCapacity) {
  WaitingRun waiting;
  std::vector<SuppliedMatch> many(
      static_cast<std::size_t>(waiting.run.localizer.options().templates.count) + 1);
  EXPECT_EQ(waiting.run.localizer.supplyMatches(many), Status::kCapacityExceeded);
  EXPECT_TRUE(waiting.run.localizer.awaitsMatches());
}

TEST(LocalizerOutside, NonFiniteMatches_CountAsNotFound) {
  WaitingRun waiting;
  std::vector<SuppliedMatch> matches = waiting.everyTemplate();
  ASSERT_GT(matches.size(), 6u);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  matches[0].x = nan;
  matches[1].y = 1e300;
  matches[2].item.point_in_station_m.x() = nan;
  matches[3].score = nan;
  matches[4].found = false;
  matches[5].item.center_x = -1000000;
  Localizer& localizer = waiting.run.localizer;
  ASSERT_EQ(localizer.supplyMatches(matches), Status::kOk);
  localizer.step();
  const Iteration& iteration = *localizer.workspace().iteration;
  EXPECT_EQ(iteration.matches.searched, iteration.matches.count - 4);
  EXPECT_TRUE(iteration.matches.matches[3].searched) << "the score does not decide";
  EXPECT_EQ(iteration.templates.templates[5].center_x, 0);
}

TEST(LocalizerOutside, NoMatchesEndTheRunAsTooFew) {
  WaitingRun waiting;
  Localizer& localizer = waiting.run.localizer;
  StepReport report;
  for (int steps = 0; !report.finished && steps < 1000000; ++steps) {
    if (localizer.awaitsMatches()) {
      ASSERT_EQ(localizer.supplyMatches({}), Status::kOk);
    }
    report = localizer.step();
  }
  EXPECT_EQ(localizer.workspace().status, LocalizationStatus::kTooFewMatches);
}

TEST(LocalizerOutside, WithoutMatchOutside_NoMatchesAreAwaited) {
  const Case scene = stationCase(2);
  OwnedRun run(scene.problem(), defaultProfile());
  run.finish([&](const StepReport&) { ASSERT_FALSE(run.localizer.awaitsMatches()); });
  EXPECT_EQ(run.localizer.supplyMatches({}), Status::kInvalidOption);
}

}  // namespace
}  // namespace boresight::test
