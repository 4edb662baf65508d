// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/frame_transform.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/math.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/json/json_writer.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using boresight::test::TemporaryFolder;
using ::testing::EndsWith;
using ::testing::HasSubstr;

const FrameName kRover{"ROVER_FRAME", {194, 835, 1}};
const FrameName kSite194{"SITE_FRAME", {194}};
const nlohmann::ordered_json kSiteJson =
    nlohmann::ordered_json::parse(R"({"name": "SITE_FRAME", "index": [194]})");

/// From the rover to the site: a quarter turn about z, and then some way.
nlohmann::ordered_json transformJson() {
  return nlohmann::ordered_json::parse(R"({"format": "boresight-transform", "version": 1,
      "target": {"name": "SITE_FRAME", "index": [194]},
      "source": {"name": "ROVER_FRAME", "index": [194, 835, 1]},
      "target_from_source": [[0,-1,0,10],[1,0,0,20],[0,0,1,-3],[0,0,0,1]],
      "comment": "localization of sol 12"})");
}

/// A camera whose model is in the rover's frame, 1 m above its origin and looking along its x.
CameraReference roverCamera() {
  Eigen::Matrix3d camera_from_rover;
  camera_from_rover << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  CameraReference reference;
  reference.camera_from_reference.rotation = Eigen::Quaterniond(camera_from_rover);
  reference.camera_from_reference.translation_m = {0.0, 1.0, 0.0};
  reference.frame = kRover;
  return reference;
}

class FrameTransforms : public ::testing::Test {
 protected:
  FrameTransform transform() {
    return readFrameTransforms(folder_.write("sol12.json", transformJson().dump())).front();
  }
  std::string error(const nlohmann::ordered_json& json) {
    const auto file = folder_.write("t.json", json.dump());
    return folder_.message([&] { (void)readFrameTransforms(file); });
  }
  /// A pose of the station at (1, 2, 3) of `frame`, its axes along the frame's.
  PoseFile read(const nlohmann::ordered_json& frame, const PoseFrames& frames) {
    nlohmann::ordered_json json = {{"format", "boresight-pose"}, {"version", 1}};
    json["reference_from_station"] = toJson(Pose{Eigen::Quaterniond::Identity(), {1, 2, 3}});
    if (!frame.is_null()) json["reference_frame"] = frame;
    return readPose(folder_.write("seed.json", json.dump()), frames);
  }
  std::string poseError(const nlohmann::ordered_json& frame, const PoseFrames& frames) {
    return folder_.message([&] { (void)read(frame, frames); });
  }
  TemporaryFolder folder_;
};

TEST_F(FrameTransforms, SaysWhatItIs) {
  const FrameTransform read = transform();
  EXPECT_EQ(read.target, kSite194);
  EXPECT_EQ(read.source, kRover);
  EXPECT_EQ(read.comment, "localization of sol 12");
  EXPECT_LT(
      (read.target_from_source * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(10, 21, -3)).norm(),
      1e-12);
  EXPECT_NE(read.file_sha256, "");
}

TEST_F(FrameTransforms, WrittenTransformReadsBackTheSame) {
  FrameTransform written;
  written.target = kSite194;
  written.source = kRover;
  written.target_from_source = {Eigen::Quaterniond(0.9, 0.1, -0.2, 0.3).normalized(), {1, 2, 3}};
  written.covariance = Matrix6d::Identity() * 1e-6 + Matrix6d::Constant(1e-7);
  written.origin = TransformSource::kCalibration;
  written.comment = "12 postures";
  const auto file = folder_ / "hand_eye.json";
  writeFrameTransform(file, written);
  FrameTransform read = readFrameTransforms(std::filesystem::path(file)).front();
  EXPECT_LT(perturbationBetween(read.target_from_source, written.target_from_source).norm(), 1e-15);
  EXPECT_LT((*read.covariance - *written.covariance).norm(), 1e-15);
  EXPECT_EQ(read.file, file);
  read.target_from_source = written.target_from_source;
  read.covariance = written.covariance;
  read.file.clear();
  read.file_sha256.clear();
  EXPECT_EQ(read, written);
  written.covariance.reset();
  written.origin = TransformSource::kUnstated;
  writeFrameTransform(file, written);
  EXPECT_FALSE(readFrameTransforms(std::filesystem::path(file)).front().covariance);
}

TEST_F(FrameTransforms, NamesWhatIsWrong) {
  for (const char* key : {"target", "source", "target_from_source"}) {
    nlohmann::ordered_json json = transformJson();
    json.erase(key);
    EXPECT_EQ(error(json), std::string("t.json: ") + key + ": missing");
  }
  nlohmann::ordered_json json = transformJson();
  json["source"] = json["target"];
  EXPECT_EQ(error(json), "t.json: source: is the same frame as the target");
  json = transformJson();
  json["target_from_source"][0][0] = 3.0;
  EXPECT_THAT(error(json), HasSubstr("target_from_source: not a rotation"));
  json = transformJson();
  json["target"]["name"] = "";
  EXPECT_THAT(error(json), HasSubstr("t.json: target.name"));
  json = transformJson();
  json.erase("comment");
  const auto file = folder_.write("t.json", json.dump());
  EXPECT_EQ(readFrameTransforms(file).front().comment, "t.json") << "named by its file";
}

