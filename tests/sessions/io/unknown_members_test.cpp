// SPDX-License-Identifier: Apache-2.0
// A member that a format does not have is refused in every file of ours: a misspelt one would be
// ignored, and the file would mean something else than was meant.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "sessions/io/cameras/camera_conversion.h"
#include "sessions/io/cameras/frame_transform.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/io/json/config_file.h"
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
  json result = {{"format", "boresight-dataset"},
                 {"version", 1},
                 {"requirement", {{"normal_mm", 0.4}, {"lateral_mm", 0.4}}}};
  result["stations"]["bc"] = {{"mesh", "bc.ply"}, {"mesh_unit", "m"}};
  result["cameras"]["left"] = camera();
  result["cameras"]["left"].erase("format");
  result["cameras"]["left"].erase("version");
  result["cases"] = {{{"id", "a"},
                      {"station", "bc"},
                      {"image", "a.png"},
                      {"camera", "left"},
                      {"rig", {{"id", "r"}, {"camera_from_rig", kIdentity}}},
                      {"truth", {{"camera_from_station", kIdentity}}},
                      {"seed", {{"camera_from_station", kIdentity}}}}};
  return result;
}

class UnknownMembers : public testing::Test {
 protected:
  template <class Read>
  std::string refusal(Read&& read, const json& file) const {
    const auto written = folder_.write("f.json", file.dump());
    return folder_.message([&] { (void)read(written); });
  }
  /// Expects that a member which the format does not have is refused in each of these objects.
  template <class Read>
  void expectRefused(Read&& read, const json& file, std::initializer_list<const char*> objects) {
    EXPECT_EQ(refusal(read, file), "(nothing)");
    for (const char* object : objects) {
      json changed = file;
      changed[json::json_pointer(object)]["wrong"] = 1;
      EXPECT_THAT(refusal(read, changed), testing::HasSubstr(std::string("wrong: ") + kUnknown))
          << object;
    }
  }

  const test::TemporaryFolder folder_;
};

const auto kReadCamera = [](const std::filesystem::path& file) { return readCameraFile(file); };
const auto kReadPose = [](const std::filesystem::path& file) { return readPose(file); };

TEST_F(UnknownMembers, OfEveryObject_AreRefused) {
  expectRefused(kReadCamera, camera(), {""});
  expectRefused(kReadCamera, vectors(), {"", "/subframe", "/reference_frame"});
  expectRefused(kReadPose, pose(), {"", "/uncertainty"});
  expectRefused(readConfig, {{"format", "boresight-config"}, {"version", 1}}, {""});
  expectRefused([](const auto& file) { return readFrameTransforms(file); }, transformFile(), {"", "/target", "/source"});
  expectRefused(readDataset, dataset(),
                {"", "/cases/0", "/cases/0/rig", "/cases/0/seed", "/stations/bc", "/requirement"});
}

TEST_F(UnknownMembers, Refusal_NamesTheMembersThatAreNotGiven) {
  json misspelt = pose();
  misspelt["uncertainty"]["pivott"] = "camera";
  misspelt["uncertainty"].erase("pivot");
  EXPECT_EQ(refusal(kReadPose, misspelt),
            std::string("f.json: uncertainty.pivott: ") + kUnknown + ", which also has: pivot");
}

TEST_F(UnknownMembers, OfACameraThatWasFittedAreKnown) {
  const Camera given = readCamera(folder_.write("f.json", camera().dump()));
  FittedCamera fitted;
  fitted.camera = given;
  writeFittedCamera(folder_ / "fitted.json", fitted, given, "left.IMG", 0.5);
  EXPECT_EQ(readCamera(folder_ / "fitted.json"), given);
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

}  // namespace
}  // namespace boresight::sessions
