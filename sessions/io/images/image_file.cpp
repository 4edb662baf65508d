// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/image_file.h"

#include <algorithm>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/images/image_decoder.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/images/labels/label_samples.h"
#include "sessions/io/images/pixel_image.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

/// By BayerPattern; OpenCV names a pattern by its second line.
constexpr int kDemosaicCodes[] = {cv::COLOR_BayerBG2BGR_EA, cv::COLOR_BayerRG2BGR_EA,
                                  cv::COLOR_BayerGB2BGR_EA, cv::COLOR_BayerGR2BGR_EA};
static_assert(std::size(kDemosaicCodes) == std::size(kBayerPatternNames));
constexpr int kSmallestMosaic_px = 4;  // a pixel is interpolated from the two lines round it

void demosaic(const std::filesystem::path& file, BayerPattern pattern, cv::Mat& pixels) {
  if (pixels.channels() != 1)
    throw InputError(
        file, "bayer",
        "the image has " + std::to_string(pixels.channels()) + " channels; a mosaic has one");
  if (pixels.cols < kSmallestMosaic_px || pixels.rows < kSmallestMosaic_px)
    throw InputError(file, "bayer", sizeText(pixels.cols, pixels.rows) + " px are too few");
  cv::Mat color;
  cv::cvtColor(pixels, color, kDemosaicCodes[static_cast<std::size_t>(pattern)]);
  pixels = color;
}

std::string mosaicNote(const std::string& pattern) {
  return "the pixels are a mosaic of colours" + (pattern.empty() ? "" : " (" + pattern + ")") +
         ": state its pattern with --bayer, or convert it before matching";
}

/// The samples of an image file before they become 8 bits.
struct FileSamples {
  std::optional<LabelSamples> labelled;  ///< of an image with a label; holds what `pixels` shows
  std::string container;
  cv::Mat pixels;       ///< 16 bits a channel, without gaps between rows
  int sample_bits = 8;  ///< of the file: 8 or 16
  std::vector<std::string> notes;
  std::string sha256;
};

FileSamples decode(const std::filesystem::path& file, const std::optional<BayerPattern>& bayer) {
  FileSamples decoded;
  if (const auto label_file = labelFileOf(file)) {
    LabelSamples& labelled =
        decoded.labelled.emplace(readLabelSamples(readLabelFiles(*label_file)));
    decoded.container = labelled.label->format;
    decoded.pixels = cv::Mat(labelled.height, labelled.width, CV_16U, labelled.values.data());
    decoded.sample_bits = labelled.sample_bits;
    decoded.notes = labelled.label->flags;
    decoded.sha256 = labelled.sha256;
  } else {
    const std::vector<std::uint8_t> bytes = readFileBytes(file, kMaxImageFileBytes);
    DecodedImage image = decodeImage(file, bytes);
    decoded.container = image.container;
    decoded.sample_bits = image.pixels.depth() == CV_16U ? 16 : 8;
    image.pixels.convertTo(decoded.pixels, CV_16U);
    decoded.notes = std::move(image.notes);
    if (image.mosaic && !bayer) decoded.notes.push_back(mosaicNote(""));
    decoded.sha256 = sha256Text(bytes);
  }
  if (bayer) demosaic(file, *bayer, decoded.pixels);
  return decoded;
}

/// One value a pixel: gray as it is, colour (blue, green, red) as luma, alpha dropped.
std::vector<std::uint16_t> grayValues(const cv::Mat& image) {
  const int channels = image.channels();
  std::vector<std::uint16_t> values(image.total());
  const auto* pixel = image.ptr<std::uint16_t>();
  for (std::uint16_t& value : values) {
    value = channels < 3 ? pixel[0] : luma(pixel[2], pixel[1], pixel[0]);
    pixel += channels;
  }
  return values;
}

