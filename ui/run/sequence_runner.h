// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <QObject>
#include <QString>

#include "sessions/session/case_run.h"
#include "sessions/session/case_sequence.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

/// Progress of a sequence.
struct SequenceProgress {
  std::int64_t done = 0;
  std::int64_t of = 0;  ///< 0: not stated
  std::int64_t lost = 0;
  double frames_per_s = 0.0;            ///< 0: not known yet
  QString summary;                      ///< "22 of 24 frames accepted, 2 lost: 10, 11"
  std::vector<std::string> notes = {};  ///< on the source of the frames
};

/// Localizes the frames of a sequence on a separate thread. Each frame is stored before it is
/// reported: a stop keeps the stored frames, and the next start continues after them.
class SequenceRunner : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;

  /// `loaded` is the case as it is shown; its image is not a frame.
  void start(const sessions::SequenceOrder& order,
             std::shared_ptr<const sessions::LoadedCase> loaded);
  /// Ends after the slice of the frame under way, which is not stored.
  void stop();

  bool isRunning() const { return running_; }
  bool isStopped() const { return stopped_; }
  const SequenceProgress& progress() const { return progress_; }
  const std::vector<sessions::SequenceRow>& rows() const { return rows_; }
  /// Of the latest start.
  const sessions::SequenceOrder& order() const { return order_; }
  const std::shared_ptr<const sessions::LoadedCase>& loadedCase() const { return loaded_; }

 Q_SIGNALS:
  /// Started, ended, or advanced by a frame.
  void changed();
  /// It cannot start or continue; one sentence.
  void failed(const QString& message);

 private:
  void take(const sessions::SequenceRow& row, SequenceProgress progress);
  void end();

  TaskRunner runner_;
  TaskKind sequence_;
  sessions::SequenceOrder order_;
  std::shared_ptr<const sessions::LoadedCase> loaded_;
  std::vector<sessions::SequenceRow> rows_;
  SequenceProgress progress_;
  bool running_ = false;
  bool stopped_ = false;
};

}  // namespace boresight::ui
