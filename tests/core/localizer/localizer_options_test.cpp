// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/localizer_options.h"
#include "core/base/random.h"
#include "core/localizer/localizer.h"
#include "core/localizer/run_digest.h"
#include "tests/core/localizer/random_options.h"
#include "tests/core/localizer/scene.h"

#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>

#include <gtest/gtest.h>

namespace boresight::test {
namespace {

/// Bytes of the fields visited, and how many there are.
struct Extent {
  std::size_t bytes = 0;
  int count = 0;
};

template <class Options>
Extent extentOf() {
  Options options;
  Extent extent;
  Options::visitFields(options, [&extent](const OptionInfo&, const auto& field) {
    extent.bytes += sizeof(field);
    ++extent.count;
  });
  return extent;
}

/// Fields that are not visited would show as bytes that padding cannot explain.
template <class Options>
void expectEveryFieldVisited(const char* name) {
  const Extent extent = extentOf<Options>();
  EXPECT_LE(extent.bytes, sizeof(Options)) << name;
  std::size_t padding = 0;  // each run of small fields is padded to eight bytes at most
  Options options;
  std::size_t run = 0;
  Options::visitFields(options, [&](const OptionInfo&, const auto& field) {
    if (sizeof(field) < 8) {
      run += sizeof(field);
    } else {
      padding += run > 0 ? 8 : 0;
      run = 0;
    }
  });
  padding += 8;
  EXPECT_LT(sizeof(Options), extent.bytes + padding + 8) << name;
}

TEST(LocalizerOptions, EveryFieldIsVisited) {
  expectEveryFieldVisited<EdgeOptions>("edges");
  expectEveryFieldVisited<RenderOptions>("render");
  expectEveryFieldVisited<TemplateOptions>("templates");
  expectEveryFieldVisited<PnpOptions>("pnp");
  expectEveryFieldVisited<LoopOptions>("loop");
  expectEveryFieldVisited<RefinementOptions>("refinement");
  expectEveryFieldVisited<SupportOptions>("support");
  expectEveryFieldVisited<SearchOptions>("search");
  const int parts = extentOf<EdgeOptions>().count + extentOf<RenderOptions>().count +
                    extentOf<TemplateOptions>().count + extentOf<PnpOptions>().count +
                    extentOf<LoopOptions>().count + extentOf<RefinementOptions>().count +
                    extentOf<SupportOptions>().count + extentOf<SearchOptions>().count;
  EXPECT_EQ(extentOf<LocalizerOptions>().count, parts);
}

TEST(LocalizerOptions, EveryFieldIsVisitedOnce) {
  LocalizerOptions options;
  std::set<const void*> places;
  std::set<std::string> names;
  LocalizerOptions::visitFields(options, [&](const OptionInfo& info, const auto& field) {
    EXPECT_TRUE(places.insert(&field).second) << info.name;
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
  });
  EXPECT_EQ(places.size(), names.size());
}

std::array<std::uint8_t, 32> optionsDigest(const LocalizerOptions& options) {
  DigestWriter writer;
  digestOptions(options, writer);
  return writer.digest();
}

/// Except colour: the problem's digest shows whether a run uses it.
TEST(LocalizerOptions, EachOption_ChangesTheDigest) {
  LocalizerOptions options = defaultProfile();
  std::set<std::array<std::uint8_t, 32>> digests = {optionsDigest(options)};
  std::size_t count = 1;
  LocalizerOptions::visitFields(options, [&](const OptionInfo& info, auto& field) {
    using Field = std::remove_reference_t<decltype(field)>;
    const Field kept = field;
    field = static_cast<Field>(static_cast<double>(field) >= info.maximum ? info.minimum
                                                                          : info.maximum);
    const bool is_new = digests.insert(optionsDigest(options)).second;
    EXPECT_EQ(is_new, std::string_view(info.name) != "search.color") << info.name;
    count += is_new ? 1 : 0;
    field = kept;
  });
  EXPECT_EQ(digests.size(), count);
}

TEST(LocalizerOptions, AreDescribed) {
  LocalizerOptions options;
  LocalizerOptions::visitFields(options, [](const OptionInfo& info, const auto& field) {
    const std::string name = info.name;
    EXPECT_NE(name.find('.'), std::string::npos) << name;
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_."), std::string::npos)
        << name;
    EXPECT_LT(info.minimum, info.maximum) << name;
    const std::string help = info.help;
    EXPECT_GT(help.size(), 8u) << name;
    EXPECT_EQ(help.back(), '.') << name;
    const std::string unit = info.unit;
    if (unit == "px" || unit == "m" || unit == "rad") {
      EXPECT_TRUE(name.ends_with("_" + unit) || name.ends_with("_px") || info.help != std::string())
          << name;
    }
    using Field = std::remove_cvref_t<decltype(field)>;
    EXPECT_EQ(std::is_enum_v<Field>, !info.choices.empty()) << name;
    if (!info.choices.empty()) {
      EXPECT_EQ(info.minimum, 0.0) << name;
      EXPECT_EQ(info.maximum, static_cast<double>(info.choices.size() - 1)) << name;
    }
  });
}

TEST(LocalizerOptions, ProfilesAreInRange) {
  EXPECT_EQ(firstInvalidOption(defaultProfile()), nullptr);
  EXPECT_EQ(firstInvalidOption(paperProfile()), nullptr);
}

TEST(LocalizerOptions, PaperProfileIsAsPublished) {
  const LocalizerOptions paper = paperProfile();
  EXPECT_EQ(paper.loop.max_iterations, 10);
  EXPECT_EQ(paper.loop.inlier_threshold_px, 8.0);
  EXPECT_EQ(paper.loop.threshold_shrink, 0.5);
  EXPECT_EQ(paper.loop.uncertainty_shrink, 0.5);
  EXPECT_EQ(paper.loop.shrink_iterations, 2);
  EXPECT_EQ(paper.loop.converged_translation_m, 0.0005);
  EXPECT_NEAR(paper.loop.converged_rotation_rad, 0.5 * 3.14159265358979 / 180.0, 1e-12);
  EXPECT_EQ(paper.loop.converged_iterations, 2);
  EXPECT_EQ(paper.loop.leave_factor, 75.0 / 30.0);
  EXPECT_EQ(paper.loop.correction_point, CorrectionPoint::kStation);
  EXPECT_EQ(paper.pnp.sampler, PnpSampler::kEpnp);
  EXPECT_FALSE(paper.loop.subpixel_matches);
  EXPECT_FALSE(paper.refinement.enabled);
  EXPECT_FALSE(paper.support.gate);
  EXPECT_EQ(paper.edges.equalization, Equalization::kHistogram);
}

TEST(LocalizerOptions, FirstInvalidOption_NamesTheOption) {
  LocalizerOptions options;
  LocalizerOptions::visitFields(options, [&options](const OptionInfo& info, auto& field) {
    using Field = std::remove_reference_t<decltype(field)>;
    const Field before = field;
    if constexpr (std::is_same_v<Field, double>) {
      for (const double bad :
           {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
            -std::numeric_limits<double>::infinity(), info.minimum - 1e-3, info.maximum + 1e-3}) {
        field = bad;
        EXPECT_STREQ(firstInvalidOption(options), info.name) << bad;
      }
      for (const double good : {info.minimum, info.maximum}) {
        field = good;
        EXPECT_EQ(firstInvalidOption(options), nullptr) << info.name;
      }
    } else if constexpr (!std::is_same_v<Field, bool>) {
      for (const double bad : {info.minimum - 1.0, info.maximum + 1.0}) {
        field = static_cast<Field>(static_cast<std::int64_t>(bad));
        EXPECT_STREQ(firstInvalidOption(options), info.name) << bad;
      }
    }
    field = before;
  });
}

TEST(LocalizerRandom, RandomOptions_EndWithinTheMemoryAndRepeatTheirDigest) {
  const Camera camera = smallCamera();
  const Picture picture = takePicture(stationMesh(), camera, truthPose());
  Mask mask(131, 97);
  mask.fill(0, 0, 50, 40);
  Random random(77);
  int ends[16] = {};
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const LocalizerOptions options = randomOptions(random);
    ASSERT_EQ(firstInvalidOption(options), nullptr) << firstInvalidOption(options);
    Case scene = smallCase(picture, camera, static_cast<std::uint64_t>(i));
    if (i % 4 == 0) scene.ignore = &mask.bits;
    OwnedRun run(scene.problem(), options);
    ASSERT_EQ(run.localizer.status(), Status::kOk);
    ASSERT_GT(run.finish(), 0);
    EXPECT_EQ(run.localizer.highWaterBytes(), run.memory.size());
    const Workspace& workspace = run.localizer.workspace();
    EXPECT_NE(workspace.status, LocalizationStatus::kRunning);
    EXPECT_TRUE(workspace.camera_from_station.isFinite());
    EXPECT_TRUE(workspace.covariance.allFinite());
    ++ends[static_cast<int>(workspace.status)];
    if (i % 3 != 0) continue;
    std::vector<std::byte> other(run.memory.size() + 48, std::byte{0xFF});
    Localizer again(scene.problem(), options, std::span(other).subspan(32));
    while (!again.step().finished) {
    }
    EXPECT_EQ(again.digest(), run.localizer.digest());
  }
  EXPECT_GT(ends[static_cast<int>(LocalizationStatus::kConverged)], 5);
  EXPECT_EQ(ends[static_cast<int>(LocalizationStatus::kFault)], 0);
}

}  // namespace
}  // namespace boresight::test
