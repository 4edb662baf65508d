// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boresight::sessions {

/// A property of an element of a PLY file.
struct PlyProperty {
  std::string name;
  std::string type;        ///< of its values, e.g. "float32"
  std::string count_type;  ///< of a list's length; empty: one value

  bool isList() const { return !count_type.empty(); }
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
  bool old_mac = false;    ///< its lines end in CR alone
};

/// Reads the header of a file that begins with `ply`. InputError.
PlyHeader readPlyHeader(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

/// Bytes of a value; 0: not a PLY type.
int plyTypeSize(std::string_view type);

/// Whether the property is a list of vertices.
bool isVertexList(const PlyProperty& property);
/// Whether the property is x, y or z.
bool isCoordinate(const PlyProperty& property);
/// Whether it is one of these of the vertices, faces or triangle strips.
bool isGeometry(const PlyElement& element, const PlyProperty& property);

/// The values of a body, one after the other. InputError where the file is truncated, or a text,
/// with its line, is no number.
class PlyValues {
 public:
  /// `file` and `bytes` must outlive this object.
  PlyValues(const std::filesystem::path& file, const PlyHeader& header,
            std::span<const std::uint8_t> bytes)
      : file_(file), encoding_(header.encoding), bytes_(bytes), rest_(bytes.subspan(header.body)) {}

  /// Number of values of an item's property: 1, or the length of a list, which is read.
  std::uint64_t count(const PlyElement& element, std::uint64_t item, const PlyProperty& property);
  /// Texts must be finite numbers.
  double next(const std::string& type);
  /// Texts may also be numbers that are not finite.
  void skip(std::uint64_t values, const std::string& type);
  /// Skips values of a property; texts of geometry must be finite numbers.
  void check(std::uint64_t values, const PlyElement& element, const PlyProperty& property);
  /// Whether a text so far was a number that importers may read otherwise, such as .5 or nan.
  bool unusualNumbers() const { return unusual_numbers_; }
  /// Bytes behind the last value.
  std::span<const std::uint8_t> rest() const { return rest_; }

 private:
  std::string_view word();                      ///< of an ASCII file
  std::uint64_t bits(const std::string& type);  ///< of a binary file
  [[noreturn]] void fail(std::string_view word, const std::string& reason) const;

  const std::filesystem::path& file_;
  PlyEncoding encoding_;
  std::span<const std::uint8_t> bytes_;
  std::span<const std::uint8_t> rest_;
  bool unusual_numbers_ = false;
};

/// Whether importers cannot read the mesh: triangle strips, or faces before vertices.
bool needsPlainPly(const PlyHeader& header);

/// A mesh that passed checkPly as a binary file with vertices, then faces, and nothing else; strips
/// become triangles. InputError.
std::vector<std::uint8_t> plainPly(const std::filesystem::path& file,
                                   std::span<const std::uint8_t> bytes);

}  // namespace boresight::sessions
