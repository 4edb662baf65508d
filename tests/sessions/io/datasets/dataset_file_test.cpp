// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/datasets/dataset_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "core/base/math.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using boresight::test::TemporaryFolder;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

json transform(double z_m) {
  return json::parse("[[1,0,0,0],[0,1,0,0],[0,0,1," + std::to_string(z_m) + "],[0,0,0,1]]");
}

json uncertainty(double translation_m, const char* pivot = "camera") {
  return {{"translation_m", {translation_m, translation_m, translation_m}},
          {"rotation_deg", {5, 5, 5}},
          {"pivot", pivot}};
}

/// Two stations, one in short form and one of two parts; two cases, one that waivers everything.
json sampleDataset() {
  json d = {{"format", "boresight-dataset"}, {"version", 1}};
  d["requirement"] = {{"normal_mm", 0.4}, {"lateral_mm", 0.5}, {"rotation_deg", 0.25}};
  d["stations"]["bc"] = {{"mesh", "bc/model.ply"},
                         {"mesh_unit", "mm"},
                         {"feature_size_m", 0.015},
                         {"uncertainty", uncertainty(0.03)},
                         {"camera_from_end_effector", transform(0.39)}};
  d["stations"]["os"]["parts"] = {{{"mesh", "os.ply"},
                                   {"mesh_unit", "m"},
                                   {"station_from_mesh", transform(1.5)},
                                   {"normal_threshold_deg", 20},
                                   {"depth_threshold_m", 0.002}},
                                  {{"mesh", "tube.glb"}, {"match", false}}};
  d["cameras"]["left"] = {{"model", "pinhole"}, {"width", 8}, {"height", 6}, {"fx", 10.0},
                          {"fy", 10.0},         {"cx", 3.5},  {"cy", 2.5}};
  d["cases"] = {{{"id", "a"},
                 {"station", "bc"},
                 {"image", "images/a.png"},
                 {"camera", "left"},
                 {"seed", {{"camera_from_station", transform(0.4)}}}},
                {{"id", "b"},
                 {"station", "bc"},
                 {"image", "images/b.png"},
                 {"camera", "left"},
                 {"ignore", "masks/b.png"},
                 {"seed", {{"camera_from_station", transform(0.4)}}},
                 {"truth", {{"camera_from_station", transform(0.41)}}},
                 {"rig", {{"id", "pair"}, {"camera_from_rig", transform(0.1)}}},
                 {"tags", {"low_sun", "near"}},
                 {"uncertainty", uncertainty(0.01, "station")},
                 {"requirement", {{"projection_px", 5.0}}},
                 {"camera_from_end_effector", transform(0.2)}}};
  return d;
}

class ReadDataset : public ::testing::Test {
 protected:
  Dataset read(const json& content) {
    return readDataset(folder_.write("dataset.json", content.dump()));
  }
  Dataset readSample() { return read(sampleDataset()); }
  /// The error after `change` was made to a good dataset.
  template <class Change>
  std::string error(Change&& change) {
    json content = sampleDataset();
    change(content);
    return folder_.message([&] { (void)read(content); });
  }
  TemporaryFolder folder_;
};

TEST_F(ReadDataset, ReadsStationsInBothForms) {
  const Dataset dataset = readSample();
  EXPECT_TRUE(dataset.notes.empty());
  ASSERT_EQ(dataset.stations.size(), 2u);
  const Station& bc = dataset.stations.at("bc");
  ASSERT_EQ(bc.parts.size(), 1u);
  EXPECT_EQ(bc.parts[0].mesh, folder_ / "bc/model.ply");
  EXPECT_EQ(bc.parts[0].mesh_unit, "mm");
  EXPECT_TRUE(bc.parts[0].state.matched());
  EXPECT_EQ(bc.parts[0].normal_threshold_rad, ScenePart().normal_threshold_rad);
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
  EXPECT_EQ(dataset.cameras.at("left").width, 8);
}

