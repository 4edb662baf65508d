// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/input_sheet.h"

#include <algorithm>

#include "core/base/math.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr int kPlaces = 9;            ///< along a side, where two cameras are compared
constexpr double kAgreeing_px = 1.0;  ///< also a camera that was fitted to the label's
constexpr double kAgreeing_m = 1e-3;  ///< of labels with six digits
constexpr double kAgreeing_rad = 1e-3;

/// How far from a pixel of `a` camera `b` sees what the pixel sees at a distance, at most over the
/// places of a grid; nothing where the two have no pixel in common.
std::optional<double> largestDifference_px(const Camera& a, const Camera& b, double distance_m) {
  std::optional<double> largest_px;
  for (int row = 0; row < kPlaces; ++row)
    for (int column = 0; column < kPlaces; ++column) {
      const Eigen::Vector2d pixel(column * (a.width - 1.0) / (kPlaces - 1),
                                  row * (a.height - 1.0) / (kPlaces - 1));
      Ray ray;
      Eigen::Vector2d seen;
      if (!unprojectRay(a, pixel, ray) || !project(b, ray.at(distance_m), seen)) continue;
      largest_px = std::max(largest_px.value_or(0.0), (seen - pixel).norm());
    }
  return largest_px;
}

/// "1.0 mm and 0.02 deg"; "" where the poses agree.
std::string apartText(const Pose& pose, const Pose& other) {
  const double apart_m = (pose.translation_m - other.translation_m).norm();
  const double turned_rad = pose.rotation.angularDistance(other.rotation);
  if (apart_m <= kAgreeing_m && turned_rad <= kAgreeing_rad) return "";
  return formatText("%.1f mm and %.2f deg", 1e3 * apart_m, turned_rad / kDegree_rad);
}

std::string cameraConcern(const SessionCase& session_case, const CameraFile& label) {
  const Camera& stated = label.camera;
  if (stated.width != session_case.camera.width || stated.height != session_case.camera.height)
    return "";
  const double distance_m =
      session_case.has_seed
          ? std::max(session_case.camera_from_station_seed.translation_m.norm(), 1e-3)
          : 1.0;
  const auto difference_px = largestDifference_px(stated, session_case.camera, distance_m);
  if (!difference_px || *difference_px > kAgreeing_px)
    return "the camera is not that of the image's label: " +
           (difference_px ? "at the seed's distance the two differ by up to " +
                                fixedText(*difference_px, 1) + " px"
                          : "they have no common field of view");
  if (!session_case.camera_reference || !label.reference || label.reference->frame.name.empty() ||
      !(session_case.camera_reference->frame == label.reference->frame))
    return "";
  const std::string apart =
      apartText(session_case.camera_reference->camera_from_reference.inverse(),
                label.reference->camera_from_reference.inverse());
  if (apart.empty()) return "";
  return "the camera is not that of the image's label: in " + frameText(label.reference->frame) +
         " it differs by " + apart;
}

/// What the label says of the transform's two frames, as target_from_source.
std::optional<Pose> statedTransform(const FrameTransform& given, const ImageLabel& label) {
  for (const LabelFrame& label_frame : label.frames) {
    if (label_frame.reference == given.target && label_frame.frame == given.source)
      return label_frame.reference_from_frame;
    if (label_frame.reference == given.source && label_frame.frame == given.target)
      return label_frame.reference_from_frame.inverse();
  }
  return std::nullopt;
}

std::string transformConcern(const FrameTransform& given, const ImageLabel& label) {
  const auto stated = statedTransform(given, label);
  if (!stated) return "";
  const std::string apart = apartText(*stated, given.target_from_source);
  if (apart.empty()) return "";
  return given.file.filename().string() + " and the image's label differ about where " +
         frameText(given.source) + " is in " + frameText(given.target) + ": by " + apart;
}

}  // namespace

void flagLabel(const SessionCase& session_case, const ImageLabel& label,
               std::vector<RedFlag>& flags) {
  if (label.camera) {
    const std::string concern = cameraConcern(session_case, *label.camera);
    if (!concern.empty()) flags.push_back({"camera_label", concern});
    // Of a part of the detector, as the label says, the principal point may lie anywhere.
    if (concern.empty() && label.subframe && !label.subframe->whole())
      std::erase_if(flags, [](const RedFlag& flag) { return flag.code == "camera_off_centre"; });
  }
  for (const FrameTransform& given : session_case.frames) {
    const RedFlag flag{"transform_label", transformConcern(given, label)};
    if (!flag.text.empty() && std::ranges::find(flags, flag) == flags.end()) flags.push_back(flag);
  }
}

std::vector<std::string> labelWarnings(const SessionCase& session_case) {
  if (!hasImageLabel(session_case.image.source.file)) return {};
  std::vector<RedFlag> flags;
  flagLabel(session_case, readImageLabel(session_case.image.source.file), flags);
  std::vector<std::string> warnings;
  for (const RedFlag& flag : flags) warnings.push_back(flag.text);
  return warnings;
}

}  // namespace boresight::sessions
