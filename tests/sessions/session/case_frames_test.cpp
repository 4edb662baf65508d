// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_frames.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/session/case_inputs.h"
#include "sessions/session/input_check.h"
#include "sessions/session/rig_links.h"
#include "sessions/session/stated_inputs.h"
#include "tests/sessions/session/example_session.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"
#include "tests/support/vicar_image.h"

namespace boresight::test {
namespace {

using namespace sessions;

const FrameName kArm{"ARM_BASE", {}};
const FrameName kSiteOfLabel{"SITE_FRAME", {194}};

FrameTransform transformOf(const FrameName& target, const FrameName& source, const Pose& pose) {
  FrameTransform transform = shifted(target, source, 0.0);
  transform.target_from_source = pose;
  return transform;
}

/// A camera on an arm: files of frames, and of poses that are given in the arm's frame.
class FramesOfACase : public ::testing::Test {
 protected:
  FramesOfACase() {
    for (const char* name : {"seed", "truth"}) writePoseIn(kArm, randomPose(random_), name);
    writeArm("arm.json");
    files_ = filesOf(exampleFolder() / "os");
    files_.seed = folder_ / "seed.json";
    files_.truth = folder_ / "truth.json";
    files_.transforms = {folder_ / "hand_eye.json", folder_ / "arm.json"};
    write(transformOf(kCameraFrame, kEndEffectorFrame, randomPose(random_)), "hand_eye.json");
  }
  void write(const FrameTransform& transform, const std::string& name) {
    writeFrameTransform(folder_ / name, transform);
  }
  void writeArm(const std::string& name) {
    write(transformOf(kArm, kEndEffectorFrame, randomPose(random_)), name);
  }
  void writePoseIn(const FrameName& frame, const Pose& pose, const std::string& name) {
    const nlohmann::ordered_json json = {{"format", "boresight-pose"},
                                         {"version", 1},
                                         {"reference_frame", sessions::toJson(frame)},
                                         {"reference_from_station", sessions::toJson(pose)}};
    writeJsonFile(folder_ / (name + ".json"), json);
  }
  /// By the files as they are now.
  SessionCase madeCase() const { return makeCase(files_).made; }

  /// As a new case of the same files has it, but for rounding.
  static void expectSamePoses(const SessionCase& found, const SessionCase& fresh) {
    const auto near = [](const Pose& pose) { return poseNear(pose, 1e-12, 1e-9); };
    EXPECT_THAT(found.camera_from_station_seed, near(fresh.camera_from_station_seed));
    EXPECT_THAT(*found.camera_from_station_truth, near(*fresh.camera_from_station_truth));
    EXPECT_THAT(*found.camera_from_end_effector, near(*fresh.camera_from_end_effector));
    EXPECT_EQ(found.station_frame, fresh.station_frame);
    EXPECT_EQ(found.truth_frame, fresh.truth_frame);
    EXPECT_EQ(found.uncertainty, fresh.uncertainty);
  }

