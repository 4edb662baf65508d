// SPDX-License-Identifier: Apache-2.0
#include "sessions/checks/pose_uncertainty.h"

#include <nlohmann/json.hpp>

#include "core/base/math.h"
#include "core/pnp/normal_equations.h"
#include "sessions/annotation/annotations_on_image.h"
#include "sessions/checks/edge_evidence.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

/// This number of points gives the sums to a percent.
constexpr std::size_t kPlaces = 4000;

using ByCamera = Eigen::Matrix<double, 6, 3>;

/// That of a single point, without turning.
ByCamera pointByCamera(const Camera& camera, const Eigen::Vector3d& point_in_camera_m) {
  ByCamera by = ByCamera::Zero();
  by.bottomRows<3>() = point_in_camera_m.z() / camera.fx *
                       Eigen::Matrix3d{{0.0, -1.0, 0.0},  //
                                       {0.0, 0.0, -1.0},
                                       {1.0, 0.0, 0.0}};
  return by;
}

/// How a place's distance along its normal follows each component of the vectors; empty where the
/// place does not project.
std::optional<Eigen::RowVectorXd> distanceByVectors(const std::vector<VectorStep>& steps,
                                                    const EdgePlace& place,
                                                    const Eigen::Vector3d& point_in_camera_m) {
  Eigen::RowVectorXd by(std::ssize(steps));
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto& [before, after, width] = steps[i];
    Eigen::Vector2d from, to;
    if (!project(before.camera, before.displaced_from_camera * point_in_camera_m, from) ||
        !project(after.camera, after.displaced_from_camera * point_in_camera_m, to))
      return {};
    by[static_cast<Eigen::Index>(i)] = place.normal.dot(to - from) / width;
  }
  return by;
}

/// Derivative of the fitted pose by some parameters: -(J' J)^-1 J' K, with the rows of J by the
/// pose and those of K (`distance_by`) by the parameters, of each place's distance along its
/// normal. Empty where the places do not determine the pose. `right` is zero, with a column per
/// parameter.
template <class Right, class DistanceBy>
std::optional<Right> poseBy(std::span<const EdgePlace> places, const Camera& camera,
                            const Pose& camera_from_station, Right right,
                            const DistanceBy& distance_by) {
  Matrix6d information = Matrix6d::Zero();
  for (const EdgePlace& place : places) {
    const PredictedPlace at = predictPlace(camera, camera_from_station, place.point_in_station_m);
    if (!at.valid) continue;
    const auto distance = distance_by(place, at.pixel);
    if (!distance) continue;
    const Vector6d row = at.pixel_by_xi.transpose() * place.normal;
    information += row * row.transpose();
    right -= row * *distance;
  }
  Matrix6d inverse;
  if (!invert(information, inverse)) return {};
  return inverse * right;
}

/// The calibration's part of a pose's covariance where focal length and principal point err alone.
Matrix6d bySigmas(std::span<const EdgePlace> places, const Camera& camera,
                  const Pose& camera_from_station, const CalibrationSigma& sigma,
                  const Eigen::Vector3d& middle_in_camera_m) {
  const Eigen::Vector3d sigmas_px(sigma.focal_relative * camera.fx, sigma.principal_point_px,
                                  sigma.principal_point_px);
  const ByCamera scaled = poseByCamera(places, camera, camera_from_station)
                              .value_or(pointByCamera(camera, middle_in_camera_m)) *
                          sigmas_px.asDiagonal();
  return scaled * scaled.transpose();
}

}  // namespace

std::optional<ByCamera> poseByCamera(std::span<const EdgePlace> places, const Camera& camera,
                                     const Pose& camera_from_station) {
  return poseBy(places, camera, camera_from_station, ByCamera(ByCamera::Zero()),
                [&camera](const EdgePlace& place, const Eigen::Vector2d& pixel) {
                  return std::optional<Eigen::RowVector3d>(place.normal.transpose() *
                                                           pixelByCamera(camera, pixel));
                });
}

std::optional<Eigen::MatrixXd> poseByVectors(std::span<const EdgePlace> places,
                                             const Camera& camera,
                                             const Pose& camera_from_station) {
  const std::vector<VectorStep> steps = vectorSteps(camera);
  if (steps.empty()) return {};
  return poseBy(places, camera, camera_from_station,
                Eigen::MatrixXd(Eigen::MatrixXd::Zero(6, std::ssize(steps))),
                [&](const EdgePlace& place, const Eigen::Vector2d&) {
                  return distanceByVectors(steps, place,
                                           camera_from_station * place.point_in_station_m);
                });
}

