// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/datasets/dataset_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/math.h"
#include "tests/sessions/io/folder_test.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

/// Two stations, one in short form and one of two parts; two cases, one that waivers everything.
const json& sampleDataset() {
  static const json sample = json::parse(R"({"format": "boresight-dataset", "version": 1,
    "requirement": {"normal_mm": 0.4, "lateral_mm": 0.5, "rotation_deg": 0.25},
    "stations": {
      "bc": {"mesh": "bc/model.ply", "mesh_unit": "mm", "feature_size_m": 0.015,
        "uncertainty": {"translation_m": [0.03, 0.03, 0.03], "rotation_deg": [5, 5, 5]},
        "camera_from_end_effector": [[1,0,0,0],[0,1,0,0],[0,0,1,0.39],[0,0,0,1]]},
      "os": {"parts": [
        {"mesh": "os.ply", "mesh_unit": "m", "normal_threshold_deg": 20,
         "depth_threshold_m": 0.002,
         "station_from_mesh": [[1,0,0,0],[0,1,0,0],[0,0,1,1.5],[0,0,0,1]]},
        {"mesh": "tube.glb", "match": false}]}},
    "cameras": {"left": {"model": "pinhole", "width": 8, "height": 6, "fx": 10, "fy": 10,
                         "cx": 3.5, "cy": 2.5}},
    "cases": [
      {"id": "a", "station": "bc", "image": "images/a.png", "camera": "left",
       "seed": {"camera_from_station": [[1,0,0,0],[0,1,0,0],[0,0,1,0.4],[0,0,0,1]]}},
      {"id": "b", "station": "bc", "image": "images/b.png", "camera": "left",
       "ignore": "masks/b.png", "tags": ["low_sun", "near"],
       "seed": {"camera_from_station": [[1,0,0,0],[0,1,0,0],[0,0,1,0.4],[0,0,0,1]]},
       "truth": {"camera_from_station": [[1,0,0,0],[0,1,0,0],[0,0,1,0.41],[0,0,0,1]]},
       "rig": {"id": "pair", "camera_from_rig": [[1,0,0,0],[0,1,0,0],[0,0,1,0.1],[0,0,0,1]]},
       "uncertainty": {"translation_m": [0.01, 0.01, 0.01], "rotation_deg": [5, 5, 5],
                       "pivot": "station"},
       "requirement": {"projection_px": 5.0},
       "camera_from_end_effector": [[1,0,0,0],[0,1,0,0],[0,0,1,0.2],[0,0,0,1]]}]})");
  return sample;
}

/// A member of a dataset, what it becomes (nullptr: left out), and the refusal without the file;
/// "*" at its end stands for any text.
struct Wrong {
  const char* member;
  const char* value;
  std::string refusal;
};

class ReadDataset : public FolderTest {
 protected:
  Dataset read(const json& content) {
    return readDataset(folder_.write("dataset.json", content.dump()));
  }
  Dataset readSample() { return read(sampleDataset()); }
  /// The sample with other values of some members.
  static json changed(const json& given, const std::vector<std::pair<const char*, json>>& values) {
    json content = given;
    for (const auto& [member, value] : values) content[json::json_pointer(member)] = value;
    return content;
  }
  /// Expects that each of these changes is refused by its message.
  void expectRefused(const json& good, const std::vector<Wrong>& all) {
    for (const Wrong& wrong : all) {
      const json::json_pointer place(wrong.member);
      json content = good;
      if (wrong.value == nullptr)
        content[place.parent_pointer()].erase(place.back());
      else
        content[place] = json::parse(wrong.value);
      std::string message = folder_.message([&] { (void)read(content); });
      std::string refusal = "dataset.json: " + wrong.refusal;
      if (refusal.back() == '*') {
        refusal.pop_back();
        message.resize(std::min(message.size(), refusal.size()));
      }
      EXPECT_EQ(message, refusal) << content.dump();
    }
  }
};

