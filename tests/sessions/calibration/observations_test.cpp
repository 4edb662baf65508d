// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/observations.h"

#include <algorithm>
#include <cstddef>

#include <gtest/gtest.h>

#include "sessions/session/case_run.h"
#include "sessions/session/session_maker.h"
#include "tests/support/annotated_example.h"
#include "tests/support/example_run.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

/// An upright object in raster order: each row crosses its left and its right side.
TEST(ObservationsOfRuns, SamplesInRasterOrder_AreTakenFromBothSides) {
  LocalizationTrace run = test::exampleTrace();
  const auto of_run = run.iterations.back()->refinement.samples;
  ASSERT_FALSE(of_run.empty());
  const auto [left, right] = std::ranges::minmax(
      of_run, {}, [](const EdgeSample& sample) { return sample.point_in_station_m.x(); });
  test::editIteration(run, run.iterations.size() - 1, [&](IterationTrace& last) {
    last.refinement.samples.clear();
    for (int row = 0; row < 65; ++row)
      for (EdgeSample sample : {left, right}) {
        sample.weight = 1.0F;
        last.refinement.samples.push_back(sample);
      }
  });
  const test::TemporaryFolder folder;
  Session session = makeSession(test::exampleFolder() / "dataset.json");
  const std::string case_id = test::caseOfStation(session, "os");
  session = withRun(session, storeRun(session, case_id, run, folder / "s.boresight.json"));
  const auto views = observationsOf(session, ObservationSource::kRuns);
  ASSERT_EQ(views.size(), 1U);
  const auto& points = views[0].points;
  const auto of_left =
      std::ranges::count(points, left.point_in_station_m, &PointObservation::point_in_station_m);
  EXPECT_GE(points.size(), 60U);
  EXPECT_GT(of_left, 16);
  EXPECT_LT(of_left, static_cast<std::ptrdiff_t>(points.size()) - 16);
}

}  // namespace
}  // namespace boresight::sessions
