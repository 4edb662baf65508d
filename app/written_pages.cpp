// SPDX-License-Identifier: Apache-2.0
#include "app/written_pages.h"

#include <fstream>
#include <iostream>
#include <string_view>

#include "app/exit_codes.h"

namespace boresight::app {

std::string markdownText(const std::string& text) {
  constexpr std::string_view kMeant = "\\|<*`[_";
  std::string safe;
  for (const char c : text) {
    if (kMeant.find(c) != std::string_view::npos) safe += '\\';
    safe += c == '\n' ? ' ' : c;
  }
  return safe;
}

int writePages(const std::filesystem::path& folder,
               const std::map<std::string, std::string>& pages) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  for (const auto& [name, text] : pages) {
    std::ofstream stream(folder / name, std::ios::binary | std::ios::trunc);
    stream << text;
    stream.close();
    if (stream) continue;
    std::cerr << (folder / name).string() << ": cannot be written\n";
    return kBadInput;
  }
  return kDone;
}

}  // namespace boresight::app
