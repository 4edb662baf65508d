// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/vtk_shapes.h"

#include <algorithm>

#include <vtkAppendPolyData.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCubeSource.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>
#include <vtkUnsignedCharArray.h>

namespace boresight::ui {
namespace {

void insert(vtkPoints& points, const Eigen::Vector3d& at_m) {
  points.InsertNextPoint(at_m.x(), at_m.y(), at_m.z());
}

}  // namespace

double placeCamera(vtkRenderer& renderer, const Viewpoint& view) {
  const Camera& camera = view.camera;
  const Pose station_from_view = view.view_from_station.inverse();
  const Eigen::Vector3d eye = station_from_view.translation_m;
  const Eigen::Vector3d ahead = station_from_view * Eigen::Vector3d(0.0, 0.0, 1.0);
  const Eigen::Vector3d up = station_from_view.rotation * Eigen::Vector3d(0.0, -1.0, 0.0);
  vtkCamera* placed = renderer.GetActiveCamera();
  placed->SetPosition(eye.data());
  placed->SetFocalPoint(ahead.data());
  placed->SetViewUp(up.data());
  renderer.ResetCameraClippingRange();
  double nearest = 0.0;
  double farthest = 0.0;
  placed->GetClippingRange(nearest, farthest);
  // Clip x = x/z at pixel u is 2 (u + 0.5) / width - 1; y counts upwards.
  vtkNew<vtkMatrix4x4> projection;
  projection->Zero();
  projection->SetElement(0, 0, 2.0 * camera.fx / camera.width);
  projection->SetElement(0, 2, 1.0 - 2.0 * (camera.cx + 0.5) / camera.width);
  projection->SetElement(1, 1, 2.0 * camera.fy / camera.height);
  projection->SetElement(1, 2, 2.0 * (camera.cy + 0.5) / camera.height - 1.0);
  projection->SetElement(2, 2, -(farthest + nearest) / (farthest - nearest));
  projection->SetElement(2, 3, -2.0 * farthest * nearest / (farthest - nearest));
  projection->SetElement(3, 2, -1.0);
  placed->SetExplicitProjectionTransformMatrix(projection);
  placed->UseExplicitProjectionTransformMatrixOn();
  return farthest;
}

BackdropActor::BackdropActor(vtkRenderer& renderer) {
  texture_->InterpolateOn();
  texture_->MipmapOn();
  square_->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  mapper_->SetInputConnection(square_->GetOutputPort());
  actor_->SetMapper(mapper_);
  actor_->UseBoundsOff();  // lies as far away as can be seen, whatever that is
  actor_->SetTexture(texture_);
  actor_->GetProperty()->SetLighting(false);
  actor_->VisibilityOff();
  renderer.AddActor(actor_);
}

void BackdropActor::place(const std::optional<Backdrop>& backdrop, const Viewpoint& view,
                          double far_m) {
  actor_->SetVisibility(backdrop.has_value());
  if (!backdrop) return;
  if (backdrop->gray.cacheKey() != key_) fillTexture(backdrop->gray);
  const auto corner = [&](const QPointF& at) -> Eigen::Vector3d {
    return view.eyeInStation_m() + 0.999 * far_m * view.rayInStation(at - QPointF(0.5, 0.5));
  };
  Eigen::Vector3d top_left = corner(backdrop->where.topLeft());
  Eigen::Vector3d top_right = corner(backdrop->where.topRight());
  Eigen::Vector3d bottom_left = corner(backdrop->where.bottomLeft());
  square_->SetOrigin(top_left.data());
  square_->SetPoint1(top_right.data());
  square_->SetPoint2(bottom_left.data());
}

void BackdropActor::fillTexture(const QImage& gray) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(gray.width(), gray.height(), 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  for (int y = 0; y < gray.height(); ++y)
    std::copy_n(gray.constScanLine(y), gray.width(),
                static_cast<unsigned char*>(image->GetScalarPointer(0, y, 0)));
  texture_->SetInputData(image);
  texture_->SetColorModeToDirectScalars();
  key_ = gray.cacheKey();
}

namespace {

vtkNew<vtkPolyData> polyDataOf(const ColoredLines& lines) {
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

vtkNew<vtkPolyData> crossShape() {
  vtkNew<vtkAppendPolyData> bars;
  for (int axis = 0; axis < 3; ++axis) {
    vtkNew<vtkCubeSource> bar;
    bar->SetXLength(axis == 0 ? 2.6 : 0.6);
    bar->SetYLength(axis == 1 ? 2.6 : 0.6);
    bar->SetZLength(axis == 2 ? 2.6 : 0.6);
    bars->AddInputConnection(bar->GetOutputPort());
  }
  bars->Update();
  vtkNew<vtkPolyData> shape;
  shape->ShallowCopy(bars->GetOutput());
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
  mapper->SetInputData(polyDataOf(lines));
  actor->SetVisibility(!lines.empty());
}

}  // namespace boresight::ui
