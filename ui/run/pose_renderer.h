// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QObject>
#include <QString>
#include <QTimer>

#include "core/geometry/pose.h"
#include "sessions/session/case_run.h"
#include "sessions/trace/trace.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

/// Renders the salient edges of a pose that the operator moves, off the UI's thread. While poses
/// come in, each is drawn at half resolution, the newest first, and those in between are left out;
/// once the pose has rested it is drawn at full resolution, which the next move interrupts.
class PoseRenderer : public QObject {
  Q_OBJECT

 public:
  static constexpr int kRest_ms = 150;
  static constexpr int kMovingLevel = 1;  ///< half resolution

  using RenderPtr = std::shared_ptr<const sessions::RenderTrace>;

  explicit PoseRenderer(QObject* parent = nullptr);

  /// Later poses are of this case; what was drawn of another one is dropped. nullptr: none.
  void setCase(std::shared_ptr<const sessions::LoadedCase> loaded_case);
  void setPose(const Pose& camera_from_station);
  /// Nothing more comes until the next pose.
  void clear();

 Q_SIGNALS:
  /// `level` is that of the render's pixels: 0 full resolution, 1 half.
  void rendered(const std::shared_ptr<const boresight::sessions::RenderTrace>& render, int level);
  /// The pose cannot be drawn; a sentence for the operator.
  void failed(const QString& message);

 private:
  struct Renderers;
  struct Drawn;

  void drawMoving();
  void drawResting();
  void take(const Drawn& drawn);

  std::shared_ptr<Renderers> renderers_;  ///< nullptr without a case
  Pose camera_from_station_;
  bool drawing_ = false;    ///< at half resolution
  bool overtaken_ = false;  ///< by a pose that waits for the end of that
  QTimer rest_;
  TaskRunner runner_;
};

}  // namespace boresight::ui
