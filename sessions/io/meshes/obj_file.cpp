// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/obj_file.h"

#include <algorithm>
#include <optional>
#include <string>

#include "sessions/io/files/errors.h"
#include "sessions/text/text_reading.h"

namespace boresight::sessions {
namespace {

/// The importer's keyword of a line: "fo" is the face of older files. "" for other lines.
std::string_view geometryKeyword(std::string_view word) {
  if (word == "fo") return "f";
  for (const char* known : {"v", "f", "l", "p"})
    if (word == known) return known;
  return {};
}

/// Whether a backslash at the end of the line continues it. That of a name or a comment, such as a
/// folder of Windows, would swallow the vertex or face in the next line.
bool isContinued(std::string_view line) {
  const std::string_view keyword = takeWord(line);
  return !geometryKeyword(keyword).empty() || keyword == "vn" || keyword == "vt" || keyword == "vp";
}

/// Calls `take` with each line without indent, comment of a vertex or face, and continuation, and
/// with its number.
template <class Take>
void forEachLine(std::string_view text, Take take) {
  std::string joined;
  for (TextLines lines(text); lines.next();) {
    joined += trimmed(lines.line());
    if (isContinued(joined)) {
      joined.erase(std::min(joined.find('#'), joined.size()));
      if (joined.ends_with('\\') && !lines.isLast()) {
        joined.back() = ' ';
        continue;
      }
    }
    take(std::string_view(joined), lines.number());
    joined.clear();
  }
}

/// Free-form geometry, and other files.
bool isUnreadGeometry(std::string_view keyword) {
  for (const char* known : {"curv", "curv2", "surf", "bzp", "bsp", "cdc", "cdp", "res", "call"})
    if (keyword == known) return true;
  return false;
}

/// The vertex of a corner "7/8/9", from 1 or, from the last one back, from -1; empty for other
/// texts.
std::optional<std::int64_t> vertexOfCorner(std::string_view corner) {
  if (corner.find_first_not_of("+-0123456789/") != std::string_view::npos) return std::nullopt;
  const auto vertex = wholeIn<std::int64_t>(corner.substr(0, corner.find('/')));
  return vertex == 0 ? std::nullopt : vertex;
}

/// Where a face has the vertex with the largest number.
struct LastCorner {
  std::int64_t vertex = 0;
  std::int64_t line = 0;
};

class ObjLine {
 public:
  ObjLine(const std::filesystem::path& file, std::string_view text, std::int64_t number)
      : file_(file), rest_(text), number_(number) {}

  std::string_view word() { return takeWord(rest_); }

  void checkVertex() {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view text = word();
      if (text.empty()) fail("a vertex has three coordinates");
      if (!realIn(text)) fail(noNumberText(text));
    }
  }

  /// The number of corners; `last` becomes the corner with the largest index so far.
  int checkFace(std::int64_t vertices, LastCorner& last) {
    int corners = 0;
    for (std::string_view text = word(); !text.empty(); text = word()) {
      const auto vertex = vertexOfCorner(text);
      if (!vertex) fail("'" + shortWord(text) + "' is not a corner of a face");
      if (*vertex < -vertices) failMissing(*vertex, vertices);
      if (*vertex > last.vertex) last = {*vertex, number_};
      ++corners;
    }
    if (corners == 0) fail("a face has no corners");
    return corners;
  }

  /// A blank of another script makes one word of a keyword and what is behind it.
  void checkKeyword(std::string_view keyword) {
    if (keyword == "V" || keyword == "F")
      fail("'" + std::string(keyword) + "' is no keyword: they are in lower case");
    const bool joined = keyword.size() > 1 && (keyword[0] == 'v' || keyword[0] == 'f') &&
                        std::ranges::any_of(keyword, [](char c) { return c < 0; });
    if (joined) fail("'" + shortWord(keyword) + "' is no keyword: write blanks of ASCII");
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(file_, "line " + std::to_string(number_), reason);
  }
  [[noreturn]] void failMissing(std::int64_t vertex, std::int64_t vertices) const {
    fail("vertex " + std::to_string(vertex) + " does not exist (there are " +
         std::to_string(vertices) + ")");
  }

 private:
  const std::filesystem::path& file_;
  std::string_view rest_;
  std::int64_t number_;
};

/// The three coordinates of a vertex alone: the importer divides by a weight behind them, takes
/// colours for one, and counts no number that begins with its point.
std::string plainVertex(std::string_view coordinates) {
  std::string plain;
  for (int axis = 0; axis < 3; ++axis) {
    std::string_view text = takeWord(coordinates);
    plain += text.starts_with('-') ? " -" : " ";
    if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
    if (text.starts_with('.')) plain += "0";
    plain += text;
  }
  std::ranges::replace_if(
      plain, [](char c) { return c == 'd' || c == 'D'; }, 'e');
  return plain;
}

/// The vertices of corners.
std::string plainCorners(std::string_view corners) {
  std::string plain;
  for (std::string_view text = takeWord(corners); !text.empty(); text = takeWord(corners))
    if (const auto vertex = vertexOfCorner(text)) plain += " " + std::to_string(*vertex);
  return plain;
}

}  // namespace

MeshDeclaration checkObj(const std::filesystem::path& file, std::string_view text) {
  MeshDeclaration declaration;
  std::int64_t vertices = 0, faces = 0, unread = 0;
  LastCorner last;
  forEachLine(text, [&](std::string_view content, std::int64_t number) {
    ObjLine line(file, content, number);
    const std::string_view word = line.word();
    const std::string_view keyword = geometryKeyword(word);
    line.checkKeyword(word);
    if (keyword == "v") {
      line.checkVertex();
      ++vertices;
    } else if (keyword == "f" && line.checkFace(vertices, last) >= 3) {
      ++faces;
    } else if (isUnreadGeometry(word)) {
      ++unread;
    }
  });
  if (vertices == 0)
    throw InputError(file, "not an OBJ mesh: it has no line of a vertex (v x y z)");
  if (last.vertex > vertices) ObjLine(file, "", last.line).failMissing(last.vertex, vertices);
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
    const std::string_view keyword = geometryKeyword(takeWord(line));
    if (keyword.empty()) return;
    const std::string content = keyword == "v" ? plainVertex(line) : plainCorners(line);
    plain.insert(plain.end(), keyword.begin(), keyword.end());
    plain.insert(plain.end(), content.begin(), content.end());
    plain.push_back('\n');
  });
  return plain;
}

}  // namespace boresight::sessions
