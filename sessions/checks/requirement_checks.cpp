// SPDX-License-Identifier: Apache-2.0
#include "sessions/checks/checks.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "sessions/checks/mesh_scale.h"
#include "sessions/checks/pose_quality.h"
#include "sessions/decision/check.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/io/files/least_known.h"
#include "sessions/session/pose_comparer.h"
#include "sessions/session/stated_inputs.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kAnnotation{"agreement_annotation", "Agreement with the annotation"};
constexpr CheckName kTruth{"agreement_truth", "Agreement with the truth"};
constexpr CheckName kCamera{"agreement_camera", "Agreement with the other camera"};
constexpr CheckName kScale{"mesh_scale", "Mesh scale estimated by the rig"};

/// A truth as near as this to a pose that was given was taken from it.
constexpr double kSamePose = 1e-6;  ///< rad, m

constexpr const char* kBySymmetry = " Poses that differ by a declared symmetry count as the same.";

/// How far two poses are apart: in words, and as the largest part of what is allowed.
struct Distance {
  double of_allowed = 0.0;            ///< 1: as far as allowed
  bool covariance_dominates = false;  ///< it allows more than the requirement does
  bool by_symmetry = false;           ///< to an equivalent of the other pose
  std::string text;
};

/// `apart` is the covariance of the difference of both poses; zero: not known.
Distance distanceTo(const Pose& other, const ReviewSubject& subject, const Matrix6d& apart,
                    double sigmas) {
  const Requirement& required = subject.requirement;
  const PoseComparer comparer = subject.comparer();
  const std::optional<Pose>& end_effector = comparer.endEffector();
  const Pose& pose = subject.camera_from_station;
  const PoseError error = comparer.difference(other, pose);
  const std::optional<PoseSigma> sigma = poseSigma(comparer.determined(apart, pose), end_effector);
  Distance distance;
  distance.by_symmetry = comparer.equivalent(other, pose) != other;
  const auto add = [&](double value, double limit, double known_to, const char* words) {
    const double allowed = std::hypot(limit, known_to);
    distance.of_allowed = std::max(distance.of_allowed, allowed > 0.0 ? value / allowed : 1e6);
    distance.covariance_dominates = distance.covariance_dominates || known_to > limit;
    distance.text += (distance.text.empty() ? "" : ", ") + sentenceNumber(value) + " " + words;
  };
  const auto addIfLimited = [&](std::optional<double> limit, double value,
                                double PoseSigma::*member, const char* words) {
    if (limit) add(value, *limit, sigma ? sigmas * (*sigma.*member) : 0.0, words);
  };
  addIfLimited(required.normal_mm, std::abs(error.normal_mm), &PoseSigma::normal_mm, "mm along");
  addIfLimited(required.lateral_mm, error.lateral_mm, &PoseSigma::lateral_mm, "mm across");
  if (!distance.text.empty())
    distance.text += std::string(" the view axis at the ") + judgedPlace(end_effector);
  addIfLimited(rotationLimit_mrad(required), error.rotation_mrad, &PoseSigma::out_of_plane_mrad,
               "mrad between the view axes");
  if (!required.projection_px) return distance;
  const std::optional<double> error_px = comparer.projection_px(other, pose);
  const std::optional<double> sigma_px = comparer.projectionSigma_px(pose, apart);
  constexpr double kHuge_px = 1e6;
  add(error_px.value_or(kHuge_px), *required.projection_px, sigmas * sigma_px.value_or(0.0),
      "px in the image");
  return distance;
}

Check agreementCheck(const CheckName& name, const ReviewSubject& subject, const OtherPose& other,
                     const Matrix6d& apart, const CheckLimits& limits, const std::string& remedy) {
  const Distance distance = distanceTo(other.camera_from_station, subject, apart, limits.sigmas);
  if (distance.text.empty()) return notAskedCheck(name, "The requirement has no limits.");
  std::string found = "The pose and " + other.from + " differ by " + distance.text + ".";
  if (distance.by_symmetry) found += kBySymmetry;
  if (distance.covariance_dominates)
    found += " Their covariances exceed the requirement, so that this check is weak.";
  return measuredCheck(name, "%", 100.0 * distance.of_allowed, limits.agreement_percent,
                       LimitSide::kAtMost, found, remedy);
}

