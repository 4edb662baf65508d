// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <QObject>

#include "sessions/annotation/mesh_snap.h"
#include "ui/run/task_runner.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

/// What of the current case's mesh an annotation may snap to: its corners, edges and circles, found
/// once for all views and off the UI's thread. Image and scene both ask here, each with the camera
/// and the pose that it draws with.
class StationSnapper : public QObject {
  Q_OBJECT

 public:
  explicit StationSnapper(ViewState& state, QObject* parent = nullptr);

  using MeshPtr = std::shared_ptr<const sessions::MeshSnapper>;
  /// nullptr without a case and until they are found; may be kept and asked in another thread.
  const MeshPtr& mesh() const { return mesh_; }

  /// The nearest seen vertex, circle centre and edge within the radius of a pixel of that camera,
  /// the likeliest first; nothing until they are found.
  std::vector<sessions::MeshSnap> near(const Camera& camera, const Pose& camera_from_station,
                                       const Eigen::Vector2d& pixel, double radius_px) const;

 Q_SIGNALS:
  void meshChanged();
  /// A mesh that cannot be searched; one sentence.
  void failed(const QString& message);

 private:
  void takeCase();

  ViewState& state_;
  ViewState::CasePtr case_;
  MeshPtr mesh_;
  TaskRunner runner_;
};

}  // namespace boresight::ui
