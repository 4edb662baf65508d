// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>
#include <vtkTexture.h>

#include "ui/scene/scene_canvas.h"

namespace boresight::ui {

/// Gives a renderer exactly the viewpoint's pinhole: its focal lengths and principal point, not an
/// opening angle. Returns how far away something can be and still be seen, m.
double placeCamera(vtkRenderer& renderer, const SceneContent& content, const Viewpoint& view);

/// The camera's image: a textured square behind everything else, as far away as can be seen.
class BackdropActor {
 public:
  explicit BackdropActor(vtkRenderer& renderer);
  void place(const std::optional<Backdrop>& backdrop, const Viewpoint& view, double far_m);

 private:
  void fillTexture(const QImage& gray);

  vtkNew<vtkPolyDataMapper> mapper_;
  vtkNew<vtkActor> actor_;
  vtkNew<vtkTexture> texture_;
  qint64 key_ = 0;  ///< of the picture in the texture
};

}  // namespace boresight::ui
