// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>

#include <QFlags>
#include <QObject>
#include <QString>

#include "core/geometry/pose.h"
#include "sessions/session/case_run.h"
#include "sessions/trace/alternatives.h"
#include "sessions/trace/trace.h"

namespace boresight::ui {

class Document;

/// The role of a pose.
enum class PoseRole : std::uint8_t { kSeed, kEstimate, kNudged, kTruth, kAnnotated };
inline constexpr int kPoseRoles = 5;

/// The position in a run that every view shows.
struct RunCursor {
  int iteration = -1;  ///< index into the snapshot's iterations; -1: the seed, before the first
  Stage stage = Stage::kFinished;  ///< shown of the iteration: this stage and those before

  bool operator==(const RunCursor&) const = default;
};

/// A run of which the views have nothing to show.
struct MissingRun {
  std::string
      digest;       ///< of a stored run whose trace cannot be read; empty: it failed at its start
  QString problem;  ///< why, one sentence
};

/// Changed parts of the view state.
enum class ViewChange {
  kCase = 1 << 0,
  kSnapshot = 1 << 1,
  kCursor = 1 << 2,
  kTemplate = 1 << 3,
  kNudgedPose = 1 << 4,
  kAnnotatedPose = 1 << 5,
  kAlternative = 1 << 6,
  kOtherCase = 1 << 7,  ///< the open case is another one, or none
  kAll = (1 << 8) - 1,
};
Q_DECLARE_FLAGS(ViewChanges, ViewChange)
Q_DECLARE_OPERATORS_FOR_FLAGS(ViewChanges)

/// The case that is open, from its opening until another case or session is. A dialog keeps the
/// value of when it opened, and drops its result where the opening is another one by then.
struct CaseOpening {
  std::string id;            ///< empty: none
  std::uint64_t number = 0;  ///< of all openings of the program

  bool operator==(const CaseOpening&) const = default;
};

/// "bc-000004 is no longer shown: nothing was changed."
QString leftText(const CaseOpening& left);

/// The view state of the whole window: one case, its run so far, one position in the run, one
/// template, and the nudged pose. All views show this state and change it only here; it is not part
/// of the document.
class ViewState : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;

  using CasePtr = std::shared_ptr<const sessions::LoadedCase>;
  using SnapshotPtr = std::shared_ptr<const sessions::LocalizationTrace>;

  /// The open case. It is the shown one, or none is shown: no view shows another.
  const CaseOpening& opening() const { return opening_; }
  /// nullptr while no case is open, and until the open one is read.
  const CasePtr& currentCase() const { return case_; }
  /// nullptr before the first run of the case.
  const SnapshotPtr& snapshot() const { return snapshot_; }
  /// Why there is no snapshot where there should be one.
  const std::optional<MissingRun>& missingRun() const { return missing_run_; }
  /// Digest of the run that the views show or report as missing. Empty: none, or one that has not
  /// ended.
  std::string shownRun() const;
  const RunCursor& cursor() const { return cursor_; }
  /// The iteration under the cursor, or nullptr.
  std::shared_ptr<const sessions::IterationTrace> iteration() const;
  /// The pose after the iteration, or before it when the shown stage is earlier than the pose.
  std::optional<Pose> iterationPose() const;
  /// Index into the iteration's templates, or -1.
  int selectedTemplate() const { return selected_template_; }
  /// The pose that is being nudged, if any.
  const std::optional<Pose>& nudgedPose() const { return nudged_; }
  /// The pose solved from the case's annotations, if any.
  const std::optional<Pose>& annotatedPose() const { return annotated_; }
  /// The hypothesis that is shown next to the chosen pose, if any.
  const std::optional<sessions::Alternative>& alternative() const { return alternative_; }
  /// The pose that the views show: the nudged one, else that after the cursor's iteration (before
  /// it where the shown stage is earlier), else the seed; of a case without a seed the annotated
  /// pose. Empty when there is none of these, and in a blind round.
  std::optional<Pose> knownPose() const;
  /// The same; the identity when there is none.
  Pose shownPose() const { return knownPose().value_or(Pose()); }

  /// Empties every view: this case is about to be read. Empty: no case is open.
  void openCase(const std::string& id);
  /// Shows a case; nullptr opens none.
  void setCase(CasePtr loaded_case);
  /// The current case after an edit of its inputs: the shown run, now stale, the position in it and
  /// the nudged pose stay.
  void replaceCase(CasePtr loaded_case);
  /// Keeps the cursor; a cursor at the last iteration follows the run.
  void setSnapshot(SnapshotPtr snapshot);
  /// Drops the snapshot.
  void setMissingRun(const MissingRun& missing);
  void setCursor(const RunCursor& cursor);
  /// -1 selects none.
  void selectTemplate(int index);
  void setNudgedPose(const std::optional<Pose>& camera_from_station);
  void setAnnotatedPose(const std::optional<Pose>& camera_from_station);
  /// Whether a blind annotation round hides what a pose predicts.
  void setBlind(bool blind);
  bool isBlind() const { return blind_; }
  /// Sets an alternative of the current snapshot; another snapshot drops it.
  void setAlternative(const std::optional<sessions::Alternative>& alternative);

  /// Calls a function of the receiver once for each change of any of these parts.
  template <class Receiver, class Function>
  void onChange(ViewChanges any_of, Receiver* receiver, Function function) {
    if constexpr (std::is_member_function_pointer_v<Function>) {
      onChange(any_of, receiver, [receiver, function] { std::invoke(function, receiver); });
    } else {
      connect(this, &ViewState::changed, receiver, [any_of, function](ViewChanges what) {
        if (what & any_of) function();
      });
    }
  }

 Q_SIGNALS:
  /// The case, or its inputs, are about to be replaced by this case's (empty: none): gestures on it
  /// end now.
  void aboutToSetCase(const std::string& next_id);
  /// Emitted once for each change, with all parts concerned.
  void changed(boresight::ui::ViewChanges what);

 private:
  int lastIteration() const;
  void show(const std::string& id, CasePtr loaded_case);
  void showSnapshot(SnapshotPtr snapshot);

  CaseOpening opening_;
  CasePtr case_;
  SnapshotPtr snapshot_;
  std::optional<MissingRun> missing_run_;
  RunCursor cursor_;
  int selected_template_ = -1;
  std::optional<Pose> nudged_;
  std::optional<Pose> annotated_;
  bool blind_ = false;
  std::optional<sessions::Alternative> alternative_;
};

/// camera_from_station of that role in the views: the run's seed (the case's before a run), the
/// pose before or after the cursor's iteration (by the shown stage), the nudged pose, the truth, or
/// the pose solved from annotations. Empty when there is none.
std::optional<Pose> poseOf(const ViewState& state, PoseRole role);

/// The document's case that the views show, or nullptr.
const sessions::SessionCase* shownCase(const Document& document, const ViewState& state);
/// The id of that case, or empty.
std::string shownCaseId(const Document& document, const ViewState& state);

/// "Competing pose 2", "Candidate 1", "Rolled by +5.0 deg".
QString alternativeTitle(const sessions::Alternative& alternative);
/// Name of the pose that it was compared with: "Result of the run", "Chosen candidate", "Chosen
/// roll".
QString chosenTitle(const sessions::Alternative& alternative);

}  // namespace boresight::ui
