// SPDX-License-Identifier: Apache-2.0

#include <functional>
#include <memory>

#include <nlohmann/json.hpp>

#include "core/base/math.h"
#include "sessions/checks/pose_uncertainty.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/review/validated_pose_file.h"
#include "sessions/session/named_poses.h"
#include "tests/sessions/review/judged_case.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using namespace sessions;
using nlohmann::ordered_json;

/// A document without files: the pose of a random case.
struct Handed {
  Session session;
  HandedPose pose;

  explicit Handed(Random& random, const std::function<void(SessionCase&)>& edit = {}) {
    SessionCase session_case = randomCase(random, "a");
    if (edit) edit(session_case);
    session = withCase({}, session_case);
    session.runs.push_back(randomRun(random, "a"));
    pose.case_id = "a";
    pose.run_digest = session.runs.back().digest;
    pose.camera_from_station = randomPose(random);
    pose.review_status = "NOT VALIDATED: converged";
  }
  const SessionCase& sessionCase() const { return *session.findCase("a"); }
  ordered_json json(const std::optional<LocalizationTrace>& run = {}) const {
    return validatedPoseJson(session, pose, run, "/out/validated_pose.json");
  }
};

ordered_json rowsOf(const Eigen::Matrix4d& matrix) {
  ordered_json rows = ordered_json::array();
  for (int row = 0; row < 4; ++row)
    rows.push_back({matrix(row, 0), matrix(row, 1), matrix(row, 2), matrix(row, 3)});
  return rows;
}

TEST(ValidatedPoseJson, Pose_IsWrittenThreeWaysThatAgree) {
  Random random = randomFor("ValidatedPoseJson.Pose");
  for (int trial = 0; trial < 20; ++trial) {
    Handed handed(random);
    Eigen::Quaterniond& rotation = handed.pose.camera_from_station.rotation;
    if (trial == 0) rotation = Eigen::Quaterniond(-0.0, 0.6, 0.8, 0.0);
    const ordered_json pose = handed.json()["pose"];
    const ordered_json& q = pose["camera_from_station_quaternion_wxyz"];
    EXPECT_GE(q[0].get<double>(), 0.0);
    const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
    EXPECT_EQ(q, (ordered_json{sign * rotation.w(), sign * rotation.x(), sign * rotation.y(),
                               sign * rotation.z()}));
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = handed.pose.camera_from_station.matrix();
    matrix.topRightCorner<3, 1>() = handed.pose.camera_from_station.translation_m;
    EXPECT_EQ(pose["camera_from_station"], rowsOf(matrix));
    EXPECT_EQ(pose["station_from_camera"], toJson(handed.pose.camera_from_station.inverse()));
    EXPECT_EQ(pose["source"], "run");
  }
}

TEST(ValidatedPoseJson, Covariance_IsWrittenWhereItIsKnown) {
  Random random = randomFor("ValidatedPoseJson.Covariance");
  for (const bool of_effector : {false, true}) {
    Handed handed(random, [&](SessionCase& item) {
      item.camera_from_end_effector.reset();
      if (of_effector) item.camera_from_end_effector = randomPose(random);
      item.mesh_scale_sigma = 0.002;
      item.calibration_sigma.reset();
    });
    for (const char* member : {"covariance", "covariance_terms", "one_sigma", "input_sigmas"})
      EXPECT_FALSE(handed.json()["pose"].contains(member)) << member;
    EXPECT_EQ(handed.json().contains("end_effector"), of_effector);
    if (of_effector) {
      EXPECT_FALSE(handed.json()["end_effector"].contains("covariance"));
    }
    PoseCovariance& covariance = handed.pose.covariance;
    covariance.picture = 1e-6 * Matrix6d::Identity();
    covariance.mesh_scale = 2e-6 * Matrix6d::Identity();
    covariance.calibration = 4e-6 * Matrix6d::Identity();
    const ordered_json json = handed.json();
    const ordered_json& pose = json["pose"];
    EXPECT_EQ(pose["covariance"], toJson(covariance.total()));
    EXPECT_EQ(pose["covariance_terms"]["calibration"], toJson(covariance.calibration));
    EXPECT_EQ(pose["one_sigma"]["of"], of_effector ? "end effector" : "camera centre");
    EXPECT_EQ(pose["one_sigma"]["rotation_mrad"].size(), 3u);
    EXPECT_EQ(pose["input_sigmas"]["mesh_scale_sigma"], 0.002);
    EXPECT_EQ(pose["input_sigmas"]["mesh_scale_is"], "stated");
    EXPECT_EQ(pose["input_sigmas"]["calibration_is"], "assumed");
    if (of_effector) {
      EXPECT_TRUE(json["end_effector"].contains("correction_to_command"));
    }
  }
  Handed assumed(random, [](SessionCase& item) {
    item.mesh_scale_sigma.reset();
    item.calibration_sigma = StatedCalibration{0.01, 2.0};
  });
  assumed.pose.covariance.picture.setIdentity();
  const ordered_json sigmas = assumed.json()["pose"]["input_sigmas"];
  EXPECT_EQ(sigmas["mesh_scale_is"], "assumed");
  EXPECT_EQ(sigmas["calibration_is"], "stated");
}

