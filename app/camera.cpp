// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <limits>
#include <stdexcept>

#include "app/commands.h"
#include "sessions/io/cameras/cahvor_file.h"
#include "sessions/io/cameras/camera_conversion.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/images/camera_of_file.h"

namespace boresight::app {
namespace {

using std::filesystem::path;

struct CameraArguments {
  std::string file, model, out;
  double distance_m = std::numeric_limits<double>::infinity();

  void addTo(CLI::App& command) {
    addFile(command, "file", file, kCameraHelp)->required();
    addChoice(command, "--as", model, {"pinhole", "brown_conrady", "kannala_brandt"},
              "Fits this model in the same camera frame and prints its worst error in pixels");
    addOption(command, "--distance", "M", distance_m,
              "Distance from the camera at which the model is fitted, where the entrance "
              "pupil moves (cahvore), m")
        ->check(numberIn(1e-3, 1e6));
    addFile(command, "--out", out,
            "camera.json, or for vectors a text file (.cahv, .cahvor, .cahvore)");
  }
};

CameraModel modelNamed(const std::string& name) {
  for (int i = 0; i <= static_cast<int>(kLastCameraModel); ++i)
    if (const auto model = static_cast<CameraModel>(i);
        !isCahvFamily(model) && name == sessions::cameraModelName(model))
      return model;
  throw CLI::ValidationError("--as", "'" + name + "' cannot be fitted");
}

/// A text file's ending is read as the kind of its model by many programs, though not by this one.
void noteEnding(const path& out, CameraModel model) {
  const std::string needed = std::string(".") + sessions::cameraModelName(model);
  if (out.extension() != needed)
    note("the vectors belong to a " + needed.substr(1) +
         " model; other programs expect the file ending " + needed);
}

/// Of Hs Hc Vs Vc Theta, from which the sigmas are read back; empty, with a note, where one of them
/// is assumed, or both are 0.
Eigen::MatrixXd internalCovariance(const Camera& camera, const sessions::StatedCalibration& sigma) {
  if (!sigma.focal_relative || !sigma.principal_point_px) {
    note("a text file cannot state one member of calibration_sigma alone; it is left out");
    return {};
  }
  if (*sigma.focal_relative == 0.0 && *sigma.principal_point_px == 0.0)
    note("a text file cannot state a calibration_sigma of 0; it is left out");
  Eigen::VectorXd one_sigma(5);
  one_sigma << *sigma.focal_relative * camera.fx, *sigma.principal_point_px,
      *sigma.focal_relative * camera.fy, *sigma.principal_point_px, 0.0;
  return one_sigma.cwiseAbs2().asDiagonal();
}

/// Vectors as text, with their covariance where it is known.
void writeVectors(const CameraArguments& arguments, const sessions::CameraFile& given) {
  if (!isCahvFamily(given.camera.model))
    throw sessions::InputError(arguments.file, "model",
                               std::string("a ") + sessions::cameraModelName(given.camera.model) +
                                   " camera has no vectors; write a .json file");
  noteEnding(arguments.out, given.camera.model);
  if (sessions::isCahvorFile(path(arguments.file)))
    return sessions::writeCahvorFile(arguments.out, sessions::readCahvorFile(arguments.file));
  sessions::CahvorFile cahvor_file;
  cahvor_file.cahv = cahvFromCamera(
      given.camera, given.reference ? given.reference->camera_from_reference : Pose());
  cahvor_file.width = given.camera.width;
  cahvor_file.height = given.camera.height;
  if (given.covariance)
    cahvor_file.covariance =
        inFrame(*given.covariance,
                given.reference ? given.reference->camera_from_reference.inverse() : Pose())
            .of_vectors;
  else if (given.calibration_sigma)
    cahvor_file.internal_covariance = internalCovariance(given.camera, *given.calibration_sigma);
  sessions::writeCahvorFile(arguments.out, cahvor_file);
  if (given.reference)
    note("the vectors are in " + frameText(given.reference->frame) +
         "; a text file cannot state this frame");
}

void convertAs(const CameraArguments& arguments, const sessions::CameraFile& given) {
  sessions::FittedCamera fitted;
  try {
    fitted = sessions::fitCamera(given.camera, modelNamed(arguments.model), arguments.distance_m);
  } catch (const std::runtime_error& error) {
    throw sessions::InputError(arguments.file, "model", error.what());
  }
  print(arguments.model + ": " + fitText(fitted));
  if (std::isfinite(arguments.distance_m))
    std::cout << "points " << arguments.distance_m << " m from the camera; of far ones the worst "
              << "error is " << fitted.worst_error_far_px << " px\n";
  else if (pupilMoves(given.camera))
    note("the entrance pupil moves, which shifts nearby points; state --distance");
  if (given.covariance)
    note(
        "the covariance of the vectors does not apply to the fitted camera; its sigmas of focal "
        "length and principal point are kept");
  if (!arguments.out.empty())
    sessions::writeFittedCamera(arguments.out, fitted, given,
                                path(arguments.file).filename().string(), arguments.distance_m);
}

int convert(const CameraArguments& arguments) {
  const sessions::CameraFile given = sessions::readCameraFile(path(arguments.file));
  if (!arguments.model.empty() && sessions::isCahvorFile(path(arguments.out)))
    throw CLI::ValidationError("--out",
                               "a text file holds vectors only; write a fitted model as .json");
  requireWritable({arguments.out});
  if (!arguments.model.empty()) {
    convertAs(arguments, given);
  } else if (arguments.out.empty()) {
    throw CLI::RequiredError("--as, --out or both");
  } else if (sessions::isCahvorFile(path(arguments.out))) {
    writeVectors(arguments, given);
  } else {
    sessions::writeCamera(path(arguments.out), given);
  }
  if (!arguments.out.empty()) print(arguments.out);
  return kDone;
}

}  // namespace

void addCamera(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "camera",
             "Converts a camera to another file format, or fits another model and prints its error",
             convert);
}

}  // namespace boresight::app