/// Of poses by one camera and mesh, whose errors are in both.
Matrix6d apartOfOneCamera(const ReviewSubject& subject, const OtherPose& other) {
  if (!other.covariance.known()) return Matrix6d::Zero();
  return subject.covariance.picture + other.covariance.picture;
}

/// Of poses by two cameras that share the mesh.
Matrix6d apartOfTwoCameras(const ReviewSubject& subject, const OtherPose& other) {
  if (!other.covariance.known()) return Matrix6d::Zero();
  return apartOfOneCamera(subject, other) + subject.covariance.calibration +
         other.covariance.calibration;
}

Check camerasCheck(const ReviewSubject& subject, const CheckLimits& limits) {
  if (subject.other_cameras.empty())
    return notAskedCheck(kCamera, "No other camera of a rig has a pose.");
  std::optional<Check> worst;
  for (const OtherPose& other : subject.other_cameras) {
    Check check =
        agreementCheck(kCamera, subject, other, apartOfTwoCameras(subject, other), limits,
                       "One pose or the rig's camera positions are wrong: check both overlays.");
    if (!worst || check.figure.value_or(0.0) > worst->figure.value_or(0.0))
      worst = std::move(check);
  }
  return *worst;
}

/// One image cannot tell the mesh's scale from its distance; cameras with a baseline can.
Check meshScaleCheck(const ReviewSubject& subject, const CheckLimits& limits) {
  if (subject.loaded == nullptr || subject.other_cameras.empty())
    return notAskedCheck(kScale,
                         "One image cannot see the mesh's scale: it needs a rig, or an image from "
                         "another place on the arm, linked by frames, whose case has run on its "
                         "own.");
  const auto scale = meshScaleByRig(subject, matchedBounds(subject.loaded->scene.view()).centre());
  if (!scale) return notAskedCheck(kScale, "The rig's cameras have no baseline or no covariance.");
  const InputSigmas known(subject.loaded->source);
  const double known_to = limits.sigmas * std::hypot(scale->sigma, known.mesh_scale);
  const double figure = 100.0 * std::max(0.0, std::abs(scale->change) - known_to);
  return measuredCheck(
      kScale, "%", figure, limits.scale_percent, LimitSide::kAtMost,
      "By the rig's baseline the object is " + sentenceNumber(100.0 * std::abs(scale->change)) +
          " % " + (scale->change < 0.0 ? "larger" : "smaller") + " than its mesh (one sigma " +
          sentenceNumber(100.0 * scale->sigma) + " %). Errors below " +
          sentenceNumber(100.0 * known_to) + " % cannot be seen.",
      "The mesh has another scale than the object, or the rig's camera positions are wrong: "
      "measure a length of the object.");
}

Check annotationCheck(const ReviewSubject& subject, const CheckLimits& limits) {
  if (subject.source == PoseSource::kAnnotation)
    return notAskedCheck(kAnnotation, "The pose is that of the annotations.");
  if (!subject.annotated) return notAskedCheck(kAnnotation, "No annotations give a pose.");
  return agreementCheck(kAnnotation, subject, *subject.annotated,
                        apartOfOneCamera(subject, *subject.annotated), limits,
                        "Pose or annotations are wrong: compare overlay and annotations.");
}

Check truthCheck(const ReviewSubject& subject, const CheckLimits& limits) {
  if (subject.loaded == nullptr || !subject.loaded->source.camera_from_station_truth)
    return notAskedCheck(kTruth, "The case has no truth.");
  const SessionCase& session_case = subject.loaded->source;
  const Pose* judging = judgingTruth(session_case);
  if (judging == nullptr)
    return notAskedCheck(kTruth, "The truth is " + truthSourceText(session_case) +
                                     ": agreement with it proves nothing.");
  if (subject.source == PoseSource::kAnnotation &&
      perturbationBetween(*judging, subject.camera_from_station).cwiseAbs().maxCoeff() <= kSamePose)
    return notAskedCheck(kTruth,
                         "The truth is the pose of these annotations: agreement with it "
                         "proves nothing.");
  const std::string source = truthSourceText(session_case);
  const OtherPose truth{source.empty() ? "the truth" : "the truth (" + source + ")",
                        *judging,
                        {session_case.truth_covariance.value_or(Matrix6d::Zero())}};
  return agreementCheck(kTruth, subject, truth, apartOfOneCamera(subject, truth), limits,
                        truth.covariance.known()
                            ? "One of both poses is wrong: check both overlays."
                            : "The pose does not meet the requirement: reject it.");
}

