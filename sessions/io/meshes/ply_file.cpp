// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/ply_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <sstream>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/meshes/mesh_container.h"

namespace boresight::sessions {
namespace {

using Bytes = std::span<const std::uint8_t>;

[[noreturn]] void truncatedPly(const std::filesystem::path& file) {
  throw InputError(file, "the PLY mesh is truncated");
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
    PlyProperty property;
    words >> property.type;
    const bool is_list = property.type == "list";
    if (is_list) words >> property.count_type >> property.type;
    words >> property.name;
    const bool bad_list = is_list && plyTypeSize(property.count_type) == 0;
    if (header.elements.empty() || plyTypeSize(property.type) == 0 || bad_list)
      throw InputError(file, "header", "bad line '" + line + "'");
    header.elements.back().properties.push_back(property);
  } else if (keyword != "ply" && keyword != "comment" && keyword != "obj_info" &&
             !keyword.empty()) {
    throw InputError(file, "header", "bad line '" + line + "'");
  }
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

/// What makes geometry of the values has a name.
void requireNames(const std::filesystem::path& file, const PlyElement& element) {
  const auto has = [&element](bool list, const char* name) {
    return std::ranges::any_of(element.properties, [&](const PlyProperty& property) {
      return property.isList() == list && property.name == name;
    });
  };
  if (element.name == "vertex" && !(has(false, "x") && has(false, "y") && has(false, "z")))
    throw InputError(file, "header", "the vertices have no properties x, y and z");
  if (element.name == "face" && element.count > 0 && !has(true, "vertex_indices") &&
      !has(true, "vertex_index"))
    throw InputError(file, "header", "the faces have no list vertex_indices");
}

/// Whether each item has a line, as importers take for granted.
bool isLineByItem(const PlyHeader& header, std::string_view body) {
  std::uint64_t items = 0;
  for (const PlyElement& element : header.elements) items += element.count;
  const std::size_t last = body.find_last_not_of(" \t\r\n");
  if (last == std::string_view::npos) return items == 0;
  const auto ends = std::ranges::count(body.substr(0, last), '\n');
  return items == static_cast<std::uint64_t>(ends) + 1;
}

}  // namespace

int plyTypeSize(std::string_view type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "int" || type == "uint" || type == "float") return 4;
  if (type == "int32" || type == "uint32" || type == "float32") return 4;
  if (type == "double" || type == "float64") return 8;
  return 0;
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

std::string_view PlyValues::word() {
  constexpr const char* kBlanks = " \t\r\n";
  const std::string_view text = asText(rest_);
  const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
  const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
  if (begin == end) truncatedPly(file_);
  rest_ = rest_.subspan(end);
  return text.substr(begin, end - begin);
}

std::uint64_t PlyValues::bits(const std::string& type) {
  const Bytes before = rest_;
  skip(1, type);
  return readUnsigned(before, 0, plyTypeSize(type), encoding_ == PlyEncoding::kBigEndian);
}

void PlyValues::skip(std::uint64_t values, const std::string& type) {
  if (encoding_ == PlyEncoding::kAscii) {
    for (; values > 0; --values)
      if (const std::string_view text = word(); !coordinateIn(text))
        throw InputError(file_, "'" + oneLine(text.substr(0, 40)) + "' is not a number");
    return;
  }
  const auto size = static_cast<std::uint64_t>(plyTypeSize(type));
  if (values > rest_.size() / size) truncatedPly(file_);
  rest_ = rest_.subspan(values * size);
}

std::uint64_t PlyValues::count(const PlyElement& element, std::uint64_t item,
                               const PlyProperty& property) {
  if (!property.isList()) return 1;
  if (encoding_ != PlyEncoding::kAscii) return bits(property.count_type);
  const std::string_view text = word();
  const auto number = numberIn<std::uint64_t>(text);
  if (!number || *number > body_.size())
    throw InputError(file_, element.name + " " + std::to_string(item),
                     "'" + std::string(text) + "' is not the length of a list");
  return *number;
}

double PlyValues::next(const std::string& type) {
  if (encoding_ == PlyEncoding::kAscii) return numberIn<double>(word()).value_or(std::nan(""));
  const std::uint64_t raw = bits(type);
  const int size = plyTypeSize(type);
  if (size == 8) return std::bit_cast<double>(raw);
  if (type.starts_with("float"))
    return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
  if (type.starts_with("u")) return static_cast<double>(raw);
  const int unused = 64 - 8 * size;
  return static_cast<double>(static_cast<std::int64_t>(raw << unused) >> unused);
}

MeshDeclaration checkPly(const std::filesystem::path& file, Bytes bytes) {
  if (!asText(bytes).starts_with("ply\n") && !asText(bytes).starts_with("ply\r"))
    throw InputError(file, "not a PLY mesh (the file does not begin with 'ply')");
  const PlyHeader header = readPlyHeader(file, bytes);
  MeshDeclaration declaration;
  declaration.polygon_count = 0;
  for (const PlyElement& element : header.elements) {
    // Any count of a file that we would accept fits.
    if (element.count > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()))
      throw InputError(file, "header", "too many items in element '" + element.name + "'");
    requireNames(file, element);
    if (element.name == "vertex")
      declaration.vertex_count = static_cast<std::int64_t>(element.count);
    if (element.name == "face")
      declaration.polygon_count = static_cast<std::int64_t>(element.count);
  }
  const bool is_ascii = header.encoding == PlyEncoding::kAscii;
  const std::string_view body_text = asText(bytes.subspan(header.body));
  declaration.needs_plain_ply =
      needsPlainPly(header) || (is_ascii && !isLineByItem(header, body_text));
  if (is_ascii) noteOpenEnd(body_text, declaration);
  if (declaration.needs_plain_ply) declaration.polygon_count.reset();
  if (declaration.vertex_count.value_or(0) == 0) throw InputError(file, "the mesh has no vertices");
  const std::uint64_t body = header.body;
  if (!is_ascii && body < bytes.size() && bytes[body] == '\n' && bytes[body - 2] != '\r')
    declaration.newline_as_data = static_cast<std::size_t>(body);
  PlyValues values(file, header, bytes);
  for (const PlyElement& element : header.elements)
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
      for (const PlyProperty& property : element.properties)
        values.skip(values.count(element, i, property), property.type);
  requireEnd(file, header, values.rest());
  return declaration;
}

}  // namespace boresight::sessions
