// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/station_snapper.h"

#include <utility>

#include "sessions/annotation/image_snap.h"

namespace boresight::ui {
namespace {

/// A snapper looks into the mesh of its case, which must stay as long.
struct SearchedCase {
  explicit SearchedCase(ViewState::CasePtr searched)
      : one(std::move(searched)), mesh(one->scene.view()) {}

  ViewState::CasePtr one;
  sessions::MeshSnapper mesh;
};

bool haveSameMesh(const ViewState::CasePtr& a, const ViewState::CasePtr& b) {
  return a && b && a->source.id == b->source.id && sessions::sameScene(a->source, b->source);
}

}  // namespace

StationSnapper::StationSnapper(ViewState& state, QObject* parent) : QObject(parent), state_(state) {
  state_.onChange(ViewChange::kCase, this, &StationSnapper::takeCase);
  connect(&runner_, &TaskRunner::failed, this, &StationSnapper::failed);
  takeCase();
}

void StationSnapper::takeCase() {
  const ViewState::CasePtr before = std::exchange(case_, state_.currentCase());
  if (haveSameMesh(before, case_)) return;  // an edit left it alone
  mesh_.reset();
  const QString key = QStringLiteral("mesh");
  if (!case_) runner_.cancel(key);
  Q_EMIT meshChanged();
  if (!case_) return;
  runner_.start(
      key,
      [one = case_](const std::stop_token&) {
        auto searched = std::make_shared<const SearchedCase>(one);
        return MeshPtr(searched, &searched->mesh);
      },
      [this](MeshPtr mesh) {
        mesh_ = std::move(mesh);
        Q_EMIT meshChanged();
      });
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
