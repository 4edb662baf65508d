// SPDX-License-Identifier: Apache-2.0
// A member that a format does not have is refused in every file of ours: a misspelt one would be
// ignored, and the file would mean something else than was meant.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "sessions/io/cameras/frame_transform.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/io/json/config_file.h"
#include "tests/sessions/io/folder_test.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kUnknown = "is not known to this version of the format";

constexpr const char* kCamera =
    R"({"format": "boresight-camera", "version": 1, "model": "brown_conrady", "width": 8,
        "height": 6, "fx": 10, "fy": 10, "cx": 3.5, "cy": 2.5, "dist": [0, 0, 0, 0]})";
constexpr const char* kVectors =
    R"({"format": "boresight-camera", "version": 1, "model": "cahv", "width": 8, "height": 6,
        "C": [0, 0, 0], "A": [0, 0, 1], "H": [10, 0, 3.5], "V": [0, 10, 2.5],
        "reference_frame": {"name": "ROVER", "index": [1]},
        "subframe": {"first_sample": 0, "first_line": 0, "scale": 1}})";
constexpr const char* kPose =
    R"({"format": "boresight-pose", "version": 1,
        "camera_from_station": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]],
        "uncertainty": {"translation_m": [1, 1, 1], "rotation_deg": [1, 1, 1], "pivot": "camera"}})";
constexpr const char* kTransform =
    R"({"format": "boresight-transform", "version": 1, "target": {"name": "SITE"},
        "source": {"name": "ROVER"}, "comment": "by hand",
        "target_from_source": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})";
constexpr const char* kDataset =
    R"({"format": "boresight-dataset", "version": 1,
        "requirement": {"normal_mm": 0.4, "lateral_mm": 0.4},
        "stations": {"bc": {"mesh": "bc.ply", "mesh_unit": "m"}},
        "cameras": {"left": {"model": "pinhole", "width": 8, "height": 6, "fx": 10, "fy": 10,
                             "cx": 3.5, "cy": 2.5}},
        "cases": [{"id": "a", "station": "bc", "image": "a.png", "camera": "left",
          "rig": {"id": "r", "camera_from_rig": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]},
          "truth": {"camera_from_station": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]},
          "seed": {"camera_from_station": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}}]})";

using Read = void (*)(const fs::path&);
constexpr Read kReadCamera = [](const fs::path& file) { (void)readCameraFile(file); };
constexpr Read kReadPose = [](const fs::path& file) { (void)readPose(file); };
constexpr Read kReadDataset = [](const fs::path& file) { (void)readDataset(file); };

class UnknownMembers : public FolderTest {
 protected:
  std::string refusal(Read read, const json& content) const {
    return folder_.message([&] { read(folder_.write("f.json", content.dump())); });
  }
};

TEST_F(UnknownMembers, OfEveryObject_AreRefused) {
  const struct {
    Read read;
    const char* file;
    std::vector<const char*> objects;
  } formats[] = {
      {kReadCamera, kCamera, {""}},
      {kReadCamera, kVectors, {"", "/subframe", "/reference_frame"}},
      {kReadPose, kPose, {"", "/uncertainty"}},
      {[](const fs::path& file) { (void)readConfig(file); },
       R"({"format": "boresight-config", "version": 1})",
       {""}},
      {[](const fs::path& file) { (void)readFrameTransforms(file); },
       kTransform,
       {"", "/target", "/source"}},
      {kReadDataset,
       kDataset,
       {"", "/cases/0", "/cases/0/rig", "/cases/0/seed", "/stations/bc", "/requirement"}}};
  for (const auto& format : formats) {
    const json good = json::parse(format.file);
    EXPECT_EQ(refusal(format.read, good), "(nothing)");
    for (const char* object : format.objects) {
      json changed = good;
      changed[json::json_pointer(object)]["wrong"] = 1;
      EXPECT_THAT(refusal(format.read, changed), testing::HasSubstr("wrong: " + kUnknown))
          << format.file << object;
    }
  }
}

TEST_F(UnknownMembers, Refusal_NamesTheMembersThatAreNotGiven) {
  json misspelt = json::parse(kPose);
  misspelt["uncertainty"]["pivott"] = "camera";
  misspelt["uncertainty"].erase("pivot");
  EXPECT_EQ(refusal(kReadPose, misspelt),
            "f.json: uncertainty.pivott: " + kUnknown + ", which also has: pivot");
}

TEST_F(UnknownMembers, OfADatasetDoNotIncludeTheHeadOfAFileThatWasCopiedIn) {
  json given = json::parse(kDataset);
  given["cameras"]["left"] = json::parse(kCamera);
  given["cases"][0]["seed"] = json::parse(kPose);
  EXPECT_EQ(refusal(kReadDataset, given), "(nothing)");
  given["cases"][0]["seed"]["format"] = "boresight-camera";
  EXPECT_EQ(refusal(kReadDataset, given),
            "f.json: cases[0].seed.format: is 'boresight-camera', not 'boresight-pose'");
}

}  // namespace
}  // namespace boresight::sessions
