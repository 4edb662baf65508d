// SPDX-License-Identifier: Apache-2.0
// Samples far off all others must not take the levels from them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/base/random.h"
#include "sessions/io/labels/label_samples.h"
#include "tests/sessions/io/labels/label_fixture.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::Raster;
using test::Store;
using test::TemporaryFolder;
using test::VicarFile;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

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
                Contains(HasSubstr(std::to_string(odd.size()) + " samples lie far off all")));
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

TEST(LabelOutliers, RangeStaysWholeWhereNothingIsFarOff) {
  const TemporaryFolder folder;
  std::vector<double> bright;  // a small thing, 70 pixels of 8000
  for (int i = 0; i < 70; ++i) bright.push_back(40.0 + 0.01 * i);
  for (const std::vector<double>& odd :
       std::vector<std::vector<double>>{{}, {0.0}, {0.9}, bright}) {
    const LabelSamples samples = read(folder, picture(odd), Store::kDouble);
    EXPECT_THAT(samples.rule, Not(HasSubstr("outliers")));
    EXPECT_THAT(samples.label->flags, Not(Contains(HasSubstr("far off"))));
  }
  // Two values alone: one of them is no outlier of nothing.
  Raster two = Raster::filled(100, 80, 1, [](std::size_t i) { return i == 70 ? 9.0 : -1.0; });
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
