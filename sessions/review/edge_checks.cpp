// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/edge_checks.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "sessions/review/camera_fit.h"
#include "sessions/review/check_making.h"
#include "sessions/review/edge_evidence.h"
#include "sessions/session/input_sigmas.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kCoverage{"edge_coverage", "Predicted edges that are seen"};
constexpr CheckName kClutter{"edge_clutter", "Edges on the station that are not predicted"};
constexpr CheckName kExplained{"edge_explained", "Edges that explain each other"};
constexpr CheckName kFallOff{"edge_fall_off", "Fall-off when the pose is displaced"};
constexpr CheckName kFocal{"camera_focal", "Focal length that the edges ask for"};
constexpr CheckName kCentre{"camera_centre", "Principal point that the edges ask for"};

constexpr const char* kCameraRemedy =
    "Camera, mesh and image do not fit together: make sure that the calibration is this camera's, "
    "of this focus setting and image size, and that the mesh is this station's.";

constexpr const char* kUndecidedRemedy =
    "The image cannot confirm the camera: state how well it is calibrated (calibration_sigma), or "
    "use a nearer image.";

Check coverageCheck(const EdgeEvidence& evidence, const CheckLimits& limits) {
  const double seen = evidence.coverage.value();
  return measuredCheck(
      kCoverage, "%", 100.0 * seen, limits.coverage_percent, LimitSide::kAtLeast,
      "The image shows " + percentText(seen) +
          " of the edges that this pose predicts, in place and direction.",
      "Look at the overlay: the pose or the mesh is wrong, or much is in the dark or hidden.");
}

Check clutterCheck(const EdgeEvidence& evidence, const CheckLimits& limits) {
  if (evidence.clutter.whole == 0.0)
    return notAskedCheck(kClutter, "The image shows no edges on the station.");
  const double share = evidence.clutter.value();
  return measuredCheck(
      kClutter, "%", 100.0 * share, limits.clutter_percent, LimitSide::kAtMost,
      percentText(share) + " of the image's edges on the station are none that the pose predicts.",
      "Look what they belong to: shadows and labels are harmless, another station "
      "or a part that the mesh lacks is not.");
}

/// A label or a screw that the mesh lacks leaves much unpredicted, a shadow or an obstacle leaves
/// much unseen; of a right pose one of the two is well explained.
Check explainedCheck(const EdgeEvidence& evidence, const CheckLimits& limits) {
  const double seen = evidence.coverage.value();
  const double predicted = evidence.clutter.whole > 0.0 ? 1.0 - evidence.clutter.value() : 0.0;
  return measuredCheck(kExplained, "%", 100.0 * std::max(seen, predicted), limits.explained_percent,
                       LimitSide::kAtLeast,
                       percentText(seen) + " of the predicted edges are seen, and " +
                           percentText(predicted) +
                           " of the edges seen on the station are predicted.",
                       "Neither explains the other: look at the overlay.");
}

Check fallOffCheck(const EdgeEvidence& evidence, const CheckLimits& limits) {
  const double seen = evidence.coverage.value();
  const auto least =
      std::max_element(evidence.fall_off.begin(), evidence.fall_off.end(),
                       [](const FallOff& a, const FallOff& b) { return a.coverage < b.coverage; });
  if (least == evidence.fall_off.end() || seen <= 0.0)
    return notAskedCheck(kFallOff, "None of the predicted edges is seen.");
  const double fall = 1.0 - least->coverage / seen;
  return measuredCheck(
      kFallOff, "%", 100.0 * fall, limits.fall_off_percent, LimitSide::kAtLeast,
      "Displaced by " + sentenceNumber(EvidenceSettings().displaced_px) +
          " px in the image, the pose loses least, " + percentText(fall) +
          " of the edges seen, when " + least->direction + ".",
      "The image hardly tells this pose from others that way: use marks or a second camera.");
}

/// One of the camera's parameters as the edges would have it.
struct AskedChange {
  double change = 0.0;
  double sigma = 0.0;
  double calibrated_sigma = 0.0;
  bool stated = false;  ///< that sigma; else it is assumed
  std::string unit;
};

/// What exceeds chance. Where nothing is stated of the calibration the image must confirm it: then
/// what the image cannot exclude counts as well.
double unexplained(const AskedChange& asked, double sigmas) {
  const double chance = sigmas * std::hypot(asked.sigma, asked.calibrated_sigma);
  const double beyond = std::max(0.0, std::abs(asked.change) - chance);
  return asked.stated ? beyond : std::max(beyond, sigmas * asked.sigma);
}

