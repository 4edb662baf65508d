// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include <QImage>
#include <QRectF>

#include "ui/scene/scene_content.h"
#include "ui/scene/viewpoint.h"

class QWidget;

namespace boresight::ui {

/// The camera's image behind the scene.
struct Backdrop {
  QImage gray;   ///< Format_Grayscale8
  QRectF where;  ///< on the canvas, its top-left corner (0, 0)
};

/// What the scene looks like besides what it holds.
struct SceneLook {
  SceneShown shown;
  double mesh_opacity = 1.0;
  QColor background = QColor(40, 42, 46);
  QColor mesh_lines = QColor(20, 22, 26);
};
inline const QColor kMatchedColor(196, 203, 214);
inline const QColor kOccludingColor(178, 148, 104);

/// Something that draws a scene. Names are drawn over it by whoever owns it.
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

}  // namespace boresight::ui
