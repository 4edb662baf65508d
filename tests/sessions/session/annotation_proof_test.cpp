// SPDX-License-Identifier: Apache-2.0
// Annotating, from end to end without a window: corners of the shipped example annotated with the
// noise of a careful person give back its true pose.
#include <gtest/gtest.h>

#include <algorithm>

#include "sessions/session/case_annotations.h"
#include "tests/support/annotated_example.h"

namespace boresight::test {
namespace {

using sessions::Session;

/// How far a camera's pose is off, of the middle of what was annotated.
struct Error {
  double translation_mm = 0.0;
  double rotation_deg = 0.0;
};

Error errorOf(const Session& session, const std::string& id, const Pose& found) {
  const Pose& truth = *session.findCase(id)->camera_from_station_truth;
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  const auto& points = session.annotations.at(id)->points;
  for (const sessions::PointPair& point : points)
    middle_m += *point.point_in_station_m / static_cast<double>(points.size());
  return {
      1000.0 * (found * middle_m - truth * middle_m).norm(),
      rotationLog((found.rotation * truth.rotation.conjugate()).normalized()).norm() / kDegree_rad};
}

TEST(AnnotationProof, TenCornersGiveTheTruth) {
  Session session = sessions::makeSession(exampleFolder() / "dataset.json");
  const std::string id = caseOfStation(session, "bc");
  const std::vector<SeenCorner> corners = spreadCorners(ExampleCase("bc"), 10);
  Random random = randomFor("AnnotationProof");
  int good = 0;
  Error worst;
  double squares = 0.0;
  constexpr int kTrials = 40;
  for (int trial = 0; trial < kTrials; ++trial) {
    const sessions::Annotations annotations = annotationsOf(corners, 0.2, random);
    ASSERT_EQ(annotations.points.size(), 10u);
    session = withAnnotations(session, id, annotations);
    const auto solved = sessions::solveCaseAnnotations(session, id);
    ASSERT_TRUE(solved.result.solution) << solved.result.reason;
    const Error error = errorOf(session, id, *solved.camera_from_station());
    good += error.translation_mm < 0.15 && error.rotation_deg < 0.1;
    // By the stated sigma alone, so that the normalized squares have 6 degrees of freedom.
    const Vector6d xi = perturbationBetween(*solved.camera_from_station(),
                                            *session.findCase(id)->camera_from_station_truth);
    const double noise = solved.result.solution->noise_factor;
    const Matrix6d covariance = solved.result.solution->covariance / (noise * noise);
    squares += xi.dot(covariance.ldlt().solve(xi)) / kTrials;
    worst.translation_mm = std::max(worst.translation_mm, error.translation_mm);
    worst.rotation_deg = std::max(worst.rotation_deg, error.rotation_deg);
  }
  // 0.1 deg is a little more than two deviations of such annotations: 95 % are within.
  EXPECT_GE(good, kTrials * 95 / 100);
  EXPECT_LT(worst.translation_mm, 0.15);
  EXPECT_LT(worst.rotation_deg, 0.15);
  // Mean 6, deviation of the mean of 40: sqrt(12 / 40) = 0.55.
  EXPECT_NEAR(squares, 6.0, 2.2);
}

}  // namespace
}  // namespace boresight::test
