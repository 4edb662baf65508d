// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/localizer_options.h"
#include "core/base/random.h"
#include "core/localizer/localizer.h"
#include "core/localizer/run_digest.h"
#include "tests/core/localizer/random_options.h"
#include "tests/core/localizer/scene.h"
#include "tests/support/not_finite.h"

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>

#include <gtest/gtest.h>

namespace boresight::test {
namespace {

/// The number of fields that are visited. Others would show as bytes that padding cannot explain:
/// each run of small fields is padded to eight bytes at most.
template <class Options>
int visitedFields() {
  Options options;
  int count = 0;
  std::size_t bytes = 0, padding = 8, run = 0;
  Options::visitFields(options, [&](const OptionInfo&, const auto& field) {
    ++count;
    bytes += sizeof(field);
    if (sizeof(field) >= 8 && run > 0) padding += 8;
    run = sizeof(field) < 8 ? run + sizeof(field) : 0;
  });
  EXPECT_LE(bytes, sizeof(Options));
  EXPECT_LT(sizeof(Options), bytes + padding + 8);
  return count;
}

TEST(LocalizerOptions, EveryFieldIsVisited) {
  int all = 0;
  LocalizerOptions options;
  LocalizerOptions::visitFields(options, [&](const OptionInfo&, const auto&) { ++all; });
  EXPECT_EQ(all, visitedFields<EdgeOptions>() + visitedFields<RenderOptions>() +
                     visitedFields<TemplateOptions>() + visitedFields<PnpOptions>() +
                     visitedFields<LoopOptions>() + visitedFields<RefinementOptions>() +
                     visitedFields<SupportOptions>() + visitedFields<SearchOptions>());
}

Digest optionsDigest(const LocalizerOptions& options) {
  DigestWriter writer;
  digestOptions(options, writer);
  return writer.digest();
}

/// Except colour: the problem's digest shows whether a run uses it.
TEST(LocalizerOptions, EachOption_ChangesTheDigest) {
  LocalizerOptions options = defaultProfile();
  std::set<Digest> digests = {optionsDigest(options)};
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

TEST(LocalizerOptions, AreDescribedAndVisitedOnce) {
  LocalizerOptions options;
  std::set<const void*> places;
  std::set<std::string> names;
  LocalizerOptions::visitFields(options, [&](const OptionInfo& info, const auto& field) {
    const std::string name = info.name;
    EXPECT_TRUE(places.insert(&field).second) << name;
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_NE(name.find('.'), std::string::npos) << name;
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_."), std::string::npos)
        << name;
    EXPECT_LT(info.minimum, info.maximum) << name;
    const std::string help = info.help;
    EXPECT_GT(help.size(), 8u) << name;
    EXPECT_EQ(help.back(), '.') << name;
    EXPECT_EQ(std::is_enum_v<std::remove_cvref_t<decltype(field)>>, !info.choices.empty()) << name;
    if (info.choices.empty()) return;
    EXPECT_EQ(info.minimum, 0.0) << name;
    EXPECT_EQ(info.maximum, static_cast<double>(info.choices.size() - 1)) << name;
  });
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
           {kNan, kInfinity, -kInfinity, info.minimum - 1e-3, info.maximum + 1e-3}) {
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
  Mask mask(131, 97);
  mask.fill(0, 0, 50, 40);
  Random random(77);
  std::map<LocalizationStatus, int> ends;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const LocalizerOptions options = randomOptions(random);
    ASSERT_EQ(firstInvalidOption(options), nullptr) << firstInvalidOption(options);
    Case scene = smallCase(static_cast<std::uint64_t>(i));
    if (i % 4 == 0) scene.ignore = &mask.bits;
    const FinishedRun run(scene, options);
    EXPECT_EQ(run.localizer.highWaterBytes(), run.memory.size());
    EXPECT_NE(run.workspace.status, LocalizationStatus::kRunning);
    EXPECT_TRUE(run.workspace.camera_from_station.isFinite());
    EXPECT_TRUE(run.workspace.covariance.allFinite());
    ++ends[run.workspace.status];
    if (i % 3 != 0) continue;
    std::vector<std::byte> other(run.memory.size() + 48, std::byte{0xFF});
    Localizer again(scene.problem(), options, std::span(other).subspan(32));
    while (!again.step().finished) {
    }
    EXPECT_EQ(again.digest(), run.localizer.digest());
  }
  EXPECT_GT(ends[LocalizationStatus::kConverged], 5);
  EXPECT_EQ(ends[LocalizationStatus::kFault], 0);
}

}  // namespace
}  // namespace boresight::test
