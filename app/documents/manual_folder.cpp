// SPDX-License-Identifier: Apache-2.0
#include "app/documents/manual_folder.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

namespace boresight::documents {
namespace {

namespace fs = std::filesystem;

constexpr const char* kManual = "resources/manual";

/// A page that stands beside what it tells of.
struct TakenPage {
  const char* source;  ///< below the source
  const char* name;    ///< in the manual
};
constexpr std::array<TakenPage, 19> kTaken = {{
    {"sessions/session/README.md", "session_files.md"},
    {"sessions/evaluation/README.md", "results_files.md"},
    {"sessions/tables/README.md", "tables.md"},
    {"sessions/review/README.md", "validated_pose.md"},
    {"sessions/annotation/README.md", "marks.md"},
    {"sessions/exchange/README.md", "exchange.md"},
    {"sessions/examples/README.md", "examples.md"},
    {"sessions/record/README.md", "replay.md"},
    {"sessions/baselines/README.md", "methods.md"},
    {"sessions/io/cameras.md", "cameras.md"},
    {"sessions/io/planetary.md", "image_labels.md"},
    {"core/record/FORMAT.md", "onboard_record.md"},
    {"resources/evidence/README.md", "evidence.md"},
    {"resources/evidence/accuracy.md", "accuracy.md"},
    {"resources/evidence/peers.md", "peers.md"},
    {"resources/evidence/robustness.md", "robustness.md"},
    {"resources/evidence/speed_and_memory.md", "speed_and_memory.md"},
    {"resources/evidence/trust.md", "trust.md"},
    {"resources/matchers/README.md", "matchers.md"},
}};

/// What is put into the folder: names in the manual by places below the source.
using Names = std::map<std::string, std::string>;

Names namesOf(const fs::path& source, const WrittenPages& written) {
  Names names;
  for (const TakenPage& page : kTaken) names[page.source] = page.name;
  for (const auto& entry : fs::directory_iterator(source / kManual)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".md" && name != "README.md")
      names[std::string(kManual) + "/" + name] = name;
  }
  for (const auto& page : written) names[std::string(kManual) + "/" + page.first] = page.first;
  return names;
}

std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw fs::filesystem_error("cannot be read", file, {});
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write(const fs::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << text;
  stream.close();
  if (!stream) throw fs::filesystem_error("cannot be written", file, {});
}

/// Where a link of the page leads in the manual's folder; copies what pictures there are.
std::string targetOf(const std::string& target, const fs::path& source, const std::string& page,
                     const Names& names, const fs::path& folder) {
  if (target.find("://") != std::string::npos || target.front() == '#') return target;
  const std::size_t hash = target.find('#');
  const fs::path place = (fs::path(page).parent_path() / target.substr(0, hash)).lexically_normal();
  const auto found = names.find(place.generic_string());
  if (found != names.end())
    return found->second + (hash == std::string::npos ? "" : target.substr(hash));
  // Written pages know the names in the manual alone.
  const fs::path in_manual = place.lexically_relative(kManual);
  for (const auto& name : names)
    if (in_manual == name.second) return target;
  if (place.extension() != ".png" || !fs::exists(source / place)) return {};
  const fs::path picture = fs::path("pictures") / place.filename();
  fs::copy_file(source / place, folder / picture, fs::copy_options::overwrite_existing);
  return picture.generic_string();
}

/// Place of the bracket that the one at `close` belongs to, or npos.
std::size_t openingOf(const std::string& text, std::size_t close) {
  int depth = 0;
  for (std::size_t i = close + 1; i-- > 0;) {
    if (text[i] == ']') ++depth;
    if (text[i] == '[' && --depth == 0) return i;
  }
  return std::string::npos;
}

/// One line; links do not go over line ends here.
std::string lineWithLinks(std::string line, const LinkTarget& target_of) {
  for (std::size_t close = line.find("]("); close != std::string::npos;
       close = line.find("](", close + 1)) {
    const std::size_t end = line.find(')', close);
    const std::size_t open = openingOf(line, close);
    if (end == std::string::npos || open == std::string::npos) continue;
    const std::string target = target_of(line.substr(close + 2, end - close - 2));
    if (!target.empty()) {
      line.replace(close + 2, end - close - 2, target);
      continue;
    }
    const bool picture = open > 0 && line[open - 1] == '!';
    const std::size_t begin = picture ? open - 1 : open;
    const std::string words = line.substr(open + 1, close - open - 1);
    line.replace(begin, end + 1 - begin, words);
    close = begin;
  }
  return line;
}

}  // namespace

std::string markdownText(const std::string& text) {
  constexpr std::string_view kMeant = "\\|<*`[_";
  std::string safe;
  for (const char c : text) {
    if (kMeant.find(c) != std::string_view::npos) safe += '\\';
    safe += c == '\n' ? ' ' : c;
  }
  return safe;
}

std::string withLinks(const std::string& markdown, const LinkTarget& target_of) {
  std::string text;
  bool code = false;
  for (std::size_t begin = 0; begin < markdown.size();) {
    const std::size_t end = std::min(markdown.find('\n', begin), markdown.size() - 1);
    const std::string line = markdown.substr(begin, end + 1 - begin);
    const bool fence = line.rfind("```", 0) == 0;
    if (fence) code = !code;
    text += code || fence ? line : lineWithLinks(line, target_of);
    begin = end + 1;
  }
  return text;
}

std::string assembleManual(const fs::path& source, const WrittenPages& written,
                           const fs::path& folder) {
  try {
    const Names names = namesOf(source, written);
    fs::remove_all(folder);
    fs::create_directories(folder / "pictures");
    for (const auto& [page, name] : names) {
      const auto own = written.find(name);
      const std::string text = own != written.end() ? own->second : read(source / page);
      write(folder / name, withLinks(text, [&, origin = page](const std::string& target) {
              return targetOf(target, source, origin, names, folder);
            }));
    }
  } catch (const fs::filesystem_error& error) {
    return error.what();
  }
  return {};
}

}  // namespace boresight::documents
