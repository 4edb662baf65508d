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
  const char* text;  ///< of the button
  const char* help;
  Icon icon;
};
const StepInfo& stepInfo(Step step);

}  // namespace boresight::ui
