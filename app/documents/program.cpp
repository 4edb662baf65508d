// SPDX-License-Identifier: Apache-2.0
#include "app/documents/program.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace boresight::documents {

bool Argument::takesPath() const {
  constexpr std::array<std::string_view, 5> kPaths = {"FILE", "DIR", "FOLDER", "CSV", "PATH"};
  return std::find(kPaths.begin(), kPaths.end(), value) != kPaths.end();
}

std::string firstSentence(const std::string& help) {
  const std::size_t stop = help.find(". ");
  std::string sentence = help.substr(0, stop);
  while (!sentence.empty() && sentence.back() == '.') sentence.pop_back();
  return sentence;
}

}  // namespace boresight::documents
