// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/ply_header.h"

#include <algorithm>
#include <sstream>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"

namespace boresight::sessions {
namespace {

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
  }
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

std::string_view takeWord(std::string_view& text) {
  constexpr const char* kBlanks = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  return word;
}

PlyHeader readPlyHeader(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kMaxHeader = 65536;
  const std::string_view text = asText(bytes.first(std::min(bytes.size(), kMaxHeader)));
  PlyHeader header;
  std::size_t start = 0;
  while (true) {
    const std::size_t end = text.find('\n', start);
    if (end == std::string_view::npos) {
      if (bytes.size() <= kMaxHeader) throw InputError(file, "the PLY mesh is truncated");
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

}  // namespace boresight::sessions
