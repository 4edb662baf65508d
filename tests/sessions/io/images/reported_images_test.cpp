// SPDX-License-Identifier: Apache-2.0
// Images as image tools write them: palettes, single bits, deep samples of which few are used.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <string>
#include <vector>

#include "sessions/io/files/errors.h"
#include "sessions/io/images/image_file.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using boresight::test::TemporaryFolder;
using Bytes = std::vector<std::uint8_t>;

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

class ReportedImage : public ::testing::Test {
 protected:
  GrayImage read(const Bytes& bytes, const ImageReadOptions& options = {}) {
    return readImage(folder_.write("image.png", bytes), options);
  }
  TemporaryFolder folder_;
};

TEST_F(ReportedImage, PngWithAPalette_HasThePalettesColours) {
  const Bytes palette = {255, 0, 0, 0, 255, 0, 10, 10, 10, 200, 200, 200};
  const GrayImage image = read(png(4, 8, 3, {{0, 1, 2, 3}, {3, 2, 1, 0}}, palette));
  const std::uint8_t red = 76;     // 0.299 * 255
  const std::uint8_t green = 150;  // 0.587 * 255
  EXPECT_EQ(image.pixels, (Bytes{red, green, 10, 200, 200, 10, green, red}));
}

TEST_F(ReportedImage, PngOfOneBit_IsBlackAndWhite) {
  const GrayImage image = read(png(4, 1, 0, {{0b1010'0000}, {0b0110'0000}}));
  EXPECT_EQ(image.pixels, (Bytes{255, 0, 255, 0, 0, 255, 255, 0}));
}

/// Samples of 6 bits in 16: black without the depth, which is then stated.
TEST_F(ReportedImage, PngOfSixteenBitsWithSixUsed_IsReadByAStatedDepth) {
  const Bytes bytes = png(2, 16, 0, {{0, 0, 0, 63}, {0, 32, 0, 1}});
  EXPECT_EQ(read(bytes).pixels, (Bytes{0, 0, 0, 0}));
  EXPECT_EQ(read(bytes, {6}).pixels, (Bytes{0, 255, 130, 4}));
}

TEST_F(ReportedImage, PngOfGrayWithAlpha_LosesItsAlpha) {
  const GrayImage image = read(png(2, 8, 4, {{7, 0, 9, 255}, {11, 128, 13, 1}}));
  EXPECT_EQ(image.pixels, (Bytes{7, 9, 11, 13}));
}

}  // namespace
}  // namespace boresight::sessions
