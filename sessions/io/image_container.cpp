// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/image_container.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "sessions/io/byte_cursor.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"

namespace boresight::sessions {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPngSignature = {0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a};

[[noreturn]] void truncated(const std::filesystem::path& file, const char* container) {
  throw InputError(file, std::string("the ") + container + " image is truncated");
}

[[noreturn]] void damaged(const std::filesystem::path& file, const std::string& what) {
  throw InputError(file, "the image is damaged: " + what);
}

// --- PNG (ISO/IEC 15948) ------------------------------------------------------------------------

std::array<std::uint32_t, 256> crcTable() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < table.size(); ++n) {
    std::uint32_t c = n;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1u) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    table[n] = c;
  }
  return table;
}

std::uint32_t crc32(Bytes bytes) {
  static const std::array<std::uint32_t, 256> table = crcTable();
  std::uint32_t c = 0xffffffffu;
  for (const std::uint8_t byte : bytes) c = table[(c ^ byte) & 0xffu] ^ (c >> 8);
  return c ^ 0xffffffffu;
}

ImageHeader checkPng(const std::filesystem::path& file, Bytes bytes) {
  ImageHeader header{ImageContainer::kPng, 0, 0};
  std::uint64_t offset = kPngSignature.size();
  bool has_data = false;
  while (true) {
    if (!holds(bytes, offset, 12)) truncated(file, "PNG");
    const std::uint64_t length = readUnsigned(bytes, offset, 4, true);
    if (!holds(bytes, offset, 12 + length)) truncated(file, "PNG");
    const Bytes type_and_data = bytes.subspan(offset + 4, 4 + length);
    const std::string type(asText(type_and_data.first(4)));
    if (crc32(type_and_data) != readUnsigned(bytes, offset + 8 + length, 4, true))
      damaged(file, "the checksum of PNG chunk " + type + " is wrong");
    if (type == "IHDR" && length >= 8) {
      header.width = static_cast<std::int64_t>(readUnsigned(type_and_data, 4, 4, true));
      header.height = static_cast<std::int64_t>(readUnsigned(type_and_data, 8, 4, true));
    }
    has_data = has_data || type == "IDAT";
    if (type == "IEND") break;
    offset += 12 + length;
  }
  if (header.width == 0 || !has_data) damaged(file, "a PNG without IHDR or IDAT");
  return header;
}

// --- JPEG (ITU-T T.81, annex B) -----------------------------------------------------------------

bool isStartOfFrame(std::uint8_t marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

bool standsAlone(std::uint8_t marker) {
  return marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8);
}

/// First byte after entropy-coded data: the next marker that is neither stuffing nor a restart.
std::uint64_t endOfScan(Bytes bytes, std::uint64_t offset) {
  while (offset + 1 < bytes.size()) {
    const std::uint8_t next = bytes[offset + 1];
    if (bytes[offset] == 0xff && next != 0x00 && next != 0xff && !(next >= 0xd0 && next <= 0xd7))
      return offset;
    ++offset;
  }
  return bytes.size();
}

ImageHeader checkJpeg(const std::filesystem::path& file, Bytes bytes) {
  ImageHeader header{ImageContainer::kJpeg, 0, 0};
  std::uint64_t offset = 2;
  bool has_scan = false;
  while (true) {
    while (holds(bytes, offset, 2) && bytes[offset] == 0xff && bytes[offset + 1] == 0xff) ++offset;
    if (!holds(bytes, offset, 2)) truncated(file, "JPEG");
    if (bytes[offset] != 0xff) damaged(file, "a JPEG marker is missing");
    const std::uint8_t marker = bytes[offset + 1];
    offset += 2;
    if (marker == 0xd9) break;
    if (standsAlone(marker)) continue;
    if (!holds(bytes, offset, 2)) truncated(file, "JPEG");
    const std::uint64_t length = readUnsigned(bytes, offset, 2, true);
    if (!holds(bytes, offset, length)) truncated(file, "JPEG");
    if (isStartOfFrame(marker) && length >= 7) {
      header.height = static_cast<std::int64_t>(readUnsigned(bytes, offset + 3, 2, true));
      header.width = static_cast<std::int64_t>(readUnsigned(bytes, offset + 5, 2, true));
    }
    offset += length;
    if (marker == 0xda) {
      has_scan = true;
      offset = endOfScan(bytes, offset);
    }
  }
  if (header.width == 0 || header.height == 0 || !has_scan)
    damaged(file, "a JPEG without frame or scan");
  return header;
}

// --- TIFF 6.0 and BigTIFF -----------------------------------------------------------------------

/// The first directory of a TIFF file.
class TiffDirectory {
 public:
  TiffDirectory(const std::filesystem::path& file, Bytes bytes) : file_(file), bytes_(bytes) {
    big_endian_ = bytes[0] == 'M';
    big_ = readUnsigned(bytes, 2, 2, big_endian_) == 43;
    const int word = big_ ? 8 : 4;
    const std::uint64_t start = number(big_ ? 8 : 4, word);
    entry_count_ = number(start, big_ ? 8 : 2);
    first_entry_ = start + (big_ ? 8 : 2);
    entry_size_ = big_ ? 20 : 12;
    // The count may be anything in a damaged file: bounded before it is multiplied.
    if (entry_count_ > bytes.size() || !holds(bytes, first_entry_, entry_count_ * entry_size_))
      truncated(file, "TIFF");
    for (std::uint64_t i = 0; i < entry_count_; ++i)
      (void)placeOfValues(first_entry_ + i * entry_size_);
    // The link to the next directory ends this one; what it leads to is not read.
    (void)number(first_entry_ + entry_count_ * entry_size_, word);
  }

