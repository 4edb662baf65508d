// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/image_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "sessions/io/files/errors.h"
#include "tests/sessions/io/folder_test.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using Bytes = std::vector<std::uint8_t>;

cv::Mat randomImage(int type, int width = 67, int height = 41) {
  Random random(static_cast<std::uint64_t>(type) + 1);
  cv::Mat image(height, width, type);
  std::generate_n(image.ptr(), image.total() * image.elemSize(),
                  [&random] { return static_cast<std::uint8_t>(random.below(256)); });
  return image;
}

Bytes encoded(const cv::Mat& image, const std::string& extension) {
  Bytes bytes;
  EXPECT_TRUE(cv::imencode(extension, image, bytes));
  return bytes;
}

/// The rule in doubles.
std::uint8_t byRule(double v, int n) {
  return static_cast<std::uint8_t>(std::floor(v * 255.0 / (std::pow(2.0, n) - 1.0) + 0.5));
}

/// The rule of a matrix' values, row by row.
Bytes byRule(const cv::Mat& source, int n) {
  cv::Mat values;
  source.convertTo(values, CV_16U);
  Bytes bytes;
  for (std::size_t i = 0; i < values.total() * static_cast<std::size_t>(values.channels()); ++i)
    bytes.push_back(byRule(values.ptr<std::uint16_t>()[i], n));
  return bytes;
}

/// Random samples of 12 bits.
cv::Mat twelveBits() {
  cv::Mat image = randomImage(CV_16UC1);
  cv::bitwise_and(image, cv::Scalar(0x0fff), image);
  return image;
}

class ReadImage : public FolderTest {
 protected:
  GrayImage read(const Bytes& bytes, const ImageReadOptions& options = {}) {
    return readImage(folder_.write("image", bytes), options);
  }
  std::string error(const Bytes& bytes, const ImageReadOptions& options = {}) {
    return folder_.message([&] { (void)read(bytes, options); });
  }
};

TEST(TableOfLevels, OfTheWholeRangeIsTheRuleForEveryValueAndDepth) {
  for (int n = 1; n <= 16; ++n) {
    const std::vector<std::uint8_t> table = tableOfLevels({0, (1 << n) - 1}, n);
    for (std::uint32_t v = 0; v < (1u << n); ++v)
      ASSERT_EQ(table[v], byRule(v, n)) << "v " << v << " n " << n;
  }
}

/// Against the luma of OpenCV.
TEST_F(ReadImage, PixelsOfEveryKind_BecomeGrayByTheRuleAndKeepTheirColoursAndSamples) {
  const std::string luma = "luma (9798 R + 19235 G + 3735 B + 16384) >> 15; ";
  const std::string eight = "8-bit values as they are";
  const std::string sixteen = "floor(v * 255 / (2^16 - 1) + 0.5), bit depth that of the file";
  for (const auto& [type, rule] : {std::pair(CV_8UC1, eight),
                                   {CV_16UC1, sixteen},
                                   {CV_8UC3, luma + eight},
                                   {CV_16UC3, luma + sixteen},
                                   {CV_8UC4, "alpha dropped; " + luma + eight},
                                   {CV_16UC4, "alpha dropped; " + luma + sixteen}})
    for (const char* extension : {".png", ".tiff"}) {
      const cv::Mat source = randomImage(type);
      if (source.channels() == 4 && extension[1] == 't') continue;
      SCOPED_TRACE(rule + extension);
      cv::Mat color, gray = source;
      if (source.channels() == 3) color = source;
      if (source.channels() == 4) cv::cvtColor(source, color, cv::COLOR_BGRA2BGR);
      if (!color.empty()) cv::cvtColor(color, gray, cv::COLOR_BGR2GRAY);
      const Bytes bytes = encoded(source, extension);
      const GrayImage image = read(bytes);
      const int depth = source.depth() == CV_8U ? 8 : 16;
      EXPECT_EQ(cv::Size(image.width, image.height), source.size());
      EXPECT_EQ(image.pixels, byRule(gray, depth));
      EXPECT_EQ(image.color, byRule(color, depth));
      EXPECT_EQ(image.colorView().data, color.empty() ? nullptr : image.color.data());
      EXPECT_EQ(image.colorView().stride, color.empty() ? 0 : 3 * source.cols);
      EXPECT_EQ(image.rule, rule);
      EXPECT_EQ(
          std::tie(image.channels, image.sample_bits, image.bit_depth, image.bit_depth_stated),
          std::tuple(source.channels(), depth, depth, false));
      EXPECT_EQ(image.file_sha256, sha256Text(bytes));
      EXPECT_EQ(image.pixels_sha256, sha256Text(image.pixels));
      const ImageSamples samples = readSamples(folder_ / "image");
      EXPECT_EQ(samples.sample_bits, depth);
      EXPECT_EQ(samples.file_sha256, image.file_sha256);
      ASSERT_EQ(samples.values.size(), image.pixels.size());
      for (std::size_t i = 0; i < image.pixels.size(); ++i)
        ASSERT_EQ(byRule(samples.values[i], depth), image.pixels[i]);
    }
  const cv::Mat twelve = twelveBits();
  const GrayImage stated = read(encoded(twelve, ".png"), {12});
  EXPECT_TRUE(stated.bit_depth_stated);
  EXPECT_EQ(stated.rule, "floor(v * 255 / (2^12 - 1) + 0.5), bit depth stated");
  EXPECT_EQ(stated.pixels, byRule(twelve, 12));
}

