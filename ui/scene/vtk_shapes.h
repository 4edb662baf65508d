// SPDX-License-Identifier: Apache-2.0
// Lines and clouds of small shapes, as VTK draws them.
#pragma once

#include <utility>
#include <vector>

#include <vtkActor.h>
#include <vtkDoubleArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>

#include <QColor>

#include "ui/scene/scene_content.h"

namespace boresight::ui {

void insert(vtkPoints& points, const Eigen::Vector3d& at_m);

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
