// SPDX-License-Identifier: Apache-2.0
// Whether a label's camera model is that of the image it stands in.
#include <algorithm>
#include <cmath>

#include "sessions/io/label_camera.h"
#include "sessions/io/label_values.h"

namespace boresight::sessions {
namespace {

constexpr double kFarOff = 0.35;         ///< of a side: an uncut image's principal point
constexpr double kFarOutside = 0.5;      ///< of a side beyond the border, where nothing is said
constexpr double kMostUnequal = 1.25;    ///< of focal lengths on the detector
constexpr double kShortestFocal = 0.05;  ///< of the image's longer side
constexpr double kLongestFocal_px = 1e6;

/// Along one side of the image.
struct Side {
  const char* name;
  double size_px;
  double principal_px;  ///< in the image
  double first = 0.0;   ///< of the detector
  double step = 1.0;    ///< detector samples a pixel

  double onDetector() const { return first + (principal_px + 0.5) * step - 0.5; }
  double end() const { return first + size_px * step; }
};

std::string place(const Side& x, const Side& y) {
  return "(" + fixedNumber(x.principal_px, 1) + ", " + fixedNumber(y.principal_px, 1) + ")";
}

std::string sizeText(const Side& x, const Side& y) {
  return fixedNumber(x.size_px, 0) + " x " + fixedNumber(y.size_px, 0);
}

constexpr const char* kAdvice = "; give a camera file that fits";

std::string uncutMisfit(const Side& x, const Side& y, bool stated) {
  const double most = stated ? kFarOff : 0.5 + kFarOutside;
  const auto off = [most](const Side& side) {
    return std::abs(side.principal_px - 0.5 * (side.size_px - 1.0)) > most * side.size_px;
  };
  if (!off(x) && !off(y)) return "";
  return "the label's camera model does not fit the image: its principal point would be at " +
         place(x, y) + " of " + sizeText(x, y) + " px" +
         (stated ? ", although the image is said to be uncut" : ", and no sub-frame is stated") +
         kAdvice;
}

/// Of a cut image the principal point may lie outside. Read as the model of the sub-frame it has a
/// place on the detector, and another one read as the model of the whole detector.
std::string cutMisfit(const Side& x, const Side& y, bool of_subframe) {
  const auto beyond = [](const Side& side, double at) { return at < -0.5 || at > side.end(); };
  const bool beyond_as_subframe = beyond(x, x.onDetector()) || beyond(y, y.onDetector());
  const bool beyond_as_whole = beyond(x, x.principal_px) || beyond(y, y.principal_px);
  if (beyond_as_subframe && !beyond_as_whole)
    return "the label's camera model is that of the whole detector, not of the sub-frame at "
           "sample " +
           fixedNumber(x.first, 0) + ", line " + fixedNumber(y.first, 0) +
           ": give a camera file with these vectors and that subframe";
  if (of_subframe || (beyond_as_whole && !beyond_as_subframe)) return "";
  return "the label does not show whether its camera model is that of the whole detector or of the "
         "sub-frame at sample " +
         fixedNumber(x.first, 0) + ", line " + fixedNumber(y.first, 0) + kAdvice;
}

std::string focalMisfit(const Side& x, const Side& y, double fx, double fy, bool stated) {
  const double longest = std::max(x.size_px, y.size_px);
  const auto absurd = [longest](double focal_px) {
    return !(focal_px >= kShortestFocal * longest && focal_px <= kLongestFocal_px);
  };
  if (absurd(fx) || absurd(fy))
    return "the label's camera model is no camera's: focal lengths of " + fixedNumber(fx, 3) +
           " and " + fixedNumber(fy, 3) + " px for an image of " + sizeText(x, y) + " px";
  const double ratio = fx * x.step / (fy * y.step);
  if (stated && (ratio > kMostUnequal || ratio < 1.0 / kMostUnequal))
    return "the label's camera model does not fit the down-sampling by " + fixedNumber(x.step, 2) +
           " x " + fixedNumber(y.step, 2) + ": focal lengths of " + fixedNumber(fx, 1) + " and " +
           fixedNumber(fy, 1) + " px" + kAdvice;
  return "";
}

}  // namespace

std::string cameraMisfit(const CahvModel& cahv, int width, int height,
                         const std::optional<LabelSubframe>& subframe, bool of_subframe) {
  Camera camera;
  Pose camera_from_reference;
  if (!(std::abs(cahv.a.norm() - 1.0) <= 1e-3))
    return "the label's camera model is no camera's: its axis A has the length " +
           fixedNumber(cahv.a.norm(), 4) + " instead of 1";
  if (cameraFromCahv(cahv, width, height, camera, camera_from_reference) != Status::kOk)
    return "the label's camera model cannot project: O must have length 1 and lie within 60 deg of "
           "A, H and V must not lie along A or along each other, and 1 + r0 must be positive";
  Side x{"sample", static_cast<double>(width), camera.cx};
  Side y{"line", static_cast<double>(height), camera.cy};
  if (subframe) {
    x.first = subframe->first_sample;
    x.step = subframe->samples_per_pixel;
    y.first = subframe->first_line;
    y.step = subframe->lines_per_pixel;
  }
  const std::string focal =
      focalMisfit(x, y, std::abs(camera.fx), std::abs(camera.fy), subframe.has_value());
  if (!focal.empty()) return focal;
  const bool cut = subframe && (subframe->first_sample > 0 || subframe->first_line > 0);
  return cut ? cutMisfit(x, y, of_subframe) : uncutMisfit(x, y, subframe.has_value());
}

}  // namespace boresight::sessions
