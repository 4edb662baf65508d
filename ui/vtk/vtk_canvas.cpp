// SPDX-License-Identifier: Apache-2.0
#include <QVTKInteractor.h>
#include <QVTKOpenGLNativeWidget.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCullerCollection.h>
#include <vtkDoubleArray.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkGlyph3DMapper.h>
#include <vtkImageData.h>
#include <vtkLookupTable.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>
#include <vtkTexture.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>

#include "ui/vtk/scene_backend.h"
#include "ui/vtk/scene_canvas.h"

namespace boresight::ui {
namespace {

constexpr double kTrailRadius_px = 2.5;

void insert(vtkPoints& points, const Eigen::Vector3d& at_m) {
  points.InsertNextPoint(at_m.x(), at_m.y(), at_m.z());
}

/// Lines of one colour each.
vtkNew<vtkPolyData> linesOf(const std::vector<std::pair<SceneLine, QColor>>& lines) {
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

/// Three bars across each other: what an outlier looks like from everywhere.
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

/// Round enough for a template's point, or for one of ten thousand places on edges.
enum class Roundness { kFew, kMany };
constexpr vtkIdType kManyPoints = 1000;
constexpr double kUnmatchedRadius = 0.45;  ///< of an inlier's

vtkNew<vtkPolyData> sphereShape(double radius, Roundness roundness = Roundness::kFew) {
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

/// A cloud of equal shapes, coloured by a table or all alike; their size follows the view.
struct Cloud {
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> values;
  vtkNew<vtkPolyData> data;
  vtkNew<vtkGlyph3DMapper> mapper;
  vtkNew<vtkActor> actor;

  Cloud() {
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
  void clear() {
    points->Reset();
    values->Reset();
  }
  void add(const Eigen::Vector3d& at_m, double value = 0.0) {
    insert(*points, at_m);
    values->InsertNextValue(value);
  }
  void changed() {
    points->Modified();
    values->Modified();
    data->Modified();
    actor->SetVisibility(points->GetNumberOfPoints() > 0);
  }
  void setColor(const QColor& color) {
    actor->GetProperty()->SetColor(color.redF(), color.greenF(), color.blueF());
  }
};

/// Lines of a constant width on the screen, each with its colour.
struct Lines {
  vtkNew<vtkPolyDataMapper> mapper;
  vtkNew<vtkActor> actor;

  Lines() {
    actor->SetMapper(mapper);
    actor->GetProperty()->SetLighting(false);
    // In front of the faces that they lie on.
    mapper->SetResolveCoincidentTopologyToPolygonOffset();
    lift(4.0);
  }
  void lift(double units) {
    mapper->SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -units);
  }
  void set(const std::vector<std::pair<SceneLine, QColor>>& lines) {
    mapper->SetInputData(linesOf(lines));
    actor->SetVisibility(!lines.empty());
  }
};

class VtkCanvas final : public SceneCanvas {
 public:
  explicit VtkCanvas(QWidget* parent) : widget_(new QVTKOpenGLNativeWidget(parent)) {
    vtkNew<vtkGenericOpenGLRenderWindow> window;
    window->SetMultiSamples(sceneIsDrawnInSoftware() ? 0 : 4);
    widget_->setRenderWindow(window);
    window->AddRenderer(renderer_);
    if (widget_->interactor() != nullptr) widget_->interactor()->SetInteractorStyle(nullptr);
    renderer_->GetCullers()->RemoveAllItems();
    setUpMesh(matched_, kMatchedColor);
    setUpMesh(occluding_, kOccludingColor);
    setUpBackdrop();
    setUpPoints();
    for (Lines* lines : {&mesh_lines_, &axes_, &trail_}) renderer_->AddActor(lines->actor);
    for (std::size_t role = 0; role < frusta_.size(); ++role) {
      // Poses that agree nearly coincide: the later ones are thinner and lie upon the others.
      frusta_[role].lift(4.0 + 6.0 * static_cast<double>(role));
      renderer_->AddActor(frusta_[role].actor);
    }
  }

  QWidget* widget() override { return widget_; }

  void setContent(std::shared_ptr<const SceneContent> content, const SceneLook& look) override {
    const bool other_mesh = !content_ || content_->one != content->one;
    content_ = std::move(content);
    look_ = look;
    if (other_mesh) {
      fillMesh();
      sharp_edges_ = sharpEdges(content_->mesh());
    }
    fillLines();
    fillPoints();
    applyLook();
  }

  void setView(const Viewpoint& view, const std::optional<Backdrop>& backdrop) override {
    view_ = view;
    placeCamera();
    placeBackdrop(backdrop);
    scalePoints();
    const double ratio = widget_->devicePixelRatioF();
    for (Lines* lines : {&axes_, &trail_})
      lines->actor->GetProperty()->SetLineWidth(static_cast<float>(2.0 * ratio));
    for (std::size_t role = 0; role < frusta_.size(); ++role)
      frusta_[role].actor->GetProperty()->SetLineWidth(
          static_cast<float>(poseRoleStyle(static_cast<PoseRole>(role)).width_px * ratio));
    mesh_lines_.actor->GetProperty()->SetLineWidth(static_cast<float>(ratio));
    render();
  }

 private:
  struct MeshActor {
    vtkNew<vtkPolyDataMapper> mapper;
    vtkNew<vtkActor> actor;
  };

  void setUpMesh(MeshActor& mesh, const QColor& color) {
    mesh.actor->SetMapper(mesh.mapper);
    mesh.mapper->SetScalarVisibility(false);
    vtkProperty* property = mesh.actor->GetProperty();
    property->SetColor(color.redF(), color.greenF(), color.blueF());
    property->SetInterpolationToFlat();
    property->SetAmbient(0.25);
    property->SetDiffuse(0.75);
    renderer_->AddActor(mesh.actor);
  }

  void setUpBackdrop() {
    backdrop_texture_->InterpolateOn();
    backdrop_texture_->MipmapOn();
    backdrop_.actor->SetMapper(backdrop_.mapper);
    backdrop_.actor->SetTexture(backdrop_texture_);
    backdrop_.actor->GetProperty()->SetLighting(false);
    backdrop_.actor->VisibilityOff();
    renderer_->AddActor(backdrop_.actor);
  }

  void setUpPoints() {
    constexpr int kColors = 256;
    table_->SetNumberOfTableValues(kColors);
    for (int i = 0; i < kColors; ++i) {
      const QColor color = residualColor(static_cast<double>(i) / (kColors - 1));
      table_->SetTableValue(i, color.redF(), color.greenF(), color.blueF());
    }
    outliers_.mapper->SetSourceData(crossShape());
    unmatched_.setColor(QColor(150, 150, 150));
    selected_.mapper->SetSourceData(sphereShape(2.1));
    selected_.setColor(QColor(255, 235, 60));
    selected_.actor->GetProperty()->SetRepresentationToWireframe();
    trail_points_.mapper->SetSourceData(sphereShape(1.0));
    trail_points_.setColor(poseRoleStyle(PoseRole::kEstimate).color.darker(120));
    trail_now_.mapper->SetSourceData(sphereShape(1.8));
    trail_now_.setColor(poseRoleStyle(PoseRole::kEstimate).color);
    for (Cloud* cloud : {&inliers_, &outliers_}) {
      cloud->mapper->SetScalarVisibility(true);
      cloud->mapper->SetLookupTable(table_);
      cloud->mapper->UseLookupTableScalarRangeOff();
    }
    for (Cloud* cloud :
         {&inliers_, &outliers_, &unmatched_, &selected_, &trail_points_, &trail_now_})
      renderer_->AddActor(cloud->actor);
  }

  void fillMesh() {
    const MeshView mesh = content_->mesh();
    vtkNew<vtkPoints> points;
    points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices_in_station_m.size()));
    for (std::size_t i = 0; i < mesh.vertices_in_station_m.size(); ++i) {
      const Eigen::Vector3f& vertex = mesh.vertices_in_station_m[i];
      points->SetPoint(static_cast<vtkIdType>(i), static_cast<double>(vertex.x()),
                       static_cast<double>(vertex.y()), static_cast<double>(vertex.z()));
    }
    vtkNew<vtkCellArray> matched;
    vtkNew<vtkCellArray> occluding;
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
      const auto& vertex = mesh.faces[i].vertex;
      const vtkIdType corners[3] = {vertex[0], vertex[1], vertex[2]};
      (mesh.parts[mesh.part_of_face[i]].match ? matched : occluding)->InsertNextCell(3, corners);
    }
    fillPart(matched_, points, matched);
    fillPart(occluding_, points, occluding);
  }

