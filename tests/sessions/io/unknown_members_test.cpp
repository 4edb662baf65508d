// SPDX-License-Identifier: Apache-2.0
// A member that a format does not have is refused in every file of ours: a misspelt one would be
// ignored, and the file would mean something else than was meant.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "sessions/io/camera_conversion.h"
#include "sessions/io/camera_file.h"
#include "sessions/io/config_file.h"
#include "sessions/io/dataset_file.h"
#include "sessions/io/frame_transform.h"
#include "sessions/io/pose_file.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

const json kIdentity = json::parse("[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]");
constexpr const char* kUnknown = "is not known to this version of the format";

json camera() {
  return json::parse(
      R"({"format": "boresight-camera", "version": 1, "model": "brown_conrady", "width": 8,
          "height": 6, "fx": 10, "fy": 10, "cx": 3.5, "cy": 2.5, "dist": [0, 0, 0, 0]})");
}

json vectors() {
  return json::parse(
      R"({"format": "boresight-camera", "version": 1, "model": "cahv", "width": 8, "height": 6,
          "C": [0, 0, 0], "A": [0, 0, 1], "H": [10, 0, 3.5], "V": [0, 10, 2.5],
          "reference_frame": {"name": "ROVER", "index": [1]},
          "subframe": {"first_sample": 0, "first_line": 0, "scale": 1}})");
}

json pose() {
  return {{"format", "boresight-pose"},
          {"version", 1},
          {"camera_from_station", kIdentity},
          {"uncertainty",
           {{"translation_m", {1, 1, 1}}, {"rotation_deg", {1, 1, 1}}, {"pivot", "camera"}}}};
}

json transformFile() {
  return {{"format", "boresight-transform"}, {"version", 1},
          {"target", {{"name", "SITE"}}},    {"source", {{"name", "ROVER"}}},
          {"target_from_source", kIdentity}, {"comment", "by hand"}};
}

json dataset() {
  json made = {{"format", "boresight-dataset"},
               {"version", 1},
               {"requirement", {{"normal_mm", 0.4}, {"lateral_mm", 0.4}}}};
  made["stations"]["bc"] = {{"mesh", "bc.ply"}, {"mesh_unit", "m"}};
  made["cameras"]["left"] = camera();
  made["cameras"]["left"].erase("format");
  made["cameras"]["left"].erase("version");
  made["cases"] = {{{"id", "a"},
                    {"station", "bc"},
                    {"image", "a.png"},
                    {"camera", "left"},
                    {"rig", {{"id", "r"}, {"camera_from_rig", kIdentity}}},
                    {"truth", {{"camera_from_station", kIdentity}}},
                    {"seed", {{"camera_from_station", kIdentity}}}}};
  return made;
}

class UnknownMembers : public testing::Test {
 protected:
  template <class Read>
  std::string refusal(Read&& read, json file) const {
    const auto written = folder_.write("f.json", file.dump());
    return folder_.message([&] { (void)read(written); });
  }
  /// What is refused about a file after a member, by its JSON pointer, got another name.
  template <class Read>
  std::string renamed(Read&& read, json file, const std::string& pointer,
                      const std::string& name) const {
    EXPECT_EQ(refusal(read, file), "(nothing)");
    const json::json_pointer whole(pointer);
    json& parent = file[whole.parent_pointer()];
    json value = parent[whole.back()];
    parent.erase(whole.back());
    parent[name] = std::move(value);
    return refusal(read, file);
  }
  template <class Read>
  std::string added(Read&& read, json file, const std::string& pointer) const {
    file[json::json_pointer(pointer)] = 1;
    return refusal(read, file);
  }
  static std::string unknown(const std::string& place, const std::string& meant = "") {
    return "f.json: " + place + ": " + kUnknown +
           (meant.empty() ? "" : "; did you mean \"" + meant + "\"?");
  }

  const test::TemporaryFolder folder_;
};

const auto kReadCamera = [](const std::filesystem::path& file) { return readCameraFile(file); };
const auto kReadPose = [](const std::filesystem::path& file) { return readPose(file); };

