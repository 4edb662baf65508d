// SPDX-License-Identifier: Apache-2.0
// What scenes are made of: lines, clouds of small shapes, a backdrop image, and camera placement.
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

/// Gives a renderer exactly the viewpoint's pinhole: its focal lengths and principal point, not an
/// opening angle. Returns how far away something can be and still be seen, m.
double placeCamera(vtkRenderer& renderer, const Viewpoint& view);

/// The camera's image: a textured square behind everything else, as far away as can be seen.
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

/// Lines of one colour each.
using ColoredLines = std::vector<std::pair<SceneLine, QColor>>;

/// Three bars across each other: what an outlier looks like from everywhere.
vtkNew<vtkPolyData> crossShape();

/// Round enough for a template's point, or for one of ten thousand places on edges.
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
  /// Lines with more of it lie upon those with less.
  void lift(double units);
  void set(const ColoredLines& lines);
};

}  // namespace boresight::ui
