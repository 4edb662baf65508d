// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QString>
#include <QStringList>

#include "sessions/checks/pose_quality.h"
#include "sessions/record/compare_records.h"
#include "sessions/review/review_status.h"
#include "sessions/trace/trace.h"
#include "ui/run/run_controller.h"
#include "ui/workspaces/step.h"
#include "ui/workspaces/workspace.h"

namespace boresight::ui {

/// The background colour of a verdict.
enum class VerdictTone { kPlain, kGood, kBad, kCaution };

/// Status of the shown case: a state, a sentence, and the next step.
struct Verdict {
  VerdictTone tone = VerdictTone::kPlain;
  Icon icon = Icon::kInfo;
  QString head = {};
  QString sentence = {};
  Step step = Step::kNone;
  std::vector<Step> others = {};  ///< the first of them has a button also in a narrow window
  QString step_text = {};         ///< replaces the step's own text, or empty
  bool plain = false;             ///< the step only stops a job

  bool operator==(const Verdict&) const = default;
};

/// The files collected for a new case.
struct FilesSituation {
  int added = 0;  ///< of four
  QString missing;
  QString problem = {};  ///< why a file cannot be used, or empty
  QString next = {};     ///< the file to choose next: "camera"; empty: all are present
};

/// The annotations of the case.
struct AnnotationSituation {
  int pairs = 0;
  std::optional<double> rms_px;
  QString bad_pair;  ///< the outlier, or empty
  double bad_sigmas = 0.0;
  bool has_pose = false;
  QString concern;       ///< why the pose is not good enough, or empty
  QStringList suspects;  ///< annotations that fit badly
  bool robust = false;   ///< the solution gives these little weight
  bool blind = false;    ///< nothing is solved until all are placed
  int unplaced = 0;      ///< in the image
};

struct ReviewSituation {
  bool current = false;  ///< the checks are of the shown state
  int failed = 0;
  bool testing = false;
  int seeds_done = 0;
  int seeds_returned = 0;
  bool tested = false;
  sessions::ReviewState state = sessions::ReviewState::kNew;
  QString decision;  ///< "by A. Operator, 09:02"; empty: none holds
  QString outdated;  ///< why the validated run would differ if repeated, or empty
  QString problem;   ///< why there is nothing to check, or empty
};

/// All inputs of a verdict.
struct Situation {
  Workspace workspace = Workspace::kRun;
  FilesSituation files;
  bool has_case = false;
  bool has_seed = true;
  bool has_next = true;  ///< another case is open to be decided
  QString load_problem;
  QString input_problem;  ///< input that a run would reject, or empty
  QString input_step;     ///< step that corrects it: "Choose camera..."
  QString file_problem;   ///< a missing or changed input file, or empty
  RunState run = RunState::kEmpty;
  QString reading;        ///< the case of which files or the last run are being read, or empty
  bool in_batch = false;  ///< the shown case is run as soon as it is read, or by the batch
  std::shared_ptr<const sessions::LocalizationTrace> trace;
  QString run_problem;      ///< why there is no trace where there should be one, or empty
  std::vector<Step> tried;  ///< remedies of earlier runs
  QString stale;            ///< changes since the run, or empty
  /// Quality of the run's pose; empty during its measurement.
  std::optional<sessions::PoseQuality> quality;
  AnnotationSituation annotation;
  ReviewSituation review;
  std::shared_ptr<const sessions::RecordComparison> comparison;
  QString not_compared;     ///< why there is no comparison
  bool can_repeat = false;  ///< the onboard record suffices for a run on the ground
};

Verdict verdictOf(const Situation& situation);

}  // namespace boresight::ui
