// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include "app/commands.h"
#include "sessions/record/compare_records.h"

namespace boresight::app {
namespace {

struct CompareArguments {
  std::string one;
  std::string other;
  sessions::ComparisonLimits limits;
};

int compare(const CompareArguments& arguments) {
  const sessions::OnboardRecord one = sessions::readRecord(arguments.one);
  const sessions::OnboardRecord other = sessions::readRecord(arguments.other);
  const sessions::RecordComparison found = sessions::compareRecords(one, other, arguments.limits);
  std::cout << sessions::comparisonText(found);
  switch (found.verdict) {
    case sessions::RunVerdict::kEqual:
      return kDone;
    case sessions::RunVerdict::kWithinLimits:
      return kWithinLimits;
    case sessions::RunVerdict::kDifferent:
      break;
  }
  return kDifferent;
}

}  // namespace

void addCompare(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "compare",
      "Compares two onboard records (run.whsr): equal to the bit (exit 0), within limits where the "
      "pixels differ or a record was cut (5), or different (6), and where they differ first");
  auto arguments = std::make_shared<CompareArguments>();
  command->add_option("A", arguments->one, "run.whsr")->required()->type_name("FILE");
  command->add_option("B", arguments->other, "run.whsr")->required()->type_name("FILE");
  sessions::ComparisonLimits& limits = arguments->limits;
  command
      ->add_option("--found-px", limits.found_px,
                   "Templates found this near each other count as found alike, px at their level")
      ->capture_default_str();
  command->add_option("--found-share", limits.found_share, "Least share of these, 0 to 1")
      ->capture_default_str();
  command
      ->add_option("--inlier-share", limits.inlier_share,
                   "Least share of the inliers of either that both have, 0 to 1")
      ->capture_default_str();
  command
      ->add_option("--sigmas", limits.pose_sigmas,
                   "Most that the final poses may be apart, in sigmas of A's covariance")
      ->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = compare(*arguments); });
}

}  // namespace boresight::app
