// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <QPointF>

namespace boresight::ui {

/// A pixel as Qt draws it.
inline QPointF pointOf(const Eigen::Vector2d& pixel) { return {pixel.x(), pixel.y()}; }

}  // namespace boresight::ui
