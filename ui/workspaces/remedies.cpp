// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/remedies.h"

#include <QCoreApplication>

namespace boresight::ui {
namespace {

constexpr Remedy kWider = {
    Step::kWiderSearch, QT_TR_NOOP("The seed's edges look turned: slots and clamps are elsewhere")};
constexpr Remedy kNudge = {Step::kNudgeSeed,
                           QT_TR_NOOP("The seed's edges look like the image, but displaced")};
constexpr Remedy kFarther = {
    Step::kUncertainty,
    QT_TR_NOOP("Arrows agree but end at window borders: the seed is farther off than stated")};
constexpr Remedy kMasked = {
    Step::kMask,
    QT_TR_NOOP("Part of the station is hidden, or edges are everywhere: print, shadows")};
constexpr Remedy kMarks = {Step::kAnnotate,
                           QT_TR_NOOP("Nothing is known of the pose: four points give a seed")};
constexpr Remedy kSheet = {Step::kInputs,
                           QT_TR_NOOP("Wrong mesh, unit, camera or calibration: see the warnings")};
constexpr Remedy kOthers = {
    Step::kCompetingPoses,
    QT_TR_NOOP("Repetition or symmetry: another pose explains the image as well")};

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
