// SPDX-License-Identifier: Apache-2.0
#include <iomanip>
#include <sstream>

#include "sessions/record/compare_records.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {

const char* runPartText(RunPart part) {
  switch (part) {
    case RunPart::kPixels:
      return "pixels";
    case RunPart::kMask:
      return "mask";
    case RunPart::kScene:
      return "scene";
    case RunPart::kCamera:
      return "camera";
    case RunPart::kSeed:
      return "seed";
    case RunPart::kOptions:
      return "options";
    case RunPart::kEdges:
      return "edge map";
    case RunPart::kRender:
      return "render";
    case RunPart::kTemplates:
      return "templates";
    case RunPart::kMatches:
      return "matches";
    case RunPart::kInliers:
      return "inliers";
    case RunPart::kPose:
      return "pose";
    case RunPart::kSupport:
      return "support";
    case RunPart::kEnd:
      return "end";
    case RunPart::kDigest:
      return "digest";
  }
  return "";
}

std::string comparisonText(const RecordComparison& comparison) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(3);
  switch (comparison.verdict) {
    case RunVerdict::kEqual:
      text << "equal to the bit\n";
      break;
    case RunVerdict::kWithinLimits:
      text << (comparison.first ? "not the same, but within the limits\n"
                                : "equal to the bit as far as the records go\n");
      break;
    case RunVerdict::kDifferent:
      text << "different\n";
      break;
  }
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
