// SPDX-License-Identifier: Apache-2.0
#include "sessions/report/trends.h"

#include <gtest/gtest.h>

#include "sessions/checks/pose_uncertainty.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_maker.h"
#include "tests/support/example_case.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

std::vector<TrendPoint> pointsWith(std::initializer_list<double> figures, double sigma) {
  std::vector<TrendPoint> points;
  for (const double figure : figures) {
    TrendPoint& point = points.emplace_back();
    point.station = "bc";
    point.figures[0] = figure;
    point.sigmas.fill(sigma);
  }
  return points;
}

std::vector<bool> flagsOf(std::vector<TrendPoint> points) {
  flagOutliers(points);
  std::vector<bool> flags;
  for (const TrendPoint& point : points) flags.push_back(point.outlier[0]);
  return flags;
}

/// Median 3, MAD 1: beyond 3 +- 3.5 / 0.6745 = 3 +- 5.19 stands out.
TEST(Trends, OutliersAreThoseOfTheModifiedScore) {
  EXPECT_EQ(flagsOf(pointsWith({1, 2, 3, 4, 8.1}, 0.0)), std::vector<bool>(5, false));
  EXPECT_EQ(flagsOf(pointsWith({1, 2, 3, 4, 8.3}, 0.0)),
            (std::vector<bool>{false, false, false, false, true}));
  EXPECT_EQ(flagsOf(pointsWith({1, 2, 3, 4, 8.3}, 3.0)), std::vector<bool>(5, false));
  EXPECT_EQ(flagsOf(pointsWith({1, 2, 3, 100}, 0.0)), std::vector<bool>(4, false));  // too few
  auto points = pointsWith({1, 2, 3, 4, 5, 100, 101, 102, 103, 104}, 0.0);
  for (std::size_t i = 5; i < points.size(); ++i) points[i].station = "os";
  EXPECT_EQ(flagsOf(points), std::vector<bool>(10, false)) << "each station by itself";
}

TEST(Trends, PointOfASessionIsItsCorrection) {
  const test::TemporaryFolder folder;
  Session session = makeSession(test::exampleFolder() / "dataset.json");
  const std::string id = session.cases.front()->id;
  const auto file = folder / "sol12.boresight.json";
  const auto loaded = loadCase(*session.cases.front());
  const LocalizationTrace run = runCase(session, *loaded);
  ASSERT_TRUE(run.converged());
  session = withRun(session, storeRun(session, id, run, file));
  std::vector<std::string> remarks;
  const auto points = trendOf(session, file, remarks);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_THAT(remarks, ElementsAre(HasSubstr("has no run")));  // the other case
  SessionCase session_case = *session.cases.front();
  if (!session_case.camera_from_end_effector) session_case.camera_from_end_effector = Pose();
  const Pose move = endEffectorPose(session_case, run.camera_from_station, Matrix6d::Zero())
                        .end_effector_seed_from_end_effector_estimated.inverse();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(points[0].figures[axis], 1e3 * move.translation_m[static_cast<Eigen::Index>(axis)],
                1e-9);
    EXPECT_GT(points[0].sigmas[axis], 0.0);
  }
  EXPECT_THAT(trendCsv(points), HasSubstr("correction_x_mm,sigma_of_correction_x_mm"));
  EXPECT_THAT(trendTable(points), HasSubstr(id));
  EXPECT_FALSE(points[0].checks_failed) << "no decision has judged checks";
  const auto pdf = trendPdf(points);
  EXPECT_EQ(std::string(pdf.begin(), pdf.begin() + 4), "%PDF");

  SessionCase moved = *session.cases.front();
  moved.camera_from_station_seed.translation_m.x() += 0.05;
  remarks.clear();
  EXPECT_THAT(trendOf(withCase(session, moved), file, remarks), testing::IsEmpty());
  EXPECT_THAT(remarks,
              ElementsAre(HasSubstr("have changed since its run"), HasSubstr("has no run")));
}

}  // namespace
}  // namespace boresight::sessions
