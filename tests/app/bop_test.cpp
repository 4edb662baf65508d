// SPDX-License-Identifier: Apache-2.0
// BOP datasets in evaluate, info and new.
#include <gtest/gtest.h>

#include "sessions/evaluation/bop_scene.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/session/session_file.h"
#include "tests/app/json_lines.h"
#include "tests/app/run_whs.h"
#include "tests/support/approach_files.h"
#include "tests/support/bop_results.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

const std::filesystem::path kRendered = BORESIGHT_SYNTHETIC_EXAMPLE;

/// One rendered case as a BOP dataset of one image, made by hand: object 5 in image 4 of scene 3.
class WhsBop : public testing::Test {
 protected:
  WhsBop() {
    const sessions::Case& dataset_case = *dataset_.findCase("bc-000000");
    truth_ = *dataset_case.truth_camera_from_station;
    sessions::PosedImage image;
    image.id = 4;
    image.camera = dataset_.cameraOf(dataset_case);
    image.camera_from_station = truth_;
    const std::filesystem::path scene = folder_ / "set/test/000003";
    std::filesystem::create_directories(scene / "gray");
    sessions::writeBopScene(scene, {{{image, 5}}});
    std::filesystem::copy_file(dataset_case.image, scene / "gray/000004.png");
    writeModel(sessions::readScene(dataset_.stations.at("bc").parts));
  }

  void writeModel(const sessions::SceneMesh& mesh) {
    Solid model;
    model.faces = mesh.faces;
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& vertex : mesh.vertices_in_station_m) {
      model.vertices.emplace_back(1000.0F * vertex);
      box.extend(model.vertices.back());
    }
    folder_.write("set/models/obj_000005.ply", plyOf(model));
    nlohmann::json info = {{"diameter", box.diagonal().norm()}};
    const char* axes[] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i) {
      info[std::string("min_") + axes[i]] = box.min()[i];
      info[std::string("size_") + axes[i]] = box.sizes()[i];
    }
    folder_.write("set/models/models_info.json", nlohmann::json{{"5", info}}.dump());
  }

  sessions::Dataset dataset_ = sessions::readDataset(kRendered / "dataset.json");
  TemporaryFolder folder_;
  std::string set_ = folder_ / "set";
  Pose truth_;
};

TEST_F(WhsBop, EvaluatesAndWritesTheChallengesResults) {
  const std::string csv = folder_ / "whs_set-test.csv";
  runWhs({"evaluate", "--dataset", set_, "--uncertainty", "0.02", "0.02", "0.02", "3", "3", "3",
          "--pivot", "camera", "--out", folder_ / "r.sqlite", "--jsonl", folder_ / "r.jsonl",
          "--bop-csv", csv},
         0);
  const auto result = jsonOf(folder_ / "r.jsonl");
  EXPECT_EQ(result["id"], "000003-000004-000005");
  ASSERT_TRUE(result["completed"]) << result["message"];
  const auto& error = result["error"];
  EXPECT_LT(error["mssd_mm"], 0.5);
  EXPECT_LT(error["mspd_px"], 1.0);
  EXPECT_LE(error["adi_mm"], error["add_mm"]);
  EXPECT_LE(error["add_mm"], error["mssd_mm"]);
  EXPECT_GT(result["seed_error"]["mssd_mm"], 2.0);
  const auto rows = readBopResults(csv);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].scene_id, 3);
  EXPECT_EQ(rows[0].image_id, 4);
  EXPECT_EQ(rows[0].object_id, 5);
  EXPECT_GT(rows[0].seconds, 0.0);
  EXPECT_LT(perturbationBetween(rows[0].camera_from_station, truth_).norm(), 2e-3);
}

TEST_F(WhsBop, IsDescribedAndBecomesASession) {
  EXPECT_THAT(runWhs({"info", set_}, 0).out,
              AllOf(HasSubstr("BOP dataset\n  1 case, 1 station, 1 camera"),
                    HasSubstr("station obj_000005: 1 case, 1 part")));
  const std::string file = folder_ / "s.boresight.json";
  runWhs({"new", "--dataset", set_, "--obj", "5", "--out", file}, 0);
  const sessions::Session session = sessions::readSessionFile(file).session;
  ASSERT_EQ(session.cases.size(), 1u);
  EXPECT_EQ(session.cases[0]->camera_from_station_truth->translation_m, truth_.translation_m);
  EXPECT_EQ(session.cases[0]->parts.at(0).source.mesh_unit, "mm");
}

TEST_F(WhsBop, AmbiguousSelection_IsRefused) {
  const std::string out = folder_ / "r.sqlite";
  const std::string file = kRendered / "dataset.json";
  EXPECT_THAT(runWhs({"evaluate", "--dataset", file, "--scene", "3", "--out", out}, 2).err,
              HasSubstr("choose of a BOP folder"));
  EXPECT_THAT(
      runWhs({"evaluate", "--dataset", file, "--bop-csv", folder_ / "r.csv", "--out", out}, 3).err,
      HasSubstr("is not part of a BOP dataset"));
  EXPECT_THAT(runWhs({"info", set_, "--scene", "9"}, 3).err, HasSubstr("has no scene 000009"));
}

}  // namespace
}  // namespace boresight::test
