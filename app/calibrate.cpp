// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <utility>

#include "app/calibration_text.h"
#include "app/commands.h"
#include "sessions/calibration/calibrated_values.h"
#include "sessions/calibration/camera_calibration.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/session/stated_inputs.h"
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
    for (const sessions::OutlyingView& view : calibration.outlying) note(outlyingText(view));
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

/// A session's camera, before and after.
struct CalibratedSession {
  std::string file;
  Camera camera;
  sessions::CameraCalibration calibration;
  sessions::SessionCase one;  ///< with the former camera
};

/// Differences between the adjusted cameras and that of the first session, in sigmas of the
/// difference. The cameras from which the adjustments begin do not count.
void printDrift(const std::vector<CalibratedSession>& sessions) {
  const auto valuesOf = [](const CalibratedSession& session) {
    return calibratedValues(session.camera, session.calibration);
  };
  const auto first_values = valuesOf(sessions.front());
  sessions::TextTable table({"session", "parameter", "change", "1 sigma", "in sigmas"});
  for (std::size_t i = 1; i < sessions.size(); ++i) {
    const auto values = valuesOf(sessions[i]);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const auto& first = first_values[k];
      const auto& later = values[k];
      const double change = later.after - first.after;
      const double sigma = std::hypot(first.sigma, later.sigma);
      const std::string name = later.name + (later.unit.empty() ? "" : ", " + later.unit);
      table.add({sessions[i].file, name, parameterText(change), parameterText(sigma),
                 std::isfinite(sigma) ? fixedText(change / sigma, 1) : "-"});
    }
  }
  std::cout << "drift since " << sessions.front().file << "\n" << table.text();
}

/// InputError where the parameters of two sessions cannot be compared.
void requireSameKind(const CalibratedSession& first, const CalibratedSession& later) {
  const bool same = first.camera.model == later.camera.model &&
                    first.camera.width == later.camera.width &&
                    first.camera.height == later.camera.height &&
                    first.calibration.parameters.size() == later.calibration.parameters.size();
  if (!same)
    throw sessions::InputError(
        later.file, "camera",
        "has another model or image size than that of " + first.file + "; calibrate one camera");
}

void writeCalibrated(const std::string& out, const CalibratedSession& session,
                     const sessions::FreeParameters& free) {
  sessions::SessionCase one = session.one;
  one.calibration_sigma = session.calibration.sigma(sessions::InputSigmas(one).stated);
  one.camera_covariance.reset();
  one.camera = session.calibration.camera;
  if (!session.calibration.undetermined.empty() && !one.calibration_sigma)
    note("calibration_sigma is not written: a parameter is not determined");
  else if (!free.focal || !free.centre)
    note("calibration_sigma of what is not adjusted stays as before: " +
         calibrationText(sessions::InputSigmas(one)));
  sessions::writeCamera(
      out, sessions::CameraFile{one.camera, one.camera_reference, one.calibration_sigma});
}

int calibrate(const CalibrateArguments& arguments) {
  requireWritable({arguments.out});
  std::vector<CalibratedSession> calibrated;
  for (const std::string& file : arguments.sessions) {
    const sessions::SessionDocument document = openToRead(file);
    const sessions::Session& session = document.session();
    sessions::CameraCalibration calibration = calibrateSession(file, arguments, session);
    const sessions::SessionCase& first = *session.cases.front();
    calibrated.push_back({file, first.camera, std::move(calibration), first});
    requireSameKind(calibrated.front(), calibrated.back());
  }
  if (calibrated.size() > 1) printDrift(calibrated);
  if (!arguments.out.empty()) writeCalibrated(arguments.out, calibrated.back(), freeOf(arguments));
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
