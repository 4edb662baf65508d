// SPDX-License-Identifier: Apache-2.0
#include "sessions/decision/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kName{"width", "Width"};
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Check measured(double figure, double limit, LimitSide side) {
  return measuredCheck(kName, "mm", figure, limit, side, "It is so wide.", "Look again.");
}

TEST(MeasuredCheck, FigureAtTheLimit_PassesAndOneBeyondFails) {
  for (const double limit : {-2.5, 0.0, 0.4, 9000.0}) {
    const double above = std::nextafter(limit, kInfinity);
    const double below = std::nextafter(limit, -kInfinity);
    for (const auto& [figure, side, state] :
         {std::tuple(limit, LimitSide::kAtMost, CheckState::kPassed),
          std::tuple(below, LimitSide::kAtMost, CheckState::kPassed),
          std::tuple(above, LimitSide::kAtMost, CheckState::kFailed),
          std::tuple(limit, LimitSide::kAtLeast, CheckState::kPassed),
          std::tuple(above, LimitSide::kAtLeast, CheckState::kPassed),
          std::tuple(below, LimitSide::kAtLeast, CheckState::kFailed)}) {
      const Check check = measured(figure, limit, side);
      EXPECT_EQ(check.state, state) << figure << " of " << limit;
      EXPECT_EQ(check.figure, figure);
      EXPECT_EQ(check.limit, limit);
      EXPECT_EQ(check.side, side);
      EXPECT_EQ(check.unit, "mm");
    }
  }
}

TEST(MeasuredCheck, FigureThatIsNotFinite_FailsOnEitherSideAndIsNotStored) {
  for (const double figure : {std::nan(""), kInfinity, -kInfinity})
    for (const LimitSide side : {LimitSide::kAtMost, LimitSide::kAtLeast}) {
      const Check check = measured(figure, 1.0, side);
      EXPECT_EQ(check.state, CheckState::kFailed) << figure;
      EXPECT_FALSE(check.figure);
      EXPECT_EQ(foundText(check), "");
      EXPECT_EQ(figureText(check), "");
    }
}

TEST(StatedCheck, Sentence_HasTheRemedyOnlyWhenItFails) {
  const Check passed = statedCheck(kName, true, "It is wide.", "Look again.");
  EXPECT_EQ(passed.id, "width");
  EXPECT_EQ(passed.title, "Width");
  EXPECT_EQ(passed.state, CheckState::kPassed);
  EXPECT_EQ(passed.sentence, "It is wide.");
  EXPECT_FALSE(passed.figure || passed.limit);
  const Check failed = statedCheck(kName, false, "It is narrow.", "Look again.");
  EXPECT_EQ(failed.state, CheckState::kFailed);
  EXPECT_EQ(failed.sentence, "It is narrow. Look again.");
  EXPECT_EQ(statedCheck(kName, false, "It is narrow.", "").sentence, "It is narrow.");
}

TEST(NotAskedCheck, EachName_IsAddedWithTheReason) {
  std::vector<Check> checks = {statedCheck(kName, true, "It is wide.", "")};
  addNotAsked({{"truth", "Truth"}, {"rig", "Rig"}}, "Not run.", checks);
  ASSERT_EQ(checks.size(), 3u);
  EXPECT_EQ(checks[1], notAskedCheck({"truth", "Truth"}, "Not run."));
  EXPECT_EQ(checks[2].id, "rig");
  EXPECT_EQ(checks[2].title, "Rig");
  EXPECT_EQ(checks[2].state, CheckState::kNotApplicable);
  EXPECT_EQ(checks[2].sentence, "Not run.");
}

TEST(FigureText, HasUnitAndLimitWhereTheyAreKnown) {
  Check check = measured(0.12345, 0.4, LimitSide::kAtMost);
  EXPECT_EQ(foundText(check), "0.123 mm");
  EXPECT_EQ(limitText(check), "at most 0.4 mm");
  EXPECT_EQ(figureText(check), "0.123 mm (at most 0.4 mm)");
  check.side = LimitSide::kAtLeast;
  check.unit = "";
  EXPECT_EQ(figureText(check), "0.123 (at least 0.4)");
  check.limit.reset();
  EXPECT_EQ(limitText(check), "");
  EXPECT_EQ(figureText(check), "0.123");
  check.figure.reset();
  check.limit = 0.4;
  EXPECT_EQ(figureText(check), "") << "a limit without a figure";
  EXPECT_EQ(limitText(check), "at least 0.4");
}

