// SPDX-License-Identifier: Apache-2.0
// calibrate and hand-eye.
#include <cmath>

#include <gtest/gtest.h>

#include "sessions/io/cameras/frame_transform.h"
#include "sessions/io/cameras/frame_tree.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_file.h"
#include "sessions/session/session_maker.h"
#include "sessions/session/stated_inputs.h"
#include "tests/app/run_whs.h"
#include "tests/support/calibration_session.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using sessions::Session;
using sessions::SessionCase;

class Calibrate : public testing::Test {
 protected:
  /// A run in each posture of the arm; telemetry as exact as a file can say.
  std::string sessionOfPostures(const std::vector<Pose>& camera_from_station,
                                const Pose& camera_from_end_effector,
                                const Pose& arm_from_station) const {
    Session session = sessionOf(static_cast<int>(camera_from_station.size()));
    session.options = {{"search.enabled", false}};
    sessions::LocalizationTrace run = sessions::runCase(session, "c0");
    EXPECT_TRUE(run.converged());
    for (std::size_t i = 0; i < camera_from_station.size(); ++i) {
      SessionCase session_case = *session.cases[i];
      session_case.camera_from_end_effector = Pose();  // where the estimate begins
      sessions::FrameTransform telemetry;
      telemetry.target = {"ARM_BASE", {}};
      telemetry.source = sessions::kEndEffectorFrame;
      telemetry.target_from_source =
          arm_from_station * camera_from_station[i].inverse() * camera_from_end_effector;
      telemetry.covariance = 1e-8 * Matrix6d::Identity();
      telemetry.comment = "posture " + std::to_string(i);
      telemetry.file = "telemetry.json";
      telemetry.file_sha256 = std::string(64, 'a');
      session_case.frames = {telemetry};
      session.cases[i] = session_case;
    }
    for (std::size_t i = 0; i < camera_from_station.size(); ++i) {
      run.camera_from_station = camera_from_station[i];
      run.digest.back() = static_cast<char>('0' + i);  // each a run of its own
      session = withRun(session, storeRun(session, session.cases[i]->id, run, file_));
    }
    sessions::writeSessionFile(file_, session);
    return file_;
  }

  const TemporaryFolder folder_;
  const std::string file_ = folder_ / "s.boresight.json";
};

TEST_F(Calibrate, FindsALongerFocalLengthWritesTheCameraAndReportsTheDriftBetweenSessions) {
  const std::string out = folder_ / "camera.json";
  sessions::writeSessionFile(file_, sessionOfALongerLens(8));
  EXPECT_THAT(runWhs({"calibrate", file_, "--out", out}, 0).out,
              AllOf(HasSubstr("8 images"), HasSubstr("focal_relative"), HasSubstr("noise factor"),
                    HasSubstr("The focal length changes by")));
  const sessions::CameraFile written = sessions::readCameraFile(out);
  const Camera stated = sessionOf(1).cases.front()->camera;
  ASSERT_TRUE(written.calibration_sigma);
  const double sigma = written.calibration_sigma->focal_relative.value();
  EXPECT_GT(sigma, 0.0);
  EXPECT_LT(sigma, 1e-3);
  EXPECT_NEAR(written.camera.fx / stated.fx, kLongerFocalLength, 4.0 * sigma);
  EXPECT_THAT(runWhs({"calibrate", file_, file_}, 0).out,
              AllOf(HasSubstr("drift since"), HasSubstr(" 0.0\n")));
  // The same observations, from the calibrated camera.
  Session calibrated = sessionOfALongerLens(8);
  for (std::size_t i = 0; i < calibrated.cases.size(); ++i) {
    SessionCase session_case = *calibrated.cases[i];
    session_case.camera = written.camera;
    calibrated.cases[i] = session_case;
  }
  const std::string later = folder_ / "later.boresight.json";
  sessions::writeSessionFile(later, calibrated);
  const std::string drift = runWhs({"calibrate", file_, later}, 0).out;
  EXPECT_THAT(drift.substr(drift.find("drift since")), HasSubstr("focal length, px"));
  int unchanged = 0;
  for (std::size_t at = drift.find("drift since");
       (at = drift.find("0.0\n", at)) != std::string::npos; ++at)
    ++unchanged;
  EXPECT_EQ(unchanged, 3) << drift;
}

TEST_F(Calibrate, FocalAlone_KeepsTheSigmaOfTheCentreAndSaysSo) {
  const std::string out = folder_ / "camera.json";
  sessions::writeSessionFile(file_, sessionOfALongerLens(8));
  EXPECT_THAT(runWhs({"calibrate", file_, "--free", "focal", "--out", out}, 0).err,
              HasSubstr("what is not adjusted stays as before"));
  const sessions::CameraFile written = sessions::readCameraFile(out);
  ASSERT_TRUE(written.calibration_sigma);
  EXPECT_TRUE(written.calibration_sigma->focal_relative);
  EXPECT_FALSE(written.calibration_sigma->principal_point_px) << "it is assumed";
}

