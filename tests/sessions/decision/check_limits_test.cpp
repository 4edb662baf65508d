// SPDX-License-Identifier: Apache-2.0
#include "sessions/decision/check_limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

/// Sessions store limits as differences from a preset: another value in a preset would change the
/// limits of every stored session.
TEST(CheckPresets, Limits_AreThoseOfStoredSessions) {
  const auto differences = [](const std::string& preset) {
    return changedOptions(checkLimits(preset, {}), CheckLimits());
  };
  EXPECT_EQ(differences("sample_transfer"), (OptionList{{"check.evidence_percent", 70.0}}));
  EXPECT_EQ(differences("photographs"), (OptionList{{"check.inlier_ratio_percent", 14.0},
                                                    {"check.coverage_percent", 25.0},
                                                    {"check.clutter_percent", 97.0},
                                                    {"check.evidence_percent", 25.0},
                                                    {"check.fall_off_percent", 8.0},
                                                    {"check.convergence_percent", 30.0}}));
}

TEST(CheckPresets, Requirement_IsThatOfItsHelp) {
  const Requirement& transfer = findCheckPreset("sample_transfer")->requirement;
  EXPECT_EQ(transfer, (Requirement{0.4, 0.4, 0.25, std::nullopt}));
  EXPECT_THAT(findCheckPreset("sample_transfer")->help, HasSubstr("0.4 mm and 0.25 deg"));
  EXPECT_EQ(findCheckPreset("photographs")->requirement,
            (Requirement{std::nullopt, std::nullopt, std::nullopt, 5.0}));
}

TEST(CheckPresets, EachName_IsFoundAndTheDefaultComesFirst) {
  EXPECT_EQ(checkPresets().front().name, kDefaultCheckPreset);
  EXPECT_EQ(ReviewSettings().preset, kDefaultCheckPreset);
  for (const CheckPreset& preset : checkPresets()) {
    EXPECT_EQ(findCheckPreset(preset.name), &preset);
    EXPECT_THAT(preset.help, testing::EndsWith("."));
    for (const OptionDescription& limit : listOptions(preset.limits))
      EXPECT_EQ(checkedValue(limit, limit.value), limit.value) << limit.name << ": in its range";
  }
  EXPECT_EQ(findCheckPreset("Photographs"), nullptr);
  EXPECT_EQ(findCheckPreset(""), nullptr);
}

TEST(CheckPresets, PresetForARequirement_LimitsTheSameFigures) {
  const auto preset = [](const Requirement& requirement) { return presetFor(requirement).name; };
  EXPECT_EQ(preset({9.0, 8.0, 7.0, std::nullopt}), "sample_transfer");
  EXPECT_EQ(preset({std::nullopt, std::nullopt, std::nullopt, 0.1}), "photographs");
  EXPECT_EQ(preset({}), "sample_transfer") << "the default, where none limits these";
  EXPECT_EQ(preset({std::nullopt, std::nullopt, 1.0, 5.0}), "sample_transfer");
}

TEST(CheckLimitsTest, Changes_ApplyOnTopOfThePreset) {
  const CheckLimits limits =
      checkLimits("photographs", {{"check.sigmas", 2.0}, {"check.range_gray", std::int64_t{5}}});
  CheckLimits expected = findCheckPreset("photographs")->limits;
  expected.sigmas = 2.0;
  expected.range_gray = 5.0;
  EXPECT_THAT(changedOptions(limits, expected), IsEmpty());
}

TEST(CheckLimitsTest, UnknownPresetOrLimit_IsRefused) {
  EXPECT_THROW((void)checkLimits("none", {}), std::invalid_argument);
  EXPECT_THROW((void)withPreset({}, "none"), std::invalid_argument);
  EXPECT_THROW((void)withLimits({"none", {}, false}, CheckLimits()), std::invalid_argument);
  EXPECT_THROW((void)checkLimits("photographs", {{"check.sigma", 2.0}}), OptionError);
  EXPECT_THROW((void)checkLimits("photographs", {{"check.sigmas", -1.0}}), OptionError);
}

TEST(CheckLimitsTest, OtherPreset_DropsTheChangesAndKeepsTheSecondPerson) {
  for (const bool second_person : {false, true}) {
    const ReviewSettings before{"sample_transfer", {{"check.sigmas", 2.0}}, second_person};
    EXPECT_EQ(withPreset(before, "photographs"),
              (ReviewSettings{"photographs", {}, second_person}));
  }
}

/// Whatever the limits are: their differences from a preset give them again, in alphabetical order.
TEST(CheckLimitsTest, DifferencesFromAPreset_GiveTheLimits) {
  Random random = test::randomFor("CheckLimits.Differences");
  for (int trial = 0; trial < 40; ++trial) {
    CheckLimits limits = checkPresets()[random.below(2)].limits;
    CheckLimits::visitFields(limits, [&random](const OptionInfo& info, double& limit) {
      if (random.below(3) == 0) limit = random.uniform(info.minimum, info.maximum);
    });
    const ReviewSettings before{
        checkPresets()[random.below(2)].name, {{"check.sigmas", 9.0}}, random.below(2) == 0};
    const ReviewSettings after = withLimits(before, limits);
    EXPECT_EQ(after.preset, before.preset);
    EXPECT_EQ(after.second_person, before.second_person);
    EXPECT_TRUE(std::ranges::is_sorted(after.limits));
    EXPECT_THAT(changedOptions(checkLimits(after.preset, after.limits), limits), IsEmpty());
  }
  for (const CheckPreset& preset : checkPresets())
    EXPECT_THAT(withLimits({preset.name, {}, false}, preset.limits).limits, IsEmpty());
}

}  // namespace
}  // namespace boresight::sessions
