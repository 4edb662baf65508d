// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/image_container.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"

namespace boresight::sessions {
namespace {

using Bytes = std::span<const std::uint8_t>;

enum Tag : std::uint64_t {
  kWidth = 256,
  kHeight = 257,
  kBitsPerSample = 258,
  kPhotometric = 262,
  kStripOffsets = 273,
  kOrientation = 274,
  kSamplesPerPixel = 277,
  kStripBytes = 279,
  kPlanarConfiguration = 284,
  kTileOffsets = 324,
  kTileBytes = 325,
  kExtraSamples = 338,
  kSampleFormat = 339,
};

[[noreturn]] void truncatedTiff(const std::filesystem::path& file) {
  throw InputError(file, "the TIFF image is truncated");
}

[[noreturn]] void damaged(const std::filesystem::path& file, const std::string& what) {
  throw InputError(file, "the image is damaged: " + what);
}

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
      truncatedTiff(file);
    for (std::uint64_t i = 0; i < entry_count_; ++i)
      (void)placeOfValues(first_entry_ + i * entry_size_);
    // The link to the next directory ends this one; what it leads to is not read.
    has_next_ = number(first_entry_ + entry_count_ * entry_size_, word) != 0;
  }

  bool hasNext() const { return has_next_; }
  bool bigEndian() const { return big_endian_; }

  /// Offset and length of the first value of a tag; length 0 when it is absent.
  std::pair<std::uint64_t, std::uint64_t> firstValue(std::uint64_t tag) const {
    const auto entry = entryOf(tag);
    if (!entry) return {0, 0};
    return {placeOfValues(*entry), typeSize(number(*entry + 2, 2))};
  }

  /// The first value of an unsigned tag, or `otherwise`.
  std::uint64_t value(std::uint64_t tag, std::uint64_t otherwise) const {
    const std::vector<std::uint64_t> all = values(tag);
    return all.empty() ? otherwise : all[0];
  }

  /// The values of an unsigned tag; empty when it is absent.
  std::vector<std::uint64_t> values(std::uint64_t tag) const {
    const auto entry = entryOf(tag);
    return entry ? entryValues(*entry) : std::vector<std::uint64_t>();
  }

 private:
  std::optional<std::uint64_t> entryOf(std::uint64_t tag) const {
    for (std::uint64_t i = 0; i < entry_count_; ++i) {
      const std::uint64_t entry = first_entry_ + i * entry_size_;
      if (number(entry, 2) == tag) return entry;
    }
    return std::nullopt;
  }