TEST_F(ReadImage, ReadsJpegAsOpenCvDoes) {
  const Bytes bytes = encoded(randomImage(CV_8UC1), ".jpg");
  const GrayImage image = read(bytes);
  EXPECT_EQ(image.container, "JPEG");
  EXPECT_EQ(image.pixels, byRule(cv::imdecode(bytes, cv::IMREAD_GRAYSCALE), 8));
}

TEST_F(ReadImage, ScalesBetweenLevels) {
  const cv::Mat source = twelveBits();
  const Bytes bytes = encoded(source, ".png");
  ImageReadOptions options{12, {}, GrayLevels{300, 1500}};
  const GrayImage image = read(bytes, options);
  EXPECT_EQ(image.rule, "linear from 300 (0) to 1500 (255), 12 bits");
  for (int y = 0; y < source.rows; ++y)
    for (int x = 0; x < source.cols; ++x) {
      const double v = std::clamp<double>(source.at<std::uint16_t>(y, x), 300.0, 1500.0);
      ASSERT_EQ(image.view().at(x, y), std::floor((v - 300.0) * 255.0 / 1200.0 + 0.5));
    }
  for (const GrayLevels wrong : {GrayLevels{5, 5}, GrayLevels{-1, 5}, GrayLevels{0, 4096}}) {
    options.levels = wrong;
    EXPECT_THAT(error(bytes, options), HasSubstr("black < white"));
  }
  options.levels = GrayLevels{0, 4095};
  EXPECT_EQ(read(bytes, options).pixels, read(bytes, {12}).pixels);
  options.table.resize(4096);
  EXPECT_THAT(error(bytes, options), HasSubstr("cannot be combined"));
}

/// Smooth colours, blue, green and red, of 12 bits.
cv::Mat smoothColors() {
  cv::Mat image(40, 60, CV_32SC3);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      image.at<cv::Vec3i>(y, x) = {300 + 20 * x, 3800 - 30 * y, 1000 + 15 * x + 40 * y};
  image.convertTo(image, CV_16U);
  return image;
}

/// What a sensor below such a mosaic sees; the letters are the colours of a 2 x 2 block.
cv::Mat mosaicOf(const cv::Mat& colors, const std::string& block) {
  cv::Mat mosaic(colors.size(), CV_16UC1);
  for (int y = 0; y < colors.rows; ++y)
    for (int x = 0; x < colors.cols; ++x) {
      const char letter = block[static_cast<std::size_t>(2 * (y % 2) + x % 2)];
      const int channel = letter == 'b' ? 0 : letter == 'g' ? 1 : 2;
      mosaic.at<std::uint16_t>(y, x) = colors.at<cv::Vec3w>(y, x)[channel];
    }
  return mosaic;
}

