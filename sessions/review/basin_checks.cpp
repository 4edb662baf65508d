// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/basin_checks.h"

#include <algorithm>
#include <string>

#include "sessions/review/check_making.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kReturned{"basin_returned", "Other seeds lead back"};
/// Of coverage over none at all.
constexpr double kNothingSeen = 10.0;
constexpr CheckName kRival{"basin_rival", "The best of other answers"};

std::string foundText(const BasinResult& basin) {
  const auto elsewhere = std::count_if(basin.rivals.begin(), basin.rivals.end(),
                                       [](const RivalPose& one) { return !one.mirrored; });
  return "Of " + std::to_string(basin.seeds) + " other seeds " + std::to_string(basin.returned) +
         " led back to this pose and " + std::to_string(elsewhere) + " to another one.";
}

/// A worse one elsewhere does not speak against the pose: a nearly symmetric station has many.
Check rivalCheck(const BasinResult& basin, const CheckLimits& limits) {
  const auto best = std::max_element(
      basin.rivals.begin(), basin.rivals.end(),
      [](const RivalPose& a, const RivalPose& b) { return a.coverage < b.coverage; });
  if (best == basin.rivals.end() && basin.returned == 0)
    return notAskedCheck(kRival,
                         "No other seed came to a pose that this one could be set against.");
  if (best == basin.rivals.end())
    return statedCheck(kRival, true, "No other pose and no mirror image of the station fits.", "");
  const std::string what = best->mirrored ? "a mirror image of the station" : "another pose";
  const double ratio = basin.coverage > 0.0 ? best->coverage / basin.coverage : kNothingSeen;
  return measuredCheck(
      kRival, "%", 100.0 * ratio, limits.rival_percent, LimitSide::kAtMost,
      "This pose shows " + percentText(basin.coverage) + " of its predicted edges, " + what + " " +
          percentText(best->coverage) + ".",
      best->mirrored ? "The mesh is mirrored, or another thing's."
                     : "The other one fits better: run from there, and compare overlays.");
}

}  // namespace

bool isBasinCheck(const std::string& check_id) {
  return check_id == kReturned.id || check_id == kRival.id;
}

void addBasinChecks(const std::optional<BasinResult>& basin, const CheckLimits& limits,
                    std::vector<Check>& checks) {
  if (!basin || basin->seeds == 0) {
    const char* why = "No other seeds were run: a second answer to this image is not excluded.";
    checks.push_back(notAskedCheck(kReturned, why));
    checks.push_back(notAskedCheck(kRival, why));
    return;
  }
  checks.push_back(measuredCheck(kReturned, "%", 100.0 * basin->returned / basin->seeds,
                                 limits.basin_percent, LimitSide::kAtLeast, foundText(*basin),
                                 "The pose is hard to find: the seed may have been luck. Compare "
                                 "with marks, or with another image."));
  checks.push_back(rivalCheck(*basin, limits));
}

}  // namespace boresight::sessions