  /// The values of an unsigned tag; empty when it is absent.
  std::vector<std::uint64_t> values(std::uint64_t tag) const {
    for (std::uint64_t i = 0; i < entry_count_; ++i) {
      const std::uint64_t entry = first_entry_ + i * entry_size_;
      if (number(entry, 2) == tag) return entryValues(entry);
    }
    return {};
  }

 private:
  std::uint64_t number(std::uint64_t offset, int size) const {
    if (!holds(bytes_, offset, static_cast<std::uint64_t>(size))) truncated(file_, "TIFF");
    return readUnsigned(bytes_, offset, size, big_endian_);
  }

  /// Bytes of one value of a TIFF type; 0 for types that do not exist.
  static std::uint64_t typeSize(std::uint64_t type) {
    constexpr std::uint8_t kSizes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8};
    return type < std::size(kSizes) ? kSizes[type] : 0;
  }

  static bool isUnsigned(std::uint64_t type) {
    return type == 1 || type == 3 || type == 4 || type == 13 || type == 16 || type == 18;
  }

  /// Where the values of an entry are: in the entry itself when they fit there.
  std::uint64_t placeOfValues(std::uint64_t entry) const {
    const std::uint64_t word = big_ ? 8 : 4;
    const std::uint64_t count = number(entry + 4, static_cast<int>(word));
    if (count > bytes_.size()) truncated(file_, "TIFF");
    const std::uint64_t total = count * typeSize(number(entry + 2, 2));
    const std::uint64_t inline_place = entry + 4 + word;
    const std::uint64_t place =
        total <= word ? inline_place : number(inline_place, static_cast<int>(word));
    if (!holds(bytes_, place, total)) truncated(file_, "TIFF");
    return place;
  }

  std::vector<std::uint64_t> entryValues(std::uint64_t entry) const {
    const std::uint64_t type = number(entry + 2, 2);
    if (!isUnsigned(type)) damaged(file_, "a TIFF tag has an unexpected type");
    const std::uint64_t size = typeSize(type);
    const std::uint64_t place = placeOfValues(entry);
    std::vector<std::uint64_t> all(static_cast<std::size_t>(number(entry + 4, big_ ? 8 : 4)));
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = number(place + i * size, static_cast<int>(size));
    return all;
  }

  const std::filesystem::path& file_;
  Bytes bytes_;
  bool big_endian_ = false;
  bool big_ = false;
  std::uint64_t entry_count_ = 0;
  std::uint64_t first_entry_ = 0;
  std::uint64_t entry_size_ = 0;
};

ImageHeader checkTiff(const std::filesystem::path& file, Bytes bytes) {
  constexpr std::uint64_t kWidth = 256, kHeight = 257;
  constexpr std::uint64_t kStripOffsets = 273, kStripBytes = 279;
  constexpr std::uint64_t kTileOffsets = 324, kTileBytes = 325;
  const TiffDirectory directory(file, bytes);
  const std::vector<std::uint64_t> width = directory.values(kWidth);
  const std::vector<std::uint64_t> height = directory.values(kHeight);
  if (width.size() != 1 || height.size() != 1) damaged(file, "a TIFF without width or height");
  const bool tiled = !directory.values(kTileOffsets).empty();
  const auto offsets = directory.values(tiled ? kTileOffsets : kStripOffsets);
  const auto sizes = directory.values(tiled ? kTileBytes : kStripBytes);
  if (offsets.empty()) damaged(file, "a TIFF without strips or tiles");
  for (std::size_t i = 0; i < offsets.size(); ++i)
    if (!holds(bytes, offsets[i], i < sizes.size() ? sizes[i] : 1)) truncated(file, "TIFF");
  constexpr std::uint64_t kAnyTooLarge = std::uint64_t{1} << 40;
  return {ImageContainer::kTiff, static_cast<std::int64_t>(std::min(width[0], kAnyTooLarge)),
          static_cast<std::int64_t>(std::min(height[0], kAnyTooLarge))};
}

bool isTiff(Bytes bytes) {
  if (bytes.size() < 8) return false;
  const bool little = bytes[0] == 'I' && bytes[1] == 'I';
  const bool big = bytes[0] == 'M' && bytes[1] == 'M';
  if (!little && !big) return false;
  const std::uint64_t magic = readUnsigned(bytes, 2, 2, big);
  return magic == 42 || (magic == 43 && bytes.size() >= 16);
}

}  // namespace

const char* imageContainerName(ImageContainer container) {
  switch (container) {
    case ImageContainer::kPng:
      return "PNG";
    case ImageContainer::kJpeg:
      return "JPEG";
    case ImageContainer::kTiff:
      return "TIFF";
  }
  return "unknown";
}

ImageHeader checkImageContainer(const std::filesystem::path& file, Bytes bytes) {
  const auto startsWith = [bytes](Bytes signature) {
    return bytes.size() >= signature.size() &&
           std::equal(signature.begin(), signature.end(), bytes.begin());
  };
  if (startsWith(kPngSignature)) return checkPng(file, bytes);
  if (startsWith(std::array<std::uint8_t, 3>{0xff, 0xd8, 0xff})) return checkJpeg(file, bytes);
  if (isTiff(bytes)) return checkTiff(file, bytes);
  if (startsWith(std::array<std::uint8_t, 4>{0x89, 'P', 'N', 'G'})) truncated(file, "PNG");
  throw InputError(file, "not a PNG, JPEG or TIFF image");
}

}  // namespace boresight::sessions