/// Largest difference of the gray values from those of the colours, but for a border.
int farthestFrom(const cv::Mat& colors, const GrayImage& gray) {
  cv::Mat luma;
  cv::cvtColor(colors, luma, cv::COLOR_BGR2GRAY);
  int most = 0;
  for (int y = 2; y < luma.rows - 2; ++y)
    for (int x = 2; x < luma.cols - 2; ++x)
      most =
          std::max(most, std::abs(gray.view().at(x, y) - byRule(luma.at<std::uint16_t>(y, x), 12)));
  return most;
}

TEST_F(ReadImage, ColoursOfAMosaicAreInterpolatedByItsPatternAlone) {
  const cv::Mat colors = smoothColors();
  for (std::size_t made = 0; made < std::size(kBayerPatternNames); ++made) {
    const Bytes file = encoded(mosaicOf(colors, kBayerPatternNames[made]), ".png");
    for (std::size_t stated = 0; stated < std::size(kBayerPatternNames); ++stated) {
      const GrayImage gray = read(file, {12, {}, {}, static_cast<BayerPattern>(stated)});
      const int off = farthestFrom(colors, gray);
      EXPECT_EQ(off <= 1, made == stated)
          << kBayerPatternNames[made] << " as " << kBayerPatternNames[stated] << ": " << off;
      EXPECT_EQ(gray.channels, 3);
      EXPECT_THAT(gray.rule, HasSubstr(kBayerPatternNames[stated]));
    }
  }
  // Colours and tiny images are no mosaics.
  const ImageReadOptions options{{}, {}, {}, bayerPatternNamed("grbg")};
  ASSERT_EQ(options.bayer, BayerPattern::kGrbg);
  EXPECT_FALSE(bayerPatternNamed("rgb"));
  EXPECT_THAT(error(encoded(randomImage(CV_8UC3), ".png"), options), HasSubstr("a mosaic has one"));
  EXPECT_THAT(error(encoded(randomImage(CV_8UC1, 3, 9), ".png"), options), HasSubstr("too few"));
}

TEST_F(ReadImage, RefusesABitDepthThatThePixelsContradict) {
  cv::Mat source(3, 4, CV_16UC1, cv::Scalar(0));
  source.at<std::uint16_t>(2, 1) = 4096;
  EXPECT_EQ(error(encoded(source, ".png"), {12}),
            "image: bit_depth: pixel (1, 2) is 4096, more than 12 bits");
  EXPECT_EQ(error(encoded(source, ".png"), {17}), "image: bit_depth: 17 is outside 1 .. 16");
  EXPECT_EQ(error(encoded(randomImage(CV_8UC1), ".png"), {12}),
            "image: bit_depth: 12 bits stated, but the file holds 8");
}

TEST_F(ReadImage, RefusesWhatIsNotAnImage) {
  EXPECT_EQ(folder_.message([&] { (void)readImage(folder_ / "none.png"); }),
            "none.png: no such file");
  EXPECT_EQ(error({}), "image: the file is empty");
  const std::string text = "{\"format\": \"boresight-pose\"}";
  const std::string none =
      "image: not a PNG, JPEG or TIFF image, nor one with a VICAR, PDS3 or PDS4 label "
      "in it or next to it";
  EXPECT_EQ(error(Bytes(text.begin(), text.end())), none);
  EXPECT_EQ(error(encoded(randomImage(CV_8UC1), ".bmp")), none);
}