constexpr const char* kNotRequired = "The requirement does not limit this value.";
constexpr const char* kNoCovariance =
    "The pose has no covariance, so that its precision is unknown.";
constexpr const char* kNoCovarianceRemedy = "Run the case again, or annotate it.";
constexpr const char* kPictureRemedy =
    "The seen edges constrain the pose too weakly: take a nearer image, or one with more of the "
    "station.";
constexpr const char* kInputsRemedy =
    "The image alone would pass: state mesh_scale_sigma and calibration_sigma after measurement, "
    "or take a nearer image.";

/// Names the motion that the image leaves undetermined, if one is clearly the least certain.
std::string imageRemedy(const ReviewSubject& subject) {
  const std::string least_known =
      leastKnownText(subject.determined(subject.covariance.picture), subject.camera_from_station);
  return least_known.empty() ? kPictureRemedy
                             : "Least known: " + least_known + ". " + kPictureRemedy;
}

std::string inputsText(const ReviewSubject& subject, const PrecisionFigure& figure) {
  const double inputs =
      std::sqrt(std::max(0.0, *figure.found * *figure.found - *figure.by_image * *figure.by_image));
  std::string text = "The image alone gives " + sentenceNumber(*figure.by_image) + " " +
                     figure.unit + "; the pose is limited by the mesh's scale";
  if (subject.loaded == nullptr) return text + " and the camera's calibration.";
  const InputSigmas known(subject.loaded->source);
  return text + " (" + meshScaleText(known) + ") and the camera's calibration (" +
         calibrationText(known) + "): " + sentenceNumber(inputs) + " " + figure.unit + ".";
}

Check precisionCheck(const ReviewSubject& subject, const PrecisionFigure& figure,
                     const std::string& sigmas) {
  if (!figure.required) return notAskedCheck(figure.check, kNotRequired);
  if (!figure.found) return statedCheck(figure.check, false, kNoCovariance, kNoCovarianceRemedy);
  const std::string unconfirmed = subject.degrees_of_freedom && figure.holds()
                                      ? unconfirmedSigmasText(*subject.degrees_of_freedom)
                                      : "";
  if (!unconfirmed.empty()) return statedCheck(figure.check, false, unconfirmed, "");
  return measuredCheck(figure.check, figure.unit, *figure.found, *figure.required,
                       LimitSide::kAtMost,
                       sigmas + figure.place + " are " + sentenceNumber(*figure.found) + " " +
                           figure.unit + ". " + inputsText(subject, figure),
                       *figure.by_image <= *figure.required ? kInputsRemedy : imageRemedy(subject));
}

}  // namespace

void addAgreementChecks(const ReviewSubject& subject, const CheckLimits& limits,
                        std::vector<Check>& checks) {
  checks.push_back(annotationCheck(subject, limits));
  checks.push_back(truthCheck(subject, limits));
  checks.push_back(camerasCheck(subject, limits));
  checks.push_back(meshScaleCheck(subject, limits));
}

bool withinRequirement(const ReviewSubject& subject, const Pose& camera_from_station) {
  const Distance distance = distanceTo(camera_from_station, subject, Matrix6d::Zero(), 0.0);
  return !distance.text.empty() && distance.of_allowed <= 1.0;
}

void addPrecisionChecks(const ReviewSubject& subject, const CheckLimits& limits,
                        std::vector<Check>& checks) {
  const PoseQuality quality = poseQuality(subject, limits.sigmas);
  for (const PrecisionFigure& figure : quality.figures)
    checks.push_back(precisionCheck(subject, figure, quality.sigmasText()));
}

}  // namespace boresight::sessions