TEST_F(ReadDataset, KeepsTheAlbedoOfEveryPartThatStatesOne) {
  json content = sampleDataset();
  content["stations"]["bc"]["albedo"] = 0.42;
  content["stations"]["os"]["parts"][1]["albedo"] = 0;
  const Dataset dataset = read(content);
  EXPECT_EQ(dataset.stations.at("bc").parts[0].albedo, 0.42);
  EXPECT_FALSE(dataset.stations.at("os").parts[0].albedo.has_value());
  EXPECT_EQ(dataset.stations.at("os").parts[1].albedo, 0.0);
  for (const double outside : {-0.01, 1.01})
    EXPECT_THAT(error([&](json& d) { d["stations"]["os"]["parts"][0]["albedo"] = outside; }),
                HasSubstr("stations.os.parts[0].albedo"));
}

TEST_F(ReadDataset, GivesACaseWhatItsStationAndTheDatasetSay) {
  const Dataset dataset = readSample();
  ASSERT_EQ(dataset.cases.size(), 2u);
  const Case& a = dataset.cases[0];
  EXPECT_EQ(a.id, "a");
  EXPECT_EQ(a.image, folder_ / "images/a.png");
  EXPECT_FALSE(a.ignore.has_value());
  EXPECT_FALSE(a.truth_camera_from_station.has_value());
  EXPECT_FALSE(a.rig.has_value());
  EXPECT_EQ(a.uncertainty->translation_m.x(), 0.03);
  EXPECT_EQ(a.requirement->lateral_mm, 0.5);
  EXPECT_FALSE(a.requirement->projection_px.has_value());
  EXPECT_EQ(a.camera_from_end_effector->translation_m.z(), 0.39);
}

TEST_F(ReadDataset, SigmasOfMeshCameraAndTruth_AreRead) {
  const Dataset unstated = readSample();
  EXPECT_FALSE(unstated.stations.at("bc").mesh_scale_sigma);
  EXPECT_TRUE(unstated.calibration_sigmas.empty());
  json content = sampleDataset();
  content["stations"]["bc"]["mesh_scale_sigma"] = 0.001;
  content["cameras"]["left"]["calibration_sigma"] = {{"focal_relative", 0.002},
                                                     {"principal_point_px", 0.5}};
  json covariance = json::array();
  for (int row = 0; row < 6; ++row) {
    covariance.push_back(json::array({0, 0, 0, 0, 0, 0}));
    covariance[static_cast<std::size_t>(row)][static_cast<std::size_t>(row)] = 1e-6;
  }
  content["cases"][1]["truth"]["covariance"] = covariance;
  const Dataset dataset = read(content);
  EXPECT_EQ(dataset.stations.at("bc").mesh_scale_sigma, 0.001);
  EXPECT_EQ(dataset.calibration_sigmas.at("left"), (CalibrationSigma{0.002, 0.5}));
  EXPECT_FALSE(unstated.findCase("b")->truth_covariance) << "exact";
  EXPECT_EQ(dataset.findCase("b")->truth_covariance, Matrix6d(1e-6 * Matrix6d::Identity()));
  EXPECT_THAT(error([](json& d) { d["stations"]["bc"]["mesh_scale_sigma"] = 0.2; }),
              HasSubstr("stations.bc.mesh_scale_sigma"));
}

TEST_F(ReadDataset, CaseMembers_OverrideThoseOfTheStation) {
  const Dataset dataset = readSample();
  const Case& b = *dataset.findCase("b");
  EXPECT_EQ(dataset.findCase("c"), nullptr);
  EXPECT_EQ(b.ignore, folder_ / "masks/b.png");
  EXPECT_EQ(b.truth_camera_from_station->translation_m.z(), 0.41);
  EXPECT_EQ(b.rig->id, "pair");
  EXPECT_EQ(b.rig->camera_from_rig.translation_m.z(), 0.1);
  EXPECT_TRUE(b.hasTag("near"));
  EXPECT_FALSE(b.hasTag("far"));
  EXPECT_EQ(b.uncertainty->translation_m.x(), 0.01);
  EXPECT_EQ(b.uncertainty->pivot, UncertaintyPivot::kStation);
  EXPECT_EQ(b.requirement->projection_px, 5.0);
  EXPECT_FALSE(b.requirement->normal_mm.has_value()) << "a requirement is overridden whole";
  EXPECT_EQ(b.camera_from_end_effector->translation_m.z(), 0.2);
}