void append(Bytes& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void appendChunk(Bytes& file, const std::string& type, const Bytes& data) {
  append(file, static_cast<std::uint32_t>(data.size()));
  Bytes checked(type.begin(), type.end());
  checked.insert(checked.end(), data.begin(), data.end());
  file.insert(file.end(), checked.begin(), checked.end());
  append(file, static_cast<std::uint32_t>(
                   crc32(0, checked.data(), static_cast<unsigned>(checked.size()))));
}

/// A PNG (ISO/IEC 15948) of 2 lines with the stated bytes; `palette` may be empty.
Bytes png(std::uint32_t width, int depth, int colour_type, const std::vector<Bytes>& lines,
          const Bytes& palette = {}) {
  Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  Bytes header;
  append(header, width);
  append(header, static_cast<std::uint32_t>(lines.size()));
  for (const int byte : {depth, colour_type, 0, 0, 0})
    header.push_back(static_cast<std::uint8_t>(byte));
  appendChunk(file, "IHDR", header);
  if (!palette.empty()) appendChunk(file, "PLTE", palette);
  Bytes raw;
  for (const Bytes& line : lines) {
    raw.push_back(0);  // no filter
    raw.insert(raw.end(), line.begin(), line.end());
  }
  uLongf size = compressBound(static_cast<uLong>(raw.size()));
  Bytes packed(size);
  EXPECT_EQ(compress(packed.data(), &size, raw.data(), static_cast<uLong>(raw.size())), Z_OK);
  packed.resize(size);
  appendChunk(file, "IDAT", packed);
  appendChunk(file, "IEND", {});
  return file;
}

/// Palettes, single bits, samples of 6 bits in 16 and alpha.
TEST_F(ReadImage, PngAsImageToolsWriteIt_IsRead) {
  const Bytes palette = {255, 0, 0, 0, 255, 0, 10, 10, 10, 200, 200, 200};
  const std::uint8_t red = 76;     // 0.299 * 255
  const std::uint8_t green = 150;  // 0.587 * 255
  EXPECT_EQ(read(png(4, 8, 3, {{0, 1, 2, 3}, {3, 2, 1, 0}}, palette)).pixels,
            (Bytes{red, green, 10, 200, 200, 10, green, red}));
  EXPECT_EQ(read(png(4, 1, 0, {{0b1010'0000}, {0b0110'0000}})).pixels,
            (Bytes{255, 0, 255, 0, 0, 255, 255, 0}));
  const Bytes six_bits = png(2, 16, 0, {{0, 0, 0, 63}, {0, 32, 0, 1}});
  EXPECT_EQ(read(six_bits).pixels, (Bytes{0, 0, 0, 0})) << "black without the depth";
  EXPECT_EQ(read(six_bits, {6}).pixels, (Bytes{0, 255, 130, 4}));
  EXPECT_EQ(read(png(2, 8, 4, {{7, 0, 9, 255}, {11, 128, 13, 1}})).pixels, (Bytes{7, 9, 11, 13}));
}

using Tag = std::array<std::uint32_t, 2>;

/// A little-endian TIFF of 2 x 1 pixels with one strip; `tags` replace or add to those of 8-bit
/// gray.
Bytes smallTiff(const Bytes& pixels, std::vector<Tag> tags) {
  const std::vector<Tag> gray = {{256, 2}, {257, 1}, {258, 8},
                                 {259, 1}, {262, 1}, {273, 8},
                                 {277, 1}, {278, 1}, {279, std::uint32_t(pixels.size())}};
  for (const Tag& tag : gray)
    if (std::none_of(tags.begin(), tags.end(), [&](const Tag& t) { return t[0] == tag[0]; }))
      tags.push_back(tag);
  std::sort(tags.begin(), tags.end());
  Bytes bytes = {'I', 'I', 42, 0};
  const auto append = [&bytes](std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  };
  append(static_cast<std::uint32_t>(8 + pixels.size()), 4);
  bytes.insert(bytes.end(), pixels.begin(), pixels.end());
  append(static_cast<std::uint32_t>(tags.size()), 2);
  for (const Tag& tag : tags) {
    append(tag[0], 2);
    append(4, 2);  // type LONG
    append(1, 4);
    append(tag[1], 4);
  }
  append(0, 4);
  return bytes;
}

TEST_F(ReadImage, KeepsTheValuesOfTiffOrRefusesThem) {
  EXPECT_EQ(read(smallTiff({10, 20}, {})).pixels, (Bytes{10, 20}));
  EXPECT_EQ(read(smallTiff({10, 20}, {{262, 0}})).pixels, (Bytes{245, 235})) << "0 is white";
  EXPECT_EQ(read(smallTiff({0xe8, 0x03, 0xff, 0xff}, {{258, 16}})).pixels, (Bytes{4, 255}));
  EXPECT_EQ(read(smallTiff({0x80}, {{258, 1}})).pixels, (Bytes{255, 0}));
  EXPECT_EQ(read(smallTiff({0, 0, 0, 128}, {{258, 16}, {262, 0}})).pixels, (Bytes{255, 127}));
  const Bytes colours = {10, 20, 30, 128, 40, 50, 60, 128};
  const GrayImage straight = read(smallTiff(colours, {{262, 2}, {277, 4}, {338, 2}}));
  EXPECT_EQ(straight.color, (Bytes{30, 20, 10, 60, 50, 40})) << "not multiplied by alpha";
  const std::string other =
      "image: samples are not unsigned integers of 8 or 16 bits: write the image as a TIFF or PNG "
      "of 16 bits, its range spread over 0 .. 65535";
  const Bytes four = {1, 2, 3, 4};
  EXPECT_EQ(error(smallTiff(four, {{258, 12}})), other);
  EXPECT_EQ(error(smallTiff(four, {{258, 16}, {339, 2}})), other);
  EXPECT_EQ(error(smallTiff(colours, {{258, 32}, {339, 3}})), other);
  EXPECT_THAT(error(smallTiff(colours, {{262, 5}, {277, 4}})),
              HasSubstr("colours other than gray and RGB"));
}

/// GDAL gives signed bytes as unsigned ones, and of a raw file of a camera its preview.
TEST_F(ReadImage, TiffWhoseBytesMeanSomethingElse_IsRefusedOrNoted) {
  EXPECT_THAT(error(smallTiff({10, 200}, {{339, 2}})),
              HasSubstr("samples are not unsigned integers of 8 or 16 bits"));
  EXPECT_EQ(read(smallTiff({10, 200}, {{339, 1}})).pixels, (Bytes{10, 200}));
  EXPECT_EQ(error(smallTiff({10, 20}, {{254, 1}})),
            "image: the TIFF image begins with a reduced preview, as raw files of cameras do: "
            "convert it to a TIFF or PNG of its pixels");
  EXPECT_EQ(read(smallTiff({10, 20}, {{254, 0}})).pixels, (Bytes{10, 20}));
  const GrayImage mosaic = read(smallTiff({10, 20}, {{262, 32803}}));
  EXPECT_EQ(mosaic.notes, std::vector<std::string>{
                              "the pixels are a mosaic of colours: state its pattern with --bayer, "
                              "or convert it before matching"});
}

TEST_F(ReadImage, PixelOutsideOfItsPalette_IsRefused) {
  EXPECT_EQ(error(png(2, 8, 3, {{0, 2}, {1, 1}}, {255, 0, 0, 0, 255, 0})),
            "image: the PNG image is damaged: its palette has 2 colours, but a pixel has number 2");
}

TEST_F(ReadImage, OrientationOfTiffIsReportedAndNotApplied) {
  const Bytes stored = {1, 2, 3, 4, 5, 6};
  Bytes wide;
  for (const std::uint8_t value : stored) wide.insert(wide.end(), {0, value});
  for (std::uint32_t orientation = 1; orientation <= 9; ++orientation) {
    const std::vector<Tag> tags = {{256, 3}, {257, 2}, {274, orientation}, {278, 2}};
    const GrayImage image = read(smallTiff(stored, tags));
    EXPECT_EQ(image.width, 3);
    EXPECT_EQ(image.pixels, stored) << orientation;
    std::vector<Tag> deep = tags;
    deep.push_back({258, 16});
    EXPECT_EQ(read(smallTiff(wide, deep)).pixels, stored) << orientation;
    std::vector<std::string> notes;
    if (orientation > 1 && orientation < 9)
      notes = {"EXIF orientation " + std::to_string(orientation) +
               " is not applied: pixels are used as they are stored"};
    EXPECT_EQ(image.notes, notes);
  }
}

/// A TIFF without an image that states an orientation, in the order of bytes of its sender.
Bytes exifBlock(std::uint8_t orientation) {
  return {'M', 'M', 0, 42, 0, 0, 0,           8, 0, 1, 0x01, 0x12, 0,
          3,   0,   0, 0,  1, 0, orientation, 0, 0, 0, 0,    0,    0};
}

/// `bytes` with the segment APP1 behind the two bytes that begin a JPEG.
Bytes withExif(Bytes bytes, const Bytes& exif) {
  Bytes segment = {0xff, 0xe1, 0, static_cast<std::uint8_t>(exif.size() + 8), 'E', 'x', 'i',
                   'f',  0,    0};
  segment.insert(segment.end(), exif.begin(), exif.end());
  bytes.insert(bytes.begin() + 2, segment.begin(), segment.end());
  return bytes;
}

TEST_F(ReadImage, OrientationOfJpegIsReportedAndNotApplied) {
  const Bytes plain = encoded(randomImage(CV_8UC1), ".jpg");
  const GrayImage expected = read(plain);
  const GrayImage turned = read(withExif(plain, exifBlock(6)));
  EXPECT_EQ(turned.width, expected.width);
  EXPECT_EQ(turned.pixels, expected.pixels);
  EXPECT_THAT(turned.notes,
              ElementsAre("EXIF orientation 6 is not applied: pixels are used as they are stored"));
  EXPECT_THAT(read(withExif(plain, exifBlock(1))).notes, IsEmpty());
  EXPECT_THAT(read(withExif(plain, {'M', 'M', 0, 42, 0, 0, 0, 99})).notes, IsEmpty());
}

/// Of other places in which programs state it.
TEST_F(ReadImage, OrientationOfBigTiffAndXmp_IsReported) {
  const cv::Mat pixels = randomImage(CV_8UC1);
  const auto with = [&](const std::string& text) {
    const Bytes block(text.begin(), text.end());
    return read(withExif(encoded(pixels, ".jpg"), block)).notes;
  };
  const auto six =
      ElementsAre("XMP orientation 6 is not applied: pixels are used as they are stored");
  EXPECT_THAT(with("<rdf tiff:Orientation=\"6\">"), six);
  EXPECT_THAT(with("<tiff:Orientation>6</tiff:Orientation>"), six);
  EXPECT_THAT(with("<rdf tiff:Orientation=\"1\">"), IsEmpty());
  Bytes text;
  const std::string profile = "Raw profile type exif";
  appendChunk(text, "tEXt", Bytes(profile.begin(), profile.end()));
  Bytes raw = encoded(pixels, ".png");
  raw.insert(raw.begin() + 33, text.begin(), text.end());  // behind IHDR
  EXPECT_THAT(read(raw).notes, ElementsAre(HasSubstr("in the file's raw EXIF profile is not")));
  // Little-endian: a directory at 16 with width, height, samples, orientation and one strip.
  Bytes tiff = {'I', 'I', 43, 0, 8, 0, 0, 0};
  const auto add = [&tiff](std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) tiff.push_back(static_cast<std::uint8_t>(value >> 8 * i));
  };
  const std::pair<int, int> tags[] = {{256, 2}, {257, 2}, {258, 8}, {259, 1}, {262, 1},
                                      {273, 0}, {274, 6}, {277, 1}, {278, 2}, {279, 4}};
  add(16, 8);
  add(std::size(tags), 8);
  const auto data = static_cast<int>(16 + 8 + 20 * std::size(tags) + 8);
  for (const auto& [tag, value] : tags) {
    add(static_cast<std::uint64_t>(tag), 2);
    add(3, 2);
    add(1, 8);
    add(static_cast<std::uint64_t>(tag == 273 ? data : value), 8);
  }
  add(0, 8);
  tiff.insert(tiff.end(), {1, 2, 3, 4});
  const GrayImage big = read(tiff);
  EXPECT_EQ(big.pixels, (Bytes{1, 2, 3, 4}));
  EXPECT_THAT(big.notes, ElementsAre("EXIF orientation 6 is not applied: pixels are used as they "
                                     "are stored"));
}