TEST_F(ReadDataset, ReadsStationsInBothForms) {
  const Dataset dataset = readSample();
  EXPECT_THAT(dataset.notes, IsEmpty());
  ASSERT_EQ(dataset.stations.size(), 2u);
  const Station& bc = dataset.stations.at("bc");
  PartSource model;
  model.mesh = folder_ / "bc/model.ply";
  model.mesh_unit = "mm";
  EXPECT_EQ(bc.parts, std::vector{model});
  EXPECT_EQ(bc.feature_size_m, 0.015);
  EXPECT_EQ(bc.camera_from_end_effector->translation_m.z(), 0.39);
  const Station& os = dataset.stations.at("os");
  ASSERT_EQ(os.parts.size(), 2u);
  EXPECT_EQ(os.parts[0].frame_from_mesh.translation_m.z(), 1.5);
  EXPECT_DOUBLE_EQ(os.parts[0].normal_threshold_rad, kPi / 9.0);
  EXPECT_EQ(os.parts[0].depth_threshold_m, 0.002);
  EXPECT_EQ(os.parts[1].state.role, PartRole::kOccludes);
  EXPECT_EQ(os.parts[1].mesh_unit, "");
  EXPECT_FALSE(os.feature_size_m.has_value());
  EXPECT_EQ(dataset.cameras.at("left").camera.width, 8);
}

TEST_F(ReadDataset, CasesHaveTheMembersOfTheirStationAndTheDatasetUnlessTheyStateTheirOwn) {
  const Dataset dataset = readSample();
  ASSERT_EQ(dataset.cases.size(), 2u);
  const Case& a = dataset.cases[0];
  EXPECT_EQ(a.id, "a");
  EXPECT_EQ(a.image, folder_ / "images/a.png");
  EXPECT_FALSE(a.ignore || a.truth_camera_from_station || a.rig);
  EXPECT_EQ(a.uncertainty->translation_m.x(), 0.03);
  EXPECT_TRUE(a.requirement == (Requirement{0.4, 0.5, 0.25, std::nullopt}));
  EXPECT_EQ(a.camera_from_end_effector->translation_m.z(), 0.39);
  const Case& b = *dataset.findCase("b");
  EXPECT_EQ(dataset.findCase("c"), nullptr);
  EXPECT_EQ(b.ignore, folder_ / "masks/b.png");
  EXPECT_EQ(b.truth_camera_from_station->translation_m.z(), 0.41);
  EXPECT_TRUE(b.rig == (Rig{"pair", {Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.1}}}));
  EXPECT_TRUE(b.hasTag("near"));
  EXPECT_FALSE(b.hasTag("far"));
  EXPECT_EQ(b.uncertainty->translation_m.x(), 0.01);
  EXPECT_EQ(b.uncertainty->pivot, UncertaintyPivot::kStation);
  EXPECT_TRUE(b.requirement == (Requirement{{}, {}, {}, 5.0})) << "it is overridden whole";
  EXPECT_EQ(b.camera_from_end_effector->translation_m.z(), 0.2);
}

TEST_F(ReadDataset, AlbedosAndSigmasOfMeshCameraAndTruth_AreRead) {
  const Dataset unstated = readSample();
  EXPECT_FALSE(unstated.stations.at("bc").mesh_scale_sigma);
  EXPECT_FALSE(unstated.cameras.at("left").calibration_sigma);
  EXPECT_FALSE(unstated.findCase("b")->truth_covariance) << "exact";
  const Dataset dataset = read(
      changed(sampleDataset(),
              {{"/stations/bc/albedo", 0.42},
               {"/stations/os/parts/1/albedo", 0},
               {"/stations/bc/mesh_scale_sigma", 0.001},
               {"/cameras/left/calibration_sigma",
                json::parse(R"({"focal_relative": 0.002, "principal_point_px": 0.5})")},
               {"/cases/1/truth/covariance",
                json::parse("[[1e-6,0,0,0,0,0],[0,1e-6,0,0,0,0],[0,0,1e-6,0,0,0],[0,0,0,1e-6,0,0],"
                            "[0,0,0,0,1e-6,0],[0,0,0,0,0,1e-6]]")}}));
  EXPECT_EQ(dataset.stations.at("bc").parts[0].albedo, 0.42);
  EXPECT_EQ(dataset.stations.at("os").parts[0].albedo, std::nullopt);
  EXPECT_EQ(dataset.stations.at("os").parts[1].albedo, 0.0);
  EXPECT_EQ(dataset.stations.at("bc").mesh_scale_sigma, 0.001);
  EXPECT_EQ(dataset.cameras.at("left").calibration_sigma, (StatedCalibration{0.002, 0.5}));
  EXPECT_EQ(dataset.findCase("b")->truth_covariance, Matrix6d(1e-6 * Matrix6d::Identity()));
}