TEST_F(ReadDataset, NamesThePlaceOfWhatIsWrong) {
  EXPECT_EQ(error([](json& d) { d.erase("stations"); }), "dataset.json: stations: missing");
  EXPECT_EQ(error([](json& d) { d["cases"][1]["station"] = "x"; }),
            "dataset.json: cases[1].station: there is no station 'x'");
  EXPECT_EQ(error([](json& d) { d["cases"][1]["camera"] = "x"; }),
            "dataset.json: cases[1].camera: there is no camera 'x'");
  EXPECT_EQ(error([](json& d) { d["cases"][1]["id"] = "a"; }),
            "dataset.json: cases[1].id: 'a' is given twice");
  EXPECT_EQ(error([](json& d) { d["cases"][0].erase("seed"); }),
            "dataset.json: cases[0].seed: missing");
  EXPECT_EQ(error([](json& d) { d["cases"][0]["image"] = 5; }),
            "dataset.json: cases[0].image: not a string (is a number)");
  EXPECT_THAT(error([](json& d) { d["cases"][1]["truth"]["camera_from_station"][0][0] = 2; }),
              StartsWith("dataset.json: cases[1].truth.camera_from_station: not a rotation"));
  EXPECT_EQ(error([](json& d) { d["cases"][1]["rig"].erase("id"); }),
            "dataset.json: cases[1].rig.id: missing");
  EXPECT_EQ(error([](json& d) { d["cases"][1]["tags"] = "near"; }),
            "dataset.json: cases[1].tags: not a list (is a string)");
  EXPECT_EQ(error([](json& d) { d["cameras"]["left"]["fx"] = 0; }),
            "dataset.json: cameras.left.fx: 0 is outside 0.001 .. 1e+07");
  EXPECT_EQ(error([](json& d) { d["requirement"] = json::object(); }),
            "dataset.json: requirement: names none of normal_mm, lateral_mm, rotation_deg, "
            "projection_px");
  EXPECT_EQ(error([](json& d) { d["requirement"]["normal_mm"] = 0; }),
            "dataset.json: requirement.normal_mm: 0 is not above 0");
}

