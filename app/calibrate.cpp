// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include "app/calibration_text.h"
#include "app/commands.h"
#include "sessions/calibration/calibrated_values.h"
#include "sessions/calibration/camera_calibration.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/session/session_file.h"
#include "sessions/text/text_table.h"

namespace boresight::app {
namespace {

using sessions::fixedText;

struct CalibrateArguments {
  std::vector<std::string> sessions;
  std::string from = "annotations";
  std::vector<std::string> free = {"focal", "centre"};
  std::string out;

  void addTo(CLI::App& command) {
    addFile(command, "sessions", sessions, "Session files of one camera")->required();
    addChoice(command, "--from", from, {"annotations", "runs"},
              "Observations: annotations (points), or runs (edges of converged runs)");
    addChoice(command, "--free", free, {"focal", "centre", "distortion"},
              "Adjusted: focal, centre, distortion");
    addFile(
        command, "--out", out,
        "Writes the adjusted camera as camera.json, with calibration_sigma where determined; of "
        "several sessions the last one's");
  }
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
                                     session.cases.front()->id +
                                     "; calibrate one camera at a time");
  return camera;
}

sessions::CameraCalibration calibrateSession(const std::string& file,
                                             const CalibrateArguments& arguments,
                                             const sessions::Session& session) {
  const auto views = sessions::observationsOf(
      session, arguments.from == "runs" ? sessions::ObservationSource::kRuns
                                        : sessions::ObservationSource::kAnnotations);
  try {
    const Camera& camera = sharedCamera(session, file);
    auto calibration = sessions::calibrateCamera(camera, views, freeOf(arguments));
    std::cout << file << ": " << views.size() << " images, rms " << fixedText(calibration.rms_px, 3)
              << " px\n";
    printParameters(calibration.parameters, calibration.undetermined, calibration.noise_factor,
                    "add images from other distances and turned about the view axis");
    const auto values = sessions::calibratedValues(camera, calibration);
    if (const std::string change = sessions::changeText(values); !change.empty())
      std::cout << change << "\n";
    return calibration;
  } catch (const std::invalid_argument& refusal) {
    throw sessions::InputError(file, arguments.from, refusal.what());
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
      table.add({files[i], later.name, parameterText(change), parameterText(sigma),
                 std::isfinite(sigma) ? fixedText(change / sigma, 1) : "-"});
    }
  std::cout << "drift since " << files.front() << "\n" << table.text();
}

int calibrate(const CalibrateArguments& arguments) {
  requireWritable({arguments.out});
  std::vector<sessions::CameraCalibration> calibrations;
  std::optional<sessions::CameraReference> reference;  // of the last session
  for (const std::string& file : arguments.sessions) {
    const sessions::Session session = sessions::readSessionFile(file).session;
    calibrations.push_back(calibrateSession(file, arguments, session));
    reference = session.cases.front()->camera_reference;
  }
  if (calibrations.size() > 1) printDrift(calibrations, arguments.sessions);
  if (!arguments.out.empty())
    sessions::writeCamera(arguments.out, sessions::CameraFile{calibrations.back().camera, reference,
                                                              calibrations.back().sigma()});
  std::cout << std::flush;
  return kDone;
}

}  // namespace

void addCalibrate(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "calibrate",
             "Estimates camera parameters from many images of a station, with their sigmas; "
             "reports what the images cannot determine. Several sessions: each by itself, and "
             "the drift since the first",
             calibrate);
}

}  // namespace boresight::app
