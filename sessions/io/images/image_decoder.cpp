// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/image_decoder.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/gdal_memory.h"
#include "sessions/io/images/image_file.h"

namespace boresight::sessions {
namespace {

using namespace std::string_view_literals;
using Bytes = std::span<const std::uint8_t>;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& container,
                         const std::string& why) {
  throw InputError(file, "the " + container + " image " + why);
}

/// Where the last marker of a JPEG is, after its scans: segments before them may hold a thumbnail
/// with an end of its own. npos where there is none.
std::size_t endOfJpeg(Bytes bytes) {
  constexpr std::uint8_t kFill = 0xff, kStartOfScan = 0xda;
  std::uint64_t at = 2;
  while (holds(bytes, at, 4) && bytes[at + 1] != kStartOfScan)
    at += bytes[at + 1] == kFill ? 1 : 2 + readUnsigned(bytes, at + 2, 2, true);
  return asText(bytes).find("\xff\xd9"sv, at);
}

/// Whether an arithmetic coder wrote the JPEG, which leaves any number of last bytes out.
bool isArithmetic(Bytes bytes) {
  constexpr std::uint8_t kStartOfScan = 0xda, kFirst = 0xc9, kLast = 0xcf, kConditions = 0xcc;
  for (std::uint64_t at = 2; holds(bytes, at, 4) && bytes[at + 1] != kStartOfScan;) {
    const std::uint8_t marker = bytes[at + 1];
    if (marker >= kFirst && marker <= kLast && marker != kConditions) return true;
    at += marker == 0xff ? 1 : 2 + readUnsigned(bytes, at + 2, 2, true);
  }
  return false;
}

/// The container of a complete file. Decoders accept truncated files, so the end marker is checked.
std::string completeContainerOf(const std::filesystem::path& file, Bytes bytes) {
  const char* known = imageContainerOf(bytes);
  if (known == nullptr)
    throw InputError(file,
                     "not a PNG, JPEG or TIFF image, nor one with a VICAR, PDS3 or PDS4 label "
                     "in it or next to it");
  const std::string container = known;
  std::size_t end = 0;  // of a TIFF, requireEveryBlock checks the blocks
  if (container == "PNG") end = asText(bytes).find("IEND\xae\x42\x60\x82");
  if (container == "JPEG") end = endOfJpeg(bytes);
  if (end == std::string_view::npos) refuse(file, container, "is truncated");
  return container;
}

/// The number that the first directory of a TIFF, or of an Exif block, which is one, has for a tag;
/// empty where it has none.
std::optional<std::uint64_t> directoryNumber(Bytes block, std::uint64_t tag) {
  const bool big_endian = !block.empty() && block[0] == 'M';
  const auto number = [&](std::uint64_t place, int size) {
    return holds(block, place, static_cast<std::uint64_t>(size))
               ? readUnsigned(block, place, size, big_endian)
               : 0;
  };
  constexpr std::uint64_t kShort = 3, kBigTiff = 43;
  const bool big = number(2, 2) == kBigTiff;
  const std::uint64_t directory = big ? number(8, 8) : number(4, 4);
  const std::uint64_t count = std::min(number(directory, big ? 8 : 2), std::uint64_t{65536});
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t entry = directory + (big ? 8 + i * 20 : 2 + i * 12);
    if (number(entry, 2) == tag)
      return number(entry + (big ? 12 : 8), number(entry + 2, 2) == kShort ? 2 : 4);
  }
  return std::nullopt;
}

/// The orientation 1 .. 8 that such a directory states; 1 where it states none.
int directoryOrientation(Bytes block) {
  constexpr std::uint64_t kOrientation = 274;
  const std::uint64_t stated = directoryNumber(block, kOrientation).value_or(1);
  return stated >= 1 && stated <= 8 ? static_cast<int>(stated) : 1;
}

/// Raw files of cameras (DNG, NEF, CR2) are TIFF whose first image is a small preview.
void requireNoPreview(const std::filesystem::path& file, Bytes tiff) {
  constexpr std::uint64_t kSubfileType = 254, kReduced = 1;
  if ((directoryNumber(tiff, kSubfileType).value_or(0) & kReduced) != 0)
    refuse(file, "TIFF",
           "begins with a reduced preview, as raw files of cameras do: convert it to a TIFF or PNG "
           "of its pixels");
}

/// Whether the samples of a TIFF are a mosaic of colours.
bool isMosaic(const std::string& container, Bytes bytes) {
  constexpr std::uint64_t kPhotometric = 262, kColorFilterArray = 32803;
  return container == "TIFF" && directoryNumber(bytes, kPhotometric) == kColorFilterArray;
}

/// The same of an XMP packet: tiff:Orientation="6" or <tiff:Orientation>6<.
int xmpOrientation(std::string_view text) {
  constexpr std::string_view kName = "tiff:Orientation";
  const std::size_t at = text.find(kName);
  if (at == std::string_view::npos) return 1;
  const std::string_view value = text.substr(at + kName.size(), 4);
  const std::size_t digit = value.find_first_of("12345678");
  return digit == std::string_view::npos ? 1 : value[digit] - '0';
}

