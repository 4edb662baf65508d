// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <QImage>
#include <QRectF>
#include <QString>

#include "ui/scene/scene_content.h"
#include "ui/scene/viewpoint.h"

class QWidget;

namespace boresight::ui {

/// The renderer of the scene.
enum class SceneBackend {
  kVtk,
  kPicture,  ///< the core; when no OpenGL context is available
};

/// Sets the surface format that VTK requires. Call before the application object is created.
void prepareSceneSurface();

/// VTK on window systems that it is built for, when a context of at least OpenGL 3.2 can be
/// created; the picture everywhere else, and when the environment's BORESIGHT_SCENE is "picture"
/// (for broken drivers). `context_works` is called at most once, and only when it decides.
SceneBackend decideSceneBackend(const QString& platform, const QString& wish,
                                const std::function<bool()>& context_works);

/// Decided once per program, at the first call.
SceneBackend sceneBackend();

/// Whether OpenGL runs without a graphics card, so that decoration is left out.
bool sceneIsDrawnInSoftware();

/// The camera's image behind the scene.
struct Backdrop {
  QImage gray;   ///< Format_Grayscale8
  QRectF where;  ///< on the canvas, whose top-left corner is (0, 0)
};

/// Appearance of the scene apart from its contents.
struct SceneLook {
  SceneShown shown;
  double mesh_opacity = 1.0;
  QColor background = QColor(40, 42, 46);
  QColor mesh_lines = QColor(20, 22, 26);
};
inline const QColor kMatchedColor(196, 203, 214);
inline const QColor kOccludingColor(178, 148, 104);

/// Interface of a widget that draws a scene. Its owner draws names over it.
class SceneCanvas {
 public:
  virtual ~SceneCanvas() = default;
  virtual QWidget* widget() = 0;
  /// Shown with the next view.
  virtual void setContent(std::shared_ptr<const SceneContent> content, const SceneLook& look) = 0;
  virtual void setView(const Viewpoint& view, const std::optional<Backdrop>& backdrop) = 0;
};

/// Drawn by VTK; needs an OpenGL context.
std::unique_ptr<SceneCanvas> makeVtkCanvas(QWidget* parent);
/// Drawn by the core; needs no OpenGL.
std::unique_ptr<SceneCanvas> makePictureCanvas(QWidget* parent);

/// The scene drawn without OpenGL: the core renders surfaces and salient edges, plain Qt draws
/// lines and points where no surface hides them. `ratio`: device pixels per pixel of the view; it
/// is set in the picture.
QImage drawScenePicture(const SceneContent& content, const SceneLook& look, const Viewpoint& view,
                        const std::optional<Backdrop>& backdrop, double ratio = 1.0);

}  // namespace boresight::ui
