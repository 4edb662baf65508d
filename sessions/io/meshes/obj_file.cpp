// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/obj_file.h"

#include <algorithm>
#include <string>

#include "sessions/io/files/errors.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

constexpr const char* kBlanks = " \t\r\v\f";

/// The first word of `rest`, which loses it; "" at its end.
std::string_view takeWord(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
  rest.remove_prefix(word.size());
  return word;
}

/// Whether a backslash at the end of the line continues it. That of a name or a comment, such as a
/// folder of Windows, would swallow the vertex or face in the next line.
bool isGeometry(std::string_view line) {
  const std::string_view keyword = takeWord(line);
  for (const char* known : {"v", "vn", "vt", "vp", "f", "l", "p"})
    if (keyword == known) return true;
  return false;
}

/// Calls `take` with each line without indent, comment of a vertex or face, and continuation, and
/// with its number.
template <class Take>
void forEachLine(std::string_view text, Take take) {
  std::string joined;
  std::int64_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    const bool pair = text.substr(end).starts_with("\r\n");
    text.remove_prefix(std::min(end + (pair ? 2 : 1), text.size()));
    ++number;
    joined += line;
    if (isGeometry(joined)) {
      joined.erase(std::min(joined.find('#'), joined.size()));
      if (joined.ends_with('\\') && !text.empty()) {
        joined.back() = ' ';
        continue;
      }
    }
    take(std::string_view(joined), number);
    joined.clear();
  }
}

/// Free-form geometry, and other files.
bool isUnreadGeometry(std::string_view keyword) {
  for (const char* known : {"curv", "curv2", "surf", "bzp", "bsp", "cdc", "cdp", "res", "call"})
    if (keyword == known) return true;
  return false;
}

class ObjLine {
 public:
  ObjLine(const std::filesystem::path& file, std::string_view text, std::int64_t number)
      : file_(file), rest_(text), number_(number) {}

  std::string_view word() { return takeWord(rest_); }

  void checkVertex() {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view text = word();
      if (text.empty()) fail("a vertex has three coordinates");
      if (!coordinateIn(text)) fail("'" + shortened(text) + "' is not a number");
    }
  }

  /// The number of corners.
  int checkFace() {
    int corners = 0;
    for (std::string_view text = word(); !text.empty(); text = word()) {
      const std::string_view index = text.substr(0, text.find('/'));
      const bool others = text.find_first_not_of("-0123456789/") == std::string_view::npos;
      if (!others || !numberIn<std::int64_t>(index))
        fail("'" + shortened(text) + "' is not a corner of a face");
      ++corners;
    }
    if (corners == 0) fail("a face has no corners");
    return corners;
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(file_, "line " + std::to_string(number_), reason);
  }

 private:
  static std::string shortened(std::string_view word) { return oneLine(word.substr(0, 40)); }

  const std::filesystem::path& file_;
  std::string_view rest_;
  std::int64_t number_;
};

void append(std::vector<std::uint8_t>& plain, std::string_view text) {
  plain.insert(plain.end(), text.begin(), text.end());
}

/// The three coordinates of a vertex alone: the importer divides by a weight behind them, takes
/// colours for one, and does not count a number that begins with its point.
void appendVertex(std::vector<std::uint8_t>& plain, std::string_view coordinates) {
  append(plain, "v");
  for (int axis = 0; axis < 3; ++axis) {
    std::string_view text = takeWord(coordinates);
    append(plain, " ");
    if (text.starts_with('-')) append(plain, "-");
    if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
    if (text.starts_with('.')) append(plain, "0");
    append(plain, text);
  }
}

}  // namespace

MeshDeclaration checkObj(const std::filesystem::path& file, std::string_view text) {
  MeshDeclaration declaration;
  std::int64_t vertices = 0, faces = 0, unread = 0;
  forEachLine(text, [&](std::string_view content, std::int64_t number) {
    ObjLine line(file, content, number);
    const std::string_view keyword = line.word();
    if (keyword == "v") {
      line.checkVertex();
      ++vertices;
    } else if (keyword == "f" && line.checkFace() >= 3) {
      ++faces;
    } else if (keyword == "V" || keyword == "F") {
      line.fail("'" + std::string(keyword) + "' is no keyword: they are in lower case");
    } else if (isUnreadGeometry(keyword)) {
      ++unread;
    }
  });
  if (vertices == 0)
    throw InputError(file, "not an OBJ mesh: it has no line of a vertex (v x y z)");
  declaration.vertex_count = vertices;
  declaration.polygon_count = faces;
  if (unread > 0)
    declaration.notes.push_back(countText(unread, "line") +
                                " of curves, surfaces or other files: not read");
  noteOpenEnd(text, declaration);
  return declaration;
}

std::vector<std::uint8_t> plainObj(std::string_view text) {
  std::vector<std::uint8_t> plain;
  plain.reserve(text.size() + 1);
  forEachLine(text, [&plain](std::string_view line, std::int64_t) {
    std::string_view rest = line;
    if (takeWord(rest) == "v")
      appendVertex(plain, rest);
    else
      for (const char letter : line)
        plain.push_back(static_cast<std::uint8_t>(letter == '\\' ? '/' : letter));
    plain.push_back('\n');
  });
  return plain;
}

}  // namespace boresight::sessions
