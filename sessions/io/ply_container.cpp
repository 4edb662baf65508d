// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/mesh_container.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"

namespace boresight::sessions {
namespace {

using Bytes = std::span<const std::uint8_t>;

[[noreturn]] void truncatedPly(const std::filesystem::path& file) {
  throw InputError(file, "the PLY mesh is truncated");
}

struct PlyProperty {
  int count_size = 0;  ///< bytes of a list's count; 0 for a plain value
  int value_size = 0;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::uint64_t body = 0;  ///< offset of the first byte after the header
};

int plyTypeSize(std::string_view type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "int" || type == "uint" || type == "float") return 4;
  if (type == "int32" || type == "uint32" || type == "float32") return 4;
  if (type == "double" || type == "float64") return 8;
  return 0;
}

void readPlyLine(const std::filesystem::path& file, const std::string& line, PlyHeader& header) {
  std::istringstream words(line);
  std::string keyword;
  words >> keyword;
  if (keyword == "format") {
    std::string encoding;
    words >> encoding;
    if (encoding == "binary_little_endian")
      header.encoding = PlyEncoding::kLittleEndian;
    else if (encoding == "binary_big_endian")
      header.encoding = PlyEncoding::kBigEndian;
    else if (encoding != "ascii")
      throw InputError(file, "header", "unknown PLY encoding '" + encoding + "'");
  } else if (keyword == "element") {
    PlyElement element;
    std::string count;
    words >> element.name >> count;
    const auto whole = numberIn<std::uint64_t>(count);
    if (!whole)
      throw InputError(file, "header",
                       "bad line '" + line + "': '" + count + "' is not a whole number");
    element.count = *whole;
    header.elements.push_back(element);
  } else if (keyword == "property") {
    std::string type;
    std::string count_type;
    words >> type;
    PlyProperty property;
    if (type == "list") {
      words >> count_type >> type;
      property.count_size = plyTypeSize(count_type);
    }
    property.value_size = plyTypeSize(type);
    const bool bad_list = !count_type.empty() && property.count_size == 0;
    if (header.elements.empty() || property.value_size == 0 || bad_list)
      throw InputError(file, "header", "bad line '" + line + "'");
    header.elements.back().properties.push_back(property);
  }
}

PlyHeader readPlyHeader(const std::filesystem::path& file, Bytes bytes) {
  constexpr std::size_t kMaxHeader = 65536;
  const std::string_view text = asText(bytes.first(std::min(bytes.size(), kMaxHeader)));
  PlyHeader header;
  std::size_t start = 0;
  while (true) {
    const std::size_t end = text.find('\n', start);
    if (end == std::string_view::npos) {
      if (bytes.size() <= kMaxHeader) truncatedPly(file);
      throw InputError(file, "header", "no end_header within its first 64 kB");
    }
    std::string line(text.substr(start, end - start));
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    start = end + 1;
    if (line == "end_header") break;
    readPlyLine(file, line, header);
  }
  header.body = start;
  return header;
}

/// Walks one binary element; returns the offset after it.
std::uint64_t walkPlyElement(const std::filesystem::path& file, Bytes bytes,
                             const PlyElement& element, bool big_endian, std::uint64_t offset) {
  const auto step = [&](std::uint64_t values, int size) {
    if (values > bytes.size() || !holds(bytes, offset, values * static_cast<std::uint64_t>(size)))
      truncatedPly(file);
    offset += values * static_cast<std::uint64_t>(size);
  };
  if (element.properties.empty()) return offset;
  for (std::uint64_t i = 0; i < element.count; ++i)
    for (const PlyProperty& property : element.properties) {
      std::uint64_t values = 1;
      if (const int size = property.count_size; size != 0) {
        step(1, size);
        values = readUnsigned(bytes, offset - static_cast<std::uint64_t>(size), size, big_endian);
      }
      step(values, property.value_size);
    }
  return offset;
}

/// Takes the next word from the text; empty at its end.
std::string_view takeWord(std::string_view& text) {
  constexpr const char* kBlanks = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  return word;
}

/// Returns the offset after the last element.
std::uint64_t walkPlyText(const std::filesystem::path& file, const PlyHeader& header,
                          std::string_view body) {
  std::string_view rest = body;
  for (const PlyElement& element : header.elements)
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
      for (const PlyProperty& property : element.properties) {
        std::uint64_t values = 1;
        if (property.count_size != 0) {
          const std::string_view count = takeWord(rest);
          if (count.empty()) truncatedPly(file);
          values = numberIn<std::uint64_t>(count).value_or(body.size() + 1);
          if (values > body.size())
            throw InputError(file, element.name + " " + std::to_string(i),
                             "'" + std::string(count) + "' is not the length of a list");
        }
        for (; values > 0; --values)
          if (takeWord(rest).empty()) truncatedPly(file);
      }
  return header.body + (body.size() - rest.size());
}

/// A count that is too small would leave out what is behind.
void requireEnd(const std::filesystem::path& file, const PlyHeader& header, Bytes rest) {
  if (asText(rest).find_first_not_of(" \t\r\n") == std::string_view::npos) return;
  std::string declared;
  for (const PlyElement& element : header.elements)
    declared += (declared.empty() ? "" : ", ") + element.name + " " + std::to_string(element.count);
  throw InputError(file, "header",
                   "declares " + declared + ", but " + std::to_string(rest.size()) +
                       " more bytes follow these elements");
}

}  // namespace

MeshDeclaration checkPly(const std::filesystem::path& file, Bytes bytes) {
  if (!asText(bytes).starts_with("ply\n") && !asText(bytes).starts_with("ply\r"))
    throw InputError(file, "not a PLY mesh (the file does not begin with 'ply')");
  const PlyHeader header = readPlyHeader(file, bytes);
  MeshDeclaration declaration;
  for (const PlyElement& element : header.elements) {
    // Any count of a file that we would accept fits.
    if (element.count > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()))
      throw InputError(file, "header", "too many items in element '" + element.name + "'");
    if (element.name == "vertex")
      declaration.vertex_count = static_cast<std::int64_t>(element.count);
    if (element.name == "face")
      declaration.polygon_count = static_cast<std::int64_t>(element.count);
  }
  if (declaration.vertex_count.value_or(0) == 0) throw InputError(file, "the mesh has no vertices");
  std::uint64_t offset = header.body;
  if (header.encoding == PlyEncoding::kAscii) {
    offset = walkPlyText(file, header, asText(bytes.subspan(header.body)));
  } else {
    if (offset < bytes.size() && bytes[offset] == '\n' && bytes[offset - 2] != '\r')
      declaration.newline_as_data = static_cast<std::size_t>(offset);
    for (const PlyElement& element : header.elements)
      offset =
          walkPlyElement(file, bytes, element, header.encoding == PlyEncoding::kBigEndian, offset);
  }
  requireEnd(file, header, bytes.subspan(offset));
  return declaration;
}

}  // namespace boresight::sessions