/// The colour of an image that has any, in OpenCV's order. A sample beyond the table gets the
/// table's last value; luma that is too large is rejected before.
std::vector<std::uint8_t> colorOf(const cv::Mat& image, const std::vector<std::uint8_t>& table) {
  const int channels = image.channels();
  std::vector<std::uint8_t> color;
  if (channels < ColorView::kChannels) return color;
  color.reserve(image.total() * ColorView::kChannels);
  const auto* pixel = image.ptr<std::uint16_t>();
  for (std::size_t i = 0; i < image.total(); ++i, pixel += channels)
    for (int c = 0; c < ColorView::kChannels; ++c)
      color.push_back(table[std::min<std::size_t>(pixel[c], table.size() - 1)]);
  return color;
}

/// The 8-bit value of every sample.
std::vector<std::uint8_t> sampleTable(const std::filesystem::path& file, int bit_depth,
                                      const ImageReadOptions& options) {
  const int count = 1 << bit_depth;
  if (!options.table.empty()) {
    if (std::ssize(options.table) != count)
      throw InputError(file, "table",
                       "has " + std::to_string(options.table.size()) + " entries, but " +
                           std::to_string(bit_depth) + " bits need " + std::to_string(count));
    return options.table;
  }
  const GrayLevels levels = options.levels.value_or(GrayLevels{0, count - 1});
  if (levels.black < 0 || levels.black >= levels.white || levels.white >= count)
    throw InputError(file, "levels",
                     "black " + std::to_string(levels.black) + " and white " +
                         std::to_string(levels.white) + " are not 0 <= black < white < " +
                         std::to_string(count));
  return tableOfLevels(levels, bit_depth);
}

std::string depthText(const GrayImage& gray) {
  if (gray.bit_depth_stated) return "stated";
  if (!gray.label || !gray.bit_depth_of_label) return "that of the file";
  if (gray.label->bit_depth && *gray.label->bit_depth == gray.bit_depth) return "that of the label";
  return gray.bit_depth == 16 ? "that of q" : "the least that holds all samples";
}

std::string ruleText(const GrayImage& gray, const ImageReadOptions& options) {
  std::string text;
  if (options.bayer)
    text += std::string("mosaic ") + kBayerPatternNames[static_cast<std::size_t>(*options.bayer)] +
            " interpolated edge-aware; ";
  if (gray.channels == 2 || gray.channels == 4) text += "alpha dropped; ";
  if (gray.channels >= 3) text += "luma (9798 R + 19235 G + 3735 B + 16384) >> 15; ";
  if (options.levels)
    return text + "linear from " + std::to_string(options.levels->black) + " (0) to " +
           std::to_string(options.levels->white) + " (255), " + std::to_string(gray.bit_depth) +
           " bits";
  if (!options.table.empty())
    return text + "by a given table of " + std::to_string(1 << gray.bit_depth) + " values";
  if (gray.bit_depth == 8) return text + "8-bit values as they are";
  return text + "floor(v * 255 / (2^" + std::to_string(gray.bit_depth) +
         " - 1) + 0.5), bit depth " + depthText(gray);
}

/// Fills in what follows from the samples: size, 8-bit pixels, colour and the end of the rule.
void setPixels(const cv::Mat& image, const ImageReadOptions& options, GrayImage& gray) {
  gray.width = image.cols;
  gray.height = image.rows;
  const std::vector<std::uint8_t> table = sampleTable(gray.file, gray.bit_depth, options);
  gray.pixels.reserve(image.total());
  for (const std::uint16_t value : grayValues(image)) {
    const int at = static_cast<int>(gray.pixels.size());
    if (value >= table.size())
      throw InputError(gray.file, "bit_depth",
                       "pixel (" + std::to_string(at % gray.width) + ", " +
                           std::to_string(at / gray.width) + ") is " + std::to_string(value) +
                           ", more than " + std::to_string(gray.bit_depth) + " bits");
    gray.pixels.push_back(table[value]);
  }
  gray.color = colorOf(image, table);
  gray.rule += ruleText(gray, options);
  gray.pixels_sha256 = sha256Text(gray.pixels);
  if (!gray.color.empty()) gray.color_sha256 = sha256Text(gray.color);
}

