// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/remedies.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <QCoreApplication>
#include <QStringList>

#include "sessions/trace/run_headline.h"

namespace boresight::ui {
namespace {

constexpr Remedy kWider = {Step::kWiderSearch,
                           QT_TR_NOOP("The seed looks turned about the view axis")};
constexpr Remedy kNudge = {Step::kNudgeSeed, QT_TR_NOOP("The seed looks right, but displaced")};
constexpr Remedy kFarther = {
    Step::kUncertainty,
    QT_TR_NOOP(
        "Matches lie at the border of what was searched: the seed is farther off than stated")};
constexpr Remedy kMasked = {
    Step::kMask, QT_TR_NOOP("Something hides part of the station, or print and shadows add edges")};
constexpr Remedy kMarks = {Step::kAnnotate,
                           QT_TR_NOOP("Nothing else helps: four marked points give a seed")};
constexpr Remedy kSheet = {
    Step::kInputs, QT_TR_NOOP("Mesh, unit, camera or calibration may be wrong: see the warnings")};
constexpr Remedy kOthers = {
    Step::kCompetingPoses,
    QT_TR_NOOP("The station repeats itself: another pose explains the image as well")};

const std::vector<Remedy>& likeliestFor(const sessions::LocalizationTrace& trace) {
  static const std::vector<Remedy> kNothing;
  static const std::vector<Remedy> kTurned = {kWider, kNudge, kMasked, kFarther, kMarks, kSheet};
  static const std::vector<Remedy> kFar = {kFarther, kNudge, kMarks, kSheet};
  static const std::vector<Remedy> kFew = {kNudge, kWider, kMasked, kMarks, kSheet};
  static const std::vector<Remedy> kAmbiguous = {kOthers, kNudge, kMarks, kSheet};
  static const std::vector<Remedy> kInput = {kSheet, kMasked, kMarks};
  if (!trace.finished || trace.converged()) return kNothing;
  switch (trace.status) {
    case LocalizationStatus::kNotSupported:
      return kTurned;
    case LocalizationStatus::kLeftUncertainty:
      return kFar;
    case LocalizationStatus::kAmbiguous:
      return kAmbiguous;
    case LocalizationStatus::kBlurred:
    case LocalizationStatus::kCameraMismatch:
    case LocalizationStatus::kFault:
      return kInput;
    default:
      return kFew;
  }
}

/// As a part of "Tried: ..."; empty for what only shows something.
const char* doneText(Step step) {
  switch (step) {
    case Step::kWiderSearch:
      return QT_TRANSLATE_NOOP("Remedies", "wider search");
    case Step::kNudgeSeed:
      return QT_TRANSLATE_NOOP("Remedies", "nudged seed");
    case Step::kMask:
      return QT_TRANSLATE_NOOP("Remedies", "mask");
    case Step::kUncertainty:
      return QT_TRANSLATE_NOOP("Remedies", "stated uncertainty");
    case Step::kAnnotate:
      return QT_TRANSLATE_NOOP("Remedies", "annotations");
    default:
      return "";
  }
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
  for (const Taken& taken : found->second)
    if (taken.digest != digest) steps.push_back(taken.step);
  return steps;
}

}  // namespace boresight::ui