TEST_F(ReadImage, FurtherPagesOfTiffAreReported) {
  const cv::Mat first = randomImage(CV_8UC1);
  cv::imwritemulti((folder_ / "pages.tiff").string(), std::vector<cv::Mat>{first, first.t()});
  const GrayImage image = readImage(folder_ / "pages.tiff");
  EXPECT_EQ(image.pixels, byRule(first, 8));
  EXPECT_THAT(image.notes,
              ElementsAre("the file holds further images (pages): only the first is read"));
}

/// The decoder of a JPEG fills what it cannot read and goes on.
TEST_F(ReadImage, DamagedImagesAreReportedAndDecodersPrintNothing) {
  Bytes bytes = encoded(randomImage(CV_8UC1), ".jpg");
  const Bytes start_of_scan = {0xff, 0xda};
  const auto scan =
      std::search(bytes.begin(), bytes.end(), start_of_scan.begin(), start_of_scan.end());
  ASSERT_LT(scan - bytes.begin(), std::ssize(bytes) - 400);
  std::fill(scan + 200, scan + 300, std::uint8_t{0x7f});
  testing::internal::CaptureStderr();
  EXPECT_THAT(read(bytes).notes, ElementsAre(HasSubstr("the image may be damaged: ")));
  EXPECT_THAT(error(smallTiff({1, 2, 3, 4, 5, 6, 7, 8}, {{277, 65535}})), StartsWith("image: "));
  EXPECT_THAT(error(smallTiff({1, 2, 3, 4}, {{259, 7}})), StartsWith("image: the TIFF image is "));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

Bytes firstOf(const Bytes& bytes, std::size_t count) {
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count)};
}