/// Depth of the label, of its file where it states none, or, where a sample is beyond the label's,
/// the least that holds them all: an image is not rejected because of an inaccurate label.
void chooseDepth(const LabelSamples& labelled, const ImageReadOptions& options, GrayImage& gray) {
  const int stated = labelled.quantized ? 0 : labelled.label->bit_depth.value_or(0);
  gray.bit_depth_of_label = labelled.quantized;
  if (options.bit_depth || options.levels || stated == 0) return;
  if (!options.table.empty() && options.table.size() != std::size_t{1} << stated) return;
  gray.bit_depth = stated;
  gray.bit_depth_of_label = true;
  if (labelled.highest < 1 << stated) return;
  while (labelled.highest >= 1 << gray.bit_depth) ++gray.bit_depth;
  gray.notes.push_back("the label says that " + std::to_string(stated) +
                       " bits are used, but a sample is " + std::to_string(labelled.highest) +
                       ": read as " + std::to_string(gray.bit_depth) + " bits");
}

void takeLabel(const LabelSamples& labelled, const ImageReadOptions& options, GrayImage& gray) {
  gray.channels = labelled.bands;
  gray.label = labelled.label;
  if (!labelled.rule.empty()) gray.rule = labelled.rule + "; ";
  const std::string& mosaic = labelled.label->bayer_pattern;
  if (!mosaic.empty() && !options.bayer) gray.notes.push_back(mosaicNote(mosaic));
  if (labelled.quantized && options.bit_depth && *options.bit_depth != 16)
    throw InputError(gray.file, "bit_depth",
                     std::to_string(*options.bit_depth) +
                         " bits stated, but its samples are not whole numbers from 0 on and "
                         "become 16 bits");
  chooseDepth(labelled, options, gray);
}

}  // namespace

std::vector<std::uint8_t> tableOfLevels(const GrayLevels& levels, int n) {
  std::vector<std::uint8_t> table(std::size_t{1} << n);
  const std::int64_t span = levels.white - levels.black;
  for (std::size_t v = 0; v < table.size(); ++v) {
    const std::int64_t above =
        std::clamp(static_cast<std::int64_t>(v) - levels.black, std::int64_t{0}, span);
    table[v] = static_cast<std::uint8_t>((2 * above * 255 + span) / (2 * span));
  }
  return table;
}

std::optional<BayerPattern> bayerPatternNamed(std::string_view name) {
  const auto found = std::find(std::begin(kBayerPatternNames), std::end(kBayerPatternNames), name);
  if (found == std::end(kBayerPatternNames)) return std::nullopt;
  return static_cast<BayerPattern>(found - std::begin(kBayerPatternNames));
}

ImageSamples readSamples(const std::filesystem::path& file,
                         const std::optional<BayerPattern>& bayer) {
  const FileSamples decoded = decode(file, bayer);
  ImageSamples samples;
  samples.width = decoded.pixels.cols;
  samples.height = decoded.pixels.rows;
  samples.sample_bits = decoded.sample_bits;
  samples.values = grayValues(decoded.pixels);
  samples.file_sha256 = decoded.sha256;
  if (decoded.labelled) {
    samples.offset = decoded.labelled->offset;
    samples.scale = decoded.labelled->scale;
  }
  return samples;
}

GrayImage readImage(const std::filesystem::path& file, const ImageReadOptions& options) {
  if (options.bit_depth && (*options.bit_depth < 1 || *options.bit_depth > 16))
    throw InputError(file, "bit_depth", std::to_string(*options.bit_depth) + " is outside 1 .. 16");
  if (options.levels && !options.table.empty())
    throw InputError(file, "levels", "cannot be combined with a table");
  const FileSamples decoded = decode(file, options.bayer);
  GrayImage gray;
  gray.file = file;
  gray.container = decoded.container;
  gray.notes = decoded.notes;
  gray.file_sha256 = decoded.sha256;
  gray.sample_bits = decoded.sample_bits;
  gray.bit_depth = options.bit_depth.value_or(gray.sample_bits);
  gray.bit_depth_stated = options.bit_depth.has_value();
  if (decoded.labelled) takeLabel(*decoded.labelled, options, gray);
  if (!decoded.labelled || options.bayer) gray.channels = decoded.pixels.channels();
  if (gray.bit_depth > gray.sample_bits)
    throw InputError(file, "bit_depth",
                     std::to_string(gray.bit_depth) + " bits stated, but the file holds " +
                         std::to_string(gray.sample_bits));
  setPixels(decoded.pixels, options, gray);
  return gray;
}

