// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/vtk_shapes.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>
#include <vtkUnsignedCharArray.h>

namespace boresight::ui {
namespace {

vtkNew<vtkPolyData> linesOf(const ColoredLines& lines) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  for (const auto& [line, color] : lines) {
    const vtkIdType first = points->GetNumberOfPoints();
    insert(*points, line.first);
    insert(*points, line.second);
    const vtkIdType ends[2] = {first, first + 1};
    cells->InsertNextCell(2, ends);
    const unsigned char rgb[3] = {static_cast<unsigned char>(color.red()),
                                  static_cast<unsigned char>(color.green()),
                                  static_cast<unsigned char>(color.blue())};
    colors->InsertNextTypedTuple(rgb);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  data->GetCellData()->SetScalars(colors);
  return data;
}

}  // namespace

void insert(vtkPoints& points, const Eigen::Vector3d& at_m) {
  points.InsertNextPoint(at_m.x(), at_m.y(), at_m.z());
}

vtkNew<vtkPolyData> crossShape() {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> quads;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 4; ++side) {
      const vtkIdType first = points->GetNumberOfPoints();
      for (int corner = 0; corner < 4; ++corner) {
        const int turn = side + (corner == 1 || corner == 2 ? 1 : 0);
        double at[3];
        at[axis] = corner < 2 ? -1.3 : 1.3;
        at[(axis + 1) % 3] = (turn % 4 == 0 || turn % 4 == 3) ? -0.3 : 0.3;
        at[(axis + 2) % 3] = turn % 4 < 2 ? -0.3 : 0.3;
        points->InsertNextPoint(at);
      }
      const vtkIdType ids[4] = {first, first + 1, first + 2, first + 3};
      quads->InsertNextCell(4, ids);
    }
  vtkNew<vtkPolyData> shape;
  shape->SetPoints(points);
  shape->SetPolys(quads);
  return shape;
}

vtkNew<vtkPolyData> sphereShape(double radius, Roundness roundness) {
  const bool few = roundness == Roundness::kFew;
  vtkNew<vtkSphereSource> sphere;
  sphere->SetRadius(radius);
  sphere->SetThetaResolution(few ? 10 : 4);
  sphere->SetPhiResolution(few ? 6 : 3);
  sphere->Update();
  vtkNew<vtkPolyData> shape;
  shape->ShallowCopy(sphere->GetOutput());
  return shape;
}

Cloud::Cloud() {
  points->SetDataTypeToDouble();
  data->SetPoints(points);
  data->GetPointData()->SetScalars(values);
  mapper->SetInputData(data);
  mapper->SetScaling(true);
  mapper->SetScaleModeToNoDataScaling();
  mapper->SetScalarVisibility(false);
  actor->SetMapper(mapper);
  actor->GetProperty()->SetAmbient(0.6);
  actor->GetProperty()->SetDiffuse(0.5);
}

void Cloud::clear() {
  points->Reset();
  values->Reset();
}

void Cloud::add(const Eigen::Vector3d& at_m, double value) {
  insert(*points, at_m);
  values->InsertNextValue(value);
}

void Cloud::changed() {
  points->Modified();
  values->Modified();
  data->Modified();
  actor->SetVisibility(points->GetNumberOfPoints() > 0);
}

void Cloud::setColor(const QColor& color) {
  actor->GetProperty()->SetColor(color.redF(), color.greenF(), color.blueF());
}

Lines::Lines() {
  actor->SetMapper(mapper);
  actor->GetProperty()->SetLighting(false);
  // In front of the faces that they lie on.
  mapper->SetResolveCoincidentTopologyToPolygonOffset();
  lift(4.0);
}

void Lines::lift(double units) {
  mapper->SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -units);
}

void Lines::set(const ColoredLines& lines) {
  mapper->SetInputData(linesOf(lines));
  actor->SetVisibility(!lines.empty());
}

}  // namespace boresight::ui