  Random random_ = randomFor("FramesOfACase");
  TemporaryFolder folder_;
  CaseFiles files_;
};

TEST_F(FramesOfACase, ChangedFiles_MoveEveryPoseThatCameFromThem) {
  SessionCase nudged = madeCase();
  nudged.camera_from_station_working = Pose();
  for (const char* name : {"arm.json", "hand_eye.json"}) {
    const Session session = withCase({}, nudged);
    FrameTransform changed = readFrameTransforms(folder_ / name).front();
    changed.target_from_source = randomPose(random_);
    write(changed, name);
    const Session accepted = acceptingInputs(session, "os");
    expectSamePoses(*accepted.findCase("os"), madeCase());
    EXPECT_FALSE(accepted.findCase("os")->camera_from_station_working);
    EXPECT_TRUE(withAccepted(session, nudged, *accepted.findCase("os")) == accepted);
  }
}

TEST_F(FramesOfACase, StatedTransforms_MoveEveryPoseThatCameFromTheFormerOnes) {
  const Session session = withCase({}, madeCase());
  writeArm("arm_2.json");
  StatedInputs stated;
  stated.frames = readFrameTransforms(folder_ / "arm_2.json");
  files_.transforms.back() = folder_ / "arm_2.json";
  expectSamePoses(*withStated(session, "os", stated).findCase("os"), madeCase());
}

TEST_F(FramesOfACase, SeedThatIsTheChain_IsTheNewChainWithItsUncertainty) {
  FrameTransform station = transformOf(kArm, kStationFrame, randomPose(random_));
  station.covariance = Matrix6d(1e-6 * Matrix6d::Identity());
  write(station, "station.json");
  files_.seed.clear();
  files_.transforms.push_back(folder_ / "station.json");
  const SessionCase former = madeCase();
  SessionCase apart = former;
  apart.uncertainty.rotation_deg.z() = 90.0;
  station.target_from_source = randomPose(random_);
  *station.covariance *= 4.0;
  write(station, "station.json");
  const auto accepted = [](const SessionCase& session_case) {
    return *acceptingInputs(withCase({}, session_case), "os").findCase("os");
  };
  expectSamePoses(accepted(former), madeCase());
  EXPECT_EQ(accepted(apart).uncertainty, apart.uncertainty) << "stated apart from the frames";
}

TEST_F(FramesOfACase, PosesStatedApartFromFrames_Stay) {
  SessionCase apart = madeCase();
  setSeed(apart, randomPose(random_));
  setTruth(apart, randomPose(random_), {});
  apart.camera_from_end_effector = randomPose(random_);
  writeArm("arm.json");
  SessionCase expected = apart;
  expected.frames.back() = readFrameTransforms(folder_ / "arm.json").front();
  EXPECT_EQ(*acceptingInputs(withCase({}, apart), "os").findCase("os"), expected);
}

TEST_F(FramesOfACase, TransformOfASeed_IsNotRemoved) {
  SessionCase seeded = madeCase();
  const std::vector<FrameTransform> hand_eye = {seeded.frames.front()};
  const Session session = withCase({}, seeded);
  EXPECT_EQ(folder_.message([&] { (void)withFrames(session, "os", hand_eye); }),
            "case os: the seed comes from the frames between CAMERA and ARM_BASE, which would no "
            "longer be joined: give the seed as camera_from_station first, or make a new case");
  setSeed(seeded, Pose());
  EXPECT_THAT(folder_.message([&] { (void)withFrames(withCase({}, seeded), "os", hand_eye); }),
              testing::StartsWith("case os: the truth comes from"));
  setTruth(seeded, Pose(), {});
  const Session without = withFrames(withCase({}, seeded), "os", {});
  EXPECT_FALSE(without.findCase("os")->camera_from_end_effector);
}

TEST_F(FramesOfACase, PoseOfARigByFrames_FollowsThem) {
  SessionCase other = madeCase();
  other.id = "other";
  writeArm("arm.json");
  Session session = withCase(withCase({}, madeCase()), other);
  const auto by_frames = [&session] {
    return linkOfFrames(*session.findCase("os"), *session.findCase("other"))->other_from_case;
  };
  session = withRigLink(session, "os", "other", by_frames());
  writeArm("arm.json");
  for (const char* id : {"os", "other"}) {
    session = acceptingInputs(session, id);
    EXPECT_THAT(*linkOfRig(*session.findCase("os"), *session.findCase("other")),
                poseNear(by_frames(), 1e-12, 1e-9));
  }
  session = withRigLink(session, "os", "other", randomPose(random_));
  const auto apart = session.findCase("other")->rig;
  writeArm("arm.json");
  EXPECT_EQ(acceptingInputs(session, "other").findCase("other")->rig, apart);
}

TEST_F(FramesOfACase, NewCameraReference_MovesThePosesGivenInIt) {
  SessionCase session_case = madeCase();
  CameraReference& reference = session_case.camera_reference.emplace();
  for (const char* name : {"", "MAST"}) {
    reference = {randomPose(random_), {name, {}}};
    session_case.station_frame = reference.frame;
    const Pose in_mast =
        reference.camera_from_reference.inverse() * session_case.camera_from_station_seed;
    SessionCase changed = session_case;
    changed.camera_reference->camera_from_reference = randomPose(random_);
    followFrames(session_case, changed);
    EXPECT_THAT(changed.camera_from_station_seed,
                poseNear(changed.camera_reference->camera_from_reference * in_mast, 1e-12, 1e-9));
  }
  const auto camera = exampleFolder() / "os/camera.json";  // states no frame
  EXPECT_THAT(
      folder_.message([&] { (void)withInputFile(session_case, InputKind::kCamera, camera); }),
      HasSubstr("the seed comes from the frames between CAMERA and MAST"));
}

/// Cameras of a rig on a mast: `b` has a pose 0.25 m from `a`, `c` is where the frames put it, and
/// `d` is a second image of `a`.
class RigOnAMast : public ::testing::Test {
 protected:
  RigOnAMast() {
    for (const auto& [id, x_m] : {std::pair{"a", 1.0}, {"b", 0.0}, {"c", 7.0}, {"d", 1.0}}) {
      SessionCase session_case;
      session_case.id = id;
      session_case.has_seed = false;
      if (session_case.id != "b") session_case.frames = onMast(x_m);
      session_ = withCase(session_, session_case);
    }
    Pose b_from_a;
    b_from_a.translation_m.x() = 0.25;
    session_ = withRigLink(session_, "a", "b", b_from_a);
    session_ = withRigLink(session_, "a", "d", Pose());
    session_ = withRigLink(session_, "a", "c", byFrames(session_, "a", "c"));
  }
  static std::vector<FrameTransform> onMast(double x_m) {
    return {shifted(kCameraFrame, kMast, x_m)};
  }
  static Pose byFrames(const Session& session, const char* from, const char* to) {
    return linkOfFrames(*session.findCase(from), *session.findCase(to))->other_from_case;
  }
  /// x of the pose between two cameras of the rig. m
  static double link(const Session& session, const char* from, const char* to) {
    return linkOfRig(*session.findCase(from), *session.findCase(to))->translation_m.x();
  }
  std::string refusal(const std::function<void()>& change) const { return folder_.message(change); }