/// Wherever a file is cut, it is refused: decoders alone would fill the rest with gray.
TEST_F(ReadImage, RefusesEveryTruncationAndAcceptsBytesAfterTheEnd) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1}) {
    const cv::Mat source = randomImage(type);
    for (const char* extension : {".png", ".jpg", ".tiff"}) {
      if (type == CV_16UC1 && std::string(extension) == ".jpg") continue;
      const Bytes bytes = encoded(source, extension);
      // A TIFF ends with the place of its next page, which may be cut.
      const std::size_t last = bytes.size() - (extension[1] == 't' ? 5 : 1);
      for (std::size_t size = 1; size <= last; size += 1 + bytes.size() / 97) {
        ASSERT_THAT(error(firstOf(bytes, size)),
                    ::testing::AnyOf(HasSubstr("truncated"), HasSubstr("not a PNG, JPEG or TIFF")))
            << extension << " cut to " << size << " of " << bytes.size();
      }
      EXPECT_THAT(error(firstOf(bytes, last)), HasSubstr("truncated")) << extension;
      if (extension[1] == 't') continue;
      Bytes other = bytes;
      other.insert(other.end(), {1, 2, 0xff, 0xda, 3});
      EXPECT_EQ(error(other), "(nothing)") << "bytes after the end";
    }
  }
}

