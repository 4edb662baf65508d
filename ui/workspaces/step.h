// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QString>

#include "ui/style/icons.h"

namespace boresight::ui {

/// A next step, as a button of the verdict bar or of the remedies.
enum class Step {
  kNone,
  kChooseFiles,
  kFixFiles,
  kChangeInput,
  kRun,
  kStop,
  kGoOn,
  kRunAgain,
  kRunRest,
  kShowBatch,
  kReview,
  kWiderSearch,
  kNudgeSeed,
  kMask,
  kUncertainty,
  kAnnotate,
  kAnnotateFromPose,
  kInspect,
  kCompetingPoses,
  kInputs,
  kSeedFromAnnotation,
  kDisablePair,
  kRobust,
  kConvergenceTest,
  kStopTest,
  kValidate,
  kExportPose,
  kReport,
  kNextCase,
  kFirstDifference,
  kRepeatRecord,
  kLoadRecord,
};

struct StepInfo {
  QString text;  ///< of the button
  QString help;
  Icon icon;
};
StepInfo stepInfo(Step step);

/// Shows a step on a button or an action.
template <class Target>
void showStep(Target& target, Step step) {
  const StepInfo info = stepInfo(step);
  target.setText(info.text);
  target.setToolTip(info.help);
  target.setIcon(iconOf(info.icon));
}

}  // namespace boresight::ui
