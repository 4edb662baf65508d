// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/remedies.h"

#include <QCoreApplication>

namespace boresight::ui {
namespace {

#define CAUSE(text) QT_TRANSLATE_NOOP("Remedies", text)

constexpr Remedy kWider = {
    Step::kWiderSearch, CAUSE("The seed's edges look turned: slots and clamps are elsewhere")};
constexpr Remedy kNudge = {Step::kNudgeSeed,
                           CAUSE("The seed's edges look like the image, but displaced")};
constexpr Remedy kFarther = {
    Step::kUncertainty,
    CAUSE("Arrows agree but end at window borders: the seed is farther off than stated")};
constexpr Remedy kMasked = {
    Step::kMask, CAUSE("Part of the station is hidden, or edges are everywhere: print, shadows")};
constexpr Remedy kMarks = {Step::kAnnotate,
                           CAUSE("Nothing is known of the pose: four points give a seed")};
constexpr Remedy kSheet = {Step::kInputs,
                           CAUSE("Wrong mesh, unit, camera or calibration: see the warnings")};
constexpr Remedy kOthers = {
    Step::kCompetingPoses,
    CAUSE("Repetition or symmetry: another pose explains the image as well")};

}  // namespace

const std::vector<Remedy>& remediesFor(const sessions::LocalizationTrace& trace) {
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

}  // namespace boresight::ui