TEST_F(Calibrate, RunsOfAnotherCamera_AreRefused) {
  const std::string file = sessionOfPostures(placesOfTheCamera(3), Pose(), Pose());
  Session session = sessions::readSessionFile(file).session;
  SessionCase changed = *session.cases[1];
  changed.camera.fx *= 1.03;
  changed.camera.fy *= 1.03;
  session.cases[1] = changed;
  sessions::writeSessionFile(file_, session);
  EXPECT_THAT(refusal({"hand-eye", file_, "--arm", "ARM_BASE"}),
              HasSubstr("c1: runs: the inputs have changed since the last run"));
  for (std::size_t i : {0u, 2u}) {
    SessionCase same = *session.cases[i];
    same.camera = changed.camera;
    session.cases[i] = same;
  }
  sessions::writeSessionFile(file_, session);
  EXPECT_THAT(refusal({"calibrate", file_, "--from", "runs"}),
              HasSubstr("the inputs have changed since the last run"));
}

TEST_F(Calibrate, RefusesWhatCannotBeCalibratedInOneSentence) {
  sessions::writeSessionFile(file_, sessionOf(2));
  refusal({"calibrate", file_});
  Session two_cameras = sessionOf(2);
  SessionCase other = *two_cameras.cases[1];
  other.camera.fx *= 1.1;
  two_cameras.cases[1] = other;
  sessions::writeSessionFile(file_, two_cameras);
  EXPECT_THAT(refusal({"calibrate", file_}), HasSubstr("c1 has another camera than c0"));
  runWhs({"calibrate", file_, "--free", "zoom"}, 2);
  runWhs({"calibrate", file_, "--out", folder_ / "no_folder" / "camera.json"}, 3);
}

TEST_F(Calibrate, UnsavedEdits_AreRefused) {
  sessions::writeSessionFile(file_, sessionOf(2));
  {
    auto document = sessions::SessionDocument::open(file_);
    Session edited = document.session();
    edited.robust_annotations = !edited.robust_annotations;
    document.apply(edited, "Edit");
  }
  const std::vector<std::vector<std::string>> commands = {
      {"calibrate", file_}, {"hand-eye", file_, "--arm", "ARM_BASE"}, {"trends", file_}};
  for (const auto& command : commands)
    EXPECT_THAT(refusal(command), HasSubstr(file_ + ": 1 edit was never saved: recover with"))
        << command[0];
}

TEST_F(Calibrate, HandEyeFindsTheCamerasPlaceOnTheArm) {
  Random random = randomFor("Calibrate.HandEye");
  Vector6d place;
  place << 0.1, -0.2, 0.05, 0.02, -0.03, 0.1;
  const Pose camera_from_end_effector = perturbed(place, Pose());
  const std::string out = folder_ / "hand_eye.json";
  const std::string file =
      sessionOfPostures(placesOfTheCamera(6), camera_from_end_effector, randomPose(random));
  EXPECT_THAT(runWhs({"hand-eye", file, "--arm", "ARM_BASE", "--out", out}, 0).out,
              HasSubstr("6 postures"));
  const auto chain = sessions::FrameTree(sessions::readFrameTransforms(std::filesystem::path(out)))
                         .chain(sessions::kCameraFrame, sessions::kEndEffectorFrame);
  ASSERT_TRUE(chain);
  EXPECT_TRUE(chain->covariance_stated);
  EXPECT_LT(perturbationBetween(chain->a_from_b, camera_from_end_effector).norm(), 1e-6);
}

TEST_F(Calibrate, HandEyeDoesNotWriteWhatPosturesLeaveOpen) {
  std::vector<Pose> about_one_axis;
  for (int i = 0; i < 5; ++i)
    about_one_axis.push_back({rotationExp({0.0, 0.0, 0.3 * i}), {0.0, 0.0, 0.4}});
  const std::string file = sessionOfPostures(about_one_axis, Pose(), Pose());
  EXPECT_THAT(runWhs({"hand-eye", file, "--arm", "ARM_BASE"}, 0).out,
              AllOf(HasSubstr("not determined: "), HasSubstr("turn about other axes")));
  const std::string out = folder_ / "hand_eye.json";
  EXPECT_THAT(runWhs({"hand-eye", file, "--arm", "ARM_BASE", "--out", out}, 3).err,
              HasSubstr("not written while a direction is not determined"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(Calibrate, HandEyeSaysWhatItNeeds) {
  sessions::writeSessionFile(file_, sessionOf(3));
  EXPECT_THAT(refusal({"hand-eye", file_, "--arm", "ARM_BASE"}),
              HasSubstr("converged runs with a transform between ARM_BASE and"));
  runWhs({"hand-eye", file_}, 2);
}

}  // namespace
}  // namespace boresight::test
