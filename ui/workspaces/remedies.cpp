// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/remedies.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <QCoreApplication>
#include <QStringList>

#include "sessions/trace/doubtful_pose.h"
#include "sessions/trace/run_text.h"

namespace boresight::ui {
namespace {

constexpr Remedy kWider = {Step::kWiderSearch, "The seed looks turned about the view axis"};
constexpr Remedy kNudge = {Step::kNudgeSeed, "The seed looks right, but displaced"};
constexpr Remedy kFarther = {
    Step::kUncertainty,
    "Matches lie at the border of what was searched: the seed is farther off than stated"};
constexpr Remedy kMasked = {Step::kMask,
                            "Something hides part of the station, or print and shadows add edges"};
constexpr Remedy kMarks = {Step::kAnnotate, "Nothing else helps: four marked points give a seed"};
constexpr Remedy kFromPose = {Step::kAnnotateFromPose,
                              "The pose may be right: part of the station is hidden or missing"};
constexpr Remedy kSheet = {Step::kInputs,
                           "Mesh, unit, camera or calibration may be wrong: see the warnings"};
constexpr Remedy kOthers = {Step::kCompetingPoses,
                            "The station repeats itself: another pose explains the image as well"};

std::vector<Remedy> likeliestFor(const sessions::LocalizationTrace& trace) {
  if (!trace.finished || trace.converged()) return {};
  switch (trace.status) {
    case LocalizationStatus::kNotSupported:
      if (sessions::doubtfulPose(trace))
        return {kFromPose, kMasked, kNudge, kWider, kFarther, kSheet};
      return {kWider, kNudge, kMasked, kFarther, kMarks, kSheet};
    case LocalizationStatus::kLeftUncertainty:
      return {kFarther, kNudge, kMarks, kSheet};
    case LocalizationStatus::kAmbiguous:
      return {kOthers, kNudge, kMarks, kSheet};
    case LocalizationStatus::kBlurred:
    case LocalizationStatus::kCameraMismatch:
    case LocalizationStatus::kFault:
      return {kSheet, kMasked, kMarks};
    default:
      return {kNudge, kWider, kMasked, kMarks, kSheet};
  }
}

/// As a part of "Tried: ..."; empty for a step that only shows something.
const char* doneText(Step step) {
  static constexpr std::pair<Step, const char*> kTexts[] = {
      {Step::kWiderSearch, QT_TRANSLATE_NOOP("Remedies", "wider search")},
      {Step::kNudgeSeed, QT_TRANSLATE_NOOP("Remedies", "nudged seed")},
      {Step::kMask, QT_TRANSLATE_NOOP("Remedies", "mask")},
      {Step::kUncertainty, QT_TRANSLATE_NOOP("Remedies", "stated uncertainty")},
      {Step::kAnnotate, QT_TRANSLATE_NOOP("Remedies", "annotations")},
      {Step::kAnnotateFromPose, QT_TRANSLATE_NOOP("Remedies", "annotations")},
  };
  for (const auto& [done, text] : kTexts)
    if (done == step) return text;
  return "";
}

}  // namespace

std::vector<Remedy> remediesFor(const sessions::LocalizationTrace& trace,
                                const std::vector<Step>& tried) {
  std::vector<Remedy> remedies = likeliestFor(trace);
  for (Remedy& remedy : remedies)
    remedy.tried = std::ranges::count(tried, remedy.step) > 0 ||
                   (remedy.step == Step::kWiderSearch && sessions::searchedEveryTurn(trace));
  std::stable_partition(remedies.begin(), remedies.end(),
                        [](const Remedy& remedy) { return !remedy.tried; });
  return remedies;
}

Step stepOfCheck(const std::string& check_id) {
  static constexpr std::pair<std::string_view, Step> kSteps[] = {
      {"convergence_", Step::kCompetingPoses},
      {"matches_at_border", Step::kUncertainty},
      {"image_saturated", Step::kMask},
      {"image_", Step::kInputs},
      {"camera_", Step::kInputs},
      {"mesh_scale", Step::kInputs},
      {"agreement_annotation", Step::kAnnotate},
      {"agreement_onboard", Step::kFirstDifference},
  };
  for (const auto& [beginning, step] : kSteps)
    if (check_id.starts_with(beginning)) return step;
  return Step::kInspect;  // of the run itself: its matches and edges
}

QString triedText(const std::vector<Remedy>& remedies) {
  QStringList names;
  for (const Remedy& remedy : remedies)
    if (remedy.tried) names << QCoreApplication::translate("Remedies", doneText(remedy.step));
  return names.join(QStringLiteral(", "));
}

/// What only shows something is no attempt.
void RemedyMemory::note(const std::string& case_id, const std::string& digest, Step step) {
  if (*doneText(step) != '\0') taken_[case_id].push_back({digest, step});
}

std::vector<Step> RemedyMemory::before(const std::string& case_id,
                                       const std::string& digest) const {
  std::vector<Step> steps;
  const auto found = taken_.find(case_id);
  if (found == taken_.end()) return steps;
  for (const auto& [failed, step] : found->second)
    if (failed != digest) steps.push_back(step);
  return steps;
}

}  // namespace boresight::ui
