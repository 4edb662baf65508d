// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/edge_checks.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "sessions/review/camera_fit.h"
#include "sessions/review/check_making.h"
#include "sessions/review/edge_evidence.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kCoverage{"edge_coverage", "Predicted edges that are seen"};
constexpr CheckName kClutter{"edge_clutter", "Edges on the station that are not predicted"};
constexpr CheckName kFallOff{"edge_fall_off", "Fall-off when the pose is displaced"};
constexpr CheckName kFocal{"camera_focal", "Focal length that the edges ask for"};
constexpr CheckName kCentre{"camera_centre", "Principal point that the edges ask for"};

constexpr const char* kCameraRemedy =
    "Camera, mesh and image do not fit together: make sure that the calibration is this camera's, "
    "of this focus setting and image size, and that the mesh is this station's.";

std::string percentText(double share) {
  return std::to_string(static_cast<int>(std::lround(100.0 * share))) + " %";
}

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

/// What is asked for beyond what may be chance.
double beyondChance(double change, double sigma, double sigmas) {
  return std::max(0.0, std::abs(change) - sigmas * sigma);
}

void addCameraChecks(const std::optional<CameraFit>& fit, const Camera& camera,
                     const CheckLimits& limits, std::vector<Check>& checks) {
  if (!fit) {
    const char* why = "The edges do not determine the camera together with the pose.";
    checks.push_back(notAskedCheck(kFocal, why));
    checks.push_back(notAskedCheck(kCentre, why));
    return;
  }
  const double focal_percent = 100.0 * fit->focal_px / camera.fx;
  const double focal_sigma_percent = 100.0 * fit->focal_sigma_px / camera.fx;
  checks.push_back(measuredCheck(
      kFocal, "%", beyondChance(focal_percent, focal_sigma_percent, limits.sigmas),
      limits.focal_percent, LimitSide::kAtMost,
      "Left free, the focal length changes by " + sentenceNumber(focal_percent) + " % (one sigma " +
          sentenceNumber(focal_sigma_percent) + " %); what exceeds chance counts.",
      kCameraRemedy));
  checks.push_back(measuredCheck(
      kCentre, "px", beyondChance(fit->centre_px, fit->centre_sigma_px, limits.sigmas),
      limits.centre_px, LimitSide::kAtMost,
      "Left free, the principal point moves by " + sentenceNumber(fit->centre_px) +
          " px (one sigma " + sentenceNumber(fit->centre_sigma_px) +
          " px); what exceeds chance counts.",
      kCameraRemedy));
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
    for (const CheckName& name : {kClutter, kFallOff, kFocal, kCentre})
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
  checks.push_back(fallOffCheck(evidence, limits));
  addCameraChecks(fitCamera(looked, loaded.source.camera, subject.camera_from_station),
                  loaded.source.camera, limits, checks);
}

}  // namespace boresight::sessions
