// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/mark_aim.h"

#include <algorithm>
#include <cmath>

#include <QCoreApplication>

#include "sessions/annotation/marks_on_image.h"
#include "sessions/run/surface_point.h"

namespace boresight::ui {

double screenDistance(const ViewTransform& transform, const Eigen::Vector2d& pixel,
                      const QPointF& place) {
  const QPointF away = transform.toWidget(QPointF(pixel.x(), pixel.y())) - place;
  return std::hypot(away.x(), away.y());
}

std::optional<MarkHandle> handleAt(const sessions::Marks& marks, const ViewTransform& transform,
                                   const QPointF& place) {
  std::optional<MarkHandle> found;
  double nearest = kHandle;
  const auto offer = [&](const std::string& id, int end, const Eigen::Vector2d& pixel) {
    const double distance = screenDistance(transform, pixel, place);
    if (distance > nearest) return;
    nearest = distance;
    found = MarkHandle{id, end, pixel};
  };
  for (const sessions::PointPair& point : marks.points)
    if (point.pixel) offer(point.id, 0, *point.pixel);
  for (const sessions::LinePair& line : marks.lines) {
    if (!line.line) continue;
    offer(line.id, 0, line.line->start);
    offer(line.id, 1, line.line->end);
  }
  return found;
}

const sessions::Proposal* proposalAt(const std::vector<sessions::Proposal>& proposals,
                                     const ViewTransform& transform, const QPointF& place) {
  const sessions::Proposal* found = nullptr;
  double nearest = kHandle;
  for (const sessions::Proposal& proposal : proposals) {
    const double distance = screenDistance(transform, proposal.pixel, place);
    if (distance > nearest) continue;
    nearest = distance;
    found = &proposal;
  }
  return found;
}

std::string stationOnlyAt(const sessions::Marks& marks, const Camera& camera,
                          const Pose& camera_from_station, const ViewTransform& transform,
                          const QPointF& place) {
  for (const sessions::PointPair& point : marks.points) {
    if (point.pixel || !point.point_in_station_m) continue;
    const auto at = sessions::predictPlace(camera, camera_from_station, *point.point_in_station_m);
    if (at.valid && screenDistance(transform, at.pixel, place) <= kHandle) return point.id;
  }
  return {};
}

namespace {

using sessions::ImageSnap;
using sessions::ImageSnapKind;
using sessions::MeshSnap;
using sessions::MeshSnapKind;

constexpr double kSnapRadius = 12.0;  ///< on the screen
constexpr double kLeastRadius_px = 2.0;
constexpr double kMostRadius_px = 12.0;
constexpr double kRims = 3.0;  ///< an ellipse's rim may be this many radii away
constexpr double kLeastRim_px = 16.0;

QString aimText(const char* text) { return QCoreApplication::translate("MarkAim", text); }

QString nameOf(ImageSnapKind kind) {
  switch (kind) {
    case ImageSnapKind::kCorner:
      return aimText("corner");
    case ImageSnapKind::kEllipse:
      return aimText("ellipse centre");
    case ImageSnapKind::kEdge:
      return aimText("edge");
  }
  return {};
}

QString nameOf(MeshSnapKind kind) {
  switch (kind) {
    case MeshSnapKind::kVertex:
      return aimText("vertex");
    case MeshSnapKind::kEdge:
      return aimText("model edge");
    case MeshSnapKind::kCircle:
      return aimText("circle centre");
  }
  return {};
}

/// Which of several, and how many there are to choose from.
template <class Snap>
const Snap& chosenOf(const std::vector<Snap>& snaps, int turn, MarkAim& aim) {
  aim.found = static_cast<int>(snaps.size());
  aim.chosen = turn % aim.found;
  return snaps[static_cast<std::size_t>(aim.chosen)];
}

}  // namespace

double snapRadius_px(double scale) {
  return std::clamp(kSnapRadius / scale, kLeastRadius_px, kMostRadius_px);
}

MarkAim aimAtImage(const sessions::LoadedCase& one, const Eigen::Vector2d& pointer,
                   const AimRules& rules) {
  MarkAim aim;
  aim.side = AimSide::kImage;
  aim.pixel = pointer;
  aim.text = aimText("free");
  if (!rules.snaps) return aim;
  std::vector<ImageSnap> snaps = sessions::imageSnaps(
      one.image.view(), pointer, rules.radius_px, std::max(kLeastRim_px, kRims * rules.radius_px));
  // Ends of a line lie on an edge; where it ends or what it goes round does not count.
  if (rules.line)
    std::stable_partition(snaps.begin(), snaps.end(),
                          [](const ImageSnap& snap) { return snap.kind == ImageSnapKind::kEdge; });
  if (snaps.empty()) return aim;
  aim.snap = chosenOf(snaps, rules.turn, aim);
  aim.pixel = aim.snap->pixel;
  aim.text = nameOf(aim.snap->kind);
  return aim;
}

MarkAim aimAtStation(const sessions::LoadedCase& one, const Pose& camera_from_station,
                     const Eigen::Vector2d& pointer, std::vector<MeshSnap> snaps,
                     const AimRules& rules) {
  MarkAim aim;
  const Camera& camera = one.source.camera;
  if (rules.line) std::erase_if(snaps, [](const MeshSnap& snap) { return !snap.edge; });
  if (!snaps.empty() && (rules.snaps || rules.line)) {
    const MeshSnap& snap = chosenOf(snaps, rules.turn, aim);
    aim.side = AimSide::kStation;
    aim.pixel = snap.pixel;
    aim.point_in_station_m = snap.point_in_station_m;
    aim.edge = snap.edge;
    if (snap.edge)
      aim.edge_on_image = sessions::edgeOnImage(camera, camera_from_station, *snap.edge);
    aim.text = nameOf(snap.kind);
    return aim;
  }
  if (rules.line) return aim;
  const auto surface =
      sessions::surfacePointAt(camera, one.scene.view(), camera_from_station, pointer);
  if (!surface) return aim;
  aim.side = AimSide::kStation;
  aim.pixel = pointer;
  aim.point_in_station_m = surface->in_station_m;
  aim.text = aimText("surface");
  return aim;
}

}  // namespace boresight::ui