TEST(FigureText, NumbersBelowAMillion_HaveNoExponent) {
  Check check;
  for (const auto& [figure, text] :
       {std::pair(999.4, "999"), std::pair(999.7, "1000"), std::pair(1000.0, "1000"),
        std::pair(-1000.4, "-1000"), std::pair(9000.0, "9000"), std::pair(123456.0, "123456"),
        std::pair(1e6, "1e+06"), std::pair(-0.5, "-0.5"), std::pair(0.0, "0")}) {
    check.figure = figure;
    EXPECT_EQ(foundText(check), text);
  }
}

TEST(SentenceNumber, HasThreeDigitsAndAtMostFourDecimals) {
  for (const auto& [value, text] :
       {std::pair(12345.0, "12345"), std::pair(250.4, "250"), std::pair(100.0, "100"),
        std::pair(99.94, "99.9"), std::pair(10.0, "10.0"), std::pair(-5.0, "-5.00"),
        std::pair(1.0, "1.00"), std::pair(0.1, "0.100"), std::pair(0.01234, "0.0123"),
        std::pair(0.00126, "0.0013"), std::pair(0.0, "0.0000")})
    EXPECT_EQ(sentenceNumber(value), text);
}

std::vector<Check> withStates(int passed, int failed, int not_applicable) {
  std::vector<Check> checks;
  const auto add = [&checks](int count, CheckState state) {
    for (int i = 0; i < count; ++i) checks.emplace_back().state = state;
  };
  add(not_applicable, CheckState::kNotApplicable);
  add(failed, CheckState::kFailed);
  add(passed, CheckState::kPassed);
  return checks;
}

TEST(CheckCounts, AllPassed_NeedsOnePassedAndNoneFailed) {
  for (int passed = 0; passed < 3; ++passed)
    for (int failed = 0; failed < 3; ++failed)
      for (int not_applicable = 0; not_applicable < 3; ++not_applicable) {
        const std::vector<Check> checks = withStates(passed, failed, not_applicable);
        EXPECT_EQ(countOf(checks, CheckState::kPassed), passed);
        EXPECT_EQ(countOf(checks, CheckState::kFailed), failed);
        EXPECT_EQ(countOf(checks, CheckState::kNotApplicable), not_applicable);
        EXPECT_EQ(allPassed(checks), passed > 0 && failed == 0) << checkCountsText(checks);
      }
  EXPECT_EQ(checkCountsText(withStates(22, 1, 5)), "22 passed, 1 failed, 5 not applicable");
}

TEST(ChecksText, AlignsFiguresAndExplainsWhatDidNotPass) {
  const std::vector<Check> checks = {
      measuredCheck({"a", "A"}, "mm", 1.0, 2.0, LimitSide::kAtMost, "Near.", "Look."),
      measuredCheck({"b", "Longest"}, "", 3.0, 4.0, LimitSide::kAtLeast, "Too few.", "Look."),
      statedCheck({"c", "C"}, true, "Found.", ""), notAskedCheck({"d", "D"}, "No truth.")};
  EXPECT_EQ(checksText(checks),
            "pass  A        1 mm (at most 2 mm)\n"
            "FAIL  Longest  3 (at least 4)\n"
            "      Too few. Look.\n"
            "pass  C\n"
            "  -   D\n"
            "      No truth.\n"
            "2 passed, 1 failed, 1 not applicable\n");
  EXPECT_EQ(checksText(checks, true),
            "pass  A        1 mm (at most 2 mm)\n"
            "      Near.\n"
            "FAIL  Longest  3 (at least 4)\n"
            "      Too few. Look.\n"
            "pass  C\n"
            "      Found.\n"
            "  -   D\n"
            "      No truth.\n"
            "2 passed, 1 failed, 1 not applicable\n");
  EXPECT_EQ(checksText({}), "0 passed, 0 failed, 0 not applicable\n");
}

TEST(CheckStateText, EachState_HasItsText) {
  EXPECT_STREQ(checkStateText(CheckState::kPassed), "passed");
  EXPECT_STREQ(checkStateText(CheckState::kFailed), "failed");
  EXPECT_STREQ(checkStateText(CheckState::kNotApplicable), "not applicable");
}

}  // namespace
}  // namespace boresight::sessions
