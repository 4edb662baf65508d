// SPDX-License-Identifier: Apache-2.0
// Whether a label's camera model fits the image of the label.
#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "sessions/io/images/labels/label_camera.h"
#include "sessions/io/images/labels/label_values.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr double kFarOff = 0.35;         ///< of a side: an uncut image's principal point
constexpr double kFarOutside = 0.5;      ///< of a side beyond the border, where nothing is said
constexpr double kMostUnequal = 1.25;    ///< of focal lengths on the detector
constexpr double kShortestFocal = 0.05;  ///< of the image's longer side
constexpr double kLongestFocal_px = 1e6;
constexpr double kFarthestCentre_m = 1e6;
constexpr double kMostSkew = 0.02;  ///< of rows against columns

constexpr const char* kAdvice = "; give a camera file that fits";

/// Along one side of the image.
struct Side {
  double size_px;
  double principal_px;  ///< in the image
  double first;         ///< of the detector
  double step;          ///< detector samples a pixel
  double detector;      ///< upper bound of the detector's samples; 0: not known

  double onDetector() const { return first + (principal_px + 0.5) * step - 0.5; }
  /// The detector has at least these samples.
  double end() const { return first + size_px * step; }
  bool isPart() const { return first > 0.0 || end() < detector; }
  /// Whether a detector that holds the image, and is no larger than is known of it, can have its
  /// principal point here.
  bool fitsDetector() const {
    const double at = onDetector() + 0.5;
    if (at < (0.5 - kFarOff) * end()) return false;
    return detector == 0.0 || at <= (0.5 + kFarOff) * std::max(detector, end());
  }
};

std::string place(const Side& x, const Side& y) {
  return "(" + fixedText(x.principal_px, 1) + ", " + fixedText(y.principal_px, 1) + ")";
}

std::string sizeText(const Side& x, const Side& y) {
  return fixedText(x.size_px, 0) + " x " + fixedText(y.size_px, 0);
}

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

std::string firstText(const Side& x, const Side& y) {
  return "sample " + fixedText(x.first, 0) + ", line " + fixedText(y.first, 0);
}

/// Of a part of the detector the principal point may lie outside. Read as the model of the part it
/// has a place on the detector; of missions that state those it must be one, of others it must not
/// be possible to read it as the model of the whole detector.
std::string partMisfit(const Side& x, const Side& y, bool of_subframe) {
  if (!x.fitsDetector() || !y.fitsDetector()) {
    const bool known = x.detector > 0.0 && y.detector > 0.0;
    return "the label's camera model does not fit the sub-frame at " + firstText(x, y) +
           ": its principal point would be at (" + fixedText(x.onDetector(), 1) + ", " +
           fixedText(y.onDetector(), 1) + ") of the detector, which has " +
           (known ? "up to " : "at least ") + fixedText(known ? x.detector : x.end(), 0) + " x " +
           fixedText(known ? y.detector : y.end(), 0) + " samples" + kAdvice;
  }
  const bool beyond_as_whole = x.principal_px < -0.5 || y.principal_px < -0.5;
  if (of_subframe || beyond_as_whole) return "";
  return "the label does not state whether its camera model is for the whole detector or the "
         "sub-frame at " +
         firstText(x, y) + kAdvice;
}

std::string focalMisfit(const Side& x, const Side& y, double fx, double fy, bool stated) {
  const double longest = std::max(x.size_px, y.size_px);
  const auto absurd = [longest](double focal_px) {
    return !(focal_px >= kShortestFocal * longest && focal_px <= kLongestFocal_px);
  };
  if (absurd(fx) || absurd(fy))
    return "the label's camera model is invalid: focal lengths of " + fixedText(fx, 3) + " and " +
           fixedText(fy, 3) + " px for an image of " + sizeText(x, y) + " px";
  const double ratio = fx * x.step / (fy * y.step);
  if (stated && (ratio > kMostUnequal || ratio < 1.0 / kMostUnequal))
    return "the label's camera model does not fit the down-sampling by " + fixedText(x.step, 2) +
           " x " + fixedText(y.step, 2) + ": focal lengths of " + fixedText(fx, 1) + " and " +
           fixedText(fy, 1) + " px" + kAdvice;
  return "";
}

std::string vectorsMisfit(const CahvModel& cahv) {
  if (!(std::abs(cahv.a.norm() - 1.0) <= 1e-3))
    return "the label's camera model is invalid: its axis A has the length " +
           fixedText(cahv.a.norm(), 4) + " instead of 1";
  if (!(cahv.c_m.norm() <= kFarthestCentre_m))
    return "the label's camera model is invalid: its centre is over " +
           fixedText(kFarthestCentre_m, 0) + " m from the origin of its frame";
  return "";
}

