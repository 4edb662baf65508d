// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include "app/commands.h"
#include "sessions/calibration/camera_calibration.h"
#include "sessions/calibration/hand_eye.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/camera_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/json_reader.h"
#include "sessions/run/run_text.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_file.h"
#include "sessions/text/text_table.h"

namespace boresight::app {
namespace {

using sessions::fixedText;

struct CalibrateArguments {
  std::vector<std::string> sessions;
  std::string from = "annotations";
  std::vector<std::string> free = {"focal", "centre"};
  std::string arm;
  std::string out;
};

sessions::FreeParameters freeOf(const CalibrateArguments& arguments) {
  const auto has = [&](const char* name) {
    return std::find(arguments.free.begin(), arguments.free.end(), name) != arguments.free.end();
  };
  return {has("focal"), has("centre"), has("distortion")};
}

/// The camera that all cases share. InputError.
const Camera& sharedCamera(const sessions::Session& session, const std::string& file) {
  if (session.cases.empty()) throw sessions::InputError(file, "cases", "there are none");
  const Camera& camera = session.cases.front()->camera;
  for (const auto& session_case : session.cases)
    if (!(session_case->camera == camera))
      throw sessions::InputError(file, "cases",
                                 session_case->id + " has another camera than " +
                                     session.cases.front()->id + "; calibrate one camera at a time");
  return camera;
}

std::string numberText(double value) {
  return std::isfinite(value) ? sessions::numberText(std::round(value * 1e9) / 1e9)
                              : "not determined";
}

void printParameters(const std::vector<sessions::CalibrationParameter>& parameters,
                     const std::vector<sessions::Undetermined>& undetermined, double noise_factor) {
  sessions::TextTable table({"parameter", "value", "1 sigma"});
  for (const auto& parameter : parameters)
    table.add({parameter.name, numberText(parameter.value), numberText(parameter.sigma)});
  std::cout << table.text() << "noise factor " << fixedText(noise_factor, 2)
            << " (1: residuals as the sigmas say)\n";
  for (const sessions::Undetermined& direction : undetermined)
    std::cout << "not determined by these images: " << direction.text
              << "; add images from other distances and turned about the view axis\n";
}

std::optional<sessions::CameraCalibration> calibrateSession(const std::string& file,
                                                            const CalibrateArguments& arguments,
                                                            const sessions::Session& session) {
  const auto views = sessions::observationsOf(session, arguments.from == "runs"
                                                           ? sessions::ObservationSource::kRuns
                                                           : sessions::ObservationSource::kAnnotations);
  try {
    auto calibration =
        sessions::calibrateCamera(sharedCamera(session, file), views, freeOf(arguments));
    std::cout << file << ": " << views.size() << " images, rms "
              << fixedText(calibration.rms_px, 3) << " px\n";
    printParameters(calibration.parameters, calibration.undetermined, calibration.noise_factor);
    return calibration;
  } catch (const std::invalid_argument& refusal) {
    throw sessions::InputError(file, arguments.from, refusal.what());
  }
}

/// The transform by telemetry between the arm's frame and the end effector, and its sigmas.
std::optional<sessions::ArmPosture> postureOf(const sessions::SessionCase& session_case,
                                              const sessions::FrameName& arm, const Pose& pose) {
  for (const sessions::FrameTransform& transform : session_case.frames) {
    const auto chain =
        sessions::FrameTree({transform}).chain(arm, sessions::kEndEffectorFrame);
    if (!chain) continue;
    sessions::ArmPosture posture{chain->a_from_b, pose};
    if (!chain->covariance_stated) return posture;
    const Matrix6d covariance = sessions::FrameTree({transform})
                                    .chain(sessions::kEndEffectorFrame, arm)
                                    ->covariance;
    const Vector6d sigma = sessions::sigmasOf(covariance);
    posture.sigma_rotation_rad = std::max(1e-9, sigma.head<3>().mean());
    posture.sigma_translation_m = std::max(1e-9, sigma.tail<3>().mean());
    return posture;
  }
  return std::nullopt;
}

void calibrateArm(const CalibrateArguments& arguments) {
  std::vector<sessions::ArmPosture> postures;
  std::optional<Pose> start;
  for (const std::string& file : arguments.sessions) {
    const sessions::Session session = sessions::readSessionFile(file).session;
    for (const auto& session_case : session.cases) {
      const sessions::RunRecord* record = session.lastRunOf(session_case->id);
      if (record == nullptr) continue;
      const sessions::LocalizationTrace run = sessions::loadSnapshot(*record);
      if (!run.converged()) continue;
      if (const auto posture =
              postureOf(*session_case, {arguments.arm, {}}, run.camera_from_station))
        postures.push_back(*posture);
      if (!start) start = session_case->camera_from_end_effector;
    }
  }
  try {
    const sessions::HandEye hand_eye =
        sessions::calibrateHandEye(postures, start.value_or(Pose()));
    std::cout << "hand-eye: " << postures.size() << " postures; changes of camera_from_end_effector\n";
    printParameters(hand_eye.parameters, hand_eye.undetermined, hand_eye.noise_factor);
    std::cout << sessions::poseText(hand_eye.camera_from_end_effector, hand_eye.covariance,
                                    "camera_from_end_effector");
  } catch (const std::invalid_argument& refusal) {
    throw sessions::InputError(arguments.sessions.front(), "frames",
                               std::string(refusal.what()) +
                                   ": converged runs with a transform between " + arguments.arm +
                                   " and END_EFFECTOR");
  }
}

/// Changes of each parameter from the first session, in sigmas of the difference.
void printDrift(const std::vector<sessions::CameraCalibration>& calibrations,
                const std::vector<std::string>& files) {
  sessions::TextTable table({"session", "parameter", "change", "1 sigma", "in sigmas"});
  for (std::size_t i = 1; i < calibrations.size(); ++i)
    for (std::size_t k = 0; k < calibrations[i].parameters.size(); ++k) {
      const auto& first = calibrations[0].parameters[k];
      const auto& later = calibrations[i].parameters[k];
      const double change = later.value - first.value;
      const double sigma = std::hypot(first.sigma, later.sigma);
      table.add({files[i], later.name, numberText(change), numberText(sigma),
                 fixedText(change / sigma, 1)});
    }
  std::cout << "drift since " << files.front() << "\n" << table.text();
}

int calibrate(const CalibrateArguments& arguments) {
  if (!arguments.out.empty()) sessions::requireWritable(arguments.out);
  if (!arguments.arm.empty()) {
    calibrateArm(arguments);
    return kDone;
  }
  std::vector<sessions::CameraCalibration> calibrations;
  for (const std::string& file : arguments.sessions) {
    const sessions::Session session = sessions::readSessionFile(file).session;
    calibrations.push_back(*calibrateSession(file, arguments, session));
  }
  if (calibrations.size() > 1) printDrift(calibrations, arguments.sessions);
  if (!arguments.out.empty()) {
    const sessions::Session session =
        sessions::readSessionFile(arguments.sessions.back()).session;
    sessions::CameraFile camera{calibrations.back().camera,
                                session.cases.front()->camera_reference,
                                calibrations.back().sigma()};
    sessions::writeCamera(arguments.out, camera);
  }
  std::cout << std::flush;
  return kDone;
}

}  // namespace

void addCalibrate(CLI::App& app, int& exit_code) {
  const auto [command, arguments] = addCommand(
      app, exit_code, "calibrate",
      "Estimates camera parameters, or the camera's place on the arm, from many images of a "
      "station, with their sigmas; says what the images cannot determine. Several sessions: each "
      "by itself, and the drift since the first",
      calibrate);
  addFile(*command, "sessions", arguments->sessions, "Session files of one camera")->required();
  command
      ->add_option("--from", arguments->from,
                   "Observations: annotations (points), or runs (edges of converged runs)")
      ->check(CLI::IsMember({"annotations", "runs"}))
      ->capture_default_str();
  command->add_option("--free", arguments->free, "Adjusted: focal, centre, distortion")
      ->check(CLI::IsMember({"focal", "centre", "distortion"}))
      ->capture_default_str();
  command
      ->add_option("--hand-eye", arguments->arm,
                   "Instead of the camera: camera_from_end_effector, from converged runs and the "
                   "transforms between this frame and END_EFFECTOR")
      ->type_name("FRAME");
  addFile(*command, "--out", arguments->out,
          "Writes the adjusted camera as camera.json, with calibration_sigma where determined; of "
          "several sessions the last one's");
}

}  // namespace boresight::app