  std::uint64_t number(std::uint64_t offset, int size) const {
    if (!holds(bytes_, offset, static_cast<std::uint64_t>(size))) truncatedTiff(file_);
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
    if (count > bytes_.size()) truncatedTiff(file_);
    const std::uint64_t total = count * typeSize(number(entry + 2, 2));
    const std::uint64_t inline_place = entry + 4 + word;
    const std::uint64_t place =
        total <= word ? inline_place : number(inline_place, static_cast<int>(word));
    if (!holds(bytes_, place, total)) truncatedTiff(file_);
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
  bool has_next_ = false;
  std::uint64_t entry_count_ = 0;
  std::uint64_t first_entry_ = 0;
  std::uint64_t entry_size_ = 0;
};

void requirePixelsInFile(const std::filesystem::path& file, const TiffDirectory& directory,
                         Bytes bytes) {
  const bool tiled = !directory.values(kTileOffsets).empty();
  const auto offsets = directory.values(tiled ? kTileOffsets : kStripOffsets);
  const auto sizes = directory.values(tiled ? kTileBytes : kStripBytes);
  if (offsets.empty()) damaged(file, "a TIFF without strips or tiles");
  for (std::size_t i = 0; i < offsets.size(); ++i)
    if (!holds(bytes, offsets[i], i < sizes.size() ? sizes[i] : 1)) truncatedTiff(file);
}

/// Refuses the kinds whose values the decoder changes or misreads without saying so.
void requireFaithfulKind(const std::filesystem::path& file, const TiffDirectory& directory) {
  constexpr std::uint64_t kWhiteIsZero = 0, kBlackIsZero = 1, kRgb = 2, kPalette = 3, kYCbCr = 6;
  constexpr std::uint64_t kUnsigned = 1, kUntyped = 4;
  constexpr std::uint64_t kStraightAlpha = 2;
  constexpr std::uint64_t kMostChannels = 4;
  const std::uint64_t bits = directory.value(kBitsPerSample, 1);
  const std::uint64_t format = directory.value(kSampleFormat, kUnsigned);
  if ((format != kUnsigned && format != kUntyped) || (bits != 1 && bits != 8 && bits != 16))
    throw InputError(file, kOtherSamples);
  const std::uint64_t photometric = directory.value(kPhotometric, kBlackIsZero);
  if (photometric > kPalette && photometric != kYCbCr)
    throw InputError(file, "TIFF photometric interpretation " + std::to_string(photometric) +
                               " is not supported");
  if (photometric == kWhiteIsZero && bits == 16)
    throw InputError(file, "a TIFF of 16 bits in which 0 is white is not supported");
  const std::uint64_t channels = directory.value(kSamplesPerPixel, 1);
  if (channels < 1 || channels > kMostChannels)
    throw InputError(file, std::to_string(channels) + " channels are not supported");
  if (channels > 1 && directory.value(kPlanarConfiguration, 1) != 1)
    throw InputError(file, "a TIFF with separate colour planes is not supported");
  if (photometric == kRgb && bits == 8 && directory.value(kExtraSamples, 0) == kStraightAlpha)
    throw InputError(file,
                     "a TIFF with unassociated alpha is not supported: decoding it would "
                     "change its colours");
}

}  // namespace

int tiffOrientation(const std::filesystem::path& file, Bytes bytes) {
  constexpr std::uint64_t kUpright = 1, kLast = 8;
  if (!isTiff(bytes)) return kUpright;
  try {
    const std::uint64_t stated = TiffDirectory(file, bytes).value(kOrientation, kUpright);
    return static_cast<int>(stated >= kUpright && stated <= kLast ? stated : kUpright);
  } catch (const InputError&) {
    return kUpright;  // no pixel depends on it
  }
}

std::vector<std::uint8_t> uprightTiff(const std::filesystem::path& file, Bytes bytes) {
  std::vector<std::uint8_t> upright(bytes.begin(), bytes.end());
  const TiffDirectory directory(file, bytes);
  const auto [place, size] = directory.firstValue(kOrientation);
  for (std::uint64_t i = 0; i < size; ++i) upright[place + i] = 0;
  if (size > 0) upright[place + (directory.bigEndian() ? size - 1 : 0)] = 1;
  return upright;
}

bool isTiff(Bytes bytes) {
  if (bytes.size() < 8) return false;
  const bool little = bytes[0] == 'I' && bytes[1] == 'I';
  const bool big = bytes[0] == 'M' && bytes[1] == 'M';
  if (!little && !big) return false;
  const std::uint64_t magic = readUnsigned(bytes, 2, 2, big);
  return magic == 42 || (magic == 43 && bytes.size() >= 16);
}

ImageHeader checkTiff(const std::filesystem::path& file, Bytes bytes) {
  const TiffDirectory directory(file, bytes);
  if (directory.values(kWidth).size() != 1 || directory.values(kHeight).size() != 1)
    damaged(file, "a TIFF without width or height");
  requirePixelsInFile(file, directory, bytes);
  requireFaithfulKind(file, directory);
  constexpr std::uint64_t kAnyTooLarge = std::uint64_t{1} << 40;
  ImageHeader header{
      ImageContainer::kTiff,
      static_cast<std::int64_t>(std::min(directory.value(kWidth, 0), kAnyTooLarge)),
      static_cast<std::int64_t>(std::min(directory.value(kHeight, 0), kAnyTooLarge))};
  header.orientation = tiffOrientation(file, bytes);
  header.has_further_images = directory.hasNext();
  return header;
}

}  // namespace boresight::sessions
