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

/// Renders the salient edges of a pose that the operator moves, on a worker thread. During a move
/// the newest pose is drawn at half resolution, and poses in between are left out. A pose at rest
/// is drawn at full resolution, which the next move interrupts.
class PoseRenderer : public QObject {
  Q_OBJECT

 public:
  static constexpr int kRest_ms = 150;
  static constexpr int kMovingLevel = 1;  ///< half resolution

  using RenderPtr = std::shared_ptr<const sessions::RenderTrace>;

  explicit PoseRenderer(QObject* parent = nullptr);

  /// Sets the case of later poses; renders of another case are dropped. nullptr: none.
  void setCase(std::shared_ptr<const sessions::LoadedCase> loaded_case);
  void setPose(const Pose& camera_from_station);
  /// Emits nothing until the next pose.
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
  void draw(const TaskKind& kind, int level);
  void take(const Drawn& drawn);

  std::shared_ptr<Renderers> renderers_;  ///< nullptr without a case
  Pose camera_from_station_;
  bool drawing_ = false;    ///< at half resolution
  bool overtaken_ = false;  ///< a newer pose waits for the end of that
  QTimer rest_;
  TaskRunner runner_;
  TaskKind moving_;
  TaskKind resting_;
};

}  // namespace boresight::ui