  inline static const FrameName kMast{"MAST", {}};
  TemporaryFolder folder_;
  Session session_;
};

TEST_F(RigOnAMast, NewFramesOfACamera_LeavePosesThatWereStatedApart) {
  Session next = withFrames(session_, "a", onMast(2.0));
  EXPECT_NEAR(link(next, "a", "b"), 0.25, 1e-9);
  EXPECT_NEAR(link(next, "a", "c"), 5.0, 1e-9);
  EXPECT_NEAR(link(next, "a", "d"), 0.0, 1e-9) << "the same camera";
  next = withFrames(next, "d", onMast(2.0));
  EXPECT_NEAR(link(next, "a", "c"), 5.0, 1e-9) << "d is where it was";
  next = withFrames(next, "c", onMast(9.0));
  for (const char* id : {"a", "d"}) EXPECT_NEAR(link(next, id, "c"), 7.0, 1e-9) << id;
  EXPECT_NEAR(link(next, "a", "b"), 0.25, 1e-9);
  EXPECT_EQ(link(withFrames(next, "b", onMast(3.0)), "a", "b"), link(next, "a", "b"));
}

/// `b` is the reference, `a` has a pose from it.
TEST_F(RigOnAMast, NewFramesOfACameraThatIsNotTheReference_LeaveItsPoseThatWasStatedApart) {
  Pose a_from_b;
  a_from_b.translation_m.x() = -0.25;
  Session session = session_;
  for (const char* id : {"a", "b", "c"}) session = withoutRigLink(session, id);
  session = withRigLink(session, "b", "a", a_from_b);
  session = withRigLink(session, "a", "c", byFrames(session, "a", "c"));
  session = withFrames(session, "a", onMast(2.0));
  EXPECT_NEAR(link(session, "a", "b"), 0.25, 1e-9);
  EXPECT_NEAR(link(session, "a", "c"), 5.0, 1e-9);
  EXPECT_EQ(session.findCase("b")->rig->camera_from_rig, Pose()) << "the reference";
}

/// `d` is linked by a frame behind the mast.
TEST_F(RigOnAMast, NewTransformBehindTheMast_MovesTheCamerasBehindItAlone) {
  const FrameName body{"BODY", {}};
  const auto mastAt = [&](double x_m) { return shifted(kMast, body, x_m); };
  const auto withMast = [&](double camera_m, double mast_m) {
    std::vector<FrameTransform> frames = onMast(camera_m);
    frames.push_back(mastAt(mast_m));
    return frames;
  };
  Session session = withFrames(session_, "a", withMast(1.0, 0.0));
  session = withFrames(withoutRigLink(session, "d"), "d", {shifted(kCameraFrame, body, 4.0)});
  session = withRigLink(session, "a", "d", byFrames(session, "a", "d"));
  ASSERT_NEAR(link(session, "a", "d"), 3.0, 1e-9);
  session = withFrames(session, "a", withMast(1.0, 0.5));
  EXPECT_NEAR(link(session, "a", "d"), 2.5, 1e-9);
  EXPECT_NEAR(link(session, "a", "c"), 6.0, 1e-9);
  EXPECT_NEAR(link(session, "a", "b"), 0.25, 1e-9);
}

TEST_F(RigOnAMast, TransformOfAPoseInTheRig_IsNotRemoved) {
  EXPECT_EQ(refusal([&] { (void)withFrames(session_, "c", {}); }),
            "case c: the pose in the rig comes from the frames between CAMERA and MAST, which "
            "would no longer be joined: link the case with a by another pose first, or take it out "
            "of the rig");
  EXPECT_THAT(refusal([&] { (void)withFrames(session_, "a", {}); }),
              HasSubstr("link the case with c"));
  const Session apart = withRigLink(session_, "a", "c", Pose());
  EXPECT_TRUE(withFrames(apart, "a", {}).findCase("a")->frames.empty());
  StatedInputs stated;
  stated.frames = onMast(8.0);
  EXPECT_NEAR(link(withStated(session_, "c", stated), "a", "c"), 7.0, 1e-9) << "in its place";
}

TEST_F(RigOnAMast, AnotherCameraFile_MovesThePoseInTheRig) {
  SessionCase former = *session_.findCase("c");
  former.frames.clear();
  former.camera_reference = CameraReference{onMast(7.0).front().target_from_source, kMast};
  const Session session = withCase(session_, former);
  SessionCase changed = former;
  changed.camera_reference->camera_from_reference.translation_m.x() = 9.0;
  const auto next = withInput(session, InputKind::kCamera, former, changed);
  ASSERT_TRUE(next);
  EXPECT_NEAR(link(*next, "a", "c"), 8.0, 1e-9);
  EXPECT_NEAR(link(*next, "a", "b"), 0.25, 1e-9);
  changed.camera_reference.reset();
  EXPECT_THAT(refusal([&] { (void)withInput(session, InputKind::kCamera, former, changed); }),
              HasSubstr("the pose in the rig comes from the frames between CAMERA and MAST"));
}

/// A label that states where the end effector is in a site.
class LabelledCase : public FramesOfACase {
 protected:
  std::filesystem::path image(const std::string& name, const Pose& site_from_end_effector) {
    const Eigen::Quaterniond& turn = site_from_end_effector.rotation;
    const std::string group =
        "PROPERTY='ARM_COORDINATE_SYSTEM'  COORDINATE_SYSTEM_NAME='END_EFFECTOR'  "
        "REFERENCE_COORD_SYSTEM_NAME='SITE_FRAME'  REFERENCE_COORD_SYSTEM_INDEX=194  "
        "ORIGIN_OFFSET_VECTOR=" +
        vicarVector(site_from_end_effector.translation_m) + "  ORIGIN_ROTATION_QUATERNION=(" +
        vicarNumber(turn.w()) + "," + vicarNumber(turn.x()) + "," + vicarNumber(turn.y()) + "," +
        vicarNumber(turn.z()) + ")  ";
    return folder_.write(name, vicarImage(64, 48, std::vector<std::uint16_t>(64 * 48, 9), group));
  }
};

TEST_F(LabelledCase, AnotherImage_BringsTheFramesOfItsOwnLabel) {
  writePoseIn(kSiteOfLabel, randomPose(random_), "seed");
  files_.image = image("1.IMG", randomPose(random_));
  const SessionCase former = madeCase();
  ASSERT_EQ(former.frames.size(), 3u);
  files_.image = image("2.IMG", randomPose(random_));
  const SessionCase changed = withInputFile(former, InputKind::kImage, files_.image);
  expectSamePoses(changed, madeCase());
  EXPECT_EQ(changed.frames, madeCase().frames);
  SessionCase tagged = former;
  tagged.tags = {"edited meanwhile"};
  const auto session = withInput(withCase({}, tagged), InputKind::kImage, former, changed);
  ASSERT_TRUE(session);
  SessionCase expected = changed;
  expected.tags = tagged.tags;
  EXPECT_EQ(*session->findCase("os"), expected);
  const auto plain = exampleFolder() / "os/image.png";
  EXPECT_THAT(folder_.message([&] { (void)withInputFile(former, InputKind::kImage, plain); }),
              HasSubstr("the seed comes from the frames between CAMERA and SITE_FRAME (194)"));
}

}  // namespace
}  // namespace boresight::test
