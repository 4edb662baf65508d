// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/rig_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/geometry/pose.h"
#include "sessions/evaluation/batch.h"
#include "sessions/io/errors.h"
#include "tests/support/example_case.h"

namespace boresight::sessions {
namespace {

using testing::HasSubstr;

/// The example's first case, so many times, each by a camera of its own place in the rig.
Dataset rigOf(const std::vector<Pose>& cameras_from_rig) {
  Dataset dataset = readDataset(test::exampleFolder() / "dataset.json");
  const Case first = dataset.cases.front();
  dataset.cases.clear();
  for (const Pose& camera_from_rig : cameras_from_rig) {
    dataset.cases.push_back(first);
    dataset.cases.back().id += "-" + std::to_string(dataset.cases.size());
    dataset.cases.back().rig = Rig{"pair", camera_from_rig};
  }
  return dataset;
}

std::string refusal(const Dataset& dataset, const std::string& id) {
  try {
    (void)readRigViews(dataset, id);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RigViews, OneCaseIsWhatABatchMakesOfIt) {
  const Dataset dataset = rigOf({Pose()});
  BatchOptions options;
  options.localizer = defaultProfile();
  options.localizer.search.enabled = false;  // views start from their seed
  const RunResult expected = runBatch(dataset, options, {}).front();
  const RigViews rig = readRigViews(dataset, "pair");
  const RigRun run = localizeViews(rig, defaultProfile());
  ASSERT_EQ(run.result.status, LocalizationStatus::kConverged);
  EXPECT_EQ(run.result.rig_from_station, expected.camera_from_station);
  EXPECT_EQ(viewError(rig, run, 0)->geodesic_mrad, expected.error->geodesic_mrad);
}

TEST(RigViews, ThePoseIsTheRigsWhereverItsFrameLies) {
  const Pose camera_from_rig{rotationExp({0.3, -0.5, 1.1}), {0.2, -0.1, 0.4}};
  const Dataset still = rigOf({Pose()});
  const RigViews plain = readRigViews(still, "pair");
  const Dataset dataset = rigOf({camera_from_rig});
  const RigViews moved = readRigViews(dataset, "pair");
  const RigRun one = localizeViews(plain, defaultProfile());
  const RigRun other = localizeViews(moved, defaultProfile());
  ASSERT_EQ(other.result.status, LocalizationStatus::kConverged);
  const Pose camera_from_station = camera_from_rig * other.result.rig_from_station;
  const Pose& of_view = other.result.views[0].camera_from_station;
  EXPECT_LT(perturbationBetween(of_view, camera_from_station).norm(), 1e-12);
  const Matrix6d adjoint = adjointOf(camera_from_rig);
  const Matrix6d back = adjoint * other.result.covariance * adjoint.transpose();
  // The detour changes the seed's last bits, which moves any run's pose by up to two sigma: other
  // edge places are looked at.
  const Vector6d difference = perturbationBetween(one.result.rig_from_station, camera_from_station);
  for (int i = 0; i < 6; ++i) {
    const double variance = one.result.covariance(i, i);
    EXPECT_LT(std::abs(difference[i]), 3.0 * std::sqrt(variance));
    // Sums of the errors at these places, so a variance is known to a third.
    EXPECT_NEAR(back(i, i) / variance, 1.0, 0.5);
  }
}

TEST(RigViews, ResultsNameEveryView) {
  const Dataset dataset = rigOf({Pose(), Pose()});
  const RigViews rig = readRigViews(dataset, "pair");
  const RigRun run = localizeViews(rig, defaultProfile());
  const nlohmann::ordered_json json = toJson(rig, run);
  EXPECT_EQ(json["status"], "converged");
  ASSERT_EQ(json["views"].size(), 2u);
  EXPECT_EQ(json["views"][1]["case"], rig.cases[1]->id);
  EXPECT_EQ(json["views"][1]["status"], "converged");
  EXPECT_TRUE(json["views"][1].contains("error"));
  EXPECT_EQ(json["covariance"].size(), 6u);
}

TEST(RigViews, RefusesWhatIsNoRig) {
  EXPECT_THAT(refusal(rigOf({Pose()}), "other"), HasSubstr("no case names it"));
  EXPECT_THAT(refusal(rigOf(std::vector<Pose>(9)), "pair"), HasSubstr("at most 8"));
  Dataset two = readDataset(test::exampleFolder() / "dataset.json");
  for (Case& one : two.cases) one.rig = Rig{"pair", Pose()};
  EXPECT_THAT(refusal(two, "pair"), HasSubstr("several stations"));
  Dataset unknown = rigOf({Pose()});
  unknown.cases.front().uncertainty.reset();
  EXPECT_THAT(refusal(unknown, "pair"), HasSubstr("uncertainty"));
}

TEST(RigIds, AreInTheOrderOfTheirFirstCases) {
  Dataset dataset = rigOf({Pose(), Pose(), Pose()});
  EXPECT_EQ(rigIds(dataset), std::vector<std::string>{"pair"});
  dataset.cases[1].rig->id = "a";
  EXPECT_EQ(rigIds(dataset), (std::vector<std::string>{"pair", "a"}));
  dataset.cases[0].rig.reset();
  EXPECT_EQ(rigIds(dataset), (std::vector<std::string>{"a", "pair"}));
}

}  // namespace
}  // namespace boresight::sessions
