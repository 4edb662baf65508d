// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/named_poses.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "sessions/io/json/json_writer.h"
#include "tests/sessions/session/example_session.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

using namespace sessions;

const FrameName kRover{"ROVER", {}};
const FrameName kSite{"SITE", {3}};

FrameTransform joined(const FrameName& target, const FrameName& source, const Pose& pose,
                      const char* file) {
  FrameTransform transform = shifted(target, source, 0.0);
  transform.target_from_source = pose;
  transform.file = file;
  transform.file_sha256 = std::string(64, 'a');
  return transform;
}

/// A camera joined to the rover and by it to the site.
struct NamedCase {
  Random random = randomFor("NamedPoses");
  Pose rover_from_camera = randomPose(random);
  Pose site_from_rover = randomPose(random, 5.0);
  Pose camera_from_station = randomPose(random);
  SessionCase item;

  NamedCase() {
    item.frames = {joined(kRover, kCameraFrame, rover_from_camera, "/data/arm.json"),
                   joined(kSite, kRover, site_from_rover, "/data/drive.json")};
  }
  std::vector<NamedPose> poses(const std::optional<Matrix6d>& covariance = {}) const {
    return namedPoses(item, camera_from_station, covariance);
  }
};

TEST(NamedPoses, EachJoinedFrame_HasThePoseOfTheStation) {
  NamedCase named;
  EXPECT_THAT(namedPoses(SessionCase(), Pose()), IsEmpty());
  const auto poses = named.poses();
  ASSERT_EQ(poses.size(), 2u);
  for (const NamedPose& pose : poses) {
    const bool rover = pose.frame == kRover;
    EXPECT_TRUE(rover || pose.frame == kSite);
    const Pose of_rover = named.rover_from_camera * named.camera_from_station;
    EXPECT_THAT(pose.reference_from_station,
                poseNear(rover ? of_rover : named.site_from_rover * of_rover, 1e-12, 1e-12));
    EXPECT_FALSE(pose.covariance);
    EXPECT_THAT(pose.joined_by, HasSubstr("arm.json: by hand"));
    EXPECT_EQ(pose.joined_by.find("; ") == std::string::npos, rover);
  }
}

TEST(NamedPoses, FrameOfTheSeed_ComesLast) {
  NamedCase named;
  for (const FrameName& frame : {kRover, kSite}) {
    named.item.station_frame = frame;
    EXPECT_EQ(named.poses().back().frame, frame);
    EXPECT_EQ(named.poses().size(), 2u);
  }
}

TEST(NamedPoses, CameraModelsFrame_CountsWithAndWithoutAName) {
  NamedCase named;
  named.item.frames.clear();
  CameraReference& reference = named.item.camera_reference.emplace();
  reference.camera_from_reference = named.rover_from_camera.inverse();
  for (const char* name : {"", "MAST"}) {
    reference.frame.name = name;
    const auto poses = named.poses();
    ASSERT_EQ(poses.size(), 1u) << name;
    EXPECT_EQ(poses[0].frame.name, name);
    EXPECT_EQ(poses[0].joined_by, "") << "the camera model's own";
    EXPECT_THAT(poses[0].reference_from_station,
                poseNear(named.rover_from_camera * named.camera_from_station, 1e-12, 1e-12));
  }
}

/// A small motion of the pose in the camera's frame is one in the rover's: by differences.
TEST(NamedPoses, Covariance_IsThatOfThePoseInItsFrame) {
  NamedCase named;
  const Vector6d sigma = (Vector6d() << 1e-3, 2e-3, 3e-3, 1e-3, 4e-3, 2e-3).finished();
  const Matrix6d covariance = sigma.cwiseAbs2().asDiagonal();
  named.item.frames.pop_back();
  Matrix6d motion;
  constexpr double kStep = 1e-6;
  const Pose before = named.rover_from_camera * named.camera_from_station;
  for (int i = 0; i < 6; ++i) {
    const Pose moved = perturbed(kStep * Vector6d::Unit(i), named.camera_from_station);
    motion.col(i) = perturbationBetween(before, named.rover_from_camera * moved) / kStep;
  }
  const Matrix6d expected = motion * covariance * motion.transpose();
  ASSERT_TRUE(named.poses(covariance)[0].covariance);
  EXPECT_LT((*named.poses(covariance)[0].covariance - expected).norm(), 1e-4 * expected.norm());
  const Matrix6d of_arm = 1e-4 * Matrix6d::Identity();
  named.item.frames[0].covariance = of_arm;
  EXPECT_GT((*named.poses(covariance)[0].covariance - expected).diagonal().minCoeff(), 0.0)
      << "the arm's is added";
}

TEST(NamedPoses, Json_HasAnEntryPerFrame) {
  NamedCase named;
  const nlohmann::ordered_json json = toJson(named.poses());
  EXPECT_EQ(json.size(), 2u);
  EXPECT_FALSE(json["ROVER"].contains("covariance"));
  EXPECT_EQ(json["ROVER"]["joined_by"], "arm.json: by hand");
  EXPECT_TRUE(toJson(named.poses(Matrix6d::Identity()))["SITE (3)"].contains("covariance"));
  NamedPose plain{kSite, Pose(), std::nullopt, ""};
  EXPECT_FALSE(toJson(std::vector{plain})["SITE (3)"].contains("joined_by"));
  EXPECT_EQ(namedPoseTitle(plain), "reference_from_station in SITE (3)");
}

TEST(FrameLines, NameTheFramesOfCameraSeedAndTruth) {
  NamedCase named;
  EXPECT_THAT(frameLines(SessionCase()), IsEmpty());
  EXPECT_THAT(frameLines(named.item), IsEmpty());
  named.item.station_frame = kSite;
  named.item.truth_frame = kRover;
  const auto lines = frameLines(named.item);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].name, "station given in");
  EXPECT_THAT(lines[0].value, AllOf(StartsWith("SITE (3), joined by "), HasSubstr("drive.json")));
  EXPECT_EQ(lines[1], (LabelItem{"truth given in", "ROVER, joined by arm.json: by hand"}));
  named.item.station_frame = FrameName{"ELSEWHERE", {}};
  EXPECT_EQ(frameLines(named.item)[0].value, "ELSEWHERE");
  CameraReference& reference = named.item.camera_reference.emplace();
  reference.frame = FrameName{"MAST", {}};
  reference.camera_from_reference.translation_m = {-0.5, 0.25, -1.0};
  EXPECT_EQ(frameLines(named.item)[0],
            (LabelItem{"camera model in", "MAST, its centre at 0.5000 -0.2500 1.0000 m"}));
}

}  // namespace
}  // namespace boresight::test
