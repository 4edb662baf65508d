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
};

/// Reads the header of a file that begins with `ply`. InputError.
PlyHeader readPlyHeader(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

/// Bytes of a value; 0: not a PLY type.
int plyTypeSize(std::string_view type);

/// The values of a body, one after the other. InputError where the file is truncated.
class PlyValues {
 public:
  /// `file` and `bytes` must outlive this object.
  PlyValues(const std::filesystem::path& file, const PlyHeader& header,
            std::span<const std::uint8_t> bytes)
      : file_(file), encoding_(header.encoding), body_(bytes.subspan(header.body)), rest_(body_) {}

  /// Number of values of an item's property: 1, or the length of a list, which is read.
  std::uint64_t count(const PlyElement& element, std::uint64_t item, const PlyProperty& property);
  /// NaN for a text that is not a number.
  double next(const std::string& type);
  void skip(std::uint64_t values, const std::string& type);
  /// Bytes behind the last value.
  std::span<const std::uint8_t> rest() const { return rest_; }

 private:
  std::string_view word();                      ///< of an ASCII file
  std::uint64_t bits(const std::string& type);  ///< of a binary file

  const std::filesystem::path& file_;
  PlyEncoding encoding_;
  std::span<const std::uint8_t> body_;
  std::span<const std::uint8_t> rest_;
};

/// Whether importers cannot read the mesh: triangle strips, or faces before vertices.
bool needsPlainPly(const PlyHeader& header);

/// A mesh that passed checkPly as a binary file with vertices, then faces, and nothing else; strips
/// become triangles. InputError.
std::vector<std::uint8_t> plainPly(const std::filesystem::path& file,
                                   std::span<const std::uint8_t> bytes);

}  // namespace boresight::sessions