GrayImage grayImageOf(const std::filesystem::path& file, const cv::Mat& pixels) {
  requireImageSize(file, pixels.cols, pixels.rows);
  cv::Mat image;
  pixels.convertTo(image, CV_16U);
  GrayImage gray;
  gray.file = file;
  gray.channels = image.channels();
  setPixels(image, {}, gray);
  const auto& color = gray.color;
  bool same = true;
  for (std::size_t i = 0; i < color.size() && same; i += ColorView::kChannels)
    same = color[i] == color[i + 1] && color[i] == color[i + 2];
  if (!same) return gray;
  gray.color.clear();
  gray.color_sha256.clear();
  return gray;
}

void requireSameSize(const GrayImage& image, const Camera& camera) {
  if (image.width != camera.width || image.height != camera.height)
    throw InputError(image.file, "image size",
                     "is " + sizeText(image.width, image.height) + ", but the camera is " +
                         sizeText(camera.width, camera.height));
}

BitImage IgnoreMask::view() const {
  const std::span all(const_cast<std::uint64_t*>(words.data()), words.size());
  return {all, width, height, BitImage::wordsPerRow(width)};
}

IgnoreMask emptyMask(int width, int height) {
  IgnoreMask mask;
  mask.width = width;
  mask.height = height;
  mask.words.assign(
      static_cast<std::size_t>(BitImage::wordsPerRow(width)) * static_cast<std::size_t>(height), 0);
  return mask;
}

IgnoreMask readIgnoreMask(const std::filesystem::path& file, int width, int height) {
  const std::vector<std::uint8_t> bytes = readFileBytes(file, kMaxImageFileBytes);
  if (const auto format = labelFormatOf(bytes))
    throw InputError(file,
                     std::string("a mask must be PNG or TIFF, not ") + labelFormatName(*format));
  const ImageHeader header = readImageHeader(file, bytes);
  if (header.container == "JPEG")
    throw InputError(file, "a mask must be lossless: PNG or TIFF, not JPEG");
  if (header.width != width || header.height != height)
    throw InputError(file, "mask size",
                     "is " + sizeText(header.width, header.height) + ", but the image is " +
                         sizeText(width, height));
  cv::Mat image;
  decodeImage(file, bytes).pixels.convertTo(image, CV_16U);

  IgnoreMask mask = emptyMask(width, height);
  mask.file = file;
  mask.file_sha256 = sha256Text(bytes);
  BitImage bits = mask.view();
  const int channels = image.channels();
  const int judged = channels == 2 || channels == 4 ? channels - 1 : channels;
  const auto* pixel = image.ptr<std::uint16_t>();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, pixel += channels) {
      if (std::all_of(pixel, pixel + judged, [](std::uint16_t v) { return v == 0; })) continue;
      bits.set(x, y);
      ++mask.ignored_count;
    }
  return mask;
}

void writePng(const std::filesystem::path& file, std::span<const std::uint8_t> pixels, int width,
              int height, int channels) {
  if (width < 1 || height < 1 || (channels != 1 && channels != 3) ||
      pixels.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                           static_cast<std::size_t>(channels))
    throw std::logic_error("writePng: the pixels do not fit the size");
  const cv::Mat image(height, width, CV_MAKETYPE(CV_8U, channels),
                      const_cast<std::uint8_t*>(pixels.data()));
  std::vector<std::uint8_t> bytes;
  try {
    if (!cv::imencode(".png", image, bytes)) throw OutputError(file, "PNG encoding failed");
  } catch (const cv::Exception& error) {
    throw OutputError(file, "PNG encoding failed: " + error.err);
  }
  writeFileAtomically(file, bytes);
}

}  // namespace boresight::sessions
