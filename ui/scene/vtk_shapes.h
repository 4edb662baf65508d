// SPDX-License-Identifier: Apache-2.0
// Elements of scenes: lines, clouds of small shapes, a backdrop image, and camera placement.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include <QColor>

#include <vtkActor.h>
#include <vtkDoubleArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkNew.h>
#include <vtkPlaneSource.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>
#include <vtkTexture.h>

#include "ui/scene/scene_canvas.h"
#include "ui/scene/scene_content.h"

namespace boresight::ui {

/// Sets a renderer's camera exactly to the viewpoint's pinhole: focal lengths and principal point,
/// not an opening angle. Returns the distance of the far plane, m.
double placeCamera(vtkRenderer& renderer, const Viewpoint& view);

/// The camera's image: a textured square behind everything else, near the far plane.
class BackdropActor {
 public:
  explicit BackdropActor(vtkRenderer& renderer);
  void place(const std::optional<Backdrop>& backdrop, const Viewpoint& view, double far_m);

 private:
  void fillTexture(const QImage& gray);

  vtkNew<vtkPlaneSource> square_;
  vtkNew<vtkPolyDataMapper> mapper_;
  vtkNew<vtkActor> actor_;
  vtkNew<vtkTexture> texture_;
  qint64 key_ = 0;  ///< of the picture in the texture
};

/// Three crossed bars: the shape of an outlier, the same from every side.
vtkNew<vtkPolyData> crossShape();

/// Resolution of a sphere: for a few template points, or for ten thousand edge places.
enum class Roundness { kFew, kMany };

vtkNew<vtkPolyData> sphereShape(double radius, Roundness roundness = Roundness::kFew);

/// A cloud of equal shapes, coloured by a table or all alike; their size follows the view.
struct Cloud {
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> values;
  vtkNew<vtkPolyData> data;
  vtkNew<vtkGlyph3DMapper> mapper;
  vtkNew<vtkActor> actor;

  Cloud();
  void clear();
  void add(const Eigen::Vector3d& at_m, double value = 0.0);
  void changed();
  void setColor(const QColor& color);
};

/// Lines of a constant width on the screen, each with its colour.
struct Lines {
  vtkNew<vtkPolyDataMapper> mapper;
  vtkNew<vtkActor> actor;

  Lines();
  /// Lines with a larger value are drawn over those with a smaller one.
  void lift(double units);
  void set(const ColoredLines& lines);
};

}  // namespace boresight::ui
