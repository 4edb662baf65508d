// SPDX-License-Identifier: Apache-2.0
#include <iomanip>
#include <sstream>

#include "sessions/record/compare_records.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {

const char* runPartText(RunPart part) {
  constexpr const char* kTexts[] = {"pixels",  "mask",     "scene",   "camera",    "seed",
                                    "options", "edge map", "render",  "templates", "matches",
                                    "inliers", "pose",     "support", "end",       "digest"};
  return kTexts[static_cast<std::size_t>(part)];
}

std::string comparisonText(const RecordComparison& comparison) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(3);
  if (comparison.verdict == RunVerdict::kEqual)
    text << "equal to the bit\n";
  else if (comparison.verdict == RunVerdict::kDifferent)
    text << "different\n";
  else
    text << (comparison.first ? "not the same, but within the limits\n"
                              : "equal to the bit as far as the records go\n");
  if (comparison.first)
    text << plainLine("first difference: " + std::string(runPartText(comparison.first->part)) +
                      ": " + comparison.first->text);
  for (const std::string& sentence : comparison.beyond)
    text << plainLine("beyond limits: " + sentence);
  for (const std::string& sentence : comparison.missing) text << plainLine("missing: " + sentence);
  if (comparison.verdict == RunVerdict::kEqual) return text.str();
  text << "iteration  templates  found alike  inliers either  both  apart mm    mrad\n";
  for (const IterationComparison& one : comparison.iterations)
    text << std::setw(9) << one.index + 1 << std::setw(11) << one.templates << std::setw(13)
         << one.found_alike << std::setw(16) << one.inliers_either << std::setw(6)
         << one.inliers_both << std::setw(10) << one.translation_mm << std::setw(8)
         << one.rotation_mrad << "\n";
  text << "final poses: " << comparison.translation_mm << " mm and " << comparison.rotation_mrad
       << " mrad apart";
  if (comparison.pose_sigmas) text << ", " << *comparison.pose_sigmas << " sigmas";
  text << "\n";
  return text.str();
}

}  // namespace boresight::sessions
