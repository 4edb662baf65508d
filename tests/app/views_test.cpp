// SPDX-License-Identifier: Apache-2.0
// whs views: one pose from the cases of a rig.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "core/pnp/normal_equations.h"
#include "sessions/io/json/json_writer.h"
#include "tests/app/json_lines.h"
#include "tests/app/run_whs.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using nlohmann::json;

class WhsViews : public testing::Test {
 protected:
  /// A dataset of the example's first case, once per camera of the rig "pair".
  std::string datasetOf(const std::vector<Pose>& cameras_from_rig) const {
    const std::filesystem::path folder = exampleFolder();
    json dataset = jsonOf(exampleDataset());
    for (json& station : dataset["stations"])
      station["mesh"] = (folder / station["mesh"].get<std::string>()).string();
    json value = dataset["cases"][0];
    value["image"] = (folder / value["image"].get<std::string>()).string();
    dataset["cases"] = json::array();
    for (const Pose& camera_from_rig : cameras_from_rig) {
      value["id"] = "view-" + std::to_string(dataset["cases"].size());
      value["rig"]["id"] = "pair";
      value["rig"]["camera_from_rig"] = json::parse(sessions::toJson(camera_from_rig).dump());
      dataset["cases"].push_back(value);
    }
    return folder_.write("dataset.json", dataset.dump()).string();
  }

  json solved(const std::vector<Pose>& cameras_from_rig) const {
    runWhs({"views", "--dataset", datasetOf(cameras_from_rig), "--out", folder_ / "out.json"}, 0);
    return jsonOf(folder_ / "out.json")["rigs"].at(0);
  }

  static Matrix6d covarianceOf(const json& rows) {
    Matrix6d result;
    for (int i = 0; i < 36; ++i)
      result(i / 6, i % 6) = rows[static_cast<std::size_t>(i / 6)][static_cast<std::size_t>(i % 6)];
    return result;
  }

  const TemporaryFolder folder_;
};

TEST_F(WhsViews, ThePoseIsTheRigsWhereverItsFrameLies) {
  const Pose camera_from_rig{rotationExp({0.3, -0.5, 1.1}), {0.2, -0.1, 0.4}};
  const json value = solved({Pose()});
  const json other = solved({camera_from_rig});
  EXPECT_EQ(value["status"], "converged");
  EXPECT_EQ(other["status"], "converged");
  const Pose camera_from_station = camera_from_rig * poseOf(other["rig_from_station"]);
  const Pose of_view = poseOf(other["views"][0]["camera_from_station"]);
  EXPECT_LT(perturbationBetween(of_view, camera_from_station).norm(), 1e-12);
  const Matrix6d covariance = covarianceOf(value["covariance"]);
  const Matrix6d turn = adjointOf(camera_from_rig);
  const Matrix6d back = turn * covarianceOf(other["covariance"]) * turn.transpose();
  // The detour changes the seed's last bits, which moves any run's pose by up to two sigma: other
  // edge places are looked at. Covariances are sums over these places, known to a third.
  const Vector6d difference =
      perturbationBetween(poseOf(value["rig_from_station"]), camera_from_station);
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(std::abs(difference[i]), 3.0 * std::sqrt(covariance(i, i)));
    EXPECT_NEAR(back(i, i) / covariance(i, i), 1.0, 0.5);
  }
}

TEST_F(WhsViews, ResultsNameEveryView) {
  const json rig = solved({Pose(), Pose()});
  EXPECT_EQ(rig["rig"], "pair");
  EXPECT_EQ(rig["digest"].get<std::string>().size(), 64u);
  ASSERT_EQ(rig["views"].size(), 2u);
  EXPECT_EQ(rig["views"][1]["case"], "view-1");
  EXPECT_EQ(rig["views"][1]["status"], "converged");
  EXPECT_LT(rig["views"][1]["error"]["lateral_mm"], 0.4);
}

TEST_F(WhsViews, WhatIsNoRigIsRefused) {
  const auto error = [](const std::string& dataset) {
    return runWhs({"views", "--dataset", dataset, "--rig", "pair"}, 3).err;
  };
  EXPECT_THAT(error(exampleDataset()), HasSubstr("no case names it"));
  EXPECT_THAT(
      runWhs({"views", "--dataset", exampleDataset(), "--rig", "pair", "--profile", "flight"}, 3)
          .err,
      HasSubstr("only localize, follow and evaluate have the memory limit of profile flight\n"));
  EXPECT_THAT(error(datasetOf(std::vector<Pose>(9))), HasSubstr("at most 8"));
  json two = jsonOf(datasetOf({Pose(), Pose()}));
  two["cases"][1]["station"] = "os";
  EXPECT_THAT(error(folder_.write("two.json", two.dump())), HasSubstr("another station"));
  for (const char* station : {"bc", "os"}) two["stations"][station].erase("uncertainty");
  EXPECT_THAT(error(folder_.write("none.json", two.dump())), HasSubstr("uncertainty"));
}

}  // namespace
}  // namespace boresight::test