  static void fillPart(MeshActor& part, vtkPoints* points, vtkCellArray* faces) {
    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetPolys(faces);
    part.mapper->SetInputData(data);
    part.mapper->SetResolveCoincidentTopologyToPolygonOffset();
  }

  void fillLines() {
    std::vector<std::pair<SceneLine, QColor>> lines;
    const MeshView mesh = content_->mesh();
    const auto vertex = [&mesh](std::int32_t i) -> Eigen::Vector3d {
      return mesh.vertices_in_station_m[static_cast<std::size_t>(i)].cast<double>();
    };
    for (const auto& ends : sharp_edges_)
      lines.push_back({{vertex(ends[0]), vertex(ends[1])}, look_.mesh_lines});
    mesh_lines_.set(lines);

    for (std::size_t role = 0; role < frusta_.size(); ++role) {
      lines.clear();
      for (const Frustum& frustum : content_->frusta)
        if (frustum.role == static_cast<PoseRole>(role))
          for (const SceneLine& line : frustum.lines) lines.push_back({line, frustum.color});
      frusta_[role].set(lines);
    }

    lines.clear();
    for (int axis = 0; axis < 3; ++axis)
      lines.push_back(
          {{Eigen::Vector3d::Zero(), content_->axis_length_m * Eigen::Vector3d::Unit(axis)},
           axisColor(axis)});
    axes_.set(content_->empty() ? std::vector<std::pair<SceneLine, QColor>>() : lines);

    lines.clear();
    for (std::size_t i = 1; i < content_->trail_m.size(); ++i)
      lines.push_back({{content_->trail_m[i - 1], content_->trail_m[i]},
                       poseRoleStyle(PoseRole::kEstimate).color.darker(120)});
    trail_.set(lines);
  }