TEST_F(UnknownMembers, OfACameraAreRefused) {
  EXPECT_EQ(added(kReadCamera, camera(), "/subframe"), unknown("subframe"));
  EXPECT_EQ(renamed(kReadCamera, camera(), "/dist", "dits"), unknown("dits", "dist"));
  EXPECT_EQ(renamed(kReadCamera, camera(), "/width", "widht"), unknown("widht", "width"));
  EXPECT_EQ(renamed(kReadCamera, vectors(), "/subframe/scale", "scal"),
            unknown("subframe.scal", "scale"));
  EXPECT_EQ(renamed(kReadCamera, vectors(), "/reference_frame/index", "indx"),
            unknown("reference_frame.indx", "index"));
  EXPECT_EQ(added(kReadCamera, vectors(), "/R"), unknown("R"));
}

TEST_F(UnknownMembers, OfACameraThatWasFittedAreKnown) {
  const Camera given = readCamera(folder_.write("f.json", camera().dump()));
  FittedCamera fitted;
  fitted.camera = given;
  writeFittedCamera(folder_ / "fitted.json", fitted, given, "left.IMG", 0.5);
  EXPECT_EQ(readCamera(folder_ / "fitted.json"), given);
}

TEST_F(UnknownMembers, OfAPoseAreRefused) {
  EXPECT_EQ(renamed(kReadPose, pose(), "/uncertainty", "uncertainity"),
            unknown("uncertainity", "uncertainty"));
  EXPECT_EQ(renamed(kReadPose, pose(), "/uncertainty/pivot", "pivott"),
            unknown("uncertainty.pivott", "pivot"));
  EXPECT_EQ(renamed(kReadPose, pose(), "/camera_from_station", "camera_from_staiton"),
            unknown("camera_from_staiton", "camera_from_station"));
}

TEST_F(UnknownMembers, OfAConfigAreRefused) {
  const json config = {{"format", "boresight-config"},
                       {"version", 1},
                       {"profile", "paper"},
                       {"options", {{"pnp.seed", 7}}}};
  EXPECT_EQ(renamed(readConfig, config, "/options", "optoins"), unknown("optoins", "options"));
  EXPECT_EQ(renamed(readConfig, config, "/profile", "Profile"), unknown("Profile", "profile"));
}

TEST_F(UnknownMembers, OfATransformAreRefused) {
  EXPECT_EQ(added(readFrameTransform, transformFile(), "/author"), unknown("author"));
  EXPECT_EQ(added(readFrameTransform, transformFile(), "/target/idnex"),
            unknown("target.idnex", "index"));
}

TEST_F(UnknownMembers, OfADatasetDoNotIncludeTheHeadOfAFileThatWasCopiedIn) {
  json given = dataset();
  given["cameras"]["left"] = camera();
  given["cases"][0]["seed"] = pose();
  EXPECT_EQ(refusal(readDataset, given), "(nothing)");
  given["cases"][0]["seed"]["format"] = "boresight-camera";
  EXPECT_EQ(refusal(readDataset, given),
            "f.json: cases[0].seed.format: is 'boresight-camera', not 'boresight-pose'");
}

TEST_F(UnknownMembers, OfADatasetAreRefused) {
  EXPECT_EQ(renamed(readDataset, dataset(), "/cases/0/truth", "truht"),
            unknown("cases[0].truht", "truth"));
  EXPECT_EQ(renamed(readDataset, dataset(), "/requirement/normal_mm", "normal"),
            unknown("requirement.normal", "normal_mm"));
  EXPECT_EQ(renamed(readDataset, dataset(), "/cases/0/rig/id", "name"),
            "f.json: cases[0].rig.id: missing");
  EXPECT_EQ(added(readDataset, dataset(), "/stations/bc/matched"), unknown("stations.bc.matched"));
  EXPECT_EQ(added(readDataset, dataset(), "/cases/0/feature_size_m"),
            unknown("cases[0].feature_size_m"))
      << "it is the station's";
  EXPECT_EQ(added(readDataset, dataset(), "/notes"), unknown("notes"));
}

}  // namespace
}  // namespace boresight::sessions
