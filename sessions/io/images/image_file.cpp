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

namespace boresight::sessions {
namespace {

std::string sizeText(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

/// The samples of an image file before they become 8 bits.
struct FileSamples {
  std::optional<LabelSamples> labelled;  ///< of an image with a label; holds what `pixels` shows
  ImageContainer container = ImageContainer::kPng;  ///< of other images
  cv::Mat pixels;                                   ///< 16 bits a channel
  int sample_bits = 8;                              ///< of the file: 8 or 16
  std::vector<std::string> notes;
  std::string sha256;
};

FileSamples decode(const std::filesystem::path& file) {
  std::vector<std::uint8_t> bytes = readFileBytes(file, kMaxImageFileBytes);
  FileSamples decoded;
  if (labelFormatOf(bytes)) {
    decoded.labelled = readLabelSamples(readLabelFiles(file, std::move(bytes)));
  } else if (const auto label_file = labelFileOf(file)) {
    decoded.labelled = readLabelSamples(readLabelFiles(*label_file));
  } else {
    DecodedImage image = decodeImage(file, bytes);
    decoded.container = image.header.container;
    decoded.sample_bits = image.pixels.depth() == CV_16U ? 16 : 8;
    image.pixels.convertTo(decoded.pixels, CV_16U);
    decoded.notes = std::move(image.notes);
    decoded.sha256 = sha256Text(bytes);
    return decoded;
  }
  LabelSamples& labelled = *decoded.labelled;
  decoded.pixels = cv::Mat(labelled.height, labelled.width, CV_16U, labelled.values.data());
  decoded.sample_bits = labelled.sample_bits;
  decoded.sha256 = labelled.sha256;
  return decoded;
}

/// OpenCV names a pattern by its second line.
int demosaicCode(BayerPattern pattern) {
  switch (pattern) {
    case BayerPattern::kRggb:
      return cv::COLOR_BayerBG2BGR_EA;
    case BayerPattern::kBggr:
      return cv::COLOR_BayerRG2BGR_EA;
    case BayerPattern::kGrbg:
      return cv::COLOR_BayerGB2BGR_EA;
    case BayerPattern::kGbrg:
      break;
  }
  return cv::COLOR_BayerGR2BGR_EA;
}

constexpr int kSmallestMosaic_px = 4;  // a pixel is interpolated from the two lines round it

void demosaic(const std::filesystem::path& file, BayerPattern pattern, cv::Mat& pixels) {
  if (pixels.channels() != 1)
    throw InputError(
        file, "bayer",
        "the image has " + std::to_string(pixels.channels()) + " channels; a mosaic has one");
  if (pixels.cols < kSmallestMosaic_px || pixels.rows < kSmallestMosaic_px)
    throw InputError(file, "bayer", sizeText(pixels.cols, pixels.rows) + " px are too few");
  cv::Mat color;
  cv::cvtColor(pixels, color, demosaicCode(pattern));
  pixels = color;
}

std::uint32_t grayValue(const std::uint16_t* pixel, int channels) {
  if (channels < 3) return pixel[0];
  // OpenCV's integer luma; its order is blue, green, red.
  return (3735u * pixel[0] + 19235u * pixel[1] + 9798u * pixel[2] + 16384u) >> 15;
}

void convert(const std::filesystem::path& file, const cv::Mat& image,
             const std::vector<std::uint8_t>& table, GrayImage& gray) {
  const std::uint32_t largest = (1u << gray.bit_depth) - 1u;
  const int channels = image.channels();
  std::uint8_t* out = gray.pixels.data();
  for (int y = 0; y < image.rows; ++y) {
    const auto* pixel = image.ptr<std::uint16_t>(y);
    for (int x = 0; x < image.cols; ++x, pixel += channels) {
      const std::uint32_t v = grayValue(pixel, channels);
      if (v > largest)
        throw InputError(file, "bit_depth",
                         "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") is " +
                             std::to_string(v) + ", more than " + std::to_string(gray.bit_depth) +
                             " bits");
      *out++ = table[v];
    }
  }
}

/// The colour of an image that has any, in OpenCV's order. Samples beyond the table are not there:
/// convert() rejects a gray value of more bits, and the largest colour is taken for others.
std::vector<std::uint8_t> colorOf(const cv::Mat& image, const std::vector<std::uint8_t>& table) {
  const int channels = image.channels();
  std::vector<std::uint8_t> color;
  if (channels < ColorView::kChannels) return color;
  color.resize(image.total() * ColorView::kChannels);
  std::uint8_t* to = color.data();
  const std::size_t last = table.size() - 1;
  for (int y = 0; y < image.rows; ++y) {
    const auto* pixel = image.ptr<std::uint16_t>(y);
    for (int x = 0; x < image.cols; ++x, pixel += channels)
      for (int c = 0; c < ColorView::kChannels; ++c)
        *to++ = table[std::min<std::size_t>(pixel[c], last)];
  }
  return color;
}

/// Whether all channels are equal.
bool isGray(const cv::Mat& pixels) {
  if (pixels.channels() < ColorView::kChannels) return true;
  std::vector<cv::Mat> channels;
  cv::split(pixels, channels);
  return cv::norm(channels[0], channels[1], cv::NORM_INF) == 0.0 &&
         cv::norm(channels[0], channels[2], cv::NORM_INF) == 0.0;
}

/// The 8-bit value of every sample.
std::vector<std::uint8_t> sampleTable(const std::filesystem::path& file, int bit_depth,
                                      const ImageReadOptions& options) {
  const std::size_t count = std::size_t{1} << bit_depth;
  if (!options.table.empty()) {
    if (options.table.size() != count)
      throw InputError(file, "table",
                       "has " + std::to_string(options.table.size()) + " entries, but " +
                           std::to_string(bit_depth) + " bits need " + std::to_string(count));
    return options.table;
  }
  if (options.levels) {
    if (options.levels->black < 0 || options.levels->black >= options.levels->white ||
        options.levels->white >= static_cast<int>(count))
      throw InputError(file, "levels",
                       "black " + std::to_string(options.levels->black) + " and white " +
                           std::to_string(options.levels->white) +
                           " are not 0 <= black < white < " + std::to_string(count));
    return tableOfLevels(*options.levels, bit_depth);
  }
  std::vector<std::uint8_t> table(count);
  for (std::size_t v = 0; v < count; ++v)
    table[v] = toEightBit(static_cast<std::uint32_t>(v), bit_depth);
  return table;
}

void requireDepth(const std::filesystem::path& file, const GrayImage& gray) {
  if (gray.bit_depth > gray.sample_bits)
    throw InputError(file, "bit_depth",
                     std::to_string(gray.bit_depth) + " bits stated, but the file holds " +
                         std::to_string(gray.sample_bits));
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

/// Bits that the label states for samples that stay as they are; 0: none.
int statedBits(const LabelSamples& labelled) {
  return labelled.quantized ? 0 : labelled.label->bit_depth.value_or(0);
}

/// Depth of the label, of its file where it states none, or, where a sample is beyond the label's,
/// the least that holds them all: an image is not rejected because of an inaccurate label.
void chooseDepth(const LabelSamples& labelled, const ImageReadOptions& options, GrayImage& gray) {
  const int stated = statedBits(labelled);
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
  gray.container = labelled.container;
  gray.channels = labelled.bands;
  gray.label = labelled.label;
  gray.notes = labelled.label->flags;
  const std::string& mosaic = labelled.label->bayer_pattern;
  if (!mosaic.empty() && !options.bayer)
    gray.notes.push_back("the pixels are a mosaic of colours (" + mosaic +
                         "): state its pattern with --bayer, or convert it before matching");
  if (labelled.quantized && options.bit_depth && *options.bit_depth != 16)
    throw InputError(gray.file, "bit_depth",
                     std::to_string(*options.bit_depth) +
                         " bits stated, but its samples are not whole numbers from 0 on and "
                         "become 16 bits");
  chooseDepth(labelled, options, gray);
}

}  // namespace

std::uint8_t toEightBit(std::uint32_t v, int n) {
  const std::uint32_t largest = (1u << n) - 1u;
  return static_cast<std::uint8_t>((2u * v * 255u + largest) / (2u * largest));
}

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
  FileSamples decoded = decode(file);
  if (bayer) demosaic(file, *bayer, decoded.pixels);
  const cv::Mat& image = decoded.pixels;
  ImageSamples samples;
  samples.width = image.cols;
  samples.height = image.rows;
  samples.sample_bits = decoded.sample_bits;
  samples.file_sha256 = decoded.sha256;
  if (decoded.labelled) {
    samples.offset = decoded.labelled->offset;
    samples.scale = decoded.labelled->scale;
  }
  samples.values.reserve(image.total());
  const int channels = image.channels();
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      samples.values.push_back(static_cast<std::uint16_t>(
          grayValue(image.ptr<std::uint16_t>(y) + x * channels, channels)));
  return samples;
}

GrayImage readImage(const std::filesystem::path& file, const ImageReadOptions& options) {
  if (options.bit_depth && (*options.bit_depth < 1 || *options.bit_depth > 16))
    throw InputError(file, "bit_depth", std::to_string(*options.bit_depth) + " is outside 1 .. 16");
  if (options.levels && !options.table.empty())
    throw InputError(file, "levels", "cannot be combined with a table");
  FileSamples decoded = decode(file);
  if (options.bayer) demosaic(file, *options.bayer, decoded.pixels);
  const cv::Mat& image = decoded.pixels;
  GrayImage gray;
  gray.file = file;
  gray.width = image.cols;
  gray.height = image.rows;
  gray.file_sha256 = decoded.sha256;
  gray.sample_bits = decoded.sample_bits;
  gray.bit_depth = options.bit_depth.value_or(gray.sample_bits);
  gray.bit_depth_stated = options.bit_depth.has_value();
  if (decoded.labelled) {
    takeLabel(*decoded.labelled, options, gray);
    if (!decoded.labelled->rule.empty()) gray.rule = decoded.labelled->rule + "; ";
  } else {
    gray.container = imageContainerName(decoded.container);
    gray.notes = decoded.notes;
  }
  if (!decoded.labelled || options.bayer) gray.channels = image.channels();
  requireDepth(file, gray);
  gray.pixels.resize(image.total());
  const std::vector<std::uint8_t> table = sampleTable(file, gray.bit_depth, options);
  convert(file, image, table, gray);
  gray.color = colorOf(image, table);
  gray.rule += ruleText(gray, options);
  gray.pixels_sha256 = sha256Text(gray.pixels);
  return gray;
}

GrayImage grayImageOf(const std::filesystem::path& file, const cv::Mat& pixels) {
  requireImageSize(file, pixels.cols, pixels.rows);
  cv::Mat image;
  pixels.convertTo(image, CV_16U);
  GrayImage gray;
  gray.file = file;
  gray.width = image.cols;
  gray.height = image.rows;
  gray.channels = image.channels();
  gray.pixels.resize(image.total());
  const std::vector<std::uint8_t> table = sampleTable(file, gray.bit_depth, {});
  convert(file, image, table, gray);
  if (!isGray(pixels)) gray.color = colorOf(image, table);
  gray.rule = ruleText(gray, {});
  gray.pixels_sha256 = sha256Text(gray.pixels);
  return gray;
}

void requireSameSize(const GrayImage& image, const Camera& camera) {
  if (image.width != camera.width || image.height != camera.height)
    throw InputError(image.file, "image size",
                     "is " + sizeText(image.width, image.height) + ", but the camera is " +
                         sizeText(camera.width, camera.height));
}

BitImage IgnoreMask::view() const {
  BitImage image;
  image.width = width;
  image.height = height;
  image.words_per_row = BitImage::wordsPerRow(width);
  image.words = {const_cast<std::uint64_t*>(words.data()), words.size()};
  return image;
}

IgnoreMask readIgnoreMask(const std::filesystem::path& file, int width, int height) {
  const std::vector<std::uint8_t> bytes = readFileBytes(file, kMaxImageFileBytes);
  if (const auto format = labelFormatOf(bytes))
    throw InputError(file,
                     std::string("a mask must be PNG or TIFF, not ") + labelFormatName(*format));
  const ImageHeader header = readImageHeader(file, bytes);
  if (header.container == ImageContainer::kJpeg)
    throw InputError(file, "a mask must be lossless: PNG or TIFF, not JPEG");
  if (header.width != width || header.height != height)
    throw InputError(file, "mask size",
                     "is " + sizeText(header.width, header.height) + ", but the image is " +
                         sizeText(width, height));
  cv::Mat image;
  decodeImage(file, bytes).pixels.convertTo(image, CV_16U);

  IgnoreMask mask;
  mask.file = file;
  mask.width = width;
  mask.height = height;
  const int words_per_row = BitImage::wordsPerRow(width);
  mask.words.assign(static_cast<std::size_t>(words_per_row) * static_cast<std::size_t>(height), 0);
  mask.file_sha256 = sha256Text(bytes);
  const int channels = image.channels();
  const int judged = channels == 2 || channels == 4 ? channels - 1 : channels;
  for (int y = 0; y < height; ++y) {
    const auto* pixel = image.ptr<std::uint16_t>(y);
    std::uint64_t* row = mask.words.data() + static_cast<std::ptrdiff_t>(words_per_row) * y;
    for (int x = 0; x < width; ++x, pixel += channels) {
      if (std::all_of(pixel, pixel + judged, [](std::uint16_t v) { return v == 0; })) continue;
      row[x >> 6] |= std::uint64_t{1} << (x & 63);
      ++mask.ignored_count;
    }
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
