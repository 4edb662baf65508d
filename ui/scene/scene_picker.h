// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <QPointF>

#include "ui/scene/scene_content.h"
#include "ui/scene/viewpoint.h"

namespace boresight::ui {

/// A place of the mesh that somebody pointed at.
struct MeshPick {
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  ///< station frame
  std::int32_t vertex = -1;                        ///< when it snapped to one
};

inline constexpr double kTemplatePick_px = 9.0;
inline constexpr double kVertexSnap_px = 7.0;

/// The template nearest to a pixel of the canvas among those that no face hides, within
/// kTemplatePick_px; its index into the iteration's templates, or -1. Picking computes, and does
/// not read pixels back: it works alike on every screen and without OpenGL.
int pickTemplate(const SceneContent& content, const Viewpoint& view, const QPointF& pixel);

/// The nearest vertex within kVertexSnap_px that no face hides, else the face under the pixel.
std::optional<MeshPick> pickMesh(const SceneContent& content, const Viewpoint& view,
                                 const QPointF& pixel);

}  // namespace boresight::ui
