// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/station_snapper.h"

#include <algorithm>
#include <utility>

#include "sessions/annotation/image_snap.h"
#include "sessions/trace/surface_point.h"

namespace boresight::ui {

StationSnapper::StationSnapper(ViewState& state, QObject* parent) : QObject(parent), state_(state) {
  state_.onChange(ViewChange::kCase, this, &StationSnapper::takeCase);
  takeCase();
}

void StationSnapper::takeCase() {
  const ViewState::CasePtr before = std::exchange(case_, state_.currentCase());
  if (before && case_ && before->source.id == case_->source.id &&
      sessions::sameScene(before->source, case_->source))
    return;  // an edit left the mesh alone
  mesh_.reset();
  if (!case_) runner_.cancel(reading_);
  Q_EMIT meshChanged();
  if (!case_) return;
  runner_.replace(
      reading_,
      [searched_case = case_](const std::stop_token&) {
        // The snapper points into the mesh of the case; the deleter's copy keeps the case alive.
        return MeshPtr(new sessions::MeshSnapper(searched_case->scene.view()),
                       [searched_case](const sessions::MeshSnapper* mesh) { delete mesh; });
      },
      [this](MeshPtr mesh) {
        mesh_ = std::move(mesh);
        Q_EMIT meshChanged();
      },
      reportTo(this, &StationSnapper::failed));
}

std::optional<Eigen::Vector3d> StationSnapper::surfaceAt(const Camera& camera,
                                                         const Pose& camera_from_station,
                                                         const Eigen::Vector2d& pixel) const {
  if (!case_) return std::nullopt;
  const MeshView mesh = case_->scene.view();
  const bool any_fixed = std::ranges::any_of(mesh.parts, &ScenePart::fixed_to_camera);
  if (mesh_ && !any_fixed) return mesh_->surfaceAt(camera, camera_from_station, pixel);
  const auto surface = sessions::surfacePointAt(camera, mesh, camera_from_station, pixel);
  return surface ? std::optional(surface->in_station_m) : std::nullopt;
}

std::vector<sessions::MeshSnap> StationSnapper::near(const Camera& camera,
                                                     const Pose& camera_from_station,
                                                     const Eigen::Vector2d& pixel,
                                                     double radius_px) const {
  if (!mesh_) return {};
  return sessions::likeliestFirst(mesh_->near(camera, camera_from_station, pixel, radius_px),
                                  radius_px);
}

}  // namespace boresight::ui
