// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/vtk_shapes.h"

#include <algorithm>
#include <array>
#include <utility>

#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
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

/// Nearest and farthest depth of what there is, with some air.
std::pair<double, double> depthRange(const SceneContent& content, const Viewpoint& view) {
  double nearest = 1e300;
  double farthest = 0.0;
  const auto include = [&](const Eigen::Vector3d& at_m) {
    const double depth_m = (view.view_from_station * at_m).z();
    nearest = std::min(nearest, depth_m);
    farthest = std::max(farthest, depth_m);
  };
  const BoundingBox& box = content.bounds;
  for (int corner = 0; corner < 8; ++corner)
    include({((corner & 1) != 0 ? box.maximum_m : box.minimum_m).x(),
             ((corner & 2) != 0 ? box.maximum_m : box.minimum_m).y(),
             ((corner & 4) != 0 ? box.maximum_m : box.minimum_m).z()});
  include(Eigen::Vector3d::Zero());
  for (int axis = 0; axis < 3; ++axis) include(content.axis_length_m * Eigen::Vector3d::Unit(axis));
  for (const Frustum& frustum : content.frusta) {
    include(frustum.apex_m);
    for (const Eigen::Vector3d& corner : frustum.corner_m) include(corner);
  }
  farthest = std::max(farthest, 1e-6);
  return {std::clamp(0.8 * nearest, 1e-3 * farthest, 0.8 * farthest), 1.3 * farthest};
}

}  // namespace

double placeCamera(vtkRenderer& renderer, const SceneContent& content, const Viewpoint& view) {
  const Camera& camera = view.camera;
  const Pose station_from_view = view.view_from_station.inverse();
  const Eigen::Vector3d eye = station_from_view.translation_m;
  const Eigen::Vector3d ahead = station_from_view * Eigen::Vector3d(0.0, 0.0, 1.0);
  const Eigen::Vector3d up = station_from_view.rotation * Eigen::Vector3d(0.0, -1.0, 0.0);
  vtkCamera* placed = renderer.GetActiveCamera();
  placed->SetPosition(eye.data());
  placed->SetFocalPoint(ahead.data());
  placed->SetViewUp(up.data());
  const auto [nearest, farthest] = depthRange(content, view);
  placed->SetClippingRange(nearest, farthest);
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
  actor_->SetMapper(mapper_);
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
  const Pose station_from_view = view.view_from_station.inverse();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> places;
  places->SetNumberOfComponents(2);
  vtkNew<vtkCellArray> quad;
  const QRectF& where = backdrop->where;
  const std::array<QPointF, 4> corners = {where.topLeft(), where.topRight(), where.bottomRight(),
                                          where.bottomLeft()};
  constexpr std::array<std::array<double, 2>, 4> kPlaces = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  const Camera& camera = view.camera;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d ray((corners[i].x() - 0.5 - camera.cx) / camera.fx,
                              (corners[i].y() - 0.5 - camera.cy) / camera.fy, 1.0);
    insert(*points, station_from_view * (0.999 * far_m * ray));
    places->InsertNextTuple(kPlaces[i].data());
  }
  const vtkIdType ids[4] = {0, 1, 2, 3};
  quad->InsertNextCell(4, ids);
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(quad);
  data->GetPointData()->SetTCoords(places);
  mapper_->SetInputData(data);
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
