// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QObject>

#include "sessions/checks/pose_quality.h"
#include "ui/run/task_runner.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

class Document;

/// The quality of the shown run's pose by the session's requirement and limits, measured on a
/// worker thread.
class QualityController : public QObject {
  Q_OBJECT

 public:
  QualityController(Document& document, ViewState& state, TaskRunner& tasks);

  /// Empty for a run that did not converge, and during the measurement.
  const std::optional<sessions::PoseQuality>& quality() const { return quality_; }

 Q_SIGNALS:
  void changed();
  /// It cannot be measured; one sentence.
  void failed(const QString& message);

 private:
  /// All that the quality depends on.
  struct Question {
    ViewState::CasePtr loaded;
    ViewState::SnapshotPtr run;
    sessions::ReviewSettings settings;

    bool operator==(const Question&) const = default;
  };

  void follow();

  Document& document_;
  ViewState& state_;
  TaskRunner& tasks_;
  TaskKind measuring_;
  Question question_;
  std::optional<sessions::PoseQuality> quality_;
};

}  // namespace boresight::ui
