// SPDX-License-Identifier: Apache-2.0
// Pixels of images with labels: written by the test byte by byte, so that every sample is known.
// Samples far off all others must not take the levels from them. Constants that stand for no
// measurement, as labels write them.
#include "sessions/io/images/labels/label_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <set>
#include <thread>

#include <nlohmann/json.hpp>

#include "core/base/random.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/image_file.h"
#include "tests/sessions/io/images/labels/label_fixture.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

class LabelSamplesTest : public LabelTest {
 protected:
  LabelSamples readVicar(const Raster& raster, Store store) const {
    const auto file = folder_.write("a.vic", VicarFile{store}.bytes(raster));
    return readLabelSamples(readLabelFiles(file));
  }
};

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
void expectAsWritten(const ImageSamples& samples, const Raster& raster, Store store) {
  const bool floating = store >= Store::kIeee;
  const std::vector<std::uint16_t> wanted = expected(raster, floating);
  ASSERT_EQ(samples.values.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i)
    ASSERT_LE(std::abs(samples.values[i] - wanted[i]), floating ? 1 : 0) << "sample " << i;
}

double randomSample(Random& random, Store store) {
  const auto below = [&random](std::uint32_t bound) { return double(random.below(bound)); };
  if (store == Store::kByte) return below(256);
  if (store == Store::kHalf) return below(32768) - (below(8) == 0.0 ? 20000.0 : 0.0);
  if (store == Store::kFull) return below(4000000) - 1000000.0;
  return static_cast<double>(static_cast<float>((below(1000000) - 300000.0) / 128.0));
}

TEST_F(LabelSamplesTest, VicarOfEveryKindIsReadAsWritten) {
  Random random(7);
  for (const Store store :
       {Store::kByte, Store::kHalf, Store::kFull, Store::kIeee, Store::kVax, Store::kDouble})
    for (const char* organization : {"BSQ", "BIL", "BIP"})
      for (int round = 0; round < 8; ++round) {
        VicarFile vicar{store, store != Store::kVax && round % 2 == 0, organization};
        vicar.prefix_bytes = round % 3 == 1 && vicar.organization != "BIP" ? 24 : 0;
        vicar.header_records = round % 4;
        vicar.items_at_end = round % 4 == 2;
        vicar.items = "TASK='TEST'  USER='me'  DAT_TIM='Sun Nov 22 2026'  ";
        const Raster raster = Raster::filled(
            1 + static_cast<int>(random.below(40)), 1 + static_cast<int>(random.below(30)), 1,
            [&](std::size_t) { return randomSample(random, store); });
        SCOPED_TRACE(vicar.formatName() + " " + organization + " round " + std::to_string(round));
        const ImageSamples samples = readSamples(folder_.write("image.vic", vicar.bytes(raster)));
        EXPECT_EQ(samples.width, raster.width);
        EXPECT_EQ(samples.height, raster.height);
        EXPECT_EQ(samples.sample_bits, store == Store::kByte ? 8 : 16);
        expectAsWritten(samples, raster, store);
        // The file's own value comes back within half a step.
        for (std::size_t i = 0; i < samples.values.size(); ++i)
          ASSERT_NEAR(samples.offset + samples.scale * samples.values[i], raster.samples[i],
                      samples.scale == 1.0 ? 0.0 : 0.51 * samples.scale + 1e-9);
      }
}

TEST_F(LabelSamplesTest, VicarWithoutAnOrganizationIsBandSequential) {
  VicarFile vicar{Store::kHalf};
  vicar.items = "TASK='TEST'  USER='me'  GAIN=1.5D-03  ";
  const Raster raster = Raster::counting(13, 9);
  const std::string label = altered(textOf(vicar.bytes(raster)), "ORG='BSQ'", "         ");
  const ImageSamples samples = readSamples(folder_.write("silent.vic", label));
  EXPECT_EQ(samples.width, 13);
  expectAsWritten(samples, raster, vicar.store);
}

