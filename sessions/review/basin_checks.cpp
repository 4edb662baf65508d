// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/basin_checks.h"

#include <string>

#include "sessions/review/check_making.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kReturned{"basin_returned", "Other seeds lead back"};
constexpr CheckName kElsewhere{"basin_elsewhere", "Other seeds that lead elsewhere"};

}  // namespace

void addBasinChecks(const std::optional<BasinResult>& basin, const CheckLimits& limits,
                    std::vector<Check>& checks) {
  if (!basin || basin->seeds == 0) {
    const char* why = "No other seeds were run.";
    checks.push_back(notAskedCheck(kReturned, why));
    checks.push_back(notAskedCheck(kElsewhere, why));
    return;
  }
  const std::string found = "Of " + std::to_string(basin->seeds) + " other seeds " +
                            std::to_string(basin->returned) + " led back to this pose and " +
                            std::to_string(basin->elsewhere.size()) + " to another one.";
  checks.push_back(measuredCheck(kReturned, "%", 100.0 * basin->returned / basin->seeds,
                                 limits.basin_percent, LimitSide::kAtLeast, found,
                                 "The pose is hard to find: the seed may have been luck. Compare "
                                 "with marks, or with another image."));
  checks.push_back(measuredCheck(kElsewhere, "", static_cast<double>(basin->elsewhere.size()), 0.0,
                                 LimitSide::kAtMost, found,
                                 "The image has two answers: compare their overlays before you "
                                 "trust either."));
}

}  // namespace boresight::sessions
