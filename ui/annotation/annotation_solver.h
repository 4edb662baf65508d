// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QObject>

#include "sessions/annotation/annotation_pass.h"
#include "sessions/annotation/landmarks.h"
#include "sessions/session/case_marks.h"
#include "sessions/session/case_run.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

/// Has marks solved while somebody places them, off the UI's thread: the newest marks count, and
/// what was asked before is dropped.
class AnnotationSolver : public QObject {
  Q_OBJECT

 public:
  struct Question {
    sessions::CaseMarks marks;
    std::shared_ptr<const sessions::LoadedCase> one;
    Pose camera_from_station_guess;
    std::vector<sessions::Landmark> landmarks;
    sessions::AnnotationPasses passes;
    bool robust = false;
  };
  /// Somebody's earlier pass over the same image beside the marks at work.
  struct PassAnswer {
    std::string by;
    std::string time;
    std::optional<Pose> camera_from_station;
    sessions::Repeatability repeatability;  ///< marks at work minus the pass
  };
  struct Answer {
    std::shared_ptr<const sessions::CaseMarksSolution> solution;
    std::vector<sessions::Proposal> proposals;
    std::vector<PassAnswer> passes;
    std::optional<Matrix6d> covariance;  ///< of the case's camera, in its own frame
  };

  explicit AnnotationSolver(QObject* parent = nullptr);

  void ask(Question question);
  /// Nothing comes any more of what was asked.
  void drop();

 Q_SIGNALS:
  void solved(const boresight::ui::AnnotationSolver::Answer& answer);
  /// The marks cannot be solved for a reason that is not theirs; one sentence.
  void failed(const QString& message);

 private:
  TaskRunner runner_;
};

}  // namespace boresight::ui
