// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/frame_lines.h"

#include "sessions/report/text_table.h"

namespace boresight::sessions {

std::vector<FrameLine> frameLines(const SessionCase& one) {
  if (!one.camera_reference) return {};
  const Eigen::Vector3d centre_m =
      one.camera_reference->camera_from_reference.inverse().translation_m;
  std::vector<FrameLine> lines = {
      {"camera model in", frameText(one.camera_reference->frame) + ", its centre at " +
                              fixedText(centre_m.x(), 4) + " " + fixedText(centre_m.y(), 4) + " " +
                              fixedText(centre_m.z(), 4) + " m"}};
  if (!one.station_frame) return lines;
  std::string given = frameText(one.station_frame->frame);
  if (const auto& join = one.station_frame->joined_by)
    given += ", joined by " + join->file.string() + " (" + join->comment + ")";
  lines.push_back({"station given in", given});
  return lines;
}

}  // namespace boresight::sessions
