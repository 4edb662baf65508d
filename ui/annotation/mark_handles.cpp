// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/mark_handles.h"

#include <cmath>

#include "sessions/annotation/predicted_place.h"

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

}  // namespace boresight::ui
