// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/pose_file.h"

#include <nlohmann/json.hpp>

#include "core/base/math.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

constexpr const char* kPoseFormat = "boresight-pose";
constexpr int kPoseVersion = 1;
constexpr double kLastRowTolerance = 1e-9;
constexpr double kNotedDeviation = 1e-6;
constexpr double kMaxTranslation_m = 1e6;
constexpr double kMostAsymmetry = 1e-6;  ///< of a covariance, of its diagonal
constexpr auto kPivot = choiceOf<UncertaintyPivot>("camera", "station");

}  // namespace

Pose readTransform(const JsonReader& json, double* rotation_deviation) {
  const Eigen::Matrix4d matrix = json.matrix<4>();
  const Eigen::RowVector4d last_row(0.0, 0.0, 0.0, 1.0);
  if ((matrix.row(3) - last_row).cwiseAbs().maxCoeff() > kLastRowTolerance)
    json.fail("the last row is not 0 0 0 1 (the matrix is row-major)");
  const Eigen::Vector3d translation_m = matrix.topRightCorner<3, 1>();
  if (translation_m.cwiseAbs().maxCoeff() > kMaxTranslation_m)
    json.fail("the translation exceeds " + numberText(kMaxTranslation_m) + " m");
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  Pose pose;
  double deviation = 0.0;
  if (poseFromMatrix(rotation, translation_m, pose, deviation) != Status::kOk) {
    if (rotation.determinant() <= 0.0)
      json.fail("not a rotation: the determinant is " + numberText(rotation.determinant()) +
                " (a mirror image or a singular matrix)");
    json.fail("not a rotation: |R'R - I| is " +
              numberText((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm()) +
              ", above 1e-4");
  }
  if (rotation_deviation != nullptr) *rotation_deviation = deviation;
  return pose;
}

bool isCovariance(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd sigma = matrix.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::MatrixXd asymmetry = matrix - matrix.transpose();
  const Eigen::MatrixXd allowed = kMostAsymmetry * sigma * sigma.transpose();
  return matrix.diagonal().minCoeff() >= 0.0 && (asymmetry.cwiseAbs() - allowed).maxCoeff() <= 0.0;
}

Matrix6d readCovariance(const JsonReader& json) {
  const Matrix6d matrix = json.matrix<6>();
  if (!isCovariance(matrix)) json.fail(kNoCovariance);
  return matrix;
}

DeclaredUncertainty readUncertainty(const JsonReader& json) {
  DeclaredUncertainty uncertainty;
  uncertainty.translation_m = json.at("translation_m").vector3(0.0, 1000.0);
  uncertainty.rotation_deg = json.at("rotation_deg").vector3(0.0, 180.0);
  json.optional("pivot", uncertainty.pivot, kPivot);
  return uncertainty;
}

namespace {

/// The message where the transforms do not join the frame of a pose to the camera.
std::string notJoinedText(const FrameName& frame, const PoseFrames& frames) {
  const bool model = frames.reference.has_value();
  const std::string needed =
      "the pose is given in " + frameText(frame) +
      (model ? ", but the camera model in " + frameText(frames.reference->frame) : "");
  if (model && frames.reference->frame.name.empty())
    return needed +
           "; if both are one frame, leave reference_frame out of the pose; else state the "
           "camera's frame in a camera.json and give their transform";
  const std::string wanted = model ? "the two" : "it and CAMERA";
  if (frames.transforms.empty())
    return needed + "; give the transform between " + wanted + " (transform.json)";
  std::vector<std::string> others;
  for (const FrameTransform& transform : frames.transforms)
    others.push_back(transform.file.filename().string() + " leads from " +
                     frameText(transform.source) + " to " + frameText(transform.target));
  return needed + ", and no transforms join " + wanted + ": " + joined(others);
}

/// A pose of the station in the camera model's frame, or in one that is joined to the camera.
void readReferencePose(const JsonReader& json, const PoseFrames& frames, PoseFile& pose) {
  const JsonReader given = json.at("reference_from_station");
  const auto named = json.find("reference_frame");
  if (!frames.reference && !named)
    given.fail(
        "needs reference_frame, or a camera of the CAHV family, whose file states its frame; or "
        "give camera_from_station");
  const Pose reference_from_station = readTransform(given, &pose.rotation_deviation);
  if (!named) {
    pose.station_frame = frames.reference->frame;
    pose.camera_from_station = frames.reference->camera_from_reference * reference_from_station;
    return;
  }
  pose.station_frame = readFrameName(*named);
  const FrameTree tree = frameTree(frames.reference, frames.transforms);
  const auto chain = tree.chain(kCameraFrame, *pose.station_frame);
  if (!chain) named->fail(notJoinedText(*pose.station_frame, frames));
  pose.camera_from_station = chain->a_from_b * reference_from_station;
}

}  // namespace

PoseFile readPose(const JsonReader& json, const PoseFrames& frames) {
  if (json.has("format"))
    json.requireFormat(kPoseFormat, kPoseVersion);  // a file's content in a dataset
  PoseFile pose;
  if (json.has("reference_from_station") && json.has("camera_from_station"))
    json.failMember("reference_from_station",
                    "cannot be combined with camera_from_station; give one of the two");
  if (json.has("reference_from_station")) {
    readReferencePose(json, frames, pose);
  } else {
    if (json.has("reference_frame"))
      json.failMember("reference_frame",
                      "belongs to reference_from_station, but the pose is camera_from_station");
    pose.camera_from_station =
        readTransform(json.at("camera_from_station"), &pose.rotation_deviation);
  }
  json.optional("uncertainty", pose.uncertainty, readUncertainty);
  json.optional("covariance", pose.covariance, readCovariance);
  return pose;
}

PoseFile readPose(const std::filesystem::path& file, const PoseFrames& frames) {
  const JsonDocument document(file);
  const JsonReader root = document.root();
  if (root.hasFormat(kValidatedPoseFormat)) {
    root.requireFormat(kValidatedPoseFormat, 1);
    PoseFile pose = readPose(root.at("pose"), frames);
    const auto run = root.find("run");
    pose.run_digest = run ? readSha256(run->at("digest")) : "";
    return pose;
  }
  return document.read(kPoseFormat, kPoseVersion,
                       [&frames](const JsonReader& json) { return readPose(json, frames); });
}

std::string projectionNote(double rotation_deviation) {
  if (rotation_deviation <= kNotedDeviation) return "";
  return "the matrix is slightly off a rotation (|R'R - I| = " + numberText(rotation_deviation) +
         ") and was projected to the nearest one";
}

SeedUncertainty seedUncertainty(const DeclaredUncertainty& declared,
                                const Pose& camera_from_station_seed,
                                const Eigen::Vector3d& matched_centre_in_station_m) {
  SeedUncertainty uncertainty{declared.translation_m, declared.rotation_deg * kDegree_rad};
  if (declared.pivot == UncertaintyPivot::kStation)
    uncertainty.pivot_in_camera_m = camera_from_station_seed * matched_centre_in_station_m;
  return uncertainty;
}

nlohmann::ordered_json toJson(const DeclaredUncertainty& uncertainty) {
  return {{"translation_m", toJson(uncertainty.translation_m)},
          {"rotation_deg", toJson(uncertainty.rotation_deg)},
          {"pivot", kPivot.write(uncertainty.pivot)}};
}

void writePose(const std::filesystem::path& file, const Pose& camera_from_station,
               const std::optional<DeclaredUncertainty>& uncertainty,
               const std::optional<Matrix6d>& covariance) {
  nlohmann::ordered_json json = {{"format", kPoseFormat}, {"version", kPoseVersion}};
  json["camera_from_station"] = toJson(camera_from_station);
  if (uncertainty) json["uncertainty"] = toJson(*uncertainty);
  if (covariance) json["covariance"] = toJson(*covariance);
  writeJsonFile(file, json);
}

}  // namespace boresight::sessions
