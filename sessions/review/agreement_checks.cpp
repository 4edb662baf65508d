// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/agreement_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "sessions/evaluation/pose_error.h"
#include "sessions/evaluation/pose_sigma.h"
#include "sessions/review/check_making.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kAnnotation{"agreement_annotation", "Agreement with the annotation"};
constexpr CheckName kTruth{"agreement_truth", "Agreement with the truth"};
constexpr CheckName kCamera{"agreement_camera", "Agreement with the other camera"};

constexpr double kMradPerDegree = 1e3 * std::numbers::pi / 180.0;

/// How far two poses are apart: in words, and as the largest part of what is allowed.
struct Distance {
  double of_allowed = 0.0;            ///< 1: as far as allowed
  bool covariance_dominates = false;  ///< it allows more than the requirement does
  std::string text;
};

class Measure {
 public:
  /// `apart` is the covariance of the difference of both poses; zero: not known.
  Measure(const ReviewSubject& subject, const Pose& other, const Matrix6d& apart, double sigmas)
      : subject_(subject),
        error_(poseError(other, subject.camera_from_station, endEffector(subject))),
        sigmas_(sigmas),
        sigma_(poseSigma(apart, endEffector(subject))) {
    if (!subject.requirement.projection_px || subject.loaded == nullptr) return;
    const Camera& camera = subject.loaded->source.camera;
    const auto vertices = matchedVertices(subject.loaded->scene.view());
    error_.projection_px = projectionError(camera, other, subject.camera_from_station, vertices);
    sigma_px_ = projectionSigma(camera, subject.camera_from_station, vertices, apart);
  }

  Distance distance() {
    const Requirement& required = subject_.requirement;
    add(required.normal_mm, std::abs(error_.normal_mm), &PoseSigma::normal_mm, "mm along");
    add(required.lateral_mm, error_.lateral_mm, &PoseSigma::lateral_mm, "mm across");
    if (!text_.empty())
      text_ += std::string(" the view axis at the ") + judgedPlace(endEffector(subject_));
    std::optional<double> rotation_mrad;
    if (required.rotation_deg) rotation_mrad = *required.rotation_deg * kMradPerDegree;
    add(rotation_mrad, error_.rotation_mrad, &PoseSigma::out_of_plane_mrad,
        "mrad between the view axes");
    if (required.projection_px) addProjection(*required.projection_px);
    made_.text = text_;
    return made_;
  }

 private:
  static std::optional<Pose> endEffector(const ReviewSubject& subject) {
    if (subject.loaded == nullptr) return {};
    return subject.loaded->source.camera_from_end_effector;
  }

  void add(std::optional<double> required, double error, double PoseSigma::*member,
           const char* words) {
    if (!required) return;
    const double known_to = sigma_ ? sigmas_ * (*sigma_.*member) : 0.0;
    note(error, *required, known_to, words);
  }

  void addProjection(double required_px) {
    const double huge_px = 1e6;
    note(error_.projection_px.value_or(huge_px), required_px, sigmas_ * sigma_px_.value_or(0.0),
         "px in the image");
  }

  void note(double error, double required, double known_to, const char* words) {
    const double allowed = std::hypot(required, known_to);
    made_.of_allowed = std::max(made_.of_allowed, allowed > 0.0 ? error / allowed : 1e6);
    made_.covariance_dominates = made_.covariance_dominates || known_to > required;
    text_ += (text_.empty() ? "" : ", ") + sentenceNumber(error) + " " + words;
  }

  const ReviewSubject& subject_;
  PoseError error_;
  double sigmas_;
  std::optional<PoseSigma> sigma_;
  std::optional<double> sigma_px_;
  Distance made_;
  std::string text_;
};

Check agreementCheck(const CheckName& name, const ReviewSubject& subject, const OtherPose& other,
                     const Matrix6d& apart, const CheckLimits& limits, const std::string& remedy) {
  const Distance distance =
      Measure(subject, other.camera_from_station, apart, limits.sigmas).distance();
  if (distance.text.empty()) return notAskedCheck(name, "The requirement names nothing.");
  std::string found = "The pose and " + other.from + " are apart by " + distance.text + ".";
  if (distance.covariance_dominates)
    found += " Their covariances allow more than the requirement does: this says little.";
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
    Check one = agreementCheck(kCamera, subject, other, apartOfTwoCameras(subject, other), limits,
                               "One of both is wrong, or the cameras do not lie as the rig says: "
                               "look at both overlays.");
    if (!worst || one.figure.value_or(0.0) > worst->figure.value_or(0.0)) worst = std::move(one);
  }
  return *worst;
}

Check annotationCheck(const ReviewSubject& subject, const CheckLimits& limits) {
  if (subject.source == PoseSource::kAnnotation)
    return notAskedCheck(kAnnotation, "The pose is that of the annotation.");
  if (!subject.annotated) return notAskedCheck(kAnnotation, "No marks give a pose.");
  return agreementCheck(kAnnotation, subject, *subject.annotated,
                        apartOfOneCamera(subject, *subject.annotated), limits,
                        "Look where the overlay and the marks differ: one of both is wrong.");
}

Check truthCheck(const ReviewSubject& subject, const CheckLimits& limits) {
  if (subject.loaded == nullptr || !subject.loaded->source.camera_from_station_truth)
    return notAskedCheck(kTruth, "The case has no truth.");
  const SessionCase& one = subject.loaded->source;
  const OtherPose truth{"the truth",
                        *one.camera_from_station_truth,
                        {one.truth_covariance.value_or(Matrix6d::Zero())}};
  return agreementCheck(kTruth, subject, truth, apartOfOneCamera(subject, truth), limits,
                        truth.covariance.known()
                            ? "One of both is wrong: look at the overlays of both."
                            : "The pose does not meet the requirement: reject it.");
}

}  // namespace

void addAgreementChecks(const ReviewSubject& subject, const CheckLimits& limits,
                        std::vector<Check>& checks) {
  checks.push_back(annotationCheck(subject, limits));
  checks.push_back(truthCheck(subject, limits));
  checks.push_back(camerasCheck(subject, limits));
}

bool withinRequirement(const ReviewSubject& subject, const Pose& camera_from_station) {
  const Distance distance = Measure(subject, camera_from_station, Matrix6d::Zero(), 0.0).distance();
  return !distance.text.empty() && distance.of_allowed <= 1.0;
}

}  // namespace boresight::sessions
