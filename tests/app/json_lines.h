// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/json/json_reader.h"

namespace boresight::test {

/// The value of a JSON file.
inline nlohmann::json jsonOf(const std::filesystem::path& file) {
  return nlohmann::json::parse(std::ifstream(file));
}

/// The pose that a 4 x 4 matrix states.
inline Pose poseOf(const nlohmann::json& matrix) {
  const sessions::JsonDocument document("matrix", matrix.dump());
  return sessions::readTransform(document.root());
}

/// The values of a text of JSON lines.
inline std::vector<nlohmann::json> jsonLines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<nlohmann::json> values;
  for (std::string line; std::getline(stream, line);) values.push_back(nlohmann::json::parse(line));
  return values;
}

}  // namespace boresight::test
