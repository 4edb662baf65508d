// SPDX-License-Identifier: Apache-2.0
// How `whs info` writes what it finds.
#pragma once

#include <iostream>
#include <string>

#include <Eigen/Core>

#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::app {

inline void line(const std::string& text) { std::cout << sessions::plainLine("  " + text); }
inline void flag(const std::string& text) { line("! " + text); }

inline std::string vectorText(const Eigen::Vector3d& vector, int decimals) {
  using sessions::fixedText;
  return fixedText(vector.x(), decimals) + " " + fixedText(vector.y(), decimals) + " " +
         fixedText(vector.z(), decimals);
}

/// "1 case", "2 cases".
inline std::string countText(std::size_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace boresight::app
