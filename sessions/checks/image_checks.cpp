// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "sessions/checks/checks.h"
#include "sessions/decision/check.h"
#include "sessions/run/image_quality.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kSaturated{"image_saturated", "Saturated pixels on the station"};
constexpr CheckName kSharpness{"image_sharpness", "Width of the strongest edges on the station"};
constexpr CheckName kRange{"image_range", "Range of gray levels on the station"};

}  // namespace

void addImageChecks(const ReviewSubject& subject, const CheckLimits& limits,
                    std::vector<Check>& checks) {
  std::optional<ImageQuality> quality;
  if (subject.loaded != nullptr) {
    const LoadedCase& loaded = *subject.loaded;
    quality = measureImageQuality(
        loaded.image.view(), loaded.ignore ? &loaded.ignore_bits : nullptr,
        stationRegion(loaded.source.camera, loaded.scene.view(), subject.camera_from_station));
  }
  if (!quality)
    return addNotAsked({kSaturated, kRange, kSharpness},
                       "The pose shows no pixel of the station in the image.", checks);
  checks.push_back(measuredCheck(
      kSaturated, "%", 100.0 * quality->saturated_share, limits.saturated_percent,
      LimitSide::kAtMost,
      percentText(quality->saturated_share) + " of the pixels on the station are saturated.",
      "Use an image with less exposure."));
  checks.push_back(measuredCheck(
      kRange, "", quality->range_gray, limits.range_gray, LimitSide::kAtLeast,
      "The pixels on the station span " + sentenceNumber(quality->range_gray) + " gray levels.",
      "Use an image with more exposure, or state the bit depth."));
  if (quality->edge_width_px == 0.0) {
    checks.push_back(notAskedCheck(kSharpness, "Too few edges on the station are strong enough."));
    return;
  }
  checks.push_back(measuredCheck(
      kSharpness, "px", quality->edge_width_px, limits.edge_width_px, LimitSide::kAtMost,
      "The strongest edges on the station are " + sentenceNumber(quality->edge_width_px) +
          " px wide in the least sharp direction, independent of the pose.",
      "The image is blurred by motion or focus, or overexposed: use a sharper image."));
}

}  // namespace boresight::sessions