PoseCovariance poseCovariance(const SessionCase& session_case, const MeshView& mesh,
                              const Pose& camera_from_station, const Matrix6d& picture) {
  const Camera& camera = session_case.camera;
  const InputSigmas sigmas(session_case);
  const Eigen::Vector3d middle_in_camera_m = camera_from_station * matchedBounds(mesh).centre();
  PoseCovariance covariance;
  covariance.picture = picture;
  Vector6d by_scale = Vector6d::Zero();
  by_scale.tail<3>() = sigmas.mesh_scale * middle_in_camera_m;
  covariance.mesh_scale = by_scale * by_scale.transpose();
  const PredictedEdges edges = predictEdges(camera, mesh, camera_from_station);
  const std::vector<EdgePlace> places = thinned(edges.places, kPlaces);
  std::optional<Eigen::MatrixXd> by_vectors;
  if (session_case.camera_covariance)
    by_vectors = poseByVectors(places, camera, camera_from_station);
  covariance.calibration =
      by_vectors
          ? Matrix6d(*by_vectors * session_case.camera_covariance->of_vectors *
                     by_vectors->transpose())
          : bySigmas(places, camera, camera_from_station, sigmas.calibration, middle_in_camera_m);
  return covariance;
}

EndEffectorPose endEffectorPose(const Pose& camera_from_station_seed,
                                const Pose& camera_from_station,
                                const Pose& camera_from_end_effector, const Matrix6d& covariance,
                                const Matrix6d& camera_from_end_effector_covariance) {
  EndEffectorPose end_effector_pose;
  end_effector_pose.station_from_end_effector =
      camera_from_station.inverse() * camera_from_end_effector;
  end_effector_pose.end_effector_seed_from_end_effector_estimated =
      camera_from_end_effector.inverse() * camera_from_station_seed *
      end_effector_pose.station_from_end_effector;
  // camera_from_station -> Exp(xi) camera_from_station turns station_from_end_effector into
  // camera_from_station^-1 Exp(-xi) camera_from_end_effector, which is it times Exp(-Ad xi); an
  // error of camera_from_end_effector is on the same side.
  const Matrix6d turn = adjointOf(camera_from_end_effector.inverse());
  end_effector_pose.covariance =
      turn * (covariance + camera_from_end_effector_covariance) * turn.transpose();
  return end_effector_pose;
}

EndEffectorPose endEffectorPose(const SessionCase& session_case, const Pose& camera_from_station,
                                const Matrix6d& covariance) {
  const auto chain = framesOf(session_case).chain(kCameraFrame, kEndEffectorFrame);
  return endEffectorPose(session_case.camera_from_station_seed, camera_from_station,
                         *session_case.camera_from_end_effector, covariance,
                         chain ? chain->covariance : Matrix6d::Zero());
}

std::vector<Correction> correctionsOf(const SessionCase& session_case,
                                      const Pose& camera_from_station, const Matrix6d& covariance) {
  if (!session_case.camera_from_end_effector || !session_case.has_seed) return {};
  const EndEffectorPose pose = endEffectorPose(session_case, camera_from_station, covariance);
  const Pose move = pose.end_effector_seed_from_end_effector_estimated.inverse();
  // (move^-1 Exp(xi))^-1 = Exp(xi)^-1 move turns by -r and shifts by -t - r x move.translation_m.
  const Pose back{Eigen::Quaterniond::Identity(), -move.translation_m};
  const Correction own{kEndEffectorFrame, move.translation_m, rotationLog(move.rotation),
                       covarianceIn(back, pose.covariance)};
  std::vector<Correction> corrections = {own};
  const FrameTree tree = framesOf(session_case);
  for (const FrameName& frame : tree.frames()) {
    const auto chain = tree.chain(frame, kEndEffectorFrame);
    if (!chain || frame == kEndEffectorFrame) continue;
    const Eigen::Matrix3d turn = chain->a_from_b.rotation.toRotationMatrix();
    Matrix6d both = Matrix6d::Zero();
    both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = turn;
    corrections.push_back({frame, turn * own.translation_m, turn * own.rotation_rad,
                           both * own.covariance * both.transpose()});
  }
  return corrections;
}

std::string correctionText(const Correction& correction) {
  const Vector6d sigma = sigmasOf(correction.covariance);
  const auto row = [](const char* name, const Eigen::Vector3d& value, const auto& one_sigma,
                      int decimals) {
    std::string text = std::string("  ") + name;
    for (int axis = 0; axis < 3; ++axis)
      text += "  " + fixedText(1e3 * value[axis], decimals) + " +- " +
              fixedText(1e3 * one_sigma[axis], decimals);
    return text + "\n";
  };
  return "correction to command in " + frameText(correction.frame) +
         ", at the end effector (x, y, z; 1 sigma)\n" +
         row("translation, mm", correction.translation_m, sigma.tail<3>(), 3) +
         row("rotation, mrad ", correction.rotation_rad, sigma.head<3>(), 3);
}

nlohmann::ordered_json toJson(const std::vector<Correction>& corrections) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Correction& correction : corrections)
    json[frameText(correction.frame)] = {
        {"translation_m", toJson(correction.translation_m)},
        {"rotation_deg", toJson(Eigen::Vector3d(correction.rotation_rad / kDegree_rad))},
        {"covariance", toJson(correction.covariance)}};
  return json;
}

}  // namespace boresight::sessions
