// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "sessions/evaluation/posed_image.h"
#include "sessions/io/json_reader.h"

namespace boresight::sessions {

struct BopObject {
  PosedImage image;  ///< without a name; its camera has no size: BOP does not state it
  int object_id = 0;
};

/// Writes scene_gt.json and scene_camera.json of a BOP scene (bop_toolkit, bop_datasets_format.md)
/// into a folder, one object an image: rotations row by row, millimetres, pixels as OpenCV counts
/// them; a remark is a further member of its object. BOP knows no Brown-Conrady distortion:
/// OutputError for a camera that has some (undistort the image, the pose stays), for an id that is
/// given twice or negative, and for what cannot be written.
void writeBopScene(const std::filesystem::path& folder, std::span<const BopObject> objects);

/// Reads them back, several objects an image allowed; poses come back to 1e-12. InputError.
std::vector<BopObject> readBopScene(const std::filesystem::path& folder);
/// The same from two files, whatever they are called.
std::vector<BopObject> readBopScene(const std::filesystem::path& camera_file,
                                    const std::filesystem::path& truth_file);

/// The number that a key of such a file is. InputError.
int bopImageId(const std::string& key, const JsonReader& entry);

}  // namespace boresight::sessions
