// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/pose_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "core/base/math.h"
#include "core/base/random.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using boresight::test::TemporaryFolder;
using testing::HasSubstr;
using ::testing::StartsWith;

std::string poseText(const std::string& matrix, const std::string& rest = "") {
  return R"({"format": "boresight-pose", "version": 1, "camera_from_station": )" + matrix + rest +
         "}";
}

class ReadPose : public ::testing::Test {
 protected:
  PoseFile read(const std::string& text) { return readPose(folder_.write("seed.json", text)); }
  std::string error(const std::string& text) {
    return folder_.message([&] { (void)read(text); });
  }
  TemporaryFolder folder_;
};

TEST_F(ReadPose, ReadsTheMatrixRowMajor) {
  // A quarter turn about z: x of the station is y of the camera.
  const PoseFile pose = read(poseText("[[0,-1,0,0.1],[1,0,0,0.2],[0,0,1,0.3],[0,0,0,1]]"));
  EXPECT_TRUE((pose.camera_from_station * Eigen::Vector3d(1, 0, 0))
                  .isApprox(Eigen::Vector3d(0.1, 1.2, 0.3), 1e-15));
  EXPECT_EQ(pose.rotation_deviation, 0.0);
  EXPECT_FALSE(pose.uncertainty.has_value());
}

