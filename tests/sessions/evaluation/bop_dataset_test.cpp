// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/bop_dataset.h"

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "sessions/evaluation/reseed.h"
#include "sessions/io/files/errors.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

constexpr const char* kModels = R"({
  "1": {"diameter": 5, "min_x": -1, "min_y": -2, "min_z": 3, "size_x": 4, "size_y": 4, "size_z": 8,
        "symmetries_discrete": [[-1,0,0,2, 0,-1,0,0, 0,0,1,0, 0,0,0,1]]},
  "7": {"diameter": 5, "min_x": -1, "min_y": -1, "min_z": -1, "size_x": 2, "size_y": 2, "size_z": 2,
        "symmetries_continuous": [{"axis": [0, 0, 2], "offset": [1, 2, 3]}]}})";
constexpr const char* kCameras = R"({
  "0": {"cam_K": [50, 0, 7.5, 0, 51, 5.5, 0, 0, 1], "depth_scale": 1.0},
  "3": {"cam_K": [60, 0, 7.5, 0, 61, 5.5, 0, 0, 1], "depth_scale": 1.0}})";
constexpr const char* kPoseOf1 =
    R"({"cam_R_m2c": [1,0,0,0,-1,0,0,0,-1], "cam_t_m2c": [10, 20, 500], "obj_id": 1})";
constexpr const char* kPoseOf7 =
    R"({"cam_R_m2c": [1,0,0,0,1,0,0,0,1], "cam_t_m2c": [0, 0, 700], "obj_id": 7})";

/// Two objects, a scene of two images, one of them with two instances of object 7.
class BopDataset : public testing::Test {
 protected:
  BopDataset() {
    folder_.write("models/models_info.json", kModels);
    for (const char* name : {"obj_000001", "obj_000007"})
      folder_.write(std::string("models/") + name + ".ply", "ply\n");
    scene("test/000002", "png");
  }

  void scene(const std::string& at, const std::string& extension) {
    folder_.write(at + "/scene_camera.json", kCameras);
    folder_.write(at + "/scene_gt.json", std::string(R"({"0": [)") + kPoseOf1 + "], \"3\": [" +
                                             kPoseOf7 + "," + kPoseOf1 + "," + kPoseOf7 + "]}");
    const std::vector<std::uint8_t> pixels(16 * 12, 80);
    std::filesystem::create_directories(folder_ / (at + "/gray"));
    for (const char* name : {"000000", "000003"}) {
      const std::filesystem::path image = folder_ / (at + "/gray/" + name + ".png");
      writePng(image, pixels, 16, 12, 1);
      std::filesystem::rename(image, std::filesystem::path(image).replace_extension(extension));
    }
  }
  std::vector<std::string> idsOf(const BopSelection& selection = {}) {
    std::vector<std::string> ids;
    for (const Case& dataset_case : openDataset(folder_.path(), selection).cases)
      ids.push_back(dataset_case.id);
    return ids;
  }
  std::string errorOf(const BopSelection& selection = {}) {
    return folder_.message([&] { (void)openDataset(folder_.path(), selection); });
  }

  test::TemporaryFolder folder_;
};

TEST_F(BopDataset, ObjectsAreStationsAndInstancesCases) {
  const Dataset dataset = openDataset(folder_.path());
  EXPECT_THAT(idsOf(), ElementsAre("000002-000000-000001", "000002-000003-000007",
                                   "000002-000003-000001", "000002-000003-000007-2"));
  const Case& dataset_case = dataset.cases[0];
  EXPECT_EQ(dataset_case.station, "obj_000001");
  EXPECT_EQ(dataset_case.image, folder_ / "test/000002/gray/000000.png");
  EXPECT_EQ(dataset_case.truth_camera_from_station->translation_m,
            Eigen::Vector3d(0.01, 0.02, 0.5));
  EXPECT_EQ(dataset_case.bop->scene_id, 2);
  EXPECT_EQ(dataset_case.bop->object_id, 1);
  const Camera& camera = dataset.cameraOf(dataset.cases[1]);
  EXPECT_EQ(camera.fx, 60.0);
  EXPECT_EQ(camera.fy, 61.0);
  EXPECT_EQ(camera.cx, 7.5);
  EXPECT_EQ(camera.width, 16);
  EXPECT_EQ(camera.height, 12);
  const Station& station = dataset.stations.at("obj_000001");
  EXPECT_EQ(station.parts.at(0).mesh, folder_ / "models/obj_000001.ply");
  EXPECT_EQ(station.parts.at(0).mesh_unit, "mm");
  EXPECT_EQ(readCaseImage(dataset, dataset_case).width, 16);
  requireFiles(dataset);
}