Check cameraCheck(const CheckName& name, const std::string& what, const AskedChange& asked,
                  double limit, double sigmas) {
  const double figure = unexplained(asked, sigmas);
  const bool undecided = !asked.stated && std::abs(asked.change) <= limit + sigmas * asked.sigma;
  return measuredCheck(name, asked.unit, figure, limit, LimitSide::kAtMost,
                       "Left free, the " + what + sentenceNumber(asked.change) + " " + asked.unit +
                           " (one sigma " + sentenceNumber(asked.sigma) + " " + asked.unit + ").",
                       undecided ? kUndecidedRemedy : kCameraRemedy);
}

void addCameraChecks(const std::optional<CameraFit>& fit, const SessionCase& one,
                     const CheckLimits& limits, std::vector<Check>& checks) {
  if (!fit) {
    const char* why = "The edges do not determine the camera together with the pose.";
    checks.push_back(notAskedCheck(kFocal, why));
    checks.push_back(notAskedCheck(kCentre, why));
    return;
  }
  const double percent = 100.0 / one.camera.fx;
  const InputSigmas known(one);
  checks.push_back(
      cameraCheck(kFocal, "focal length changes by ",
                  {percent * fit->focal_px, percent * fit->focal_sigma_px,
                   100.0 * known.calibration.focal_relative, known.calibration_stated, "%"},
                  limits.focal_percent, limits.sigmas));
  checks.push_back(
      cameraCheck(kCentre, "principal point moves by ",
                  {fit->centre_px, fit->centre_sigma_px, known.calibration.principal_point_px,
                   known.calibration_stated, "px"},
                  limits.centre_px, limits.sigmas));
}

/// A requirement in pixels says nothing of millimetres, and a wrong camera hardly moves the image.
bool asksForMetric(const Requirement& requirement) {
  return requirement.normal_mm || requirement.lateral_mm || requirement.rotation_deg;
}

bool canBeMeasured(const ReviewSubject& subject) {
  if (subject.loaded == nullptr) return false;
  const GrayImage& image = subject.loaded->image;
  const Camera& camera = subject.loaded->source.camera;
  return !image.pixels.empty() && image.width == camera.width && image.height == camera.height;
}

void addAll(const CheckName& name, bool failed, const std::string& why,
            std::vector<Check>& checks) {
  checks.push_back(failed ? statedCheck(name, false, why, "Look at the overlay, and at the seed.")
                          : notAskedCheck(name, why));
}

}  // namespace

void addEdgeChecks(const ReviewSubject& subject, const CheckLimits& limits,
                   const PredictedEdges& edges, std::vector<Check>& checks) {
  const bool measurable = canBeMeasured(subject);
  if (!measurable || edges.places.empty()) {
    const std::string why = measurable ? "The pose shows no edge of the station in the image."
                                       : "There is no image of the camera's size.";
    addAll(kCoverage, measurable, why, checks);
    for (const CheckName& name : {kClutter, kExplained, kFallOff, kFocal, kCentre})
      addAll(name, false, why, checks);
    return;
  }
  const LoadedCase& loaded = *subject.loaded;
  const EvidenceSettings settings;
  const ImageEdges image(loaded.image.view(), loaded.ignore ? &loaded.ignore_bits : nullptr,
                         regionOf(edges, settings));
  const auto places = thinned(edges.places, settings.places);
  const auto looked = lookAt(image, places, settings);
  EdgeEvidence evidence;
  evidence.coverage = coverageOf(looked, settings.near_px);
  evidence.clutter = clutterOf(image, edges, looked, settings);
  evidence.fall_off =
      fallOffOf(image, places, loaded.source.camera, subject.camera_from_station, settings);
  checks.push_back(coverageCheck(evidence, limits));
  checks.push_back(clutterCheck(evidence, limits));
  checks.push_back(explainedCheck(evidence, limits));
  checks.push_back(fallOffCheck(evidence, limits));
  if (asksForMetric(subject.requirement)) {
    addCameraChecks(fitCamera(looked, loaded.source.camera, subject.camera_from_station),
                    loaded.source, limits, checks);
    return;
  }
  for (const CheckName& name : {kFocal, kCentre})
    checks.push_back(notAskedCheck(
        name, "The requirement is one in the image, where a wrong camera hardly shows."));
}

}  // namespace boresight::sessions
