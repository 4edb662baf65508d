// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/stl_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/text/text_reading.h"

namespace boresight::sessions {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint64_t kHeader = 84;  ///< a comment of 80 bytes and the number of facets
constexpr std::uint64_t kFacet = 50;   ///< normal, three vertices, two unused bytes

/// Nine coordinates.
using Facet = std::array<float, 9>;

/// The words of an ASCII file; errors name their line.
class StlWords {
 public:
  StlWords(const std::filesystem::path& file, std::string_view text) : file_(file), text_(text) {}

  bool atEnd() {
    at_ = std::min(text_.find_first_not_of(kTextBlanks, at_), text_.size());
    return at_ == text_.size();
  }
  /// "" at the end of the file.
  std::string_view next() {
    if (atEnd()) return {};
    word_ = at_;
    at_ = std::min(text_.find_first_of(kTextBlanks, at_), text_.size());
    return text_.substr(word_, at_ - word_);
  }
  /// In upper or lower case.
  void expect(std::string_view keyword) {
    const std::string_view word = required();
    if (lowerCase(word) == keyword) return;
    if (keyword.starts_with(lowerCase(word)) && atEnd()) truncated();
    const bool fourth_vertex = keyword == "endloop" && lowerCase(word) == "vertex";
    fail(fourth_vertex ? "a facet has more than three vertices: write triangles"
                       : "'" + shortWord(word) + "' instead of " + std::string(keyword));
  }
  float number() {
    const std::string_view word = required();
    const auto value = realIn(word);
    if (!value && atEnd()) truncated();
    if (!value) fail(noNumberText(word));
    if (std::abs(*value) > static_cast<double>(std::numeric_limits<float>::max()))
      return std::numeric_limits<float>::infinity();
    return static_cast<float>(*value);
  }
  std::string_view required() {
    const std::string_view word = next();
    if (word.empty()) truncated();
    return word;
  }
  [[noreturn]] void truncated() const { throw InputError(file_, "the STL mesh is truncated"); }
  /// The name of a solid.
  void skipLine() { at_ = std::min(text_.find_first_of("\r\n", at_), text_.size()); }

  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(file_, "line " + std::to_string(lineAt(text_, word_)), reason);
  }

 private:
  const std::filesystem::path& file_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t word_ = 0;  ///< where the last word begins
};

/// Behind the word `facet`.
Facet readFacet(StlWords& words) {
  words.expect("normal");
  for (int i = 0; i < 3; ++i) (void)words.required();  // follows from the vertices
  words.expect("outer");
  words.expect("loop");
  Facet facet{};
  for (std::size_t i = 0; i < facet.size(); ++i) {
    if (i % 3 == 0) words.expect("vertex");
    facet[i] = words.number();
  }
  words.expect("endloop");
  words.expect("endfacet");
  return facet;
}

/// Calls `take` with the facets of all solids.
template <class Take>
void readSolids(const std::filesystem::path& file, std::string_view text, Take take) {
  StlWords words(file, text);
  while (!words.atEnd()) {
    words.expect("solid");
    words.skipLine();
    while (true) {
      const std::string word = lowerCase(words.required());
      if (word == "endsolid") break;
      if (word != "facet" && words.atEnd()) words.truncated();
      if (word != "facet") words.fail("'" + shortWord(word) + "' instead of facet or endsolid");
      take(readFacet(words));
    }
    words.skipLine();
  }
}

std::uint64_t statedFacets(Bytes bytes) {
  return bytes.size() >= kHeader ? readUnsigned(bytes, 80, 4, false) : 0;
}

/// A binary header may begin with "solid" too; then its number of facets has a zero byte, as texts
/// have not.
bool isAscii(const std::filesystem::path& file, Bytes bytes) {
  const bool fits =
      bytes.size() >= kHeader && bytes.size() == kHeader + statedFacets(bytes) * kFacet;
  if (fits) return false;
  const Bytes begin = bytes.first(std::min<std::size_t>(bytes.size(), kHeader));
  const std::string_view marked = asText(begin);
  const std::string_view word = trimmed(unmarkedText(file, marked)).substr(0, 5);
  return lowerCase(word) == "solid" && marked.find('\0') == std::string_view::npos;
}

void checkBinary(const std::filesystem::path& file, Bytes bytes) {
  if (bytes.size() < kHeader) throw InputError(file, "not an STL mesh");
  const std::uint64_t facets = statedFacets(bytes);
  constexpr std::uint64_t kMostFacets = 1 << 24;  // more than a file may have: it is another format
  if (facets >= kMostFacets)
    throw InputError(file, "not an STL mesh: it begins neither with 'solid' nor as a binary one");
  if (facets == 0) throw InputError(file, "the mesh has no faces");
  const std::uint64_t rest = bytes.size() - kHeader;
  if (rest / kFacet < facets) throw InputError(file, "the STL mesh is truncated");
  if (rest / kFacet > facets)
    throw InputError(file, "header",
                     "declares " + std::to_string(facets) + " facets, but " +
                         std::to_string(rest - facets * kFacet) + " more bytes follow them");
}

void append(float value, std::vector<std::uint8_t>& bytes) {
  const auto raw = std::bit_cast<std::uint32_t>(value);
  for (int shift = 0; shift < 32; shift += 8)
    bytes.push_back(static_cast<std::uint8_t>(raw >> shift));
}

}  // namespace

MeshDeclaration checkStl(const std::filesystem::path& file, Bytes bytes) {
  MeshDeclaration declaration;
  if (!isAscii(file, bytes)) {
    checkBinary(file, bytes);
    declaration.polygon_count = static_cast<std::int64_t>(statedFacets(bytes));
    return declaration;
  }
  std::int64_t facets = 0;
  readSolids(file, textOf(file, asText(bytes)), [&facets](const Facet&) { ++facets; });
  declaration.polygon_count = facets;
  return declaration;
}

std::vector<std::uint8_t> plainStl(const std::filesystem::path& file, Bytes bytes) {
  if (!isAscii(file, bytes)) {
    const Bytes whole = bytes.first(kHeader + statedFacets(bytes) * kFacet);
    return {whole.begin(), whole.end()};
  }
  std::vector<std::uint8_t> binary(kHeader, ' ');
  std::uint32_t facets = 0;
  readSolids(file, textOf(file, asText(bytes)), [&](const Facet& facet) {
    for (int i = 0; i < 3; ++i) append(0.0F, binary);
    for (const float value : facet) append(value, binary);
    binary.insert(binary.end(), 2, 0);
    ++facets;
  });
  for (std::size_t i = 0; i < 4; ++i) binary[80 + i] = static_cast<std::uint8_t>(facets >> 8 * i);
  return binary;
}

}  // namespace boresight::sessions