  void fillPoints() {
    for (Cloud* cloud :
         {&inliers_, &outliers_, &unmatched_, &selected_, &trail_points_, &trail_now_})
      cloud->clear();
    for (const ScenePoint& point : content_->points) {
      Cloud& cloud = point.kind == ScenePointKind::kInlier    ? inliers_
                     : point.kind == ScenePointKind::kOutlier ? outliers_
                                                              : unmatched_;
      cloud.add(point.at_m, point.residual_px);
      if (point.template_index >= 0 && point.template_index == content_->selected_template)
        selected_.add(point.at_m);
    }
    for (std::size_t i = 0; i < content_->trail_m.size(); ++i)
      (static_cast<int>(i) == content_->trail_now ? trail_now_ : trail_points_)
          .add(content_->trail_m[i]);
    for (Cloud* cloud :
         {&inliers_, &outliers_, &unmatched_, &selected_, &trail_points_, &trail_now_})
      cloud->changed();
    for (Cloud* cloud : {&inliers_, &outliers_})
      cloud->mapper->SetScalarRange(0.0, content_->residual_limit_px);
    const auto roundness = [](const Cloud& cloud) {
      return cloud.points->GetNumberOfPoints() > kManyPoints ? Roundness::kMany : Roundness::kFew;
    };
    inliers_.mapper->SetSourceData(sphereShape(1.0, roundness(inliers_)));
    unmatched_.mapper->SetSourceData(sphereShape(kUnmatchedRadius, roundness(unmatched_)));
  }

  void applyLook() {
    const SceneShown& shown = look_.shown;
    const QColor& back = look_.background;
    renderer_->SetBackground(back.redF(), back.greenF(), back.blueF());
    for (MeshActor* mesh : {&matched_, &occluding_}) {
      mesh->actor->SetVisibility(shown.mesh && mesh->mapper->GetInput() != nullptr &&
                                 mesh->mapper->GetInput()->GetNumberOfPolys() > 0);
      mesh->actor->GetProperty()->SetOpacity(look_.mesh_opacity);
    }
    const auto show = [](Lines& lines, bool on) {
      if (!on) lines.actor->VisibilityOff();
    };
    show(mesh_lines_, shown.mesh_edges);
    for (Lines& frustum : frusta_) show(frustum, shown.frusta);
    show(axes_, shown.axes);
    show(trail_, shown.trail);
    for (Cloud* cloud : {&inliers_, &outliers_, &unmatched_, &selected_})
      if (!shown.points) cloud->actor->VisibilityOff();
    for (Cloud* cloud : {&trail_points_, &trail_now_})
      if (!shown.trail) cloud->actor->VisibilityOff();
  }

  /// Nearest and farthest depth of what there is, with some air.
  std::pair<double, double> depthRange() const {
    double nearest = 1e300;
    double farthest = 0.0;
    const auto include = [&](const Eigen::Vector3d& at_m) {
      const double depth_m = (view_.view_from_station * at_m).z();
      nearest = std::min(nearest, depth_m);
      farthest = std::max(farthest, depth_m);
    };
    if (content_) {
      const BoundingBox& box = content_->bounds;
      for (int corner = 0; corner < 8; ++corner)
        include({((corner & 1) != 0 ? box.maximum_m : box.minimum_m).x(),
                 ((corner & 2) != 0 ? box.maximum_m : box.minimum_m).y(),
                 ((corner & 4) != 0 ? box.maximum_m : box.minimum_m).z()});
      include(Eigen::Vector3d::Zero());
      for (int axis = 0; axis < 3; ++axis)
        include(content_->axis_length_m * Eigen::Vector3d::Unit(axis));
      for (const Frustum& frustum : content_->frusta) {
        include(frustum.apex_m);
        for (const Eigen::Vector3d& corner : frustum.corner_m) include(corner);
      }
    }
    farthest = std::max(farthest, 1e-6);
    return {std::clamp(0.8 * nearest, 1e-3 * farthest, 0.8 * farthest), 1.3 * farthest};
  }

