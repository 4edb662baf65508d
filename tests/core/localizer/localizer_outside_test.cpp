// SPDX-License-Identifier: Apache-2.0
// Matches from outside core, in the same loop.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/match/whs.h"
#include "tests/core/localizer/scene.h"
#include "tests/support/not_finite.h"

namespace boresight::test {
namespace {

/// WHS as an external matcher, built from parts of core.
class OutsideWhs {
 public:
  explicit OutsideWhs(const Camera& camera) {
    Arena arena(memory_);
    EXPECT_EQ(search_.create(256, std::max(camera.width, camera.height), Kernels::kPortable, arena),
              Status::kOk);
  }

  std::vector<SuppliedMatch> match(const Workspace& workspace) {
    const Iteration& iteration = *workspace.iteration;
    std::vector<SuppliedMatch> found;
    for (std::int32_t i = 0; i < iteration.templates.count; ++i)
      found.push_back(find(workspace, iteration.templates.templates[static_cast<std::size_t>(i)]));
    return found;
  }

 private:
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

  std::vector<std::byte> memory_ = std::vector<std::byte>(1 << 20);
  WhsSearch search_;
};

/// Runs to the end; `matches` gives the matches for each iteration that awaits them.
template <class Matches>
void finishWith(OwnedRun& run, const Matches& matches) {
  run.finish([&](const StepReport&) {
    if (!run.localizer.awaitsMatches()) return;
    ASSERT_EQ(run.localizer.supplyMatches(matches(run.workspace)), Status::kOk);
  });
}

TEST(LocalizerOutside, SameMatches_GiveTheSameBits) {
  for (const bool distorted : {false, true}) {
    const Case scene = stationCase(2, distorted);
    const FinishedRun inside(scene, withoutSearch());
    ASSERT_EQ(inside.workspace.status, LocalizationStatus::kConverged);

    OwnedRun outside(scene.problem(), withoutSearch());
    OutsideWhs whs(scene.camera);
    outside.localizer.matchOutside({});
    finishWith(outside, [&](const Workspace& workspace) { return whs.match(workspace); });
    EXPECT_EQ(outside.workspace.status, LocalizationStatus::kConverged);
    EXPECT_EQ(outside.workspace.camera_from_station, inside.workspace.camera_from_station);
    EXPECT_EQ(outside.workspace.iterations, inside.workspace.iterations);
    EXPECT_NE(outside.localizer.digest(), inside.localizer.digest()) << "WHS did not make these";
  }
}

/// A run that waits for matches.
struct WaitingRun {
  Case scene = stationCase(2);
  std::vector<std::uint8_t> intensity = std::vector<std::uint8_t>(512 * 512);
  OwnedRun run{scene.problem(), defaultProfile()};

  WaitingRun() {
    SurfaceRender surfaces;
    surfaces.intensity = intensity;
    run.localizer.matchOutside(surfaces);
    for (int steps = 0; !run.localizer.awaitsMatches() && steps < 1000000; ++steps)
      run.localizer.step();
  }
  std::vector<SuppliedMatch> everyTemplate() const {
    const TemplateSet& templates = run.workspace.iteration->templates;
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
  EXPECT_GT(std::ranges::max(waiting.intensity), 30) << "the shaded render came with the edges";
  const auto capacity = static_cast<std::size_t>(localizer.options().templates.count);
  EXPECT_EQ(localizer.supplyMatches(std::vector<SuppliedMatch>(capacity + 1)),
            Status::kCapacityExceeded);
  EXPECT_TRUE(localizer.awaitsMatches());
  ASSERT_EQ(localizer.supplyMatches(waiting.everyTemplate()), Status::kOk);
  EXPECT_FALSE(localizer.awaitsMatches());
  EXPECT_EQ(localizer.supplyMatches(waiting.everyTemplate()), Status::kInvalidOption);
  EXPECT_TRUE(localizer.step().stage_complete);
  const Iteration& iteration = *localizer.workspace().iteration;
  EXPECT_EQ(iteration.matches.searched, iteration.templates.count);
  EXPECT_DOUBLE_EQ(
      whsScore(iteration.matches.matches[0].peak.counts, iteration.matches.matches[0].norms), 1.25);
}

TEST(LocalizerOutside, NonFiniteMatches_CountAsNotFound) {
  WaitingRun waiting;
  std::vector<SuppliedMatch> matches = waiting.everyTemplate();
  ASSERT_GT(matches.size(), 6u);
  matches[0].x = kNan;
  matches[1].y = 1e300;
  matches[2].item.point_in_station_m.x() = kNan;
  matches[3].score = kNan;
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
  ASSERT_EQ(waiting.run.localizer.supplyMatches({}), Status::kOk);
  finishWith(waiting.run, [](const Workspace&) { return std::vector<SuppliedMatch>(); });
  EXPECT_EQ(waiting.run.workspace.status, LocalizationStatus::kTooFewMatches);
}

TEST(LocalizerOutside, WithoutMatchOutside_NoMatchesAreAwaited) {
  const Case scene = stationCase(2);
  OwnedRun run(scene.problem(), defaultProfile());
  run.finish([&](const StepReport&) { ASSERT_FALSE(run.localizer.awaitsMatches()); });
  EXPECT_EQ(run.localizer.supplyMatches({}), Status::kInvalidOption);
}

}  // namespace
}  // namespace boresight::test