TEST_F(FrameTransforms, MoreThanTheLimit_AreRefused) {
  nlohmann::ordered_json json = {{"format", "boresight-frames"}, {"version", 1}};
  nlohmann::ordered_json item = transformJson();
  item.erase("format");
  item.erase("version");
  for (std::size_t i = 0; i < kMostFrameTransforms; ++i) {
    item["target"]["name"] = "FRAME_" + std::to_string(i);
    item["source"]["name"] = "FRAME_" + std::to_string(i + 1);
    json["transforms"].push_back(item);
  }
  const std::filesystem::path file = folder_.write("t.json", json.dump());
  EXPECT_EQ(readFrameTransforms(file).size(), kMostFrameTransforms);
  const std::vector<std::string> both = {
      file.string(), folder_.write("other.json", transformJson().dump()).string()};
  EXPECT_THAT(folder_.message([&] { (void)readFrameTransforms(both); }),
              HasSubstr("201 exceed the limit of 200"));
  json["transforms"].push_back(item);
  EXPECT_THAT(error(json), HasSubstr("t.json: transforms: 201 exceed the limit of 200"));
}

TEST_F(FrameTransforms, BringAPoseToTheCameraEitherWayRound) {
  const CameraReference camera = roverCamera();
  // By hand: (1, 2, 3) of the site less (10, 20, -3), turned back by a quarter.
  const Eigen::Vector3d in_rover(2.0 - 20.0, -(1.0 - 10.0), 6.0);
  const Eigen::Vector3d in_camera = camera.camera_from_reference * in_rover;
  const FrameTransform forward = transform();
  FrameTransform backward = forward;
  std::swap(backward.target, backward.source);
  backward.target_from_source = forward.target_from_source.inverse();
  for (const FrameTransform& given : {forward, backward}) {
    const PoseFile pose = read(kSiteJson, {camera, {given}});
    EXPECT_LT((pose.camera_from_station.translation_m - in_camera).norm(), 1e-12);
    EXPECT_EQ(pose.station_frame, kSite194);
  }
}

TEST_F(FrameTransforms, ThatContradictEachOtherAreRefused) {
  const FrameTransform first = transform();
  FrameTransform second = first;
  second.file = "sol13.json";
  second.target_from_source.translation_m.x() += 5e-7;  // rounded otherwise
  EXPECT_EQ(read(kSiteJson, {roverCamera(), {second, first}}).station_frame, kSite194);
  for (const bool inverse : {false, true}) {
    second = first;
    second.file = "sol13.json";
    second.target_from_source.translation_m.x() += 0.02;
    if (inverse) {
      std::swap(second.target, second.source);
      second.target_from_source = second.target_from_source.inverse();
    }
    EXPECT_THAT(poseError(kSiteJson, {roverCamera(), {first, second}}),
                HasSubstr("of sol12.json; the two differ by 20.000 mm and 0.000 deg; give only "
                          "the valid one"));
  }
}

TEST_F(FrameTransforms, AreNotAskedForInTheCamerasOwnFrame) {
  const CameraReference camera = roverCamera();
  const Eigen::Vector3d in_camera = camera.camera_from_reference * Eigen::Vector3d(1, 2, 3);
  for (const nlohmann::ordered_json& frame :
       {nlohmann::ordered_json(), transformJson()["source"]}) {
    const PoseFile pose = read(frame, {camera, {}});
    EXPECT_LT((pose.camera_from_station.translation_m - in_camera).norm(), 1e-12);
    EXPECT_EQ(pose.station_frame, kRover);
  }
}

TEST_F(FrameTransforms, FramesOfOneNameAndAnotherIndexAreTwo) {
  const CameraReference camera = roverCamera();
  const auto later =
      nlohmann::ordered_json::parse(R"({"name": "ROVER_FRAME", "index": [194, 840, 0]})");
  EXPECT_THAT(poseError(later, {camera, {}}),
              EndsWith("seed.json: reference_frame: the pose is given in ROVER_FRAME (194, 840, "
                       "0), but the camera model in ROVER_FRAME (194, 835, 1); give the transform "
                       "between the two (transform.json)"));
  EXPECT_THAT(poseError(later, {camera, {transform()}}),
              HasSubstr("sol12.json leads from ROVER_FRAME (194, 835, 1) to SITE_FRAME (194)"));
  EXPECT_THAT(poseError({{"name", "ROVER_FRAME"}}, {camera, {}}),
              HasSubstr("the pose is given in ROVER_FRAME, but"));
}

TEST_F(FrameTransforms, AreNeverGuessed) {
  CameraReference nameless = roverCamera();
  nameless.frame = {};
  EXPECT_THAT(poseError(kSiteJson, {nameless, {transform()}}), HasSubstr("a frame without a name"));
  EXPECT_THAT(poseError(kSiteJson, {std::nullopt, {transform()}}),
              HasSubstr("no transforms join it and CAMERA"));
  const std::string begin = R"({"format": "boresight-pose", "version": 1, "camera_from_station":
         [[1,0,0,0],[0,1,0,0],[0,0,1,1],[0,0,0,1]], )";
  const auto message = [&](const std::string& rest) {
    const auto file = folder_.write("seed.json", begin + rest + "}");
    return folder_.message([&] { (void)readPose(file, {roverCamera(), {}}); });
  };
  EXPECT_THAT(message(R"("reference_frame": {"name": "SITE_FRAME"})"),
              HasSubstr("reference_frame: belongs to reference_from_station"));
  EXPECT_THAT(message(R"("reference_from_station": [[1,0,0,0],[0,1,0,0],[0,0,1,1],[0,0,0,1]])"),
              HasSubstr("reference_from_station: cannot be combined with camera_from_station"));
}

}  // namespace
}  // namespace boresight::sessions
