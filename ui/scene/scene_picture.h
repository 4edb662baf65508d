// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QImage>

#include "ui/scene/scene_canvas.h"

namespace boresight::ui {

/// The scene drawn without OpenGL: the core renders surfaces and salient edges, plain Qt draws
/// lines and points where no surface hides them. `ratio` device pixels to a pixel of the view; the
/// picture carries it.
QImage drawScenePicture(const SceneContent& content, const SceneLook& look, const Viewpoint& view,
                        const std::optional<Backdrop>& backdrop, double ratio = 1.0);

}  // namespace boresight::ui
