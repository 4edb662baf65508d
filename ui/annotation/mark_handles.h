// SPDX-License-Identifier: Apache-2.0
// What of the marks lies under the pointer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <QPointF>

#include "sessions/annotation/landmarks.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {

/// How near one must point, on the screen.
inline constexpr double kHandle = 8.0;

/// A place of the image that can be taken hold of.
struct MarkHandle {
  std::string id;
  int end = 0;  ///< of a line
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

/// On the widget, from a pixel to a place of the widget.
double screenDistance(const ViewTransform& transform, const Eigen::Vector2d& pixel,
                      const QPointF& place);

/// The nearest point or end of a line within reach.
std::optional<MarkHandle> handleAt(const sessions::Marks& marks, const ViewTransform& transform,
                                   const QPointF& place);

/// The nearest proposal within reach, or nullptr.
const sessions::Proposal* proposalAt(const std::vector<sessions::Proposal>& proposals,
                                     const ViewTransform& transform, const QPointF& place);

/// A point without a place in the image that the pose predicts within reach, or "".
std::string stationOnlyAt(const sessions::Marks& marks, const Camera& camera,
                          const Pose& camera_from_station, const ViewTransform& transform,
                          const QPointF& place);

}  // namespace boresight::ui
