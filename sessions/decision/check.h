// SPDX-License-Identifier: Apache-2.0
// Checks of a pose before its validation.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace boresight::sessions {

enum class CheckState {
  kPassed,
  kFailed,
  kNotApplicable,  ///< no data to check it (no truth, no annotation, not measured)
};
/// "passed", "failed", "not applicable".
const char* checkStateText(CheckState state);

/// Side of the limit on which a figure passes.
enum class LimitSide { kAtMost, kAtLeast };

struct Check {
  std::string id;     ///< stable, as files name it: "converged", "covariance_normal"
  std::string title;  ///< for display: "Sigma along the view axis"
  CheckState state = CheckState::kNotApplicable;
  std::optional<double> figure;  ///< in `unit`; empty where it is not a number
  std::optional<double> limit;   ///< in `unit`
  LimitSide side = LimitSide::kAtMost;
  std::string unit;      ///< "mm", "mrad", "px", "%", or empty
  std::string sentence;  ///< finding and meaning; for a failed check, also what to do

  bool operator==(const Check&) const = default;
};

/// The figure with its unit: "0.12 mm"; "" where there is none.
std::string foundText(const Check& check);
/// "at most 0.40 mm"; "" where there is no limit.
std::string limitText(const Check& check);
/// "0.12 mm (at most 0.40 mm)"; foundText() when figure or limit is missing.
std::string figureText(const Check& check);

int countOf(std::span<const Check> checks, CheckState state);
/// Whether no check has failed and at least one has passed.
bool allPassed(std::span<const Check> checks);

/// Id and displayed name of a check.
struct CheckName {
  const char* id;
  const char* title;
};

/// A figure against its limit. `found` is a sentence on the finding, `remedy` one that follows it
/// when the check fails. A figure that is not finite fails and is not stored.
Check measuredCheck(const CheckName& name, const std::string& unit, double figure, double limit,
                    LimitSide side, const std::string& found, const std::string& remedy);

/// A check without a figure.
Check statedCheck(const CheckName& name, bool passed, const std::string& found,
                  const std::string& remedy);

/// A check that is not applicable; `why` is a sentence.
Check notAskedCheck(const CheckName& name, const std::string& why);

/// Adds a check that is not applicable for each of these names.
void addNotAsked(const std::vector<CheckName>& names, const std::string& why,
                 std::vector<Check>& checks);

/// A number for a sentence: three significant digits, no exponent where it can be avoided.
std::string sentenceNumber(double value);

/// A readable table: state, check and figure, the sentence of each check that failed or is not
/// applicable, and the counts of the states. With `all_sentences` every check's sentence follows
/// it.
std::string checksText(std::span<const Check> checks, bool all_sentences = false);

/// "22 passed, 1 failed, 5 not applicable".
std::string checkCountsText(std::span<const Check> checks);

}  // namespace boresight::sessions
