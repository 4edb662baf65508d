// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/pose.h"
#include "sessions/evaluation/posed_image.h"
#include "sessions/io/json/json_reader.h"

namespace boresight::sessions {

struct BopObject {
  PosedImage image;  ///< without a name; its camera has no size: BOP does not state it
  int object_id = 0;
};

/// Writes scene_gt.json and scene_camera.json of a BOP scene (bop_toolkit, bop_datasets_format.md)
/// into a folder, one object per image: rotations row by row, millimetres, OpenCV pixel
/// coordinates; a remark is a further member of its object. BOP has no Brown-Conrady distortion:
/// OutputError for a camera with distortion (undistort the image, the pose stays), for a duplicate
/// or negative id, and for files that cannot be written.
void writeBopScene(const std::filesystem::path& folder, std::span<const BopObject> objects);

/// Reads such files, also with several objects per image; poses are equal within 1e-12. InputError.
std::vector<BopObject> readBopScene(const std::filesystem::path& folder);
/// The same from two files of any name.
std::vector<BopObject> readBopScene(const std::filesystem::path& camera_file,
                                    const std::filesystem::path& truth_file);

/// "000007", as BOP names scenes, images and objects.
std::string bopNumber(int number);

/// The entries of such a file by the numbers that are their keys. InputError, also for a number
/// that is given twice, such as "1" and "01".
std::map<int, JsonReader> bopEntries(const JsonReader& root);

/// One line of a BOP19 results file.
struct BopResult {
  int scene_id = 0;
  int image_id = 0;
  int object_id = 0;
  double score = 0.0;  ///< higher is more certain; only the order within an object counts
  Pose camera_from_station;
  double seconds = -1.0;  ///< for the image as a whole, the same in all its lines; -1: not measured
};

/// Writes a results file of the BOP challenges (bop_toolkit, inout.save_bop_results with version
/// "bop19"): a header and lines `scene_id,im_id,obj_id,score,R,t,time`, R nine numbers row by row
/// and t three in millimetres, with blanks between. OutputError; also for a negative id, a pose
/// that is not finite, and lines of one image that differ in their time by 1 ms or more.
void writeBopResults(const std::filesystem::path& file, std::span<const BopResult> results);

}  // namespace boresight::sessions