/// What the file states about its orientation, which is not applied; "" where it states none.
std::string orientationNote(const std::string& container, Bytes bytes) {
  const std::string_view text = asText(bytes);
  const std::string_view mark = container == "PNG"    ? "eXIf"sv
                                : container == "JPEG" ? "Exif\0\0"sv
                                                      : ""sv;
  const auto at = text.find(mark);
  int stated =
      at == std::string_view::npos ? 1 : directoryOrientation(bytes.subspan(at + mark.size()));
  const bool is_exif = stated != 1;
  if (!is_exif) stated = xmpOrientation(text);
  const std::string kept = " is not applied: pixels are used as they are stored";
  if (stated != 1)
    return (is_exif ? "EXIF" : "XMP") + (" orientation " + std::to_string(stated)) + kept;
  const bool packed = container == "PNG" && (text.find("Raw profile type exif"sv) != text.npos ||
                                             text.find("Raw profile type APP1"sv) != text.npos);
  return packed ? "an orientation in the file's raw EXIF profile" + kept : "";
}

/// An image that GDAL has opened.
class OpenImage {
 public:
  OpenImage(const std::filesystem::path& file, Bytes bytes) : file_(file) {
    header_.container = completeContainerOf(file, bytes);
    const std::string driver = header_.container == "TIFF" ? "GTiff" : header_.container;
    if (header_.container == "TIFF") requireNoPreview(file, bytes);
    dataset_ = openGdal(driver.c_str(), memory_.add("image", bytes));
    if (!dataset_) fail("is truncated, damaged, or of an unsupported kind");
    header_.width = dataset_->GetRasterXSize();
    header_.height = dataset_->GetRasterYSize();
    requireImageSize(file, header_.width, header_.height);
  }

  const ImageHeader& header() const { return header_; }
  const std::string& warning() const { return quiet_.warning(); }
  bool hasFurtherPages() const { return dataset_->GetMetadata("SUBDATASETS") != nullptr; }

  cv::Mat pixels() {
    const int bands = dataset_->GetRasterCount();
    if (bands < 1 || bands > 4)
      fail("has " + std::to_string(bands) + " channels: at most 4 are read");
    requireColours(bands);
    requireEveryBlock();
    const GDALDataType type = band(1).GetRasterDataType();
    cv::Mat image(header_.height, header_.width, CV_MAKETYPE(depthOf(type), bands));
    int gray_or_bgr[] = {bands < 3 ? 1 : 3, 2, 1, 4};
    const auto size = static_cast<GSpacing>(image.elemSize1());
    if (dataset_->RasterIO(GF_Read, 0, 0, image.cols, image.rows, image.data, image.cols,
                           image.rows, type, bands, gray_or_bgr, size * bands,
                           static_cast<GSpacing>(image.step), size, nullptr) != CE_None)
      fail("is truncated or damaged");
    return bands == 1 ? spread(image) : image;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    const std::string& message = quiet_.failure();
    refuse(file_, header_.container, why + (message.empty() ? "" : ": " + memory_.plain(message)));
  }
  GDALRasterBand& band(int number) const { return *dataset_->GetRasterBand(number); }
  int bitsStated() const {
    const char* bits = band(1).GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
    return bits == nullptr ? 0 : std::atoi(bits);
  }

  bool whiteIsZero() const {
    return dataset_->GetMetadataItem("MINISWHITE", "IMAGE_STRUCTURE") != nullptr;
  }

  int depthOf(GDALDataType type) const {
    const int bits = bitsStated();
    const char* kind = band(1).GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
    const bool is_signed = kind != nullptr && kind == "SIGNEDBYTE"sv;
    if (type == GDT_Byte && !is_signed && (bits <= 2 || bits == 4 || bits == 8)) return CV_8U;
    if (type == GDT_UInt16 && bits == 0) return CV_16U;
    throw InputError(file_,
                     "samples are not unsigned integers of 8 or 16 bits: write the image as a "
                     "TIFF or PNG of 16 bits, its range spread over 0 .. 65535");
  }

  void requireColours(int bands) const {
    const auto is = [this](int number, GDALColorInterp known) {
      return band(number).GetColorInterpretation() == known;
    };
    // Whose values GDAL converts.
    const char* source = dataset_->GetMetadataItem("SOURCE_COLOR_SPACE", "IMAGE_STRUCTURE");
    const bool converted = source != nullptr && source != "YCbCr"sv;
    const bool gray = is(1, GCI_GrayIndex) || is(1, GCI_Undefined);
    const bool known = bands == 1 ? gray || is(1, GCI_PaletteIndex)
                       : bands == 2
                           ? gray && !whiteIsZero()
                           : is(1, GCI_RedBand) && is(2, GCI_GreenBand) && is(3, GCI_BlueBand);
    if (converted || !known) fail("has colours other than gray and RGB; these are not supported");
  }