TEST_F(ReadPose, ReadsTheUncertainty) {
  const std::string identity = "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]";
  const PoseFile pose = read(poseText(identity, R"(, "uncertainty": {"translation_m": [0.01, 0.02,
      0.03], "rotation_deg": [1, 2, 3], "pivot": "station"})"));
  ASSERT_TRUE(pose.uncertainty.has_value());
  EXPECT_EQ(pose.uncertainty->translation_m, Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_EQ(pose.uncertainty->rotation_deg, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(pose.uncertainty->pivot, UncertaintyPivot::kStation);

  for (const auto& [uncertainty, refusal] : std::vector<std::array<const char*, 2>>{
           {R"({"translation_m": [0.1, 0.1, 0.1]})", "rotation_deg: missing"},
           {R"({"translation_m": [0.1, -0.1, 0.1], "rotation_deg": [1,1,1]})",
            "translation_m[1]: -0.1 is outside 0 .. 1000"},
           {R"({"translation_m": 0.1, "rotation_deg": [1,1,1]})",
            "translation_m: not a list of 3 (is a number)"},
           {R"({"translation_m": [0,0,0], "rotation_deg": [1,1,1], "pivot": "arm"})",
            "pivot: 'arm' is none of 'camera', 'station'"}})
    EXPECT_EQ(error(poseText(identity, std::string(R"(, "uncertainty": )") + uncertainty)),
              std::string("seed.json: uncertainty.") + refusal);
}

TEST_F(ReadPose, RefusesWhatIsNotARigidTransform) {
  for (const auto& [matrix, refusal] : std::vector<std::array<const char*, 2>>{
           {"[[1,0,0],[0,1,0],[0,0,1]]", "not a list of 4 (is a list of 3)"},
           {"[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0.1,0.2,0.3,1]]",
            "the last row is not 0 0 0 1 (the matrix is row-major)"},
           {"[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1000]]", "the last row is not 0 0 0 1"},
           {"[[1,0,0,0],[0,1,0,0],[0,0,-1,0],[0,0,0,1]]", "not a rotation: the determinant is -1"},
           {"[[0,0,0,0],[0,0,0,0],[0,0,0,0],[0,0,0,1]]", "not a rotation: the determinant is 0"},
           {"[[1,0.01,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]", "not a rotation: |R'R - I| is 0.0141"},
           {"[[1.001,0,0,0],[0,1.001,0,0],[0,0,1.001,0],[0,0,0,1]]", "not a rotation"},
           {"[[1000,0,0,0],[0,1000,0,0],[0,0,1000,0],[0,0,0,1]]", "not a rotation"},
           {"[[1,0,0,1e30],[0,1,0,0],[0,0,1,0],[0,0,0,1]]", "the translation exceeds 1e+06 m"}})
    EXPECT_THAT(error(poseText(matrix)),
                StartsWith(std::string("seed.json: camera_from_station: ") + refusal));
}

TEST_F(ReadPose, ProjectsANearlyOrthonormalMatrixAndSaysSo) {
  const PoseFile pose = read(poseText("[[1,0.00003,0,0],[-0.00001,1,0,0],[0,0,1,0.4],[0,0,0,1]]"));
  const Eigen::Matrix3d rotation = pose.camera_from_station.matrix();
  EXPECT_LT((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  // The off-diagonal of R'R - I is 0.00002, twice.
  EXPECT_NEAR(pose.rotation_deviation, 0.00002 * std::sqrt(2.0), 1e-8);
  EXPECT_NE(projectionNote(pose.rotation_deviation), "");
  EXPECT_EQ(projectionNote(5e-7), "");
}

TEST_F(ReadPose, RefusesAPoseInAReferenceFrame) {
  EXPECT_THAT(error(R"({"format": "boresight-pose", "version": 1, "reference_from_station": []})"),
              StartsWith("seed.json: reference_from_station: needs reference_frame, or a camera of "
                         "the CAHV family"));
  EXPECT_EQ(error(R"({"format": "boresight-pose", "version": 1})"),
            "seed.json: camera_from_station: missing");
}

TEST(WritePose, RoundTrips) {
  const TemporaryFolder folder;
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    Pose pose;
    const Eigen::Vector3d axis(random.normal(), random.normal(), random.normal());
    pose.rotation = rotationExp(axis.normalized() * random.uniform(0.0, kPi));
    pose.translation_m =
        Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    DeclaredUncertainty uncertainty;
    uncertainty.translation_m = Eigen::Vector3d(random.uniform(), random.uniform(), 0.0);
    uncertainty.rotation_deg = Eigen::Vector3d(random.uniform(), 5.5, random.uniform());
    uncertainty.pivot = i % 2 == 0 ? UncertaintyPivot::kCamera : UncertaintyPivot::kStation;
    writePose(folder / "pose.json", pose, uncertainty);
    const PoseFile read = readPose(folder / "pose.json");
    EXPECT_EQ(read.camera_from_station.translation_m, pose.translation_m);
    EXPECT_LT((read.camera_from_station.matrix() - pose.matrix()).norm(), 2e-15);
    ASSERT_TRUE(read.uncertainty.has_value());
    EXPECT_EQ(read.uncertainty->translation_m, uncertainty.translation_m);
    EXPECT_EQ(read.uncertainty->rotation_deg, uncertainty.rotation_deg);
    EXPECT_EQ(read.uncertainty->pivot, uncertainty.pivot);
  }
}

TEST(WritePose, KeepsACovarianceAndRefusesWhatIsNone) {
  const TemporaryFolder folder;
  writePose(folder / "pose.json", Pose());
  EXPECT_FALSE(readPose(folder / "pose.json").covariance);
  Matrix6d covariance = 1e-6 * Matrix6d::Identity();
  covariance(0, 4) = covariance(4, 0) = 5e-7;
  writePose(folder / "pose.json", Pose(), {}, covariance);
  EXPECT_EQ(readPose(folder / "pose.json").covariance, covariance);
  const auto message = [&] { return folder.message([&] { readPose(folder / "pose.json"); }); };
  Matrix6d asymmetric = covariance;
  asymmetric(0, 4) = 0.0;
  writePose(folder / "pose.json", Pose(), {}, asymmetric);
  EXPECT_THAT(message(), HasSubstr("covariance: not a covariance"));
  covariance(2, 2) = -1e-6;
  writePose(folder / "pose.json", Pose(), {}, covariance);
  EXPECT_THAT(message(), HasSubstr("covariance: not a covariance"));
}

TEST(SeedUncertaintyOf, TurnsDegreesAndThePivotIntoTheCoresTerms) {
  DeclaredUncertainty declared;
  declared.translation_m = Eigen::Vector3d(0.01, 0.02, 0.03);
  declared.rotation_deg = Eigen::Vector3d(180, 90, 5);
  Pose camera_from_station;
  camera_from_station.translation_m = Eigen::Vector3d(0, 0, 0.4);
  const Eigen::Vector3d centre(0.1, 0.2, 0.3);
  const SeedUncertainty camera = seedUncertainty(declared, camera_from_station, centre);
  EXPECT_EQ(camera.pivot_in_camera_m, Eigen::Vector3d::Zero());
  EXPECT_EQ(camera.translation_m, declared.translation_m);
  EXPECT_TRUE(camera.rotation_rad.isApprox(Eigen::Vector3d(kPi, kPi / 2, kPi / 36), 1e-15));
  declared.pivot = UncertaintyPivot::kStation;
  const SeedUncertainty station = seedUncertainty(declared, camera_from_station, centre);
  EXPECT_TRUE(station.pivot_in_camera_m.isApprox(Eigen::Vector3d(0.1, 0.2, 0.7), 1e-15));
}

TEST(ValidatedPoseFile, IsReadAsAPose) {
  const test::TemporaryFolder folder;
  const PoseFile pose = readPose(folder.write("validated_pose.json", R"({
    "format": "boresight-validated-pose", "version": 1, "state": "validated",
    "pose": {"source": "run", "camera_from_station": [[1,0,0,0.1],[0,1,0,0.2],[0,0,1,0.3],[0,0,0,1]],
             "covariance": [[1,0,0,0,0,0],[0,1,0,0,0,0],[0,0,1,0,0,0],
                            [0,0,0,1,0,0],[0,0,0,0,1,0],[0,0,0,0,0,2]]}})"));
  EXPECT_EQ(pose.camera_from_station.translation_m, Eigen::Vector3d(0.1, 0.2, 0.3));
  ASSERT_TRUE(pose.covariance);
  EXPECT_EQ((*pose.covariance)(5, 5), 2.0);
  EXPECT_FALSE(pose.uncertainty);
}

}  // namespace
}  // namespace boresight::sessions
