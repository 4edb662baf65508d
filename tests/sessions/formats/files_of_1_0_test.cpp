// SPDX-License-Identifier: Apache-2.0
// Files that version 1.0 wrote, which every later version reads with the same content. They are
// never changed: a format that changes gets separate files next to them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "sessions/annotation/annotations_file.h"
#include "sessions/annotation/landmarks.h"
#include "sessions/evaluation/results_file.h"
#include "sessions/io/cameras/frame_transform.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/io/json/config_file.h"
#include "sessions/record/onboard_record.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_file.h"

namespace boresight::test {
namespace {

using namespace sessions;

const std::string kDigest = "7413ccf0758d51a790019f484d24befac89d7c55a0c90e3aebebed4e9db7ac0d";

std::filesystem::path fileOf1_0(const char* name) {
  return std::filesystem::path(BORESIGHT_FORMATS) / "1.0" / name;
}

TEST(FilesOf1_0, CameraPoseAndValidatedPose) {
  const Camera camera = readCamera(fileOf1_0("camera.json"));
  EXPECT_EQ(std::tie(camera.model, camera.width, camera.fx, camera.cy, camera.distortion[1]),
            std::tuple(CameraModel::kBrownConrady, 1024, 1552.5, 509.15, 0.06));
  const Pose truth = readPose(fileOf1_0("pose.json")).camera_from_station;
  EXPECT_EQ(truth.translation_m.z(), 0.41271431107107504);
  const PoseFile validated = readPose(fileOf1_0("validated_pose.json"));
  EXPECT_EQ(validated.camera_from_station.translation_m.z(), 0.4127819421604995);
  ASSERT_TRUE(validated.covariance);
  EXPECT_GT((*validated.covariance)(5, 5), 0.0);
}

TEST(FilesOf1_0, Transforms) {
  const std::vector<FrameTransform> one = readFrameTransforms(fileOf1_0("transform.json"));
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].comment, "localization of sol 12");
  const std::vector<FrameTransform> several = readFrameTransforms(fileOf1_0("frames.json"));
  ASSERT_EQ(several.size(), 3u);
  EXPECT_EQ(several[1].origin, TransformSource::kCalibration);
  EXPECT_EQ(several[1].target_from_source.translation_m.z(), 0.39);
}

TEST(FilesOf1_0, DatasetAndOptions) {
  const Dataset dataset = readDataset(fileOf1_0("dataset.json"));
  EXPECT_EQ(dataset.cases.size(), 2u);
  EXPECT_EQ(dataset.stations.size(), 2u);
  ASSERT_TRUE(dataset.findCase("os-000038"));
  EXPECT_TRUE(dataset.findCase("os-000038")->truth_camera_from_station);
  LocalizerOptions options;
  applyConfig(options, readConfig(fileOf1_0("config.json")));
  EXPECT_EQ(options.pnp.seed, 7);
  EXPECT_EQ(options.loop.max_iterations, 5);
}

TEST(FilesOf1_0, Annotations) {
  const Annotations points = readAnnotations(fileOf1_0("points.json"));
  ASSERT_EQ(points.points.size(), 13u);
  ASSERT_TRUE(points.points[0].complete());
  EXPECT_EQ(*points.points[0].pixel, Eigen::Vector2d(380.36, 660.13));
  EXPECT_EQ(points.points[0].sigma_px, 0.3);
  EXPECT_EQ(readAnnotations(fileOf1_0("points.csv")), points);
  const std::vector<Landmark> landmarks = readLandmarks(fileOf1_0("landmarks.json"));
  ASSERT_EQ(landmarks.size(), 13u);
  EXPECT_EQ(landmarks[0].point_in_station_m, *points.points[0].point_in_station_m);
}

TEST(FilesOf1_0, Session) {
  const Session session = readSessionFile(fileOf1_0("session.boresight.json")).session;
  ASSERT_EQ(session.cases.size(), 2u);
  EXPECT_EQ(session.runs.size(), 2u);
  const Decision* decision = session.decisionOn("bc-000028");
  ASSERT_TRUE(decision);
  EXPECT_EQ(std::tie(decision->verdict, decision->by, decision->digest),
            std::tuple(Verdict::kValidated, "A. Operator", kDigest));
  const Recovery recovery = readWholeJournal(fileOf1_0("journal"));
  EXPECT_EQ(recovery.edits, (std::vector<std::string>{"Rename", "Rename"}));
}

TEST(FilesOf1_0, Record) {
  const OnboardRecord record = readRecord(fileOf1_0("run.whsr"));
  EXPECT_TRUE(record.whole()) << record.missing.front();
  ASSERT_TRUE(record.end);
  EXPECT_GT(record.iterations.size(), 0u);
}

TEST(FilesOf1_0, Results) {
  const Results results = readResults(fileOf1_0("results.sqlite"));
  ASSERT_EQ(results.runs.size(), 2u);
  const auto& run = results.runs[0];
  EXPECT_EQ(std::tie(run.case_id, run.digest, run.completed),
            std::tuple("bc-000028", kDigest, true));
  EXPECT_EQ(results.facts.batch_runs.front().version, "1.0.0");
}

}  // namespace
}  // namespace boresight::test