TEST_F(BopDataset, SymmetriesAreInMetres) {
  const Dataset dataset = openDataset(folder_.path());
  const auto& half_turn = dataset.stations.at("obj_000001").symmetries.discrete;
  ASSERT_EQ(half_turn.size(), 1u);
  // p -> diag(-1, -1, 1) p + (2, 0, 0) mm
  const Eigen::Vector3d turned_m = half_turn[0] * Eigen::Vector3d(1e-3, 2e-3, 3e-3);
  EXPECT_LT((turned_m - Eigen::Vector3d(1e-3, -2e-3, 3e-3)).norm(), 1e-15);
  const auto& turns = dataset.stations.at("obj_000007").symmetries.continuous;
  ASSERT_EQ(turns.size(), 1u);
  EXPECT_EQ(turns[0].axis, Eigen::Vector3d::UnitZ());
  // A quarter turn about the line through (1, 2) mm.
  const Eigen::Vector3d quarter_m =
      turnAbout(turns[0], 0.5 * kPi) * Eigen::Vector3d(2e-3, 2e-3, 5e-3);
  EXPECT_LT((quarter_m - Eigen::Vector3d(1e-3, 3e-3, 5e-3)).norm(), 1e-12);
}

TEST_F(BopDataset, SeedsAreDrawnInTheDeclaredUncertainty) {
  BopSelection selection;
  selection.uncertainty.translation_m = {0.02, 0.01, 0.03};
  selection.uncertainty.rotation_deg = {4.0, 5.0, 6.0};
  const Dataset dataset = openDataset(folder_.path(), selection);
  for (const Case& dataset_case : dataset.cases) {
    ASSERT_TRUE(dataset_case.uncertainty);
    // The middle of models_info's box.
    const Eigen::Vector3d centre = dataset_case.station == "obj_000001"
                                       ? Eigen::Vector3d(1e-3, 0.0, 7e-3)
                                       : Eigen::Vector3d(0.0, 0.0, 0.0);
    const Pose& seed = dataset_case.seed_camera_from_station;
    const Vector6d offset =
        offsetAboutPivot(seed, *dataset_case.truth_camera_from_station, seed * centre);
    for (int i = 0; i < 3; ++i) {
      EXPECT_LE(std::abs(offset[i]), selection.uncertainty.rotation_deg[i] * kDegree_rad);
      EXPECT_LE(std::abs(offset[i + 3]), selection.uncertainty.translation_m[i]);
    }
    EXPECT_GT(offset.norm(), 1e-4);
  }
  EXPECT_EQ(dataset.cases[1].seed_camera_from_station,
            openDataset(folder_.path(), selection).cases[1].seed_camera_from_station);
  EXPECT_NE(dataset.sha256, openDataset(folder_.path()).sha256);
}

TEST_F(BopDataset, SelectsSplitsScenesAndObjects) {
  scene("val/000001", "PNG");
  scene("val/000005", "png");
  EXPECT_EQ(idsOf().size(), 4u);  // of test
  EXPECT_THAT(idsOf({.split = "val", .scenes = {5}, .objects = {7}}),
              ElementsAre("000005-000003-000007", "000005-000003-000007-2"));
  EXPECT_EQ(errorOf({.split = "train"}), folder_.path().string() + ": has no split train");
  EXPECT_THAT(errorOf({.split = "val", .scenes = {6}}), HasSubstr("has no scene 000006"));
  EXPECT_THAT(errorOf({.objects = {2}}), HasSubstr("there is no object 2"));
  std::filesystem::rename(folder_ / "test", folder_ / "train");
  EXPECT_THAT(errorOf(), HasSubstr("has several splits, choose one with --split: train, val"));
}

TEST_F(BopDataset, TakesTheTargetsOfTheChallenge) {
  folder_.write("test_targets_bop19.json",
                R"([{"scene_id": 2, "im_id": 3, "obj_id": 7, "inst_count": 1}])");
  folder_.write("test/000002/scene_gt_info.json",
                R"({"0": [{"visib_fract": 1.0}],
                    "3": [{"visib_fract": 0.3}, {"visib_fract": 0.05}, {"visib_fract": 0.9}]})");
  EXPECT_THAT(idsOf(), ElementsAre("000002-000003-000007"));
  EXPECT_EQ(idsOf({.every_instance = true}).size(), 4u);
  std::filesystem::remove(folder_ / "test_targets_bop19.json");
  EXPECT_EQ(idsOf().size(), 3u);  // without the one of which a twentieth is seen
}

