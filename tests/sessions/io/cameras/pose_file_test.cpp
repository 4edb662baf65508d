// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/pose_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "core/base/math.h"
#include "core/base/random.h"
#include "tests/sessions/io/folder_test.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

std::string poseText(const std::string& matrix, const std::string& rest = "") {
  return R"({"format": "boresight-pose", "version": 1, "camera_from_station": )" + matrix + rest +
         "}";
}

class ReadPose : public FolderTest {
 protected:
  PoseFile read(const std::string& text) { return readPose(folder_.write("seed.json", text)); }
  std::string error(const std::string& text) {
    return folder_.message([&] { (void)read(text); });
  }
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
  const DeclaredUncertainty expected{{0.01, 0.02, 0.03}, {1, 2, 3}, UncertaintyPivot::kStation};
  EXPECT_TRUE(pose.uncertainty == expected);

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

TEST_F(ReadPose, WrittenPoseAndUncertainty_AreReadBack) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d axis(random.normal(), random.normal(), random.normal());
    const Pose pose{rotationExp(axis.normalized() * random.uniform(0.0, kPi)),
                    test::randomVector(random, 1.0)};
    const DeclaredUncertainty uncertainty{
        {random.uniform(), random.uniform(), 0.0},
        {random.uniform(), 5.5, random.uniform()},
        i % 2 == 0 ? UncertaintyPivot::kCamera : UncertaintyPivot::kStation};
    writePose(folder_ / "pose.json", pose, uncertainty);
    const PoseFile read = readPose(folder_ / "pose.json");
    EXPECT_EQ(read.camera_from_station.translation_m, pose.translation_m);
    EXPECT_LT((read.camera_from_station.matrix() - pose.matrix()).norm(), 2e-15);
    EXPECT_TRUE(read.uncertainty == uncertainty);
  }
}

TEST_F(ReadPose, WrittenCovariance_IsReadBackOrRefused) {
  const auto file = folder_ / "pose.json";
  writePose(file, Pose());
  EXPECT_FALSE(readPose(file).covariance);
  Matrix6d covariance = 1e-6 * Matrix6d::Identity();
  covariance(0, 4) = covariance(4, 0) = 5e-7;
  writePose(file, Pose(), {}, covariance);
  EXPECT_EQ(readPose(file).covariance, covariance);
  Matrix6d asymmetric = covariance, negative = covariance;
  asymmetric(0, 4) = 0.0;
  negative(2, 2) = -1e-6;
  for (const Matrix6d& none : {asymmetric, negative}) {
    writePose(file, Pose(), {}, none);
    EXPECT_THAT(folder_.message([&] { readPose(file); }),
                HasSubstr("covariance: not a covariance"));
  }
}

TEST(SeedUncertaintyOf, TurnsDegreesAndThePivotIntoTheCoresTerms) {
  DeclaredUncertainty declared{{0.01, 0.02, 0.03}, {180, 90, 5}};
  const Pose camera_from_station{Eigen::Quaterniond::Identity(), {0, 0, 0.4}};
  const Eigen::Vector3d centre(0.1, 0.2, 0.3);
  const SeedUncertainty camera = seedUncertainty(declared, camera_from_station, centre);
  EXPECT_EQ(camera.pivot_in_camera_m, Eigen::Vector3d::Zero());
  EXPECT_EQ(camera.translation_m, declared.translation_m);
  EXPECT_TRUE(camera.rotation_rad.isApprox(Eigen::Vector3d(kPi, kPi / 2, kPi / 36), 1e-15));
  declared.pivot = UncertaintyPivot::kStation;
  const SeedUncertainty station = seedUncertainty(declared, camera_from_station, centre);
  EXPECT_TRUE(station.pivot_in_camera_m.isApprox(Eigen::Vector3d(0.1, 0.2, 0.7), 1e-15));
}

TEST_F(ReadPose, ValidatedPoseFile_IsReadAsAPose) {
  const PoseFile pose = read(R"({
    "format": "boresight-validated-pose", "version": 1, "state": "validated",
    "pose": {"source": "run", "camera_from_station": [[1,0,0,0.1],[0,1,0,0.2],[0,0,1,0.3],[0,0,0,1]],
             "covariance": [[1,0,0,0,0,0],[0,1,0,0,0,0],[0,0,1,0,0,0],
                            [0,0,0,1,0,0],[0,0,0,0,1,0],[0,0,0,0,0,2]]}})");
  EXPECT_EQ(pose.camera_from_station.translation_m, Eigen::Vector3d(0.1, 0.2, 0.3));
  ASSERT_TRUE(pose.covariance);
  EXPECT_EQ((*pose.covariance)(5, 5), 2.0);
  EXPECT_FALSE(pose.uncertainty);
}

}  // namespace
}  // namespace boresight::sessions
