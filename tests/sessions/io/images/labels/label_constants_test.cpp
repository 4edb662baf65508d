// SPDX-License-Identifier: Apache-2.0
// Constants of labels that stand for no measurement, as labels write them.
#include "sessions/io/images/labels/label_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

#include <nlohmann/json.hpp>

#include "tests/sessions/io/images/labels/label_fixture.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::TemporaryFolder;

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

TEST(LabelConstants, MissingConstants_BecomeZeroOutsideTheRange) {
  const TemporaryFolder folder;
  Raster raster = Raster::filled(6, 4, 1, [](std::size_t i) { return 0.5 * double(i); });
  raster.at(0, 1, 3) = -double(FLT_MAX);
  Pds3File pds;
  pds.sample_type = "IEEE_REAL";
  pds.store = Store::kIeee;
  pds.image_items = " MISSING_CONSTANT = -3.402823e+38\r\n";
  Pds4File xml;
  xml.data_type = "IEEE754MSBSingle";
  xml.store = Store::kIeee;
  folder.write("pixels.img", xml.pixels(raster));
  std::vector<std::filesystem::path> files{folder.write("a.img", pds.bytes(raster))};
  for (const char* text : {"0xFF7FFFFF", "-3.402823e+38", "16#FF7FFFFF#"}) {
    xml.constants = "<missing_constant>" + std::string(text) + "</missing_constant>";
    files.push_back(folder.write(std::to_string(files.size()) + ".xml", xml.label(raster)));
  }
  for (const auto& file : files) {
    const LabelSamples samples = readLabelSamples(readLabelFiles(file));
    EXPECT_EQ(samples.invalid_count, 1) << file;
    EXPECT_EQ(samples.offset, 0.0) << file;
    EXPECT_EQ(samples.values[23], 65535) << file;
    EXPECT_EQ(samples.values[9], 0) << file;
  }
}

}  // namespace
}  // namespace boresight::sessions
