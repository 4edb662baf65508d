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

/// The camera's image behind the scene.
struct Backdrop {
  QImage gray;   ///< Format_Grayscale8
  QRectF where;  ///< on the canvas, its top-left corner (0, 0)
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

/// Something that draws a scene. Its owner draws names over it.
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
/// Drawn by the core; needs nothing.
std::unique_ptr<SceneCanvas> makePictureCanvas(QWidget* parent);

/// The scene drawn without OpenGL: the core renders surfaces and salient edges, plain Qt draws
/// lines and points where no surface hides them. `ratio` device pixels to a pixel of the view; the
/// picture carries it.
QImage drawScenePicture(const SceneContent& content, const SceneLook& look, const Viewpoint& view,
                        const std::optional<Backdrop>& backdrop, double ratio = 1.0);

}  // namespace boresight::ui
