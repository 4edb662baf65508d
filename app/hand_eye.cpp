// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "app/calibration_text.h"
#include "app/commands.h"
#include "sessions/calibration/hand_eye.h"
#include "sessions/io/cameras/frame_transform.h"
#include "sessions/io/cameras/frame_tree.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/session/case_run.h"
#include "sessions/trace/run_text.h"

namespace boresight::app {
namespace {

constexpr const char* kAdvice = "add postures that turn about other axes";

struct HandEyeArguments {
  std::vector<std::string> sessions;
  std::string arm, out;

  void addTo(CLI::App& command) {
    addFile(command, "sessions", sessions, "Session files of one camera")->required();
    addOption(command, "--arm", "FRAME", arm,
              "Frame that the cases' frames join with END_EFFECTOR by telemetry")
        ->required();
    addFile(command, "--out", out,
            "Writes camera_from_end_effector with its covariance as a transform for --frames");
  }
};

/// Observations of the arm from all sessions.
struct ArmObservations {
  std::vector<sessions::ArmPosture> postures;
  /// Number of each station of each session: the arm's base may have moved in between.
  std::map<std::pair<std::string, std::string>, std::size_t> stations;
  std::optional<Pose> start;  ///< the first case's camera_from_end_effector
};

/// The transform by telemetry between the arm's frame and the end effector, and its sigmas.
std::optional<sessions::ArmPosture> postureOf(const sessions::SessionCase& session_case,
                                              const sessions::FrameName& arm, const Pose& pose) {
  for (const sessions::FrameTransform& transform : session_case.frames) {
    const sessions::FrameTree tree({transform});
    const auto arm_from_end_effector = tree.chain(arm, sessions::kEndEffectorFrame);
    if (!arm_from_end_effector) continue;
    sessions::ArmPosture posture{arm_from_end_effector->a_from_b, pose};
    if (!arm_from_end_effector->covariance_stated) return posture;
    // The chain back has its covariance at the end effector, where the adjustment has residuals.
    const Vector6d sigma =
        sessions::sigmasOf(tree.chain(sessions::kEndEffectorFrame, arm)->covariance);
    posture.sigma_rotation_rad = std::max(1e-9, sigma.head<3>().mean());
    posture.sigma_translation_m = std::max(1e-9, sigma.tail<3>().mean());
    return posture;
  }
  return std::nullopt;
}

void addObservations(const std::string& file, const sessions::FrameName& arm,
                     ArmObservations& observations) {
  const sessions::SessionDocument document = openToRead(file);
  const sessions::Session& session = document.session();
  for (const auto& session_case : session.cases) {
    if (session.lastRunOf(session_case->id) == nullptr) continue;
    const sessions::LocalizationTrace run =
        sessions::loadSnapshot(sessions::currentRunOf(session, session_case->id));
    if (!run.converged()) continue;
    if (auto posture = postureOf(*session_case, arm, run.camera_from_station)) {
      const auto next = observations.stations.size();
      posture->station =
          observations.stations.try_emplace({file, session_case->station}, next).first->second;
      observations.postures.push_back(*posture);
    }
    if (!observations.start) observations.start = session_case->camera_from_end_effector;
  }
}

sessions::HandEye handEyeOf(const HandEyeArguments& arguments,
                            const ArmObservations& observations) {
  try {
    return sessions::calibrateHandEye(observations.postures, observations.start.value_or(Pose()));
  } catch (const std::invalid_argument& refusal) {
    throw sessions::InputError(arguments.sessions.front(), "frames",
                               std::string(refusal.what()) +
                                   ": converged runs with a transform between " + arguments.arm +
                                   " and END_EFFECTOR");
  }
}

void writeHandEye(const HandEyeArguments& arguments, const sessions::HandEye& hand_eye,
                  std::size_t postures) {
  // A covariance without the open directions would promise more than is known.
  if (!hand_eye.undetermined.empty())
    throw sessions::InputError(
        arguments.out, "covariance",
        std::string("is not written while a direction is not determined; ") + kAdvice);
  sessions::FrameTransform transform;
  transform.target = sessions::kCameraFrame;
  transform.source = sessions::kEndEffectorFrame;
  transform.target_from_source = hand_eye.camera_from_end_effector;
  transform.covariance = hand_eye.covariance;
  transform.origin = sessions::TransformSource::kCalibration;
  transform.comment = "whs hand-eye, " + std::to_string(postures) + " postures";
  sessions::writeFrameTransform(arguments.out, transform);
}

int handEye(const HandEyeArguments& arguments) {
  requireWritable({arguments.out});
  ArmObservations observations;
  for (const std::string& file : arguments.sessions)
    addObservations(file, {arguments.arm, {}}, observations);
  const sessions::HandEye hand_eye = handEyeOf(arguments, observations);
  const std::size_t postures = observations.postures.size();
  std::cout << postures << " postures at " << observations.stations.size()
            << " station(s); changes of camera_from_end_effector\n";
  printParameters(hand_eye.parameters, hand_eye.undetermined, hand_eye.noise_factor, kAdvice);
  std::cout << sessions::poseText(hand_eye.camera_from_end_effector, hand_eye.covariance,
                                  "camera_from_end_effector")
            << std::flush;
  if (!arguments.out.empty()) writeHandEye(arguments, hand_eye, postures);
  return kDone;
}

}  // namespace

void addHandEye(CLI::App& app, int& exit_code) {
  addCommand(
      app, exit_code, "hand-eye",
      "Estimates the camera's pose on the arm from converged runs in several postures and the "
      "arm's telemetry, with its covariance; reports what the postures cannot determine",
      handEye);
}

}  // namespace boresight::app