TEST_F(ReadImage, TruncationOfAJpegIsNotHiddenByTheEndOfItsThumbnail) {
  Bytes bytes = withExif(encoded(randomImage(CV_8UC1), ".jpg"), {0xff, 0xda, 0xff, 0xd9});
  EXPECT_EQ(error(bytes), "(nothing)");
  bytes.resize(bytes.size() - 50);
  EXPECT_EQ(error(bytes), "image: the JPEG image is truncated");
}

TEST_F(ReadImage, StripsOfTiffAreReadWholeAndMustBeThere) {
  const Bytes tall(2 * 2600, 77);
  EXPECT_EQ(read(smallTiff(tall, {{257, 2600}, {278, 2600}})).pixels, tall);
  EXPECT_THAT(error(smallTiff({1, 2}, {{273, 0}, {279, 0}})),
              HasSubstr("a strip or tile is missing"));
  EXPECT_THAT(error(smallTiff({1, 2}, {{257, 99}, {278, 99}, {279, 198}})), HasSubstr("truncated"));
}

TEST_F(ReadImage, FindsAFlippedBitInAPng) {
  const Bytes bytes = encoded(randomImage(CV_8UC1), ".png");
  for (std::size_t i = 8; i < bytes.size(); i += 101) {
    Bytes changed = bytes;
    changed[i] ^= 0x10;
    EXPECT_NE(error(changed), "(nothing)") << "byte " << i;
  }
}

TEST_F(ReadImage, ReadsProgressiveJpegAndSkipsFillBytes) {
  Bytes bytes;
  ASSERT_TRUE(cv::imencode(".jpg", randomImage(CV_8UC3), bytes,
                           {cv::IMWRITE_JPEG_PROGRESSIVE, 1, cv::IMWRITE_JPEG_RST_INTERVAL, 2}));
  EXPECT_EQ(error(bytes), "(nothing)");
  for (std::size_t size = bytes.size() / 4; size < bytes.size(); size += bytes.size() / 31)
    EXPECT_EQ(error(firstOf(bytes, size)), "image: the JPEG image is truncated")
        << "cut to " << size << " of " << bytes.size();
  bytes.insert(bytes.begin() + 2, 3, 0xff);
  EXPECT_EQ(error(bytes), "(nothing)");
}

