// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/geometry/pose.h"

namespace boresight::sessions {

/// One line of a BOP19 results file.
struct BopResult {
  int scene_id = 0;
  int image_id = 0;
  int object_id = 0;
  double score = 0.0;  ///< the higher, the surer; only the order within an object counts
  Pose camera_from_station;
  double seconds = -1.0;  ///< for the image as a whole, the same in all its lines; -1: not measured
};

/// Writes a results file as the BOP challenges take it (bop_toolkit, inout.save_bop_results with
/// version "bop19"): a header and lines `scene_id,im_id,obj_id,score,R,t,time`, R nine numbers row
/// by row and t three in millimetres, with blanks between. OutputError; also for a negative id, a
/// pose that is not finite, and lines of one image that differ in their time by 1 ms or more.
void writeBopResults(const std::filesystem::path& file, std::span<const BopResult> results);

/// Reads one back, with or without its header. InputError.
std::vector<BopResult> readBopResults(const std::filesystem::path& file);

}  // namespace boresight::sessions