TEST_F(ReadDataset, NamesThePlaceOfWhatIsWrong) {
  expectRefused(
      sampleDataset(),
      {{"/stations", nullptr, "stations: missing"},
       {"/cases/1/station", R"("x")", "cases[1].station: there is no station 'x'"},
       {"/cases/1/camera", R"("x")", "cases[1].camera: there is no camera 'x'"},
       {"/cases/1/id", R"("a")", "cases[1].id: 'a' is given twice"},
       {"/cases/0/seed", nullptr, "cases[0].seed: missing"},
       {"/cases/1/truth/camera_from_station/0/0", "2",
        "cases[1].truth.camera_from_station: not a rotation*"},
       {"/cases/1/rig/id", nullptr, "cases[1].rig.id: missing"},
       {"/cameras/left/fx", "0", "cameras.left.fx: 0 is outside 0.001 .. 1e+07"},
       {"/requirement", "{}",
        "requirement: names none of normal_mm, lateral_mm, rotation_deg, projection_px"},
       {"/requirement/normal_mm", "0", "requirement.normal_mm: 0 is not above 0"},
       {"/stations/bc/symmetries", R"({"discrete": [[1, 2, 3]]})",
        "stations.bc.symmetries.discrete[0]*"},
       {"/stations/bc/symmetries", R"({"continuous": [{"axis": [0, 0, 0]}]})",
        "stations.bc.symmetries.continuous[0].axis: has no direction*"},
       {"/stations/bc/symmetries", "{}", "stations.bc.symmetries: has neither*"},
       {"/stations/bc/mesh_scale_sigma", "0.2", "stations.bc.mesh_scale_sigma*"},
       {"/stations/os/parts/0/albedo", "-0.01", "stations.os.parts[0].albedo*"},
       {"/stations/os/parts/0/albedo", "1.01", "stations.os.parts[0].albedo*"},
       {"/stations/bc/mesh_unit", nullptr, "stations.bc.mesh_unit: missing: PLY carries no unit"},
       {"/stations/bc/mesh_unit", R"("furlong")",
        "stations.bc.mesh_unit: unknown unit 'furlong' (m, dm, cm, mm, um, in, ft, yd, km)"},
       {"/stations/bc/mesh", R"("model.step")",
        "stations.bc.mesh: unknown mesh format '.step' (ply, obj, stl, gltf, glb)"},
       {"/stations/bc/parts", "[]", "stations.bc.mesh: cannot be combined with 'parts'"},
       {"/stations/os/parts", "[]", "stations.os.parts: is empty"},
       {"/stations/os/parts/0/match", "false", "stations.os.parts: no part is to be matched"},
       {"/stations/bc/match", "false",
        "stations.bc.match: the station's only part must be matched"},
       {"/stations/os/parts/0/depth_threshold_m", "-1",
        "stations.os.parts[0].depth_threshold_m: -1 is outside 1e-06 .. 1000"},
       {"/stations/bc/feature_size_m", "0",
        "stations.bc.feature_size_m: 0 is outside 1e-06 .. 100"},
       {"/stations/bc", "5", "stations.bc: not an object (is a number)"}});
}

