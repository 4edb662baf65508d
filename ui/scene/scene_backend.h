// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <QString>

namespace boresight::ui {

/// Who draws the scene.
enum class SceneBackend {
  kVtk,
  kPicture,  ///< the core; where no OpenGL context can be had
};

/// Sets the surface format that VTK wants. Call before the application object is made.
void prepareSceneSurface();

/// The rule: VTK on window systems that it is built for, when a context of at least OpenGL 3.2 can
/// be made; the picture everywhere else, and when the environment's BORESIGHT_SCENE is "picture"
/// (for broken drivers). `context_works` is asked at most once, and not where the answer is plain.
SceneBackend decideSceneBackend(const QString& platform, const QString& wish,
                                const std::function<bool()>& context_works);

/// Decided once per program, when it is first asked.
SceneBackend sceneBackend();

/// Whether OpenGL runs without a graphics card, so that what only looks nicer is left out.
bool sceneIsDrawnInSoftware();

}  // namespace boresight::ui
