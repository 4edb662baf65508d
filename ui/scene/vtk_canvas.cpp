// SPDX-License-Identifier: Apache-2.0
#include <QVTKInteractor.h>
#include <QVTKOpenGLNativeWidget.h>
#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCullerCollection.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include <QtWidgets>
#include <algorithm>

#include "ui/plots/plot_colors.h"
#include "ui/scene/scene_canvas.h"
#include "ui/scene/vtk_shapes.h"

namespace boresight::ui {
namespace {

constexpr double kTrailRadius_px = 2.5;
constexpr vtkIdType kManyPoints = 1000;
constexpr double kUnmatchedRadius = 0.45;  ///< of an inlier's

/// What a trial context says of itself; empty when none can be had.
QString rendererName() {
  QOpenGLContext context;
  context.setFormat(QSurfaceFormat::defaultFormat());
  if (!context.create()) return {};
  QOffscreenSurface surface;
  surface.setFormat(context.format());
  surface.create();
  if (!surface.isValid() || !context.makeCurrent(&surface)) return {};
  const QSurfaceFormat format = context.format();
  const auto* name = reinterpret_cast<const char*>(context.functions()->glGetString(GL_RENDERER));
  const QString renderer = QString::fromUtf8(name != nullptr ? name : "unknown");
  context.doneCurrent();
  const bool enough =
      format.renderableType() != QSurfaceFormat::OpenGLES && format.version() >= qMakePair(3, 2);
  return enough ? renderer : QString();
}

/// Of the one trial that is made.
const QString& triedRenderer() {
  static const QString name = rendererName();
  return name;
}

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
    const bool other_mesh = !content_ || !sameMesh(*content_, *content);
    const bool other_color = look_.mesh_lines != look.mesh_lines;
    content_ = std::move(content);
    look_ = look;
    if (other_mesh) {
      fillMesh();
      sharp_edges_ = sharpEdges(content_->mesh());
    }
    if (other_mesh || other_color) fillMeshLines();
    fillLines();
    fillPoints();
    applyLook();
  }

  void setView(const Viewpoint& view, const std::optional<Backdrop>& backdrop) override {
    view_ = view;
    const double far_m = placeCamera(*renderer_, view_);
    backdrop_.place(backdrop, view_, far_m);
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

  void setUpPoints() {
    constexpr int kColors = 256;
    table_->SetNumberOfTableValues(kColors);
    for (int i = 0; i < kColors; ++i) {
      const QColor color = heatColor(static_cast<double>(i) / (kColors - 1));
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
    for (Cloud* cloud : clouds_) renderer_->AddActor(cloud->actor);
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

  void fillMeshLines() {
    ColoredLines lines;
    for (const SceneLine& edge : sharp_edges_) lines.push_back({edge, look_.mesh_lines});
    mesh_lines_.set(lines);
  }

  void fillLines() {
    ColoredLines lines;
    for (std::size_t role = 0; role < frusta_.size(); ++role) {
      lines.clear();
      for (const Frustum& frustum : content_->frusta)
        if (frustum.role == static_cast<PoseRole>(role))
          for (const SceneLine& line : frustum.lines) lines.push_back({line, frustum.color});
      frusta_[role].set(lines);
    }
    axes_.set(axisLines(*content_));
    trail_.set(trailLines(*content_));
  }

  void fillPoints() {
    for (Cloud* cloud : clouds_) cloud->clear();
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
    for (Cloud* cloud : clouds_) cloud->changed();
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
    const auto show = [](auto& drawn, bool on) {
      if (!on) drawn.actor->VisibilityOff();
    };
    mesh_lines_.actor->SetVisibility(shown.mesh_edges && !sharp_edges_.empty());
    for (Lines& frustum : frusta_) show(frustum, shown.frusta);
    show(axes_, shown.axes);
    show(trail_, shown.trail);
    for (Cloud* cloud : {&inliers_, &outliers_, &unmatched_, &selected_})
      show(*cloud, shown.points);
    for (Cloud* cloud : {&trail_points_, &trail_now_}) show(*cloud, shown.trail);
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
  BackdropActor backdrop_{*renderer_};
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
  const std::array<Cloud*, 6> clouds_ = {&inliers_,  &outliers_,     &unmatched_,
                                         &selected_, &trail_points_, &trail_now_};
  std::shared_ptr<const SceneContent> content_;
  std::vector<SceneLine> sharp_edges_;
  SceneLook look_;
  Viewpoint view_;
};

}  // namespace

std::unique_ptr<SceneCanvas> makeVtkCanvas(QWidget* parent) {
  return std::make_unique<VtkCanvas>(parent);
}

void prepareSceneSurface() {
  QSurfaceFormat::setDefaultFormat(QVTKOpenGLNativeWidget::defaultFormat());
}

SceneBackend decideSceneBackend(const QString& platform, const QString& wish,
                                const std::function<bool()>& context_works) {
  if (wish == QLatin1String("picture")) return SceneBackend::kPicture;
  static const QStringList kPlatforms = {QStringLiteral("xcb"), QStringLiteral("windows"),
                                         QStringLiteral("cocoa")};
  if (!kPlatforms.contains(platform)) return SceneBackend::kPicture;
  return context_works() ? SceneBackend::kVtk : SceneBackend::kPicture;
}

SceneBackend sceneBackend() {
  static const SceneBackend decided =
      decideSceneBackend(QGuiApplication::platformName(), qEnvironmentVariable("BORESIGHT_SCENE"),
                         [] { return !triedRenderer().isEmpty(); });
  return decided;
}

bool sceneIsDrawnInSoftware() {
  if (sceneBackend() != SceneBackend::kVtk) return true;
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader"})
    if (triedRenderer().contains(QLatin1String(name), Qt::CaseInsensitive)) return true;
  return false;
}

}  // namespace boresight::ui