TEST_F(ReadDataset, TakesDeclaredSymmetries) {
  json d = sampleDataset();
  d["stations"]["bc"]["symmetries"] = {
      {"discrete", {json::parse("[[-1,0,0,0.002],[0,-1,0,0],[0,0,1,0],[0,0,0,1]]")}},
      {"continuous", {{{"axis", {0, 0, 2}}, {"point_m", {0.01, 0, 0}}}, {{"axis", {1, 0, 0}}}}}};
  const Dataset dataset = read(d);
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

TEST_F(ReadDataset, NamesWhatIsWrongInSymmetries) {
  const auto with = [this](const json& symmetries) {
    return error([&](json& d) { d["stations"]["bc"]["symmetries"] = symmetries; });
  };
  EXPECT_THAT(with({{"discrete", {{1, 2, 3}}}}), HasSubstr("stations.bc.symmetries.discrete[0]"));
  EXPECT_THAT(with({{"continuous", {{{"axis", {0, 0, 0}}}}}}),
              HasSubstr("stations.bc.symmetries.continuous[0].axis: has no direction"));
  EXPECT_THAT(with(json::object()), HasSubstr("stations.bc.symmetries: has neither"));
}

/// The sample with a gripper of station os, and a case that shows both.
json withGripper() {
  json d = sampleDataset();
  d["stations"]["os"]["parts"].push_back({{"mesh", "gripper.ply"},
                                          {"mesh_unit", "m"},
                                          {"name", "gripper"},
                                          {"frame", "CAMERA"},
                                          {"frame_from_mesh", transform(0.2)},
                                          {"role", "occludes"},
                                          {"present", false}});
  json shown = d["cases"][0];
  shown["id"] = "c";
  shown["station"] = "os";
  shown["state"] = {{"gripper", "on"}, {"tube", "ignored"}};
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

TEST_F(ReadDataset, NamesWhatIsWrongInAPart) {
  const auto with = [this](const char* member, const json& value) {
    json content = withGripper();
    content["stations"]["os"]["parts"][2][member] = value;
    return folder_.message([&] { (void)read(content); });
  };
  EXPECT_EQ(with("frame", "WRIST"),
            "dataset.json: stations.os.parts[2].frame: WRIST is joined to neither CAMERA nor "
            "STATION: add the transform that joins it (--frames, or transforms of dataset.json)");
  EXPECT_THAT(with("role", "matched"),
              HasSubstr("stations.os.parts[2].role: a part that is fixed to the camera cannot"));
  EXPECT_THAT(with("role", "held"), HasSubstr("stations.os.parts[2].role: 'held' is none of"));
  EXPECT_THAT(with("match", false), HasSubstr("parts[2].match: cannot be combined with 'role'"));
  EXPECT_THAT(with("station_from_mesh", transform(1.0)),
              HasSubstr("parts[2].station_from_mesh: cannot be combined"));
  EXPECT_THAT(with("fixed_to", "CAMERA"), HasSubstr("parts[2].fixed_to: is not known"));
}

TEST_F(ReadDataset, NamesWhatIsWrongInAState) {
  const auto with = [this](const json& state) {
    json content = withGripper();
    content["cases"][2]["state"] = state;
    return folder_.message([&] { (void)read(content); });
  };
  EXPECT_EQ(with({{"cap", "off"}}),
            "dataset.json: cases[2].state: there is no part 'cap'; there are: os, tube, gripper");
  EXPECT_EQ(with({{"tube", "hidden"}}),
            "dataset.json: cases[2].state.tube: is not one of off, on, matched, occludes, ignored");
  EXPECT_THAT(with({{"os", "off"}}), HasSubstr("cases[2]: no part of its station is matched"));
}

TEST_F(ReadDataset, FrameOfAPart_IsJoinedByTheDatasetsTransforms) {
  json content = withGripper();
  content["stations"]["os"]["parts"][2]["frame"] = {{"name", "WRIST"}, {"index", {4}}};
  content["transforms"] = {"wrist.json"};
  folder_.write("wrist.json", json({{"format", "boresight-transform"},
                                    {"version", 1},
                                    {"target", {{"name", "CAMERA"}}},
                                    {"source", {{"name", "WRIST"}, {"index", {4}}}},
                                    {"target_from_source", transform(0.5)},
                                    {"comment", "by hand"}})
                                  .dump());
  const Dataset dataset = read(content);
  const Case& shown = *dataset.findCase("c");
  const PartSource placed =
      placedPart(partsOf(dataset, shown)[2], framesOf(dataset, shown));
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

TEST_F(ReadDataset, NamesWhatIsWrongInAStation) {
  EXPECT_EQ(error([](json& d) { d["stations"]["bc"].erase("mesh_unit"); }),
            "dataset.json: stations.bc.mesh_unit: missing: PLY carries no unit");
  EXPECT_EQ(error([](json& d) { d["stations"]["bc"]["mesh_unit"] = "furlong"; }),
            "dataset.json: stations.bc.mesh_unit: unknown unit 'furlong' (m, dm, cm, mm, um, in, "
            "ft, yd, km)");
  EXPECT_EQ(error([](json& d) { d["stations"]["bc"]["mesh"] = "model.step"; }),
            "dataset.json: stations.bc.mesh: unknown mesh format '.step' (ply, obj, stl, gltf, "
            "glb)");
  EXPECT_EQ(error([](json& d) { d["stations"]["bc"]["parts"] = json::array(); }),
            "dataset.json: stations.bc.mesh: cannot be combined with 'parts'");
  EXPECT_EQ(error([](json& d) { d["stations"]["os"]["parts"] = json::array(); }),
            "dataset.json: stations.os.parts: is empty");
  EXPECT_EQ(error([](json& d) { d["stations"]["os"]["parts"][0]["match"] = false; }),
            "dataset.json: stations.os.parts: no part is to be matched");
  EXPECT_EQ(error([](json& d) { d["stations"]["bc"]["match"] = false; }),
            "dataset.json: stations.bc.match: the station's only part must be matched");
  EXPECT_EQ(error([](json& d) { d["stations"]["os"]["parts"][0]["depth_threshold_m"] = -1; }),
            "dataset.json: stations.os.parts[0].depth_threshold_m: -1 is outside 1e-06 .. 1000");
  EXPECT_EQ(error([](json& d) { d["stations"]["bc"]["feature_size_m"] = 0; }),
            "dataset.json: stations.bc.feature_size_m: 0 is outside 1e-06 .. 100");
  EXPECT_EQ(error([](json& d) { d["stations"]["bc"] = 5; }),
            "dataset.json: stations.bc: not an object (is a number)");
}

TEST_F(ReadDataset, NotesMatricesThatWereProjected) {
  json content = sampleDataset();
  content["cases"][0]["seed"]["camera_from_station"][0][1] = 0.00002;
  const Dataset dataset = read(content);
  ASSERT_EQ(dataset.notes.size(), 1u);
  EXPECT_THAT(dataset.notes[0],
              StartsWith("cases[0].seed.camera_from_station: the matrix is slightly off a rotation"));
}

TEST_F(ReadDataset, MissingFiles_AreFoundBeforeARun) {
  const Dataset dataset = readSample();
  EXPECT_EQ(folder_.message([&] { requireFiles(dataset); }),
            "dataset.json: stations.bc: no such file: bc/model.ply");
  folder_.write("bc/model.ply", "x");
  folder_.write("os.ply", "x");
  folder_.write("tube.glb", "x");
  folder_.write("images/a.png", "x");
  folder_.write("images/b.png", "x");
  EXPECT_EQ(folder_.message([&] { requireFiles(dataset); }),
            "dataset.json: cases[1].ignore: no such file: masks/b.png");
  std::filesystem::create_directories(folder_ / "masks/b.png");
  EXPECT_EQ(folder_.message([&] { requireFiles(dataset); }),
            "dataset.json: cases[1].ignore: is a folder: masks/b.png");
  std::filesystem::remove(folder_ / "masks/b.png");
  folder_.write("masks/b.png", "x");
  EXPECT_EQ(folder_.message([&] { requireFiles(dataset); }), "(nothing)");
}

TEST_F(ReadDataset, LoadsTheImageAndMaskOfACase) {
  const Dataset dataset = readSample();
  std::filesystem::create_directory(folder_ / "images");
  std::filesystem::create_directory(folder_ / "masks");
  const std::vector<std::uint8_t> pixels(48, 7);
  writePng(folder_ / "images/b.png", pixels, 8, 6, 1);
  writePng(folder_ / "masks/b.png", pixels, 8, 6, 1);
  writePng(folder_ / "images/a.png", pixels, 6, 8, 1);
  EXPECT_EQ(readCaseImage(dataset, dataset.cases[1]).pixels, pixels);
  EXPECT_EQ(readCaseMask(dataset, dataset.cases[1])->ignored_count, 48);
  EXPECT_FALSE(readCaseMask(dataset, dataset.cases[0]).has_value());
  EXPECT_EQ(folder_.message([&] { (void)readCaseImage(dataset, dataset.cases[0]); }),
            "images/a.png: image size: is 6 x 8, but the camera is 8 x 6");
}

}  // namespace
}  // namespace boresight::sessions