TEST(ValidatedPoseJson, EndEffector_GivesItsPoseAndCorrection) {
  Random random = randomFor("ValidatedPoseJson.EndEffector");
  const Handed handed(
      random, [&](SessionCase& item) { item.camera_from_end_effector = randomPose(random); });
  const ordered_json json = handed.json()["end_effector"];
  const Pose& effector = *handed.sessionCase().camera_from_end_effector;
  const Pose station_from_effector = handed.pose.camera_from_station.inverse() * effector;
  const Pose by_seed = handed.sessionCase().camera_from_station_seed.inverse() * effector;
  const Pose correction = by_seed.inverse() * station_from_effector;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(json["station_from_end_effector"][i][3].get<double>(),
                station_from_effector.translation_m[axis], 1e-12);
    EXPECT_NEAR(json["correction_translation_m"][i].get<double>(), correction.translation_m[axis],
                1e-12);
    EXPECT_NEAR(json["correction_rotation_deg"][i].get<double>() * kDegree_rad,
                rotationLog(correction.rotation)[axis], 1e-9);
  }
}

/// Every transform, in order, computed here from what the case has.
TEST(ValidatedPoseJson, Chain_HasEveryTransformThatWasUsed) {
  Random random = randomFor("ValidatedPoseJson.Chain");
  for (int trial = 0; trial < 40; ++trial) {
    Handed handed(random);
    if (trial % 3 == 0) handed.pose.source = PoseSource::kAnnotation;
    const SessionCase& item = handed.sessionCase();
    std::vector<std::string> names = {"camera_from_station_seed"};
    for (const MeshInput& part : item.parts)
      if (part.source.state.used())
        names.push_back(part.source.frame == kStationFrame ? "station_from_mesh"
                                                           : "frame_from_mesh");
    if (item.rig) names.emplace_back("camera_from_rig");
    if (item.camera_reference) names.emplace_back("camera_from_reference");
    names.insert(names.end(), item.frames.size(), "target_from_source");
    if (item.camera_from_end_effector) names.emplace_back("camera_from_end_effector");
    names.emplace_back("camera_from_station");
    const ordered_json json = handed.json();
    std::vector<std::string> written;
    for (const ordered_json& link : json["chain"]) {
      written.push_back(link["name"]);
      EXPECT_NE(link["from"], "");
    }
    EXPECT_EQ(written, names);
    EXPECT_EQ(json["chain"].front()["matrix"], toJson(item.camera_from_station_seed));
    EXPECT_EQ(json["chain"].back()["matrix"], toJson(handed.pose.camera_from_station));
    EXPECT_EQ(json["chain"].back()["from"],
              trial % 3 == 0 ? "the annotations of the case" : "run " + handed.pose.run_digest);
  }
}

TEST(ValidatedPoseJson, Chain_SaysOfWhichFileUnitAndFrameAPartIs) {
  Random random = randomFor("ValidatedPoseJson.Parts");
  Handed handed(random, [](SessionCase& item) {
    item.parts.resize(1);
    item.parts[0].source.mesh = "/data/a.ply";
    item.parts[0].source.mesh_unit = "mm";
    item.parts[0].sha256 = std::string(64, 'a');
    item.parts.push_back(item.parts[0]);
    item.parts[1].source.frame = kCameraFrame;
    item.parts[1].source.mesh_unit = "";
    item.parts[1].source.state.role = PartRole::kOccludes;
  });
  const ordered_json chain = handed.json()["chain"];
  EXPECT_EQ(chain[1]["from"], "a.ply, sha256 " + std::string(64, 'a') + ", in mm");
  EXPECT_THAT(chain[2]["from"].get<std::string>(),
              AllOf(HasSubstr(", in its own unit, in "), testing::EndsWith(", occludes only")));
  handed.session.runs.back().together =
      TogetherRecord{{{"b", "converged"}, {"a", "converged"}}, ""};
  EXPECT_THAT(handed.json()["chain"].back()["from"].get<std::string>(),
              AllOf(StartsWith("run " + handed.pose.run_digest + ", "), HasSubstr("b")));
}