TEST_F(ReadDataset, TakesDeclaredSymmetries) {
  const Dataset dataset = read(changed(sampleDataset(), {{"/stations/bc/symmetries", json::parse(R"(
      {"discrete": [[[-1,0,0,0.002],[0,-1,0,0],[0,0,1,0],[0,0,0,1]]],
       "continuous": [{"axis": [0, 0, 2], "point_m": [0.01, 0, 0]}, {"axis": [1, 0, 0]}]})")}}));
  const Symmetries& symmetries = dataset.stations.at("bc").symmetries;
  ASSERT_EQ(symmetries.discrete.size(), 1u);
  const Eigen::Vector3d turned = symmetries.discrete.front() * Eigen::Vector3d(0.1, 0.2, 0.3);
  EXPECT_TRUE(turned.isApprox(Eigen::Vector3d(-0.098, -0.2, 0.3)));
  ASSERT_EQ(symmetries.continuous.size(), 2u);
  EXPECT_EQ(symmetries.continuous[0].axis, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(symmetries.continuous[0].point_m, Eigen::Vector3d(0.01, 0.0, 0.0));
  EXPECT_EQ(symmetries.continuous[1].point_m, Eigen::Vector3d::Zero());
  EXPECT_TRUE(dataset.stations.at("os").symmetries.empty());
}

/// The sample with a gripper of station os, and a case that shows both.
json withGripper() {
  json d = sampleDataset();
  d["stations"]["os"]["parts"].push_back(
      json::parse(R"({"mesh": "gripper.ply", "mesh_unit": "m", "name": "gripper",
        "frame": "CAMERA", "frame_from_mesh": [[1,0,0,0],[0,1,0,0],[0,0,1,0.2],[0,0,0,1]],
        "role": "occludes", "present": false})"));
  json shown = d["cases"][0];
  shown.update(json::parse(
      R"({"id": "c", "station": "os", "state": {"gripper": "on", "tube": "ignored"}})"));
  d["cases"].push_back(shown);
  return d;
}

TEST_F(ReadDataset, TakesFramesRolesAndStatesOfParts) {
  const Dataset dataset = read(withGripper());
  const PartSource& gripper = dataset.stations.at("os").parts[2];
  EXPECT_EQ(gripper.name, "gripper");
  EXPECT_EQ(gripper.frame, kCameraFrame);
  EXPECT_EQ(gripper.frame_from_mesh.translation_m.z(), 0.2);
  EXPECT_EQ(gripper.state, (PartState{PartRole::kOccludes, false}));
  EXPECT_EQ(dataset.stations.at("os").parts[0].frame, kStationFrame);
  const std::vector<PartSource> parts = partsOf(dataset, *dataset.findCase("c"));
  EXPECT_EQ(parts[1].state, (PartState{PartRole::kIgnored, true}));
  EXPECT_EQ(parts[2].state, (PartState{PartRole::kOccludes, true}));
}

TEST_F(ReadDataset, NamesWhatIsWrongInAPartOrAState) {
  expectRefused(
      withGripper(),
      {{"/stations/os/parts/2/frame", R"("WRIST")",
        "stations.os.parts[2].frame: WRIST is joined to neither CAMERA nor STATION: add the "
        "transform that joins it (--frames, or transforms of dataset.json)"},
       {"/stations/os/parts/2/role", R"("matched")",
        "stations.os.parts[2].role: a part that is fixed to the camera cannot*"},
       {"/stations/os/parts/2/role", R"("held")", "stations.os.parts[2].role: 'held' is none of*"},
       {"/stations/os/parts/2/match", "false",
        "stations.os.parts[2].match: cannot be combined with 'role'*"},
       {"/stations/os/parts/2/station_from_mesh", "[[1,0,0,0],[0,1,0,0],[0,0,1,1],[0,0,0,1]]",
        "stations.os.parts[2].station_from_mesh: cannot be combined*"},
       {"/stations/os/parts/2/fixed_to", R"("CAMERA")",
        "stations.os.parts[2].fixed_to: is not known*"},
       {"/cases/2/state", R"({"cap": "off"})",
        "cases[2].state: there is no part 'cap'; there are: os, tube, gripper"},
       {"/cases/2/state", R"({"tube": "hidden"})",
        "cases[2].state.tube: is not one of off, on, matched, occludes, ignored"},
       {"/cases/2/state", R"({"os": "off"})", "cases[2]: no part of its station is matched*"}});
}

TEST_F(ReadDataset, FrameOfAPart_IsJoinedByTheDatasetsTransforms) {
  const json wrist = json::parse(R"({"name": "WRIST", "index": [4]})");
  folder_.write("wrist.json", R"({"format": "boresight-transform", "version": 1,
      "target": {"name": "CAMERA"}, "source": {"name": "WRIST", "index": [4]},
      "target_from_source": [[1,0,0,0],[0,1,0,0],[0,0,1,0.5],[0,0,0,1]], "comment": "by hand"})");
  const Dataset dataset =
      read(changed(withGripper(), {{"/stations/os/parts/2/frame", wrist},
                                   {"/transforms", json::array({"wrist.json"})}}));
  const Case& shown = *dataset.findCase("c");
  const PartSource placed = placedPart(partsOf(dataset, shown)[2], framesOf(dataset, shown));
  EXPECT_EQ(placed.frame, kCameraFrame);
  EXPECT_DOUBLE_EQ(placed.frame_from_mesh.translation_m.z(), 0.7);
}

TEST_F(ReadDataset, StatesOfAllCases_AreChangedAtOnce) {
  const Dataset dataset = read(withGripper());
  const Dataset changed = withPartStates(dataset, {{"gripper", "off"}, {"tube", "matched"}});
  const std::vector<PartSource> parts = partsOf(changed, *changed.findCase("c"));
  EXPECT_EQ(parts[1].state, PartState());
  EXPECT_FALSE(parts[2].state.present);
  EXPECT_NE(changed.sha256, dataset.sha256);
  EXPECT_EQ(withPartStates(dataset, {}).sha256, dataset.sha256);
  const auto message = [&](const PartChange& change) {
    return folder_.message([&] { (void)withPartStates(dataset, {change}); });
  };
  EXPECT_EQ(message({"cap", "off"}),
            "dataset.json: stations: no station has a part 'cap'; there are: gripper, model, os, "
            "tube");
  EXPECT_THAT(message({"tube", "hidden"}), HasSubstr("'hidden' is not one of off, on"));
  EXPECT_THAT(message({"os", "off"}), HasSubstr("cases.c: no part of its station is matched"));
  EXPECT_THAT(message({"gripper", "matched"}), HasSubstr("cannot be matched"));
}

TEST_F(ReadDataset, NotesMatricesThatWereProjected) {
  const Dataset dataset =
      read(changed(sampleDataset(), {{"/cases/0/seed/camera_from_station/0/1", 0.00002}}));
  EXPECT_THAT(dataset.notes, ElementsAre(StartsWith("cases[0].seed.camera_from_station: the matrix "
                                                    "is slightly off a rotation")));
}

TEST_F(ReadDataset, MissingFiles_AreFoundBeforeARun) {
  const Dataset dataset = readSample();
  const auto message = [&] { return folder_.message([&] { requireFiles(dataset); }); };
  EXPECT_EQ(message(), "dataset.json: stations.bc: no such file: bc/model.ply");
  for (const char* name : {"bc/model.ply", "os.ply", "tube.glb", "images/a.png", "images/b.png"})
    folder_.write(name, "x");
  EXPECT_EQ(message(), "dataset.json: cases[1].ignore: no such file: masks/b.png");
  std::filesystem::create_directories(folder_ / "masks/b.png");
  EXPECT_EQ(message(), "dataset.json: cases[1].ignore: is a folder: masks/b.png");
  std::filesystem::remove(folder_ / "masks/b.png");
  folder_.write("masks/b.png", "x");
  EXPECT_EQ(message(), "(nothing)");
}

TEST_F(ReadDataset, LoadsTheImageAndMaskOfACase) {
  const Dataset dataset = readSample();
  std::filesystem::create_directory(folder_ / "images");
  std::filesystem::create_directory(folder_ / "masks");
  const std::vector<std::uint8_t> pixels(48, 7);
  writePng(folder_ / "images/b.png", pixels, 8, 6, 1);
  writePng(folder_ / "masks/b.png", pixels, 8, 6, 1);
  writePng(folder_ / "images/a.png", std::span(pixels).first(40), 8, 5, 1);
  EXPECT_EQ(readCaseImage(dataset, dataset.cases[1]).pixels, pixels);
  EXPECT_EQ(readCaseMask(dataset, dataset.cases[1])->ignored_count, 48);
  EXPECT_FALSE(readCaseMask(dataset, dataset.cases[0]).has_value());
  EXPECT_EQ(folder_.message([&] { (void)readCaseImage(dataset, dataset.cases[0]); }),
            "images/a.png: image size: is 8 x 5, but the camera is 8 x 6");
}

}  // namespace
}  // namespace boresight::sessions