/// A picture is not mirrored, and its rows and columns are square to each other.
std::string axesMisfit(const Camera& camera) {
  if (camera.fx * camera.fy < 0.0)
    return "the label's camera model mirrors the image (H and V are swapped, or one is reversed); "
           "give a camera file that fits";
  if (!(std::abs(camera.cahv.skew_px) <= kMostSkew * std::abs(camera.fy)))
    return "the label's camera model is invalid: H and V are " +
           fixedText(std::atan2(std::abs(camera.cahv.skew_px), std::abs(camera.fy)) / kDegree_rad,
                     1) +
           " deg off square";
  return "";
}

/// A name of a mission in labels; a host's is the whole value of INSTRUMENT_HOST_ID.
struct MissionName {
  char mission;
  std::string_view name;
  bool host;
};
constexpr MissionName kMissions[] = {
    {'E', "MARS EXPLORATION ROVER", false},
    {'S', "MARS SCIENCE LABORATORY", false},
    {'S', "CURIOSITY", false},
    {'M', "MARS 2020", false},
    {'M', "MARS2020", false},
    {'M', "PERSEVERANCE", false},
    {'E', "MER1", true},
    {'E', "MER2", true},
    {'S', "MSL", true},
    {'M', "M20", true},
    {'M', "M2020", true},
    {'P', "PHX", true},
};

/// Detectors by words of the instrument's identifier or name; the last of a mission is its largest.
struct Instrument {
  char mission;
  std::string_view word;
  int width;
  int height;
};
constexpr Instrument kInstruments[] = {
    {'E', "", 1024, 1024},         {'S', "NAV", 1024, 1024},        {'S', "HAZ", 1024, 1024},
    {'S', "MAST", 1648, 1200},     {'S', "MAHLI", 1648, 1200},      {'S', "MARDI", 1648, 1200},
    {'M', "NAVCAM", 5120, 3840},   {'M', "NAVIGATION", 5120, 3840}, {'M', "HAZ", 5120, 3840},
    {'M', "CACHECAM", 5120, 3840}, {'M', "MCZ", 1648, 1200},        {'M', "MASTCAM", 1648, 1200},
    {'M', "WATSON", 1648, 1200},   {'M', "SHERLOC", 1648, 1200},    {'S', "", 1648, 1200},
    {'M', "", 5120, 3840},
};

char missionOf(const std::vector<LabelItem>& identifiers) {
  for (const LabelItem& item : identifiers) {
    const std::string text = upperCase(item.value);
    for (const auto& [mission, name, host] : kMissions)
      if (host ? item.name == "INSTRUMENT_HOST_ID" && text == name
               : text.find(name) != std::string::npos)
        return mission;
  }
  return '\0';
}

}  // namespace

LabelDetector detectorOf(const std::vector<LabelItem>& identifiers) {
  const char mission = missionOf(identifiers);
  std::string words;
  for (const LabelItem& item : identifiers)
    if (item.name == "INSTRUMENT_ID" || item.name == "INSTRUMENT_NAME" ||
        item.name == "Observing_System_Component")
      words += upperCase(item.value) + "\n";
  for (const Instrument& instrument : kInstruments)
    if (instrument.mission == mission && words.find(instrument.word) != std::string::npos)
      return {true, instrument.width, instrument.height};
  return {mission != '\0', 0, 0};
}

std::string cameraMisfit(const CahvModel& cahv, int width, int height,
                         const std::optional<LabelSubframe>& subframe,
                         const LabelDetector& detector) {
  const std::string vectors = vectorsMisfit(cahv);
  if (!vectors.empty()) return vectors;
  Camera camera;
  Pose camera_from_reference;
  if (cameraFromCahv(cahv, width, height, camera, camera_from_reference) != Status::kOk)
    return "the label's camera model cannot project: O must have length 1 and lie within 60 deg of "
           "A, H and V must not lie along A or along each other, and 1 + r0 must be positive";
  const std::string axes = axesMisfit(camera);
  if (!axes.empty()) return axes;
  const LabelSubframe cut = subframe.value_or(LabelSubframe());
  const Side x{static_cast<double>(width), camera.cx, static_cast<double>(cut.first_sample),
               cut.samples_per_pixel, static_cast<double>(detector.width)};
  const Side y{static_cast<double>(height), camera.cy, static_cast<double>(cut.first_line),
               cut.lines_per_pixel, static_cast<double>(detector.height)};
  const std::string focal =
      focalMisfit(x, y, std::abs(camera.fx), std::abs(camera.fy), subframe.has_value());
  if (!focal.empty()) return focal;
  const bool part = subframe && (x.isPart() || y.isPart());
  return part ? partMisfit(x, y, detector.model_of_subframe)
              : uncutMisfit(x, y, subframe.has_value());
}

}  // namespace boresight::sessions
