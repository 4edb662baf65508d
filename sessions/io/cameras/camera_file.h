// SPDX-License-Identifier: Apache-2.0
// Uncertainty of mesh scale and camera calibration, which one image cannot determine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/geometry/cahv_model.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "sessions/io/cameras/camera_covariance.h"
#include "sessions/io/json/json_reader.h"

namespace boresight::sessions {

/// One sigma of a mesh's scale (relative) where none is stated: 0.06 mm on a part of 0.3 m, or 9 K
/// of aluminium. Suitable for a machined part and its drawing, not for a scan.
inline constexpr double kAssumedMeshScaleSigma = 2e-4;

/// One sigma of a camera's calibration, as used. The defaults apply where none is stated; they are
/// typical of a calibration from many images of a target.
struct CalibrationSigma {
  double focal_relative = 2e-4;     ///< of fx and fy together, as a share of them
  double principal_point_px = 0.5;  ///< per axis

  bool operator==(const CalibrationSigma&) const = default;
};

/// The members of a CalibrationSigma that are known, at least one; the others are assumed.
struct StatedCalibration {
  std::optional<double> focal_relative;
  std::optional<double> principal_point_px;

  bool operator==(const StatedCalibration&) const = default;
};

inline constexpr double kMaxScaleSigma = 0.1;
inline constexpr double kMaxFocalSigma = 0.1;
inline constexpr double kMaxPrincipalPointSigma_px = 1000.0;

/// Reads {"focal_relative", "principal_point_px"}, of which one may be missing. InputError.
StatedCalibration readCalibrationSigma(const JsonReader& json);
nlohmann::ordered_json toJson(const StatedCalibration& sigma);

/// Longest side of an image or a camera, px: edge pixels are stored in 16 bits.
inline constexpr int kMaxImageSide_px = 16384;
/// Whether this is a whole number of pixels, 1 to kMaxImageSide_px.
bool isImageSide(double side_px);

/// Calls `visit(key, vector)` for each vector of the model: C A H V, of CAHVOR and CAHVORE also O
/// R, of CAHVORE also E.
template <class Cahv, class Visit>
void forVectors(Cahv& cahv, const Visit& visit) {
  visit("C", cahv.c_m);
  visit("A", cahv.a);
  visit("H", cahv.h_px);
  visit("V", cahv.v_px);
  if (cahv.model == CameraModel::kCahv) return;
  visit("O", cahv.o);
  visit("R", cahv.r);
  if (cahv.model == CameraModel::kCahvore) visit("E", cahv.e_m);
}

/// A frame of a vehicle or a site, as named in labels. Name and index (site, drive, pose ...)
/// together identify it.
struct FrameName {
  std::string name;  ///< empty: not stated
  std::vector<std::int64_t> index;

  bool operator==(const FrameName&) const = default;
};

/// "ROVER_FRAME (194, 835, 1)", or "a frame without a name".
std::string frameText(const FrameName& frame);
/// {"name", "index"}; the name is not empty. InputError.
FrameName readFrameName(const JsonReader& json);
nlohmann::ordered_json toJson(const FrameName& frame);

/// The frame in which the vectors of a CAHV camera are given.
struct CameraReference {
  Pose camera_from_reference;
  FrameName frame;

  bool operator==(const CameraReference&) const = default;
};

/// A camera in its own frame and, for the CAHV family, the pose of that frame.
struct CameraFile {
  Camera camera;
  std::optional<CameraReference> reference = std::nullopt;
  std::optional<StatedCalibration> calibration_sigma = std::nullopt;  ///< where the file states it
  /// Of the vectors in the camera's own frame, where the file states it; it is then used instead of
  /// calibration_sigma.
  std::optional<CameraCovariance> covariance = std::nullopt;
};

/// What the file states of the calibration: by its covariance, if it has one.
std::optional<StatedCalibration> statedCalibration(const CameraFile& file);

/// The camera of vectors that are given in a frame without a name; empty where it cannot project;
/// kVectorsCannotProject is the message.
std::optional<CameraFile> cameraOfVectors(const CahvModel& cahv, int width, int height);
inline constexpr const char* kVectorsCannotProject =
    "the camera cannot project with these vectors: A and O must have length 1 and lie within 60 "
    "deg, H and V must not lie along A or along each other, and 1 + r0 must be positive";

/// Reads camera.json (`boresight-camera`, version 1): pinhole, brown_conrady with 4, 5 or 8
/// coefficients, kannala_brandt with 4, cahv, cahvor and cahvore with their vectors; or the
/// metadata of a raw image. The camera is prepared for projection. InputError.
CameraFile readCameraJson(const std::filesystem::path& file);

/// A camera inside another file: the members of camera.json without format and version. InputError.
CameraFile readCameraFile(const JsonReader& json);

/// The members of camera.json without format and version; reading it back gives the same bits. The
/// vectors of the CAHV family are then those in the camera's own frame.
nlohmann::ordered_json toJson(const Camera& camera);
/// The same with vectors in the reference frame: reading them back is exact up to rounding.
nlohmann::ordered_json toJson(const CameraFile& file);

/// Writes camera.json; OutputError.
void writeCamera(const std::filesystem::path& file, const CameraFile& camera);

/// Name of a model in files, e.g. "brown_conrady".
const char* cameraModelName(CameraModel model);

/// Numbers of distortion coefficients that a model is used with, ascending; 0 alone for models
/// whose lens is not described by coefficients.
std::span<const int> coefficientCounts(CameraModel model);
/// The least of these numbers that leaves out zeros only.
int coefficientCount(const Camera& camera);
/// The model of the CAHV family of this name, in any case; empty for other names.
std::optional<CameraModel> cahvModelOf(const std::string& name);

}  // namespace boresight::sessions