TEST_F(ReadImage, RefusesHugeDimensionsBeforeDecoding) {
  // A PNG header alone can ask for gigabytes.
  EXPECT_THAT(error(encoded(cv::Mat(1, 16385, CV_8UC1, cv::Scalar(0)), ".png")),
              StartsWith("image: image size: 16385 x 1 is outside the limits"));
  EXPECT_EQ(error(encoded(cv::Mat(1, 16384, CV_8UC1, cv::Scalar(0)), ".png")), "(nothing)");
  // Width and height of this TIFF are replaced in its directory (tags 256 and 257).
  Bytes tiff = encoded(cv::Mat(4, 4, CV_8UC1, cv::Scalar(0)), ".tiff");
  const std::size_t directory = tiff[4] + 256u * tiff[5];
  for (std::size_t entry = 0; entry < 2; ++entry) {
    std::uint8_t* value = &tiff[directory + 2 + 12 * entry + 8];
    value[0] = 0x00;
    value[1] = 0x40;
  }
  EXPECT_THAT(error(tiff), StartsWith("image: image size: 16384 x 16384 is outside the limits"));
}

TEST_F(ReadImage, IgnoreMaskPacksNonzeroPixels) {
  Random random(5);
  for (const int type : {CV_8UC1, CV_16UC1, CV_8UC3, CV_8UC4}) {
    cv::Mat image(9, 130, type, cv::Scalar(0, 0, 0, 255));
    std::vector<bool> expected(9 * 130, false);
    for (int y = 0; y < image.rows; ++y)
      for (int x = 0; x < image.cols; ++x) {
        if (random.below(3) != 0) continue;
        expected[static_cast<std::size_t>(y * 130 + x)] = true;
        if (type == CV_16UC1)
          image.at<std::uint16_t>(y, x) = 0x0100;  // low byte zero
        else
          image.ptr(y, x)[image.channels() >= 3 ? 1 : 0] = 1;
      }
    const auto file = folder_.write("mask.png", encoded(image, ".png"));
    const IgnoreMask mask = readIgnoreMask(file, 130, 9);
    EXPECT_EQ(mask.ignored_count, std::count(expected.begin(), expected.end(), true));
    const BitImage bits = mask.view();
    ASSERT_EQ(bits.words.size(), 3u * 9u);
    for (int y = 0; y < 9; ++y) {
      for (int x = 0; x < 130; ++x)
        ASSERT_EQ(bits.get(x, y), expected[static_cast<std::size_t>(y * 130 + x)]);
      EXPECT_EQ(bits.row(y)[2] >> 2, 0u) << "bits beyond the width are set";
    }
  }
}

TEST_F(ReadImage, IgnoreMaskOfAnotherSizeOrAsJpegIsRefused) {
  const cv::Mat image(9, 130, CV_8UC1, cv::Scalar(0));
  folder_.write("mask.png", encoded(image, ".png"));
  folder_.write("mask.jpg", encoded(image, ".jpg"));
  const auto message = [&](const char* name) {
    return folder_.message([&] { (void)readIgnoreMask(folder_ / name, 131, 9); });
  };
  EXPECT_EQ(message("mask.png"), "mask.png: mask size: is 130 x 9, but the image is 131 x 9");
  EXPECT_EQ(message("mask.jpg"), "mask.jpg: a mask must be lossless: PNG or TIFF, not JPEG");
}

TEST_F(ReadImage, WrittenPngIsReadBack) {
  const cv::Mat gray = randomImage(CV_8UC1);
  const std::span<const std::uint8_t> pixels(gray.ptr(), gray.total());
  writePng(folder_ / "gray.png", pixels, gray.cols, gray.rows, 1);
  EXPECT_EQ(readImage(folder_ / "gray.png").pixels, byRule(gray, 8));
  EXPECT_THROW(writePng(folder_ / "x.png", pixels, gray.cols + 1, gray.rows, 1), std::logic_error);
  EXPECT_EQ(
      folder_.message([&] { writePng(folder_ / "no/x.png", pixels, gray.cols, gray.rows, 1); }),
      "cannot write no/x.png: no such folder");
}

}  // namespace
}  // namespace boresight::sessions