TEST_F(LabelSamplesTest, ThreeBandsBecomeLumaInTheOrderRedGreenBlue) {
  Random random(11);
  for (const char* organization : {"BSQ", "BIL", "BIP"}) {
    const VicarFile vicar{Store::kByte, false, organization};
    const Raster raster =
        Raster::filled(13, 9, 3, [&](std::size_t) { return double(random.below(256)); });
    const GrayImage image = readImage(folder_.write("c.vic", vicar.bytes(raster)));
    EXPECT_EQ(image.channels, 3);
    EXPECT_THAT(image.rule, HasSubstr("luma (9798 R + 19235 G + 3735 B + 16384) >> 15"));
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 13; ++x) ASSERT_EQ(image.view().at(x, y), raster.luma(y, x));
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

TEST_F(LabelSamplesTest, Pds3OfEveryKindIsReadAsWritten) {
  Random random(5);
  for (const Kind& kind :
       {Kind{"MSB_INTEGER", Store::kHalf, true}, Kind{"LSB_INTEGER", Store::kHalf, false},
        Kind{"MSB_UNSIGNED_INTEGER", Store::kHalf, true},
        Kind{"LSB_UNSIGNED_INTEGER", Store::kHalf, false},
        Kind{"UNSIGNED_INTEGER", Store::kByte, true}, Kind{"IEEE_REAL", Store::kIeee, true},
        Kind{"PC_REAL", Store::kIeee, false}})
    for (int round = 0; round < 3; ++round) {
      SCOPED_TRACE(kind.type);
      Pds3File pds{kind.type, kind.store, kind.big_endian};
      const Raster raster = randomRaster(random, kind, 1 + static_cast<int>(random.below(70)),
                                         1 + static_cast<int>(random.below(20)));
      const ImageSamples attached = readSamples(folder_.write("a.img", pds.bytes(raster)));
      expectAsWritten(attached, raster, kind.store);

      pds.pixels_file = "PIXELS.DAT";
      const auto label = folder_.write("d.lbl", pds.label(raster, 0));
      folder_.write("pixels.dat", pds.pixels(raster));  // upper and lower case may differ
      EXPECT_EQ(readSamples(label).values, attached.values);
    }
}

TEST_F(LabelSamplesTest, Pds4OfEveryKindIsReadAsWritten) {
  Random random(6);
  for (const Kind& kind :
       {Kind{"UnsignedByte", Store::kByte, true}, Kind{"UnsignedMSB2", Store::kHalf, true},
        Kind{"UnsignedLSB2", Store::kHalf, false}, Kind{"SignedMSB2", Store::kHalf, true},
        Kind{"SignedLSB4", Store::kFull, false}, Kind{"IEEE754MSBSingle", Store::kIeee, true},
        Kind{"IEEE754LSBDouble", Store::kDouble, false}})
    for (const int offset : {0, 513}) {
      SCOPED_TRACE(kind.type);
      Pds4File pds{kind.type, kind.store, kind.big_endian};
      pds.offset = offset;
      const Raster raster = randomRaster(random, kind, 37, 11);
      folder_.write("pixels.img", pds.pixels(raster));
      const auto label = folder_.write("image.xml", pds.label(raster));
      expectAsWritten(readSamples(label), raster, kind.store);
    }
}

TEST_F(LabelSamplesTest, SamplesWithoutAValueAreZeroAndCounted) {
  const float missing = -3.402822655e+38f;  // 16#FF7FFFFB#
  Raster raster = Raster::filled(6, 4, 1, [](std::size_t i) { return -50.0 + 10.0 * double(i); });
  raster.at(0, 0, 1) = std::numeric_limits<double>::quiet_NaN();
  raster.at(0, 1, 0) = std::numeric_limits<double>::infinity();
  raster.at(0, 2, 5) = -std::numeric_limits<double>::infinity();
  raster.at(0, 3, 3) = missing;
  raster.at(0, 3, 4) = 0.25;
  Pds3File pds{"IEEE_REAL", Store::kIeee};
  pds.image_items = " MISSING_CONSTANT = 16#FF7FFFFB#\r\n INVALID_CONSTANT = 0.25\r\n";
  const auto file = folder_.write("m.img", pds.bytes(raster));
  const LabelSamples samples = readLabelSamples(readLabelFiles(file));
  EXPECT_EQ(samples.invalid_count, 5);
  EXPECT_THAT(readImage(file).rule,
              AllOf(HasSubstr("low -50, high 180"), HasSubstr("5 samples without a value as 0")));
  for (const std::size_t i : {0u, 1u, 6u, 17u, 21u, 22u}) EXPECT_EQ(samples.values[i], 0);
  EXPECT_EQ(samples.values[23], 65535);
  EXPECT_EQ(samples.values[2], std::floor(20.0 / 230.0 * 65535.0 + 0.5));
}

TEST_F(LabelSamplesTest, DepthIsThatOfTheLabelUnlessSamplesExceedIt) {
  Pds3File pds;
  pds.image_items = " SAMPLE_BIT_MASK = 2#0000111111111111#\r\n";
  Raster raster = Raster::filled(16, 4, 1, [](std::size_t i) { return double(i * 64); });
  const auto file = folder_.write("b.img", pds.bytes(raster));
  const GrayImage stated = readImage(file);
  EXPECT_EQ(stated.bit_depth, 12);
  EXPECT_TRUE(stated.bit_depth_of_label);
  EXPECT_TRUE(stated.notes.empty());
  EXPECT_THAT(stated.rule, HasSubstr("2^12 - 1) + 0.5), bit depth that of the label"));
  for (std::size_t i = 0; i < 64; ++i)
    ASSERT_EQ(stated.pixels[i], std::floor(double(i * 64) * 255.0 / 4095.0 + 0.5));

  EXPECT_EQ(readImage(file, {13}).bit_depth, 13);
  EXPECT_THAT(refusal(file, {8}), HasSubstr("more than 8 bits"));
  EXPECT_EQ(readImage(file, {std::nullopt, {}, GrayLevels{0, 40000}}).bit_depth, 16);

  raster.at(0, 3, 15) = 4200;
  const GrayImage beyond = readImage(folder_.write("b.img", pds.bytes(raster)));
  EXPECT_EQ(beyond.bit_depth, 13);
  EXPECT_THAT(
      beyond.notes,
      ElementsAre("the label says that 12 bits are used, but a sample is 4200: read as 13 bits"));
  EXPECT_THAT(beyond.rule, HasSubstr("2^13 - 1"));
  EXPECT_EQ(beyond.pixels[63], std::floor(4200.0 * 255.0 / 8191.0 + 0.5));

  const Raster quantized = Raster::filled(5, 5, 1, [](std::size_t i) { return 0.5 * double(i); });
  const auto floating = folder_.write("r.vic", VicarFile{Store::kIeee}.bytes(quantized));
  EXPECT_EQ(refusal(floating, {12}),
            "r.vic: bit_depth: 12 bits stated, but its samples are not whole numbers from 0 on and "
            "become 16 bits");
  EXPECT_EQ(readImage(floating, {16}).bit_depth, 16);
}

TEST_F(LabelSamplesTest, ManyThreadsReadAtOnce) {
  const Raster raster = Raster::counting(64, 48);
  const auto file = folder_.write("t.vic", VicarFile{Store::kHalf}.bytes(raster));
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

std::size_t levelsOf(const LabelSamples& samples) {
  return std::set<std::uint16_t>(samples.values.begin(), samples.values.end()).size();
}

TEST_F(LabelSamplesTest, FewOutliers_AreClippedAndCounted) {
  for (const std::vector<double>& odd : std::vector<std::vector<double>>{
           {55.0}, {-9999.0, 1e30}, {-3.4e38, 3e38}, {2.0}, {1e5, 2e6, 3e7, -4e8}}) {
    const Raster raster = picture(odd);
    const LabelSamples samples = readVicar(raster, Store::kDouble);
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

TEST_F(LabelSamplesTest, NoOutliers_KeepTheFullRange) {
  std::vector<double> bright;  // a small thing, 70 pixels of 8000
  for (int i = 0; i < 70; ++i) bright.push_back(40.0 + 0.01 * i);
  for (const std::vector<double>& odd :
       std::vector<std::vector<double>>{{}, {0.0}, {0.9}, bright}) {
    const LabelSamples samples = readVicar(picture(odd), Store::kDouble);
    EXPECT_THAT(samples.rule, Not(HasSubstr("outliers")));
    EXPECT_THAT(samples.label->flags, Not(Contains(HasSubstr("far outliers"))));
  }
  // Two values alone: one of them is no outlier of nothing.
  const Raster two = Raster::filled(100, 80, 1, [](std::size_t i) { return i == 70 ? 9.0 : -1.0; });
  const LabelSamples samples = readVicar(two, Store::kDouble);
  EXPECT_EQ(samples.values[70], 65535);
  EXPECT_EQ(samples.values[0], 0);
}

TEST_F(LabelSamplesTest, ValueForNothingOfSignedSamples_IsAnOutlier) {
  Raster raster = Raster::filled(100, 80, 1, [](std::size_t i) {
    return i % 1100 == 3 ? -32768.0 : 800.0 + static_cast<double>(i % 1000);
  });
  const LabelSamples samples = readVicar(raster, Store::kHalf);
  EXPECT_EQ(levelsOf(samples), 1001u);
  EXPECT_THAT(samples.rule, HasSubstr("8 outliers beyond"));
}

/// Whether the constant, stated so, takes the sample for none.
bool takes(const nlohmann::json& stated, bool floating, int bits, double sample) {
  std::vector<InvalidValue> values;
  addInvalidValues(&stated, floating, bits, values);
  return std::any_of(values.begin(), values.end(), [sample](const InvalidValue& invalid_value) {
    return std::abs(sample - invalid_value.value) <= invalid_value.tolerance;
  });
}

TEST(LabelConstants, BitsAreThoseOfASample) {
  const double lowest = -3.402822655089045e+38;  // FF7FFFFB
  for (const char* text : {"16#FF7FFFFB#", "0xFF7FFFFB", "0Xff7ffffb", "16#ff7ffffb",
                           "2#11111111011111111111111111111011#"})
    EXPECT_TRUE(takes(text, true, 32, static_cast<double>(static_cast<float>(lowest)))) << text;
  EXPECT_TRUE(takes("0xFFEFFFFFFFFFFFFF", true, 64, -DBL_MAX));
  EXPECT_TRUE(takes("16#FFEFFFFFFFFFFFFB#", true, 64, -1.7976931348623149e308));
  EXPECT_TRUE(takes("16#8000#", false, 16, 32768.0));
  EXPECT_TRUE(takes("0x8000", false, 16, -32768.0));
  EXPECT_TRUE(takes("0xFF", false, 8, -1.0));
  EXPECT_FALSE(takes("0x7FFF", false, 16, -1.0));
  EXPECT_TRUE(takes("0x80000000", false, 32, -2147483648.0));
  for (const char* text : {"0x", "16##", "16#XY#", "8#17#", "0x1FFFFFFFFFFFFFFFF", "16#", "#", "-",
                           "0x7FC00000", "N/A"})
    for (const double sample : {0.0, 1.0, 15.0, 255.0})
      EXPECT_FALSE(takes(text, true, 32, sample)) << text;
}

TEST(LabelConstants, NumbersAreExactUnlessBeyondAllMeasurement) {
  for (const char* text : {"-3.402823e+38", "-3.40282e38", "-3.4028235E+38", "-3.4D38"})
    EXPECT_TRUE(takes(text, true, 32, -double(FLT_MAX))) << text;
  EXPECT_TRUE(takes(-3.402823e+38, true, 32, -double(FLT_MAX)));
  EXPECT_TRUE(takes("-1.797693e+308", true, 64, -DBL_MAX));
  EXPECT_FALSE(takes("-3.402823e+38", true, 32, double(FLT_MAX)));
  EXPECT_FALSE(takes("-3.40282265e+38", true, 32, -double(FLT_MAX)));
  EXPECT_FALSE(takes("-3.402823e+38", true, 32, -3.4e37));
  EXPECT_TRUE(takes("1.0E32", true, 32, static_cast<double>(1e32f)));
  EXPECT_TRUE(takes("0.25", true, 32, 0.25));
  EXPECT_FALSE(takes("0.25", true, 32, 0.2500001));
  EXPECT_FALSE(takes("12345.6", true, 32, 12345.62));
  EXPECT_TRUE(takes({1, "2", "0x3"}, false, 16, 3.0));
}

TEST_F(LabelSamplesTest, MissingConstants_BecomeZeroOutsideTheRange) {
  Raster raster = Raster::filled(6, 4, 1, [](std::size_t i) { return 0.5 * double(i); });
  raster.at(0, 1, 3) = -double(FLT_MAX);
  Pds3File pds{"IEEE_REAL", Store::kIeee};
  pds.image_items = " MISSING_CONSTANT = -3.402823e+38\r\n";
  Pds4File xml{"IEEE754MSBSingle", Store::kIeee};
  folder_.write("pixels.img", xml.pixels(raster));
  std::vector<std::filesystem::path> files{folder_.write("a.img", pds.bytes(raster))};
  for (const char* text : {"0xFF7FFFFF", "-3.402823e+38", "16#FF7FFFFF#"}) {
    xml.constants = "<missing_constant>" + std::string(text) + "</missing_constant>";
    files.push_back(folder_.write(std::to_string(files.size()) + ".xml", xml.label(raster)));
  }
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    const LabelSamples samples = readLabelSamples(readLabelFiles(file));
    EXPECT_EQ(std::tuple(samples.invalid_count, samples.offset), std::tuple(1, 0.0));
    EXPECT_EQ(std::tuple(samples.values[9], samples.values[23]), std::tuple(0, 65535));
  }
}

}  // namespace
}  // namespace boresight::sessions
