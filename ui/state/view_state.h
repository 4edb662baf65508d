// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QObject>

#include "core/geometry/pose.h"
#include "sessions/run/alternatives.h"
#include "sessions/run/trace.h"
#include "sessions/session/case_run.h"

namespace boresight::ui {

/// The place in a run that every view shows.
struct RunCursor {
  int iteration = -1;  ///< index into the snapshot's iterations; -1: the seed, before the first
  Stage stage = Stage::kFinished;  ///< what of the iteration is shown: this stage and those before

  bool operator==(const RunCursor&) const = default;
};

/// What the whole window looks at: one case, its run as far as it has come, one place in it, one
/// template of it, and the pose that a person has nudged. All views show this and change it only
/// here; nothing of it is part of the document.
class ViewState : public QObject {
  Q_OBJECT

 public:
  explicit ViewState(QObject* parent = nullptr);

  using CasePtr = std::shared_ptr<const sessions::LoadedCase>;
  using SnapshotPtr = std::shared_ptr<const sessions::LocalizationTrace>;

  /// nullptr while no case is open.
  const CasePtr& currentCase() const { return case_; }
  /// nullptr before the first run of the case.
  const SnapshotPtr& snapshot() const { return snapshot_; }
  const RunCursor& cursor() const { return cursor_; }
  /// The iteration under the cursor, or nullptr.
  const sessions::IterationTrace* iteration() const;
  /// Index into the iteration's templates, or -1.
  int selectedTemplate() const { return selected_template_; }
  /// The pose that is being nudged, if any.
  const std::optional<Pose>& nudgedPose() const { return nudged_; }
  /// The pose that solves the case's annotated marks, if any.
  const std::optional<Pose>& annotatedPose() const { return annotated_; }
  /// The pose that the run weighed and that is looked at beside the one it went on with, if any.
  const std::optional<sessions::Alternative>& alternative() const { return alternative_; }
  /// The pose that the views show: the nudged one, else that after the cursor's iteration (before
  /// it where the shown stage is earlier), else the seed. Identity without a case.
  Pose shownPose() const;

  void setCase(CasePtr one);
  /// The current case after an edit of its inputs: the shown run, now stale, the place in it and
  /// the nudged pose stay.
  void replaceCase(CasePtr one);
  /// Keeps the cursor where it was; at the last iteration it follows the run.
  void setSnapshot(SnapshotPtr snapshot);
  void setCursor(const RunCursor& cursor);
  /// -1 selects none.
  void selectTemplate(int index);
  void setNudgedPose(const std::optional<Pose>& camera_from_station);
  void setAnnotatedPose(const std::optional<Pose>& camera_from_station);
  /// Of the current snapshot: another one drops it.
  void setAlternative(const std::optional<sessions::Alternative>& alternative);

 Q_SIGNALS:
  void caseChanged();
  void snapshotChanged();
  void cursorChanged();
  void templateSelected(int index);
  void nudgedPoseChanged();
  void annotatedPoseChanged();
  void alternativeChanged();

 private:
  int lastIteration() const;

  CasePtr case_;
  SnapshotPtr snapshot_;
  RunCursor cursor_;
  int selected_template_ = -1;
  std::optional<Pose> nudged_;
  std::optional<Pose> annotated_;
  std::optional<sessions::Alternative> alternative_;
};

}  // namespace boresight::ui
