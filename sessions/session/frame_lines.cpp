// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/frame_lines.h"

#include "sessions/text/text_table.h"

namespace boresight::sessions {

namespace {

std::string givenText(const StationFrame& given) {
  std::string text = frameText(given.frame);
  if (const auto& join = given.joined_by)
    text += ", joined by " + join->file.string() + " (" + join->comment + ")";
  return text;
}

}  // namespace

std::vector<FrameLine> frameLines(const SessionCase& one) {
  if (!one.camera_reference) return {};
  const Eigen::Vector3d centre_m =
      one.camera_reference->camera_from_reference.inverse().translation_m;
  std::vector<FrameLine> lines = {
      {"camera model in", frameText(one.camera_reference->frame) + ", its centre at " +
                              fixedText(centre_m.x(), 4) + " " + fixedText(centre_m.y(), 4) + " " +
                              fixedText(centre_m.z(), 4) + " m"}};
  if (one.station_frame) lines.push_back({"station given in", givenText(*one.station_frame)});
  if (one.truth_frame) lines.push_back({"truth given in", givenText(*one.truth_frame)});
  return lines;
}

}  // namespace boresight::sessions