  /// GDAL takes strips and tiles that a TIFF does not have for zeros.
  void requireEveryBlock() const {
    if (header_.container != "TIFF") return;
    int width = 0, height = 0;
    band(1).GetBlockSize(&width, &height);
    for (int y = 0; y * height < header_.height; ++y)
      for (int x = 0; x * width < header_.width; ++x) {
        const std::string item = "BLOCK_OFFSET_" + std::to_string(x) + "_" + std::to_string(y);
        if (band(1).GetMetadataItem(item.c_str(), "TIFF") == nullptr)
          fail("is truncated or damaged: a strip or tile is missing");
      }
  }

  /// One channel as gray of the full range, or as the colours of its palette.
  cv::Mat spread(const cv::Mat& image) const {
    const int bits = bitsStated();
    const int largest = image.depth() == CV_16U ? 65535 : bits > 0 ? (1 << bits) - 1 : 255;
    cv::Mat gray = image;
    if (whiteIsZero())
      gray = cv::Mat(cv::Scalar(largest) - image);
    else if (const GDALColorTable* table = band(1).GetColorTable())
      return coloured(image, *table);
    return largest < 255 ? cv::Mat(gray * (255 / largest)) : gray;
  }

  cv::Mat coloured(const cv::Mat& image, const GDALColorTable& table) const {
    if (image.depth() != CV_8U) fail("has a palette of 16 bits; this is not supported");
    double last = 0.0;
    cv::minMaxLoc(image, nullptr, &last);
    if (last >= table.GetColorEntryCount())
      fail("is damaged: its palette has " + std::to_string(table.GetColorEntryCount()) +
           " colours, but a pixel has number " + std::to_string(static_cast<int>(last)));
    cv::Mat colours(1, 256, CV_8UC3, cv::Scalar());
    for (int i = 0; i < std::min(256, table.GetColorEntryCount()); ++i) {
      const GDALColorEntry& entry = *table.GetColorEntry(i);
      colours.at<cv::Vec3b>(i) = {static_cast<std::uint8_t>(entry.c3),
                                  static_cast<std::uint8_t>(entry.c2),
                                  static_cast<std::uint8_t>(entry.c1)};
    }
    cv::Mat indices, result;
    cv::merge(std::vector<cv::Mat>(3, image), indices);
    cv::LUT(indices, colours, result);
    return result;
  }

  const std::filesystem::path& file_;
  GdalQuiet quiet_;
  GdalMemory memory_;
  ImageHeader header_;
  GdalDataset dataset_;
};

/// A decoder of JPEG fills in what is damaged, with a warning. Damage may also leave data over
/// after the last line, of which GDAL says nothing: then the image can be decoded without its last
/// bytes.
std::string damageOfJpeg(const std::filesystem::path& file, Bytes bytes,
                         const std::string& warning) {
  constexpr std::size_t kLastBytes = 4;
  if (warning.empty() && isArithmetic(bytes)) return "";
  if (!warning.empty()) return oneLine(warning.substr(0, warning.find(" (this warning")));
  const Bytes cut = bytes.first(endOfJpeg(bytes) - kLastBytes);
  std::vector<std::uint8_t> shorter(cut.begin(), cut.end());
  shorter.insert(shorter.end(), {0xff, 0xd9});
  try {
    OpenImage open(file, shorter);
    (void)open.pixels();
    return open.warning().empty() ? "data follow its last line" : "";
  } catch (const InputError&) {
    return "";
  }
}

}  // namespace

void requireImageSize(const std::filesystem::path& file, std::int64_t width, std::int64_t height) {
  const auto in_range = [](std::int64_t side) { return side >= 1 && side <= kMaxImageSide_px; };
  if (!in_range(width) || !in_range(height) || width * height > kMaxImagePixels)
    throw InputError(file, "image size",
                     sizeText(width, height) + " is outside the limits (sides 1 .. " +
                         std::to_string(kMaxImageSide_px) + " px, at most " +
                         std::to_string(kMaxImagePixels) + " px in all)");
}

const char* imageContainerOf(Bytes bytes) {
  const std::string_view text = asText(bytes);
  if (text.starts_with("\x89PNG")) return "PNG";
  if (text.starts_with("\xff\xd8\xff")) return "JPEG";
  for (const std::string_view begin : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv})
    if (text.starts_with(begin)) return "TIFF";
  return nullptr;
}

ImageHeader readImageHeader(const std::filesystem::path& file, Bytes bytes) {
  return OpenImage(file, bytes).header();
}

DecodedImage decodeImage(const std::filesystem::path& file, Bytes bytes) {
  OpenImage open(file, bytes);
  DecodedImage decoded{open.header().container, open.pixels(), {}, false};
  decoded.mosaic = isMosaic(decoded.container, bytes);
  if (const std::string note = orientationNote(decoded.container, bytes); !note.empty())
    decoded.notes.push_back(note);
  if (open.hasFurtherPages())
    decoded.notes.push_back("the file holds further images (pages): only the first is read");
  if (decoded.container == "JPEG")
    if (const std::string damage = damageOfJpeg(file, bytes, open.warning()); !damage.empty())
      decoded.notes.push_back("the image may be damaged: " + damage);
  return decoded;
}

}  // namespace boresight::sessions
