// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace boresight::test {

/// The values of a text of JSON lines.
inline std::vector<nlohmann::json> jsonLines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<nlohmann::json> values;
  for (std::string line; std::getline(stream, line);) values.push_back(nlohmann::json::parse(line));
  return values;
}

}  // namespace boresight::test
