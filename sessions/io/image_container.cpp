// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/image_container.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "core/base/crc32.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"

namespace boresight::sessions {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPngSignature = {0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a};

[[noreturn]] void truncatedImage(const std::filesystem::path& file, const char* container) {
  throw InputError(file, std::string("the ") + container + " image is truncated");
}

[[noreturn]] void damaged(const std::filesystem::path& file, const std::string& what) {
  throw InputError(file, "the image is damaged: " + what);
}

// PNG: ISO/IEC 15948.

ImageHeader checkPng(const std::filesystem::path& file, Bytes bytes) {
  ImageHeader header{ImageContainer::kPng, 0, 0};
  std::uint64_t offset = kPngSignature.size();
  bool has_data = false;
  while (true) {
    if (!holds(bytes, offset, 12)) truncatedImage(file, "PNG");
    const std::uint64_t length = readUnsigned(bytes, offset, 4, true);
    if (!holds(bytes, offset, 12 + length)) truncatedImage(file, "PNG");
    const Bytes type_and_data = bytes.subspan(offset + 4, 4 + length);
    const std::string type(asText(type_and_data.first(4)));
    if (crc32(type_and_data) != readUnsigned(bytes, offset + 8 + length, 4, true))
      damaged(file, "the checksum of PNG chunk " + type + " is wrong");
    if (type == "IHDR" && length >= 8) {
      header.width = static_cast<std::int64_t>(readUnsigned(type_and_data, 4, 4, true));
      header.height = static_cast<std::int64_t>(readUnsigned(type_and_data, 8, 4, true));
    }
    has_data = has_data || type == "IDAT";
    if (type == "eXIf") header.orientation = tiffOrientation(file, type_and_data.subspan(4));
    if (type == "IEND") break;
    offset += 12 + length;
  }
  if (header.width == 0 || !has_data) damaged(file, "a PNG without IHDR or IDAT");
  return header;
}

// JPEG: ITU-T T.81, annex B.

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
  constexpr std::string_view kExif("Exif\0\0", 6);
  ImageHeader header{ImageContainer::kJpeg, 0, 0};
  std::uint64_t offset = 2;
  bool has_scan = false;
  while (true) {
    while (holds(bytes, offset, 2) && bytes[offset] == 0xff && bytes[offset + 1] == 0xff) ++offset;
    if (!holds(bytes, offset, 2)) truncatedImage(file, "JPEG");
    if (bytes[offset] != 0xff) damaged(file, "a JPEG marker is missing");
    const std::uint8_t marker = bytes[offset + 1];
    offset += 2;
    if (marker == 0xd9) break;
    if (standsAlone(marker)) continue;
    if (!holds(bytes, offset, 2)) truncatedImage(file, "JPEG");
    const std::uint64_t length = readUnsigned(bytes, offset, 2, true);
    if (length < 2) damaged(file, "a JPEG segment without its length");
    if (!holds(bytes, offset, length)) truncatedImage(file, "JPEG");
    if (isStartOfFrame(marker) && length >= 7) {
      header.height = static_cast<std::int64_t>(readUnsigned(bytes, offset + 3, 2, true));
      header.width = static_cast<std::int64_t>(readUnsigned(bytes, offset + 5, 2, true));
    }
    const Bytes segment = bytes.subspan(offset + 2, length - 2);
    if (marker == 0xe1 && asText(segment).starts_with(kExif))
      header.orientation = tiffOrientation(file, segment.subspan(kExif.size()));
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

}  // namespace

const char* imageContainerName(ImageContainer container) {
  constexpr const char* kNames[] = {"PNG", "JPEG", "TIFF"};
  return kNames[static_cast<int>(container)];
}

ImageHeader checkImageContainer(const std::filesystem::path& file, Bytes bytes) {
  const auto startsWith = [bytes](Bytes signature) {
    return bytes.size() >= signature.size() &&
           std::equal(signature.begin(), signature.end(), bytes.begin());
  };
  if (startsWith(kPngSignature)) return checkPng(file, bytes);
  if (startsWith(std::array<std::uint8_t, 3>{0xff, 0xd8, 0xff})) return checkJpeg(file, bytes);
  if (isTiff(bytes)) return checkTiff(file, bytes);
  if (startsWith(std::array<std::uint8_t, 4>{0x89, 'P', 'N', 'G'})) truncatedImage(file, "PNG");
  throw InputError(file,
                   "not a PNG, JPEG or TIFF image, nor one with a VICAR, PDS3 or PDS4 label "
                   "in it or beside it");
}

}  // namespace boresight::sessions