/// What does not fit is not left out: rates would have another denominator.
TEST_F(BopDataset, TargetsWithoutATruePose_AreRefused) {
  const std::string known = R"({"scene_id": 2, "im_id": 3, "obj_id": 7, "inst_count": 2})";
  const auto targets = [&](const std::string& more) {
    folder_.write("test_targets_bop19.json", "[" + known + more + "]");
    return errorOf();
  };
  EXPECT_EQ(targets(""), "(nothing)");
  EXPECT_EQ(
      targets(R"(, {"scene_id": 2, "im_id": 9, "obj_id": 1, "inst_count": 1},
                         {"scene_id": 7, "im_id": 3, "obj_id": 7, "inst_count": 2})"),
      "test_targets_bop19.json: 3 target instances without a true pose, the first object 1 in "
      "image 9 of scene 2: choose scenes (--scene), or take --every-instance");
  EXPECT_THAT(targets(R"(, {"scene_id": 2, "im_id": 0, "obj_id": 1, "inst_count": 2})"),
              HasSubstr("1 target instance without a true pose, the first object 1 in image 0"));
  EXPECT_EQ(idsOf({.objects = {7}}).size(), 2u);
  EXPECT_EQ(idsOf({.every_instance = true}).size(), 4u);
  EXPECT_THAT(targets("," + known), HasSubstr("[1]: the target is listed twice"));
}

TEST_F(BopDataset, AmbiguousOrHiddenEntries_AreNamed) {
  folder_.write("test/000002/gray/3.jpg", "x");
  EXPECT_EQ(errorOf(), "test/000002/gray/3.jpg: is image 000003, as is 000003.png: remove one");
  std::filesystem::remove(folder_ / "test/000002/gray/3.jpg");
  folder_.write("test/000002/scene_gt_info.json",
                R"({"0": [{"visib_fract": -1}],
                    "3": [{"visib_fract": -1}, {"visib_fract": -1}, {"visib_fract": 0.09}]})");
  EXPECT_EQ(errorOf(),
            "test: the selection is empty: 4 instances of less than 10 % visibility are left out "
            "(--every-instance takes them)");
  std::filesystem::remove(folder_ / "test/000002/scene_gt_info.json");
  folder_.write("test/000002/scene_gt.json",
                R"({"0": [{"cam_R_m2c": [1,0,0,0,-1,0,0,0,-1], "cam_t_m2c": [0, 0, 0.4],
                           "obj_id": 1}]})");
  EXPECT_THAT(errorOf(), HasSubstr("cam_t_m2c: object 1 is 0.4 mm from the camera, at a size of "));
  folder_.write("test/000002/scene_gt.json",
                std::string(R"({"0": [)") + kPoseOf1 + "], \"00\": [" + kPoseOf7 + "]}");
  EXPECT_THAT(errorOf(), HasSubstr("the number 0 is given twice"));
}

TEST_F(BopDataset, ReadsOneOfSeveralSensors) {
  for (const char* name : {"scene_camera", "scene_gt"})
    std::filesystem::rename(folder_ / ("test/000002/" + std::string(name) + ".json"),
                            folder_ / ("test/000002/" + std::string(name) + "_cam1.json"));
  EXPECT_THAT(errorOf(), HasSubstr("has several sensors (cam1): choose one with --sensor"));
  std::filesystem::rename(folder_ / "test/000002/gray", folder_ / "test/000002/rgb_cam1");
  EXPECT_EQ(idsOf({.sensor = "cam1"}).size(), 4u);
}

TEST_F(BopDataset, SaysWhatIsMissing) {
  EXPECT_EQ(folder_.message([&] { (void)openDataset(folder_ / "models"); }),
            "models: has no folder models with a models_info.json");
  std::filesystem::remove(folder_ / "test/000002/gray/000003.png");
  EXPECT_EQ(errorOf(), "test/000002: has no image 000003");
  folder_.write("test/000002/scene_camera.json",
                R"({"0": {"cam_model": {"projection_params": []}}, "3": {}})");
  EXPECT_THAT(errorOf(), HasSubstr("only pinhole cameras (cam_K)"));
  std::filesystem::remove(folder_ / "test/000002/scene_gt.json");
  EXPECT_THAT(errorOf(), HasSubstr("seeds are drawn about true poses"));
}

TEST_F(BopDataset, ResultsAreOfCompletedRunsAndShareAnImagesTime) {
  const Dataset dataset = openDataset(folder_.path());
  std::vector<RunResult> runs(4);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].case_id = dataset.cases[i].id;
    runs[i].completed = i != 2;
    runs[i].edge_support = 0.25 * static_cast<double>(i);
    runs[i].seconds.matching = 1.0 + static_cast<double>(i);
  }
  runs.push_back(runs[0]);
  runs.back().reseed = 1;
  const std::vector<BopResult> results = bopResults(dataset, runs);
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[0].seconds, 1.0);
  EXPECT_EQ(results[1].seconds, 2.0 + 3.0 + 4.0);  // also that of the run that failed
  EXPECT_EQ(results[2].seconds, 9.0);
  EXPECT_EQ(results[2].object_id, 7);
  EXPECT_EQ(results[2].score, 0.75);
}

}  // namespace
}  // namespace boresight::sessions