TEST(ValidatedPoseJson, Optional_MembersAreThoseOfTheCase) {
  Random random = randomFor("ValidatedPoseJson.Members");
  for (int trial = 0; trial < 40; ++trial) {
    Handed handed(random);
    if (trial % 2 == 0)
      handed.session = withAnnotations(handed.session, "a", randomAnnotations(random));
    if (trial % 3 == 0) handed.pose.source = PoseSource::kAnnotation;
    const SessionCase& item = handed.sessionCase();
    const ordered_json json = handed.json();
    EXPECT_EQ(json["case"], "a");
    EXPECT_EQ(json["station"], item.station);
    EXPECT_EQ(json["review_status"], handed.pose.review_status);
    EXPECT_EQ(json.contains("requirement"), item.requirement.has_value());
    EXPECT_EQ(json.contains("image_label"), !item.image.label.empty());
    EXPECT_EQ(json.contains("frames"), !namedPoses(item, handed.pose.camera_from_station).empty());
    EXPECT_EQ(json.contains("annotations"), trial % 6 == 0);
    EXPECT_FALSE(json.contains("run"));
    const ordered_json& sha256 = json["sha256"];
    EXPECT_EQ(sha256["image_file"], item.image.source.sha256);
    EXPECT_EQ(sha256["image_pixels"], item.image.pixels_sha256);
    EXPECT_EQ(sha256["meshes"].size(), item.parts.size());
    EXPECT_EQ(sha256.contains("ignore"), item.ignore.has_value());
    EXPECT_EQ(sha256.contains("onboard_record"), item.onboard_record.has_value());
    EXPECT_EQ(json["checksum"], checksumOf(ordered_json::parse(prettyJson(json))));
  }
}

TEST(ValidatedPoseJson, Decision_IsNamedWhileItHolds) {
  Random random = randomFor("ValidatedPoseJson.Decision");
  JudgedCase judged(random);
  judged.session.review.second_person = true;
  Session session = judged.validatedBy("Ada");
  HandedPose pose;
  pose.case_id = "a";
  pose.run_digest = judged.subject.run->digest;
  pose.checks = session.decisions.back().checks;
  const auto json = [&] { return validatedPoseJson(session, pose, {}, "/out/a.json"); };
  EXPECT_EQ(json()["state"], "NOT VALIDATED");
  EXPECT_EQ(json()["decision"]["verdict"], "not validated");
  EXPECT_EQ(json()["decision"]["by"], "Ada");
  EXPECT_EQ(json()["decision"]["comment"], "looks right");
  EXPECT_FALSE(json()["decision"].contains("approval"));
  EXPECT_EQ(json()["checks"].size(), 3u);
  session = approved(session, "a", lastRunDigest(session, "a"), {"Bob", "yes"});
  pose.validated = true;
  EXPECT_EQ(json()["state"], "validated");
  EXPECT_EQ(json()["decision"]["verdict"], "validated");
  EXPECT_EQ(json()["decision"]["approval"]["by"], "Bob");
  session = withAnnotations(session, "a", randomAnnotations(random));
  EXPECT_FALSE(json()["decision"].contains("by")) << "it holds no longer";
}

/// Of three iterations, the second is the last that matched.
TEST(ValidatedPoseJson, Matches_AreThoseOfTheLastMatchingIteration) {
  Random random = randomFor("ValidatedPoseJson.Matches");
  LocalizationTrace run;
  for (const auto& [kind, count] : {std::pair(IterationKind::kMatch, 1),
                                    {IterationKind::kMatch, 3},
                                    {IterationKind::kRefine, 2}}) {
    auto iteration = std::make_shared<IterationTrace>();
    iteration->kind = kind;
    iteration->reached = Stage::kRefine;
    for (int i = 0; i < count; ++i) {
      Correspondence& pair = iteration->correspondences.emplace_back();
      pair.point_in_station_m = {1.0 * i, 2.0, 3.0};
      pair.pixel = {10.0 * i, 20.0};
    }
    iteration->pnp.inlier = {1, 0};
    iteration->pnp.residual_px = {0.5, 4.0};
    run.iterations.push_back(iteration);
  }
  run.digest = "d";
  run.version = "1.2.3";
  run.status = LocalizationStatus::kConverged;
  run.changes = {{1, run.options}};
  run.changes[0].options.pnp.min_inliers = 77;
  const ordered_json json = Handed(random).json(run)["run"];
  EXPECT_EQ(json["digest"], "d");
  EXPECT_EQ(json["version"], "1.2.3");
  EXPECT_EQ(json["status"], "converged");
  EXPECT_EQ(json["iterations"], 3);
  EXPECT_EQ(json["options"]["pnp.min_inliers"], 77) << "those at the end";
  EXPECT_EQ(json["matches"], ordered_json::parse(R"([
      {"point_in_station_m": [0.0, 2.0, 3.0], "pixel": [0.0, 20.0], "inlier": true,
       "residual_px": 0.5},
      {"point_in_station_m": [1.0, 2.0, 3.0], "pixel": [10.0, 20.0], "inlier": false,
       "residual_px": 4.0},
      {"point_in_station_m": [2.0, 2.0, 3.0], "pixel": [20.0, 20.0]}])"));
  auto of_next_attempt = std::make_shared<IterationTrace>(*run.iterations.back());
  of_next_attempt->attempt = 1;
  run.iterations.back() = of_next_attempt;
  EXPECT_EQ(Handed(random).json(run)["run"]["matches"], ordered_json::array())
      << "they did not lead to the pose";
  run.iterations.erase(run.iterations.begin(), run.iterations.begin() + 2);
  EXPECT_EQ(Handed(random).json(run)["run"]["matches"], ordered_json::array());
}

}  // namespace
}  // namespace boresight::test
