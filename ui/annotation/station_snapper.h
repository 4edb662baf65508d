// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QObject>

#include "sessions/annotation/mesh_snap.h"
#include "ui/run/task_runner.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

/// Features of the current case's mesh that an annotation may snap to: corners, edges and circles,
/// found once for all views on a worker thread. Image and scene query it, each with its own camera
/// and pose.
class StationSnapper : public QObject {
  Q_OBJECT

 public:
  explicit StationSnapper(ViewState& state, QObject* parent = nullptr);

  using MeshPtr = std::shared_ptr<const sessions::MeshSnapper>;
  /// nullptr without a case and until the features are found; usable in another thread.
  const MeshPtr& mesh() const { return mesh_; }

  /// The nearest visible vertex, circle centre and edge within the radius of a pixel of that
  /// camera, the likeliest first; empty until the features are found.
  std::vector<sessions::MeshSnap> near(const Camera& camera, const Pose& camera_from_station,
                                       const Eigen::Vector2d& pixel, double radius_px) const;

  /// The point of the station (metres) that is seen at a pixel of that camera; empty outside the
  /// station. Until the features are found, and where parts are fixed to the camera, every face is
  /// tried: some milliseconds for a hundred thousand.
  std::optional<Eigen::Vector3d> surfaceAt(const Camera& camera, const Pose& camera_from_station,
                                           const Eigen::Vector2d& pixel) const;

 Q_SIGNALS:
  void meshChanged();
  /// The mesh cannot be searched; a sentence for the operator.
  void failed(const QString& message);

 private:
  void takeCase();

  ViewState& state_;
  ViewState::CasePtr case_;
  MeshPtr mesh_;
  TaskRunner runner_;
  TaskKind reading_;
};

}  // namespace boresight::ui