  /// Exactly the viewpoint's pinhole: its focal lengths and principal point, not an opening angle.
  void placeCamera() {
    const Camera& camera = view_.camera;
    const Pose station_from_view = view_.view_from_station.inverse();
    const Eigen::Vector3d eye = station_from_view.translation_m;
    const Eigen::Vector3d ahead = station_from_view * Eigen::Vector3d(0.0, 0.0, 1.0);
    const Eigen::Vector3d up = station_from_view.rotation * Eigen::Vector3d(0.0, -1.0, 0.0);
    vtkCamera* placed = renderer_->GetActiveCamera();
    placed->SetPosition(eye.data());
    placed->SetFocalPoint(ahead.data());
    placed->SetViewUp(up.data());
    const auto [nearest, farthest] = depthRange();
    far_m_ = farthest;
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
  }

  /// A textured square behind everything else, as far away as can be seen.
  void placeBackdrop(const std::optional<Backdrop>& backdrop) {
    backdrop_.actor->SetVisibility(backdrop.has_value());
    if (!backdrop) return;
    if (backdrop->gray.cacheKey() != backdrop_key_) fillTexture(backdrop->gray);
    const Pose station_from_view = view_.view_from_station.inverse();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    vtkNew<vtkDoubleArray> places;
    places->SetNumberOfComponents(2);
    vtkNew<vtkCellArray> quad;
    const QRectF& where = backdrop->where;
    const std::array<QPointF, 4> corners = {where.topLeft(), where.topRight(), where.bottomRight(),
                                            where.bottomLeft()};
    constexpr std::array<std::array<double, 2>, 4> kPlaces = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    const Camera& camera = view_.camera;
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector3d ray((corners[i].x() - 0.5 - camera.cx) / camera.fx,
                                (corners[i].y() - 0.5 - camera.cy) / camera.fy, 1.0);
      insert(*points, station_from_view * (0.999 * far_m_ * ray));
      places->InsertNextTuple(kPlaces[i].data());
    }
    const vtkIdType ids[4] = {0, 1, 2, 3};
    quad->InsertNextCell(4, ids);
    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetPolys(quad);
    data->GetPointData()->SetTCoords(places);
    backdrop_.mapper->SetInputData(data);
  }

  void fillTexture(const QImage& gray) {
    vtkNew<vtkImageData> image;
    image->SetDimensions(gray.width(), gray.height(), 1);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
    for (int y = 0; y < gray.height(); ++y)
      std::copy_n(gray.constScanLine(y), gray.width(),
                  static_cast<unsigned char*>(image->GetScalarPointer(0, y, 0)));
    backdrop_texture_->SetInputData(image);
    backdrop_texture_->SetColorModeToDirectScalars();
    backdrop_key_ = gray.cacheKey();
  }

  /// Points keep their size on the screen, as if all were as far away as the scene's centre.
  void scalePoints() {
    if (!content_) return;
    const auto pixel_at = [this](const Eigen::Vector3d& at_m) {
      return std::max((view_.view_from_station * at_m).z(), 1e-9) / view_.camera.fx;
    };
    const double pixel_m = pixel_at(content_->bounds.centre());
    for (Cloud* cloud : {&inliers_, &outliers_, &unmatched_, &selected_})
      cloud->mapper->SetScaleFactor(content_->point_radius_px * pixel_m);
    if (content_->trail_m.empty()) return;
    const double trail_pixel_m = pixel_at(content_->trail_m.back());
    for (Cloud* cloud : {&trail_points_, &trail_now_})
      cloud->mapper->SetScaleFactor(kTrailRadius_px * trail_pixel_m);
  }

  void render() {
    if (widget_->isVisible() && widget_->isValid()) widget_->renderWindow()->Render();
    widget_->update();
  }

  QVTKOpenGLNativeWidget* widget_;
  vtkNew<vtkRenderer> renderer_;
  MeshActor matched_;
  MeshActor occluding_;
  MeshActor backdrop_;
  vtkNew<vtkTexture> backdrop_texture_;
  qint64 backdrop_key_ = 0;
  vtkNew<vtkLookupTable> table_;
  Lines mesh_lines_;
  std::array<Lines, kPoseRoles> frusta_;  ///< by role
  Lines axes_;
  Lines trail_;
  Cloud inliers_;
  Cloud outliers_;
  Cloud unmatched_;
  Cloud selected_;
  Cloud trail_points_;
  Cloud trail_now_;
  std::shared_ptr<const SceneContent> content_;
  std::vector<std::array<std::int32_t, 2>> sharp_edges_;
  SceneLook look_;
  Viewpoint view_;
  double far_m_ = 1.0;
};

}  // namespace

std::unique_ptr<SceneCanvas> makeVtkCanvas(QWidget* parent) {
  return std::make_unique<VtkCanvas>(parent);
}

}  // namespace boresight::ui
