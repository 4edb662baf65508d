// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "sessions/evaluation/bop_scene.h"

namespace boresight::test {

/// The lines of a BOP19 results file, by what the format says.
inline std::vector<sessions::BopResult> readBopResults(const std::filesystem::path& file) {
  std::vector<sessions::BopResult> results;
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);  // the header
  while (std::getline(stream, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    sessions::BopResult result;
    numbers >> result.scene_id >> result.image_id >> result.object_id >> result.score;
    Eigen::Matrix3d rotation;
    for (int i = 0; i < 9; ++i) numbers >> rotation(i / 3, i % 3);
    result.camera_from_station.rotation = Eigen::Quaterniond(rotation);
    for (double& mm : result.camera_from_station.translation_m) numbers >> mm;
    result.camera_from_station.translation_m /= 1e3;
    numbers >> result.seconds;
    results.push_back(result);
  }
  return results;
}

}  // namespace boresight::test
