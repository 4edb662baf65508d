// SPDX-License-Identifier: Apache-2.0
// Pixels of images with labels: written by the test byte by byte, so that every sample is known.
// Samples far off all others must not take the levels from them.
#include "sessions/io/images/labels/label_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <thread>

#include "core/base/random.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/image_file.h"
#include "tests/sessions/io/images/labels/label_fixture.h"

namespace boresight::sessions {
namespace {

using test::TemporaryFolder;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// What the file's samples become, by the rule as the header states it.
std::vector<std::uint16_t> expected(const Raster& raster, bool floating) {
  const auto [low, high] = std::minmax_element(raster.samples.begin(), raster.samples.end());
  const bool whole = !floating && *low >= 0.0 && *high <= 65535.0;
  std::vector<std::uint16_t> values;
  for (const double v : raster.samples)
    values.push_back(static_cast<std::uint16_t>(
        whole          ? v
        : *high > *low ? std::floor((v - *low) / (*high - *low) * 65535.0 + 0.5)
                       : 0.0));
  return values;
}

/// The same, but for a unit where a half is rounded.
void expectNear(const std::vector<std::uint16_t>& values, const std::vector<std::uint16_t>& wanted,
                int tolerance, const std::string& what) {
  ASSERT_EQ(values.size(), wanted.size()) << what;
  for (std::size_t i = 0; i < values.size(); ++i)
    ASSERT_LE(std::abs(values[i] - wanted[i]), tolerance) << what << " sample " << i;
}

double randomSample(Random& random, Store store) {
  switch (store) {
    case Store::kByte:
      return static_cast<double>(random.below(256));
    case Store::kHalf:
      return static_cast<double>(random.below(32768)) - (random.below(8) == 0 ? 20000.0 : 0.0);
    case Store::kFull:
      return static_cast<double>(random.below(4000000)) - 1000000.0;
    default:
      return static_cast<double>(
          static_cast<float>((static_cast<double>(random.below(1000000)) - 300000.0) / 128.0));
  }
}

TEST(LabelSamples, VicarOfEveryKindIsReadAsWritten) {
  const TemporaryFolder folder;
  Random random(7);
  for (const Store store :
       {Store::kByte, Store::kHalf, Store::kFull, Store::kIeee, Store::kVax, Store::kDouble})
    for (const char* organization : {"BSQ", "BIL", "BIP"})
      for (int round = 0; round < 8; ++round) {
        VicarFile vicar;
        vicar.store = store;
        vicar.organization = organization;
        vicar.big_endian = store != Store::kVax && round % 2 == 0;
        vicar.prefix_bytes = round % 3 == 1 && vicar.organization != "BIP" ? 24 : 0;
        vicar.header_records = round % 4;
        vicar.items_at_end = round % 4 == 2;
        vicar.items = "TASK='TEST'  USER='me'  DAT_TIM='Sun Nov 22 2026'  ";
        const Raster raster = Raster::filled(
            1 + static_cast<int>(random.below(40)), 1 + static_cast<int>(random.below(30)), 1,
            [&](std::size_t) { return randomSample(random, store); });
        const auto file = folder.write("image.vic", vicar.bytes(raster));
        const std::string what =
            vicar.formatName() + " " + organization + " round " + std::to_string(round);
        const ImageSamples samples = readSamples(file);
        EXPECT_EQ(samples.width, raster.width) << what;
        EXPECT_EQ(samples.height, raster.height) << what;
        EXPECT_EQ(samples.sample_bits, store == Store::kByte ? 8 : 16) << what;
        const bool floating = store >= Store::kIeee;
        expectNear(samples.values, expected(raster, floating), floating ? 1 : 0, what);
        // The file's own value comes back within half a step.
        for (std::size_t i = 0; i < samples.values.size(); ++i)
          ASSERT_NEAR(samples.offset + samples.scale * samples.values[i], raster.samples[i],
                      samples.scale == 1.0 ? 0.0 : 0.51 * samples.scale + 1e-9)
              << what;
      }
}

TEST(LabelSamples, VicarWithoutAnOrganizationIsBandSequential) {
  const TemporaryFolder folder;
  VicarFile vicar;
  vicar.store = Store::kHalf;
  vicar.items = "TASK='TEST'  USER='me'  GAIN=1.5D-03  ";
  const Raster raster = Raster::counting(13, 9);
  const std::string whole = textOf(vicar.bytes(raster));
  const auto stated = readSamples(folder.write("stated.vic", whole));
  const auto silent =
      readSamples(folder.write("silent.vic", altered(whole, "ORG='BSQ'", "         ")));
  EXPECT_EQ(silent.width, 13);
  EXPECT_EQ(silent.values, stated.values);
}

TEST(LabelSamples, ThreeBandsBecomeLumaInTheOrderRedGreenBlue) {
  const TemporaryFolder folder;
  Random random(11);
  for (const char* organization : {"BSQ", "BIL", "BIP"}) {
    VicarFile vicar;
    vicar.organization = organization;
    const Raster raster =
        Raster::filled(13, 9, 3, [&](std::size_t) { return double(random.below(256)); });
    const GrayImage image = readImage(folder.write("c.vic", vicar.bytes(raster)));
    EXPECT_EQ(image.channels, 3);
    EXPECT_THAT(image.rule, HasSubstr("luma (9798 R + 19235 G + 3735 B + 16384) >> 15"));
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 13; ++x) {
        const double luma = (9798 * raster.at(0, y, x) + 19235 * raster.at(1, y, x) +
                             3735 * raster.at(2, y, x) + 16384) /
                            32768;
        ASSERT_EQ(image.pixels[static_cast<std::size_t>(y * 13 + x)], std::floor(luma));
      }
  }
}

/// A type of samples as labels call it.
struct Kind {
  std::string type;
  Store store;
  bool big_endian;
};

Raster randomRaster(Random& random, const Kind& kind, int width, int height) {
  const bool is_unsigned =
      kind.type.starts_with("Unsigned") || kind.type.find("UNSIGNED") != std::string::npos;
  return Raster::filled(width, height, 1, [&](std::size_t) {
    return is_unsigned && kind.store == Store::kHalf ? double(random.below(65536))
                                                     : randomSample(random, kind.store);
  });
}

void expectAsWritten(const ImageSamples& samples, const Raster& raster, const Kind& kind) {
  const bool floating = kind.store >= Store::kIeee;
  expectNear(samples.values, expected(raster, floating), floating ? 1 : 0, kind.type);
}

TEST(LabelSamples, Pds3OfEveryKindIsReadAsWritten) {
  const TemporaryFolder folder;
  Random random(5);
  for (const Kind& kind :
       {Kind{"MSB_INTEGER", Store::kHalf, true}, Kind{"LSB_INTEGER", Store::kHalf, false},
        Kind{"MSB_UNSIGNED_INTEGER", Store::kHalf, true},
        Kind{"LSB_UNSIGNED_INTEGER", Store::kHalf, false},
        Kind{"UNSIGNED_INTEGER", Store::kByte, true}, Kind{"IEEE_REAL", Store::kIeee, true},
        Kind{"PC_REAL", Store::kIeee, false}})
    for (int round = 0; round < 3; ++round) {
      Pds3File pds;
      pds.sample_type = kind.type;
      pds.store = kind.store;
      pds.big_endian = kind.big_endian;
      const Raster raster = randomRaster(random, kind, 1 + static_cast<int>(random.below(70)),
                                         1 + static_cast<int>(random.below(20)));
      const ImageSamples attached = readSamples(folder.write("a.img", pds.bytes(raster)));
      expectAsWritten(attached, raster, kind);

      pds.pixels_file = "PIXELS.DAT";
      const auto label = folder.write("d.lbl", pds.label(raster, 0));
      folder.write("pixels.dat", pds.pixels(raster));  // upper and lower case may differ
      EXPECT_EQ(readSamples(label).values, attached.values) << kind.type;
    }
}

TEST(LabelSamples, Pds4OfEveryKindIsReadAsWritten) {
  const TemporaryFolder folder;
  Random random(6);
  for (const Kind& kind :
       {Kind{"UnsignedByte", Store::kByte, true}, Kind{"UnsignedMSB2", Store::kHalf, true},
        Kind{"UnsignedLSB2", Store::kHalf, false}, Kind{"SignedMSB2", Store::kHalf, true},
        Kind{"SignedLSB4", Store::kFull, false}, Kind{"IEEE754MSBSingle", Store::kIeee, true},
        Kind{"IEEE754LSBDouble", Store::kDouble, false}})
    for (const int offset : {0, 513}) {
      Pds4File pds;
      pds.data_type = kind.type;
      pds.store = kind.store;
      pds.big_endian = kind.big_endian;
      pds.offset = offset;
      const Raster raster = randomRaster(random, kind, 37, 11);
      folder.write("pixels.img", pds.pixels(raster));
      expectAsWritten(readSamples(folder.write("image.xml", pds.label(raster))), raster, kind);
    }
}

TEST(LabelSamples, SamplesWithoutAValueAreZeroAndCounted) {
  const TemporaryFolder folder;
  const float missing = -3.402822655e+38f;  // 16#FF7FFFFB#
  Raster raster = Raster::filled(6, 4, 1, [](std::size_t i) { return -50.0 + 10.0 * double(i); });
  raster.at(0, 0, 1) = std::numeric_limits<double>::quiet_NaN();
  raster.at(0, 1, 0) = std::numeric_limits<double>::infinity();
  raster.at(0, 2, 5) = -std::numeric_limits<double>::infinity();
  raster.at(0, 3, 3) = missing;
  raster.at(0, 3, 4) = 0.25;
  Pds3File pds;
  pds.sample_type = "IEEE_REAL";
  pds.store = Store::kIeee;
  pds.image_items = " MISSING_CONSTANT = 16#FF7FFFFB#\r\n INVALID_CONSTANT = 0.25\r\n";
  const auto file = folder.write("m.img", pds.bytes(raster));
  const LabelSamples samples = readLabelSamples(readLabelFiles(file));
  EXPECT_EQ(samples.invalid_count, 5);
  EXPECT_THAT(readImage(file).rule, HasSubstr("low -50, high 180"));
  EXPECT_THAT(readImage(file).rule, HasSubstr("5 samples without a value as 0"));
  for (const int i : {1, 6, 17, 21, 22}) EXPECT_EQ(samples.values[static_cast<std::size_t>(i)], 0);
  EXPECT_EQ(samples.values[0], 0);
  EXPECT_EQ(samples.values[23], 65535);
  EXPECT_EQ(samples.values[2], std::floor(20.0 / 230.0 * 65535.0 + 0.5));
}

TEST(LabelSamples, DepthIsThatOfTheLabelUnlessSamplesExceedIt) {
  const TemporaryFolder folder;
  Pds3File pds;
  pds.image_items = " SAMPLE_BIT_MASK = 2#0000111111111111#\r\n";
  Raster raster = Raster::filled(16, 4, 1, [](std::size_t i) { return double(i * 64); });
  const auto file = folder.write("b.img", pds.bytes(raster));
  const GrayImage stated = readImage(file);
  EXPECT_EQ(stated.bit_depth, 12);
  EXPECT_TRUE(stated.bit_depth_of_label);
  EXPECT_TRUE(stated.notes.empty());
  EXPECT_THAT(stated.rule, HasSubstr("2^12 - 1) + 0.5), bit depth that of the label"));
  for (std::size_t i = 0; i < 64; ++i)
    ASSERT_EQ(stated.pixels[i], std::floor(double(i * 64) * 255.0 / 4095.0 + 0.5));

  EXPECT_EQ(readImage(file, {13}).bit_depth, 13);
  EXPECT_THAT(folder.message([&] { readImage(file, {8}); }), HasSubstr("more than 8 bits"));
  EXPECT_EQ(readImage(file, {std::nullopt, {}, GrayLevels{0, 40000}}).bit_depth, 16);

  raster.at(0, 3, 15) = 4200;
  const GrayImage beyond = readImage(folder.write("b.img", pds.bytes(raster)));
  EXPECT_EQ(beyond.bit_depth, 13);
  ASSERT_EQ(beyond.notes.size(), 1u);
  EXPECT_EQ(beyond.notes[0],
            "the label says that 12 bits are used, but a sample is 4200: read as 13 bits");
  EXPECT_THAT(beyond.rule, HasSubstr("2^13 - 1"));
  EXPECT_EQ(beyond.pixels[63], std::floor(4200.0 * 255.0 / 8191.0 + 0.5));
}

TEST(LabelSamples, AskedDepthThatQuantizedSamplesContradictIsRefused) {
  const TemporaryFolder folder;
  VicarFile vicar;
  vicar.store = Store::kIeee;
  const Raster raster = Raster::filled(5, 5, 1, [](std::size_t i) { return 0.5 * double(i); });
  const auto file = folder.write("r.vic", vicar.bytes(raster));
  EXPECT_EQ(folder.message([&] { readImage(file, {12}); }),
            "r.vic: bit_depth: 12 bits stated, but its samples are not whole numbers from 0 on and "
            "become 16 bits");
  EXPECT_EQ(readImage(file, {16}).bit_depth, 16);
}

TEST(LabelSamples, ManyThreadsReadAtOnce) {
  const TemporaryFolder folder;
  VicarFile vicar;
  vicar.store = Store::kHalf;
  const Raster raster = Raster::counting(64, 48);
  const auto file = folder.write("t.vic", vicar.bytes(raster));
  std::vector<std::thread> threads;
  std::vector<int> right(8, 0);
  for (std::size_t t = 0; t < right.size(); ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 20; ++i)
        right[t] += readSamples(file).values == expected(raster, false) ? 1 : 0;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(right, ::testing::Each(20));
}

/// A picture of 100 x 80 whose values go from 0.2 to 0.7, some of them replaced.
Raster picture(const std::vector<double>& odd) {
  Raster raster = Raster::filled(100, 80, 1, [](std::size_t i) {
    return 0.2 + 0.5 * static_cast<double>(i * 5 % 1001) / 1000.0;
  });
  for (std::size_t i = 0; i < odd.size(); ++i) raster.samples[100 * i + 55] = odd[i];
  return raster;
}

LabelSamples read(const TemporaryFolder& folder, const Raster& raster, Store store) {
  VicarFile vicar;
  vicar.store = store;
  const auto file = folder.write("a.vic", vicar.bytes(raster));
  return readLabelSamples(readLabelFiles(file));
}

std::size_t levelsOf(const LabelSamples& samples) {
  return std::set<std::uint16_t>(samples.values.begin(), samples.values.end()).size();
}

TEST(LabelOutliers, AFewAreClippedAndCounted) {
  const TemporaryFolder folder;
  for (const std::vector<double>& odd : std::vector<std::vector<double>>{
           {55.0}, {-9999.0, 1e30}, {-3.4e38, 3e38}, {2.0}, {1e5, 2e6, 3e7, -4e8}}) {
    const Raster raster = picture(odd);
    const LabelSamples samples = read(folder, raster, Store::kDouble);
    EXPECT_GT(levelsOf(samples), 900u) << odd[0];
    EXPECT_THAT(samples.rule, HasSubstr(std::to_string(odd.size()) + " outliers beyond are"));
    EXPECT_THAT(samples.label->flags,
                Contains(HasSubstr(std::to_string(odd.size()) + " samples are far outliers")));
    double worst = 0.0;
    for (std::size_t i = 0; i < raster.samples.size(); ++i) {
      const double value = samples.offset + samples.scale * samples.values[i];
      if (raster.samples[i] >= 0.2 && raster.samples[i] <= 0.7)
        worst = std::max(worst, std::abs(value - raster.samples[i]));
      else
        EXPECT_EQ(samples.values[i], raster.samples[i] < 0.2 ? 0 : 65535);
    }
    EXPECT_LE(worst, 0.51 * samples.scale);
    EXPECT_LE(samples.scale, 2 * 0.5 / 65535);
  }
}

TEST(LabelOutliers, NoOutliers_KeepTheFullRange) {
  const TemporaryFolder folder;
  std::vector<double> bright;  // a small thing, 70 pixels of 8000
  for (int i = 0; i < 70; ++i) bright.push_back(40.0 + 0.01 * i);
  for (const std::vector<double>& odd :
       std::vector<std::vector<double>>{{}, {0.0}, {0.9}, bright}) {
    const LabelSamples samples = read(folder, picture(odd), Store::kDouble);
    EXPECT_THAT(samples.rule, Not(HasSubstr("outliers")));
    EXPECT_THAT(samples.label->flags, Not(Contains(HasSubstr("far outliers"))));
  }
  // Two values alone: one of them is no outlier of nothing.
  const Raster two = Raster::filled(100, 80, 1, [](std::size_t i) { return i == 70 ? 9.0 : -1.0; });
  const LabelSamples samples = read(folder, two, Store::kDouble);
  EXPECT_EQ(samples.values[70], 65535);
  EXPECT_EQ(samples.values[0], 0);
}

TEST(LabelOutliers, ValueForNothingOfSignedSamplesDoesNotCount) {
  const TemporaryFolder folder;
  Raster raster = Raster::filled(100, 80, 1, [](std::size_t i) {
    return i % 1100 == 3 ? -32768.0 : 800.0 + static_cast<double>(i % 1000);
  });
  const LabelSamples samples = read(folder, raster, Store::kHalf);
  EXPECT_EQ(levelsOf(samples), 1001u);
  EXPECT_THAT(samples.rule, HasSubstr("8 outliers beyond"));
}

}  // namespace
}  // namespace boresight::sessions
