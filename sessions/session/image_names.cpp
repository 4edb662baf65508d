// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/image_names.h"

#include <algorithm>
#include <optional>
#include <set>

#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

/// The folder that two folders are in.
fs::path commonFolder(const fs::path& a, const fs::path& b) {
  fs::path common;
  auto [in_a, in_b] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  for (auto part = a.begin(); part != in_a; ++part) common /= *part;
  return common;
}

}  // namespace

std::vector<std::string> imageNames(const Session& session) {
  if (session.cases.empty()) return {};
  fs::path folder = session.cases[0]->image.source.file.parent_path();
  for (const auto& session_case : session.cases)
    folder = commonFolder(folder, session_case->image.source.file.parent_path());
  std::vector<std::string> names;
  for (const auto& session_case : session.cases)
    names.push_back(session_case->image.source.file.lexically_relative(folder).generic_string());
  return names;
}

std::vector<int> imageNumbers(const Session& session) {
  std::vector<int> numbers;
  std::set<int> seen;
  for (const auto& session_case : session.cases)
    if (const auto number = numberIn<int>(session_case->image.source.file.stem().string());
        number && *number >= 0 && seen.insert(*number).second)
      numbers.push_back(*number);
  if (numbers.size() == session.cases.size()) return numbers;
  for (numbers.clear(); numbers.size() < session.cases.size();)
    numbers.push_back(static_cast<int>(numbers.size()) + 1);
  return numbers;
}

std::vector<int> stationNumbers(const Session& session) {
  std::vector<const SessionCase*> stations;
  std::vector<int> numbers;
  for (const auto& session_case : session.cases) {
    const auto same = std::ranges::find_if(
        stations, [&](const SessionCase* other) { return sameMeshes(*session_case, *other); });
    numbers.push_back(static_cast<int>(same - stations.begin()) + 1);
    if (same == stations.end()) stations.push_back(&*session_case);
  }
  return numbers;
}

bool isEndOf(const std::string& name, const fs::path& file) {
  const fs::path end = fs::path(name).lexically_normal();
  std::vector<fs::path> parts(end.begin(), end.end());
  std::vector<fs::path> whole(file.begin(), file.end());
  return !parts.empty() && parts.size() <= whole.size() &&
         std::equal(parts.rbegin(), parts.rend(), whole.rbegin());
}

}  // namespace boresight::sessions
