// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/frame_transform.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/math.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/json/json_writer.h"
#include "tests/sessions/io/cameras/joined_frames.h"
#include "tests/sessions/io/folder_test.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using Json = nlohmann::ordered_json;

const FrameName kRover{"ROVER_FRAME", {194, 835, 1}};
const FrameName kSite194{"SITE_FRAME", {194}};
const Json kSiteJson = Json::parse(R"({"name": "SITE_FRAME", "index": [194]})");

/// From the rover to the site: a quarter turn about z, and then some way.
Json transformJson() {
  return Json::parse(R"({"format": "boresight-transform", "version": 1,
      "target": {"name": "SITE_FRAME", "index": [194]},
      "source": {"name": "ROVER_FRAME", "index": [194, 835, 1]},
      "target_from_source": [[0,-1,0,10],[1,0,0,20],[0,0,1,-3],[0,0,0,1]],
      "comment": "localization of sol 12"})");
}

/// A camera whose model is in the rover's frame, 1 m above its origin and looking along its x.
CameraReference roverCamera() {
  Eigen::Matrix3d camera_from_rover;
  camera_from_rover << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return {{Eigen::Quaterniond(camera_from_rover), {0.0, 1.0, 0.0}}, kRover};
}

class FrameTransforms : public FolderTest {
 protected:
  FrameTransform transform() {
    return readFrameTransforms(folder_.write("sol12.json", transformJson().dump())).front();
  }
  std::string error(const Json& json) {
    const auto file = folder_.write("t.json", json.dump());
    return folder_.message([&] { (void)readFrameTransforms(file); });
  }
  /// A pose of the station at (1, 2, 3) of `frame`, turned by a quarter about z.
  PoseFile read(const Json& frame, const PoseFrames& frames) {
    Json json = {{"format", "boresight-pose"}, {"version", 1}};
    json["reference_from_station"] = toJson(Pose{rotationExp({0, 0, kPi / 2}), {1, 2, 3}});
    if (!frame.is_null()) json["reference_frame"] = frame;
    return readPose(folder_.write("seed.json", json.dump()), frames);
  }
  /// A point of that station, and its place in the frame: (1, 2, 3) + (-0.5, 0.25, 1).
  const Eigen::Vector3d point_m_{0.25, 0.5, 1.0}, point_in_frame_m_{0.5, 2.25, 4.0};
  std::string poseError(const Json& frame, const PoseFrames& frames) {
    return folder_.message([&] { (void)read(frame, frames); });
  }
};

TEST_F(FrameTransforms, WrittenTransformReadsBackTheSame) {
  FrameTransform written = test::joining(
      kSite194, kRover, {Eigen::Quaterniond(0.9, 0.1, -0.2, 0.3).normalized(), {1, 2, 3}});
  written.covariance = Matrix6d::Identity() * 1e-6 + Matrix6d::Constant(1e-7);
  written.origin = TransformSource::kCalibration;
  written.comment = "12 postures";
  written.file = folder_ / "hand_eye.json";
  writeFrameTransform(written.file, written);
  FrameTransform read = readFrameTransforms(written.file).front();
  EXPECT_LT(perturbationBetween(read.target_from_source, written.target_from_source).norm(), 1e-15);
  EXPECT_LT((*read.covariance - *written.covariance).norm(), 1e-15);
  EXPECT_NE(read.file_sha256, "");
  read.target_from_source = written.target_from_source;
  read.covariance = written.covariance;
  read.file_sha256.clear();
  EXPECT_EQ(read, written);
  written.covariance.reset();
  written.origin = TransformSource::kUnstated;
  writeFrameTransform(written.file, written);
  EXPECT_FALSE(readFrameTransforms(written.file).front().covariance);
}

TEST_F(FrameTransforms, NamesWhatIsWrong) {
  const auto without = [](const char* key) {
    Json json = transformJson();
    json.erase(key);
    return json;
  };
  for (const char* key : {"target", "source", "target_from_source"})
    EXPECT_EQ(error(without(key)), std::string("t.json: ") + key + ": missing");
  const auto with = [](const char* member, const Json& value) {
    Json json = transformJson();
    json[Json::json_pointer(member)] = value;
    return json;
  };
  EXPECT_EQ(error(with("/source", kSiteJson)), "t.json: source: is the same frame as the target");
  EXPECT_THAT(error(with("/target_from_source/0/0", 3.0)),
              HasSubstr("target_from_source: not a rotation"));
  EXPECT_THAT(error(with("/target/name", "")), HasSubstr("t.json: target.name"));
  const auto file = folder_.write("t.json", without("comment").dump());
  EXPECT_EQ(readFrameTransforms(file).front().comment, "t.json") << "named by its file";
}

TEST_F(FrameTransforms, MoreThanTheLimit_AreRefused) {
  Json json = {{"format", "boresight-frames"}, {"version", 1}};
  Json item = transformJson();
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
  // By hand: (0.5, 2.25, 4) of the site less (10, 20, -3), turned back by a quarter.
  const Eigen::Vector3d in_rover(2.25 - 20.0, -(0.5 - 10.0), 7.0);
  const Eigen::Vector3d in_camera = camera.camera_from_reference * in_rover;
  const FrameTransform forward = transform();
  FrameTransform backward = forward;
  std::swap(backward.target, backward.source);
  backward.target_from_source = forward.target_from_source.inverse();
  for (const FrameTransform& given : {forward, backward}) {
    const PoseFile pose = read(kSiteJson, {camera, {given}});
    EXPECT_LT((pose.camera_from_station * point_m_ - in_camera).norm(), 1e-12);
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
  const Eigen::Vector3d in_camera = camera.camera_from_reference * point_in_frame_m_;
  for (const Json& frame : {Json(), transformJson()["source"]}) {
    const PoseFile pose = read(frame, {camera, {}});
    EXPECT_LT((pose.camera_from_station * point_m_ - in_camera).norm(), 1e-14);
    EXPECT_EQ(pose.station_frame, kRover);
  }
}

TEST_F(FrameTransforms, FramesOfOneNameAndAnotherIndexAreTwo) {
  const CameraReference camera = roverCamera();
  const auto later = Json::parse(R"({"name": "ROVER_FRAME", "index": [194, 840, 0]})");
  EXPECT_THAT(poseError(later, {camera, {}}),
              ::testing::EndsWith(
                  "seed.json: reference_frame: the pose is given in ROVER_FRAME (194, 840, "
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
