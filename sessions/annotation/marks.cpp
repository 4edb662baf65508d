// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/marks.h"

#include <algorithm>

namespace boresight::sessions {

std::string unusedId(const Marks& marks, char letter) {
  const auto taken = [&marks](const std::string& id) {
    const auto has = [&id](const auto& pair) { return pair.id == id; };
    return std::any_of(marks.points.begin(), marks.points.end(), has) ||
           std::any_of(marks.lines.begin(), marks.lines.end(), has);
  };
  for (int number = 1;; ++number) {
    const std::string id = letter + std::to_string(number);
    if (!taken(id)) return id;
  }
}

}  // namespace boresight::sessions
