// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/ply_file.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/meshes/mesh_container.h"
#include "sessions/text/text_reading.h"

namespace boresight::sessions {
namespace {

using Bytes = std::span<const std::uint8_t>;

[[noreturn]] void truncatedPly(const std::filesystem::path& file) {
  throw InputError(file, "the PLY mesh is truncated");
}

void readPlyLine(const std::filesystem::path& file, std::string_view text, PlyHeader& header) {
  const std::string line = shortWord(text);
  const std::string_view keyword = takeWord(text);
  if (keyword == "format") {
    const std::string encoding(takeWord(text));
    if (encoding == "binary_little_endian")
      header.encoding = PlyEncoding::kLittleEndian;
    else if (encoding == "binary_big_endian")
      header.encoding = PlyEncoding::kBigEndian;
    else if (encoding != "ascii")
      throw InputError(file, "header", "unknown PLY encoding '" + encoding + "'");
  } else if (keyword == "element") {
    PlyElement element;
    element.name = takeWord(text);
    const std::string_view count = takeWord(text);
    const auto whole = wholeIn<std::uint64_t>(count);
    if (!whole)
      throw InputError(file, "header",
                       "bad line '" + line + "': '" + shortWord(count) + "' is not a whole number");
    element.count = *whole;
    header.elements.push_back(element);
  } else if (keyword == "property") {
    PlyProperty property;
    property.type = takeWord(text);
    const bool is_list = property.type == "list";
    if (is_list) {
      property.count_type = takeWord(text);
      property.type = takeWord(text);
    }
    property.name = takeWord(text);
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

/// Whether each item has a line that ends in LF, as importers take for granted.
bool isLineByItem(const PlyHeader& header, std::string_view body) {
  std::uint64_t items = 0;
  for (const PlyElement& element : header.elements) items += element.count;
  const std::size_t last = body.find_last_not_of(kTextBlanks);
  if (last == std::string_view::npos) return items == 0;
  const auto ends = std::ranges::count(body.substr(0, last), '\n');
  return items == static_cast<std::uint64_t>(ends) + 1;
}

/// A number that importers read as realIn does.
bool isUsualNumber(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789";
  if (text.starts_with('-')) text.remove_prefix(1);
  return !text.empty() && kDigits.find(text.front()) != std::string_view::npos &&
         kDigits.find(text.back()) != std::string_view::npos &&
         text.find_first_not_of("0123456789.+-eE") == std::string_view::npos &&
         text.find(".e") == std::string_view::npos && text.find(".E") == std::string_view::npos;
}

/// The file without what pads the end of a text.
Bytes contentOf(const PlyHeader& header, Bytes bytes) {
  if (header.encoding != PlyEncoding::kAscii) return bytes;
  const std::size_t body = withoutPadding(asText(bytes.subspan(header.body))).size();
  return bytes.first(header.body + body);
}

}  // namespace

bool isVertexList(const PlyProperty& property) {
  return property.isList() &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

bool isCoordinate(const PlyProperty& property) {
  return !property.isList() && property.name.size() == 1 && property.name[0] >= 'x' &&
         property.name[0] <= 'z';
}

bool isGeometry(const PlyElement& element, const PlyProperty& property) {
  if (element.name == "vertex") return isCoordinate(property);
  return (element.name == "face" || element.name == "tristrips") && isVertexList(property);
}

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
  // Behind a header whose lines end in CR alone, a LF is the first byte of the data.
  const std::size_t first_end = text.find_first_of("\r\n");
  PlyHeader header;
  header.old_mac = text.substr(std::min(first_end, text.size())).starts_with('\r') &&
                   !text.substr(first_end).starts_with("\r\n");
  const char line_end = header.old_mac ? '\r' : '\n';
  std::size_t start = 0;
  while (true) {
    const std::size_t end = text.find(line_end, start);
    if (end == std::string_view::npos) {
      if (bytes.size() <= kMaxHeader) truncatedPly(file);
      throw InputError(file, "header", "no end_header within its first 64 kB");
    }
    const std::string_view line = trimmed(text.substr(start, end - start));
    start = end + 1;
    if (line == "end_header") break;
    readPlyLine(file, line, header);
  }
  header.body = start;
  return header;
}

std::string_view PlyValues::word() {
  std::string_view text = asText(rest_);
  const std::string_view word = takeWord(text);
  if (word.empty()) truncatedPly(file_);
  rest_ = rest_.last(text.size());
  return word;
}

void PlyValues::fail(std::string_view word, const std::string& reason) const {
  const std::string_view text = asText(bytes_);
  const auto offset = static_cast<std::size_t>(word.data() - text.data());
  throw InputError(file_, "line " + std::to_string(lineAt(text, offset)), reason);
}

std::uint64_t PlyValues::bits(const std::string& type) {
  const Bytes before = rest_;
  skip(1, type);
  return readUnsigned(before, 0, plyTypeSize(type), encoding_ == PlyEncoding::kBigEndian);
}

void PlyValues::skip(std::uint64_t values, const std::string& type) {
  if (encoding_ == PlyEncoding::kAscii) {
    for (; values > 0; --values) {
      const std::string_view text = word();
      unusual_numbers_ = unusual_numbers_ || !isUsualNumber(text);
      if (!realIn(text) && !isNotFiniteText(text)) fail(text, noNumberText(text));
    }
    return;
  }
  const auto size = static_cast<std::uint64_t>(plyTypeSize(type));
  if (values > rest_.size() / size) truncatedPly(file_);
  rest_ = rest_.subspan(values * size);
}

void PlyValues::check(std::uint64_t values, const PlyElement& element,
                      const PlyProperty& property) {
  if (encoding_ != PlyEncoding::kAscii || !isGeometry(element, property))
    return skip(values, property.type);
  for (; values > 0; --values) (void)next(property.type);
}

std::uint64_t PlyValues::count(const PlyElement& element, std::uint64_t item,
                               const PlyProperty& property) {
  if (!property.isList()) return 1;
  if (encoding_ != PlyEncoding::kAscii) return bits(property.count_type);
  const std::string_view text = word();
  unusual_numbers_ = unusual_numbers_ || !isUsualNumber(text);
  const auto number = wholeIn<std::uint64_t>(text);
  if (!number || *number > bytes_.size())
    throw InputError(file_, element.name + " " + std::to_string(item),
                     "'" + shortWord(text) + "' is not the length of a list");
  return *number;
}

double PlyValues::next(const std::string& type) {
  if (encoding_ == PlyEncoding::kAscii) {
    const std::string_view text = word();
    unusual_numbers_ = unusual_numbers_ || !isUsualNumber(text);
    const auto value = realIn(text);
    if (!value) fail(text, noNumberText(text));
    return *value;
  }
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
  std::string_view begin = asText(bytes.first(std::min<std::size_t>(bytes.size(), 4)));
  if (takeWord(begin) != "ply" || begin.empty())
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
  if (declaration.vertex_count.value_or(0) == 0) throw InputError(file, "the mesh has no vertices");
  const Bytes content = contentOf(header, bytes);
  PlyValues values(file, header, content);
  for (const PlyElement& element : header.elements)
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
      for (const PlyProperty& property : element.properties)
        values.check(values.count(element, i, property), element, property);
  requireEnd(file, header, values.rest());
  const bool is_ascii = header.encoding == PlyEncoding::kAscii;
  const std::string_view body_text = asText(content.subspan(header.body));
  declaration.needs_plain_ply =
      needsPlainPly(header) || header.old_mac ||
      (is_ascii && (!isLineByItem(header, body_text) || content.size() != bytes.size() ||
                    values.unusualNumbers()));
  if (is_ascii) noteOpenEnd(body_text, declaration);
  if (declaration.needs_plain_ply) declaration.polygon_count.reset();
  const std::uint64_t body = header.body;
  if (!is_ascii && body < bytes.size() && bytes[body] == '\n' && bytes[body - 2] != '\r')
    declaration.newline_as_data = static_cast<std::size_t>(body);
  return declaration;
}

}  // namespace boresight::sessions
