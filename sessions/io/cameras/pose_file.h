// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "core/geometry/pose.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/cameras/frame_tree.h"
#include "sessions/io/json/json_reader.h"

namespace boresight::sessions {

enum class UncertaintyPivot { kCamera, kStation };

/// Uncertainty of a seed as files state it, per axis of the seed camera frame.
struct DeclaredUncertainty {
  Eigen::Vector3d translation_m = Eigen::Vector3d::Constant(0.03);
  Eigen::Vector3d rotation_deg = Eigen::Vector3d::Constant(5.0);
  UncertaintyPivot pivot = UncertaintyPivot::kCamera;

  bool operator==(const DeclaredUncertainty&) const = default;
};

/// Format of validated_pose.json, whose pose can be a seed or a truth.
inline constexpr const char* kValidatedPoseFormat = "boresight-validated-pose";

/// Content of a pose file (or of a pose inside another file).
struct PoseFile {
  Pose camera_from_station;
  /// |R'R - I| (Frobenius) of the matrix in the file, before it was projected to a rotation.
  double rotation_deviation = 0.0;
  std::optional<DeclaredUncertainty> uncertainty;
  /// Over (rotation rad, translation m), left perturbation, camera frame; empty: not stated.
  std::optional<Matrix6d> covariance = std::nullopt;
  /// Of a pose that was given as `reference_from_station`; the name may be empty.
  std::optional<FrameName> station_frame = std::nullopt;
  /// Of the pose of a validated_pose.json: the digest of its run, or "" for one of annotations.
  std::optional<std::string> run_digest = std::nullopt;
};

/// Data to convert a pose in a named frame to the camera frame.
struct PoseFrames {
  /// Of a camera of the CAHV family.
  std::optional<CameraReference> reference = std::nullopt;
  /// Transforms that join frames to the camera model's or the camera's.
  std::vector<FrameTransform> transforms = {};
};

/// Reads pose.json (`boresight-pose`, version 1), or the pose and its covariance of a
/// validated_pose.json, which may state NOT VALIDATED. `reference_from_station` may replace
/// `camera_from_station`: in the camera model's frame, or in the frame that `reference_frame`
/// {name, index} names, which the transforms join to the camera model's or the camera's. A
/// covariance or uncertainty is always stated in the camera frame. InputError.
PoseFile readPose(const std::filesystem::path& file, const PoseFrames& frames = {});
/// The same for a pose inside another file, without format and version.
PoseFile readPose(const JsonReader& json, const PoseFrames& frames = {});

/// A 4x4 rigid transform: last row 0 0 0 1, everything finite, and a rotation with
/// |R'R - I| <= 1e-4, which is projected to the nearest one; otherwise rejected.
/// `rotation_deviation` may be nullptr.
Pose readTransform(const JsonReader& json, double* rotation_deviation = nullptr);

/// Whether a square matrix is symmetric with no negative diagonal element.
bool isCovariance(const Eigen::MatrixXd& matrix);
inline constexpr const char* kNoCovariance =
    "not a covariance: not symmetric, or below 0 on its diagonal";
/// Six rows of six numbers. InputError.
Matrix6d readCovariance(const JsonReader& json);

/// Translations 0 .. 1000 m, rotations 0 .. 180 deg; `pivot` is "camera" where it is not given.
DeclaredUncertainty readUncertainty(const JsonReader& json);

/// A line for the operator when the matrix deviates from a rotation by more than 1e-6 (more than
/// single precision explains), else empty.
std::string projectionNote(double rotation_deviation);

/// The uncertainty in the core's form: radians, and the pivot in the seed camera's frame, which for
/// `station` is the centre of the bounding box of the matched parts.
SeedUncertainty seedUncertainty(const DeclaredUncertainty& declared,
                                const Pose& camera_from_station_seed,
                                const Eigen::Vector3d& matched_centre_in_station_m);

nlohmann::ordered_json toJson(const DeclaredUncertainty& uncertainty);
/// Writes pose.json; OutputError.
void writePose(const std::filesystem::path& file, const Pose& camera_from_station,
               const std::optional<DeclaredUncertainty>& uncertainty = std::nullopt,
               const std::optional<Matrix6d>& covariance = std::nullopt);

}  // namespace boresight::sessions
