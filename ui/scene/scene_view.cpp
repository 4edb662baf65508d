// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QtWidgets>

#include "sessions/io/cameras/undistort.h"
#include "sessions/trace/surface_point.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/annotation/station_snapper.h"
#include "ui/scene/scene_annotator.h"
#include "ui/scene/scene_overlay.h"
#include "ui/views/display_image.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {
namespace {

QString nameOf(const char* name) { return QCoreApplication::translate("SceneView", name); }

}  // namespace

SceneView::SceneView(ViewState& state, QWidget* parent, SceneBackend backend)
    : QWidget(parent),
      state_(state),
      backend_(backend),
      content_(std::make_shared<const SceneContent>()) {
  build();
  updateLook();
  state_.onChange(ViewChange::kCase | ViewChange::kSnapshot | ViewChange::kCursor |
                      ViewChange::kNudgedPose | ViewChange::kAnnotatedPose | ViewChange::kTemplate,
                  this, &SceneView::refreshSoon);
  refreshSoon();
}

void SceneView::build() {
  ui_.setupUi(this);
  canvas_ = backend_ == SceneBackend::kVtk ? makeVtkCanvas(this) : makePictureCanvas(this);
  QWidget* drawn = canvas_->widget();
  drawn->setObjectName(QStringLiteral("sceneCanvas"));
  drawn->setAccessibleName(tr("Scene"));
  drawn->setFocusPolicy(Qt::StrongFocus);
  drawn->setMouseTracking(true);  // what is under the pointer is shown in the image
  drawn->setMinimumSize(160, 120);
  ui_.column->insertWidget(1, drawn, 1);
  overlay_ = new SceneOverlay(drawn);
  navigation_ = new SceneNavigation(*drawn);
  connect(navigation_, &SceneNavigation::changed, this, &SceneView::updateView);
  connect(navigation_, &SceneNavigation::throughCameraChanged, this, &SceneView::showThroughCamera);
  connect(navigation_, &SceneNavigation::clicked, this, &SceneView::pick);
  connect(navigation_, &SceneNavigation::hovered, this, &SceneView::hover);
  connect(navigation_, &SceneNavigation::left, this,
          [this] { Q_EMIT stationPlaceHovered(std::nullopt); });
  buildBar();
}

void SceneView::buildBar() {
  auto* views = new QMenu(ui_.views);
  for (const StandardKey& key : kStandardKeys)
    views->addAction(nameOf(key.name) + QLatin1Char('\t') + QKeySequence(key.key).toString(), this,
                     [this, key] { navigation_->lookFrom(key.view); });
  ui_.views->setMenu(views);
  ui_.show->setMenu(showMenu());
  for (const auto& [name, role] : {std::pair(tr("shown pose"), PoseRole::kEstimate),
                                   {tr("seed"), PoseRole::kSeed},
                                   {tr("truth"), PoseRole::kTruth},
                                   {tr("annotated"), PoseRole::kAnnotated}})
    ui_.throughRole->addItem(name, static_cast<int>(role));
  connect(ui_.reset, &QToolButton::clicked, navigation_, &SceneNavigation::reset);
  connect(ui_.throughCamera, &QToolButton::toggled, navigation_,
          &SceneNavigation::setThroughCamera);
  connect(ui_.throughRole, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this] {
    role_ = static_cast<PoseRole>(ui_.throughRole->currentData().toInt());
    updateView();
  });
}

/// What of the scene is drawn, and the opacity of the mesh.
QMenu* SceneView::showMenu() {
  auto* menu = new QMenu(ui_.show);
  const auto add = [&](const char* name, const QString& title, bool SceneShown::*part) {
    QAction* action = menu->addAction(title);
    action->setObjectName(QLatin1String(name));
    action->setCheckable(true);
    action->setChecked(look_.shown.*part);
    connect(action, &QAction::toggled, this, [this, part](bool on) {
      look_.shown.*part = on;
      updateLook();
    });
  };
  add("showMesh", tr("Mesh"), &SceneShown::mesh);
  add("showMeshEdges", tr("Edges of the mesh"), &SceneShown::mesh_edges);
  add("showCameras", tr("Cameras"), &SceneShown::frusta);
  add("showTrail", tr("Trail of the iterations"), &SceneShown::trail);
  add("showPoints", tr("Template points"), &SceneShown::points);
  add("showAxes", tr("Axes of the station"), &SceneShown::axes);
  menu->addSeparator();
  opacity_ = new QSlider(Qt::Horizontal);
  opacity_->setRange(0, 100);
  opacity_->setToolTip(tr("Opacity of the mesh, in percent"));
  opacity_->setAccessibleName(tr("Opacity of the mesh"));
  connect(opacity_, &QSlider::valueChanged, this,
          [this](int percent) { setMeshOpacity(0.01 * percent); });
  auto* action = new QWidgetAction(menu);
  action->setDefaultWidget(opacity_);
  menu->addSection(tr("Opacity of the mesh"));
  menu->addAction(action);
  return menu;
}

void SceneView::setAnnotation(AnnotationController& annotation, StationSnapper& snapper) {
  snapper_ = &snapper;
  annotator_ = new SceneAnnotator(*canvas(), annotation, snapper);
  overlay_->paint_over = [this](QPainter& painter) {
    annotator_->paint(painter, QRectF(overlay_->rect()));
  };
  connect(annotator_, &SceneAnnotator::changed, this, [this] {
    updateNote();
    if (annotator_->places()) ui_.sceneReadout->setText(annotator_->place());
  });
  connect(&annotation, &AnnotationController::modeChanged, this, [this] {
    navigation_->setStationAlone(annotator_->places());
    ui_.sceneReadout->setText(tr("Click a template, an annotation or a point of the mesh."));
  });
  refreshSoon();
}

void SceneView::refreshSoon() {
  if (refresh_pending_) return;
  refresh_pending_ = true;
  const auto refresh_if_visible = [this] {
    if (isVisible()) refresh();  // else when it is shown
  };
  QMetaObject::invokeMethod(this, refresh_if_visible, Qt::QueuedConnection);
}

void SceneView::refresh() {
  refresh_pending_ = false;
  const std::shared_ptr<const SceneContent> before = content_;
  SceneContent after = sceneContent(state_);
  if (annotator_ && !after.empty())
    for (Frustum& frustum : annotator_->rigFrusta(after.bounds.centre()))
      after.frusta.push_back(std::move(frustum));
  content_ = std::make_shared<const SceneContent>(std::move(after));
  if (content_->one != before->one) {
    overlay_->clicked.reset();
    overlay_->hovered.reset();
    ui_.sceneReadout->setText(tr("Click a template, an annotation or a point of the mesh."));
    backdrop_ = QImage();
    backdrop_of_.reset();
  }
  navigation_->setContent(content_);
  canvas_->setContent(content_, look_);
  if (navigation_->throughCamera()) orderBackdrop();
  updateView();
}

void SceneView::showThroughCamera() {
  ui_.throughCamera->setChecked(navigation_->throughCamera());
  if (navigation_->throughCamera()) orderBackdrop();
  updateLook();
}

void SceneView::setMeshOpacity(double opacity) {
  (navigation_->throughCamera() ? through_opacity_ : free_opacity_) = std::clamp(opacity, 0.0, 1.0);
  updateLook();
}

void SceneView::updateLook() {
  look_.mesh_opacity = navigation_->throughCamera() ? through_opacity_ : free_opacity_;
  const bool dark = palette().color(QPalette::Window).lightnessF() < 0.5;
  look_.background = dark ? QColor(38, 40, 44) : QColor(226, 229, 233);
  look_.mesh_lines = navigation_->throughCamera() ? QColor(255, 215, 70) : QColor(24, 26, 30);
  const QSignalBlocker blocked(opacity_);
  opacity_->setValue(static_cast<int>(std::lround(100.0 * look_.mesh_opacity)));
  canvas_->setContent(content_, look_);
  updateView();
}

Pose SceneView::throughPose() const {
  if (role_ == PoseRole::kEstimate || state_.isBlind()) return state_.shownPose();
  return poseOf(state_, role_).value_or(state_.shownPose());
}

void SceneView::updateView() {
  overlay_->setGeometry(canvas()->rect());
  navigation_->fitImage();
  const Viewpoint view = viewpoint();
  std::optional<Backdrop> backdrop;
  if (backdropReady())
    backdrop = Backdrop{backdrop_, navigation_->image().toWidget(
                                       QRectF(-0.5, -0.5, backdrop_.width(), backdrop_.height()))};
  canvas_->setView(view, backdrop);
  overlay_->content = content_;
  overlay_->look = look_;
  overlay_->view = view;
  if (annotator_) annotator_->setShot({content_, look_, view, backdrop});
  updateNote();
}

/// Taking out the distortion takes a while: it is done off the UI's thread, and once per case.
void SceneView::orderBackdrop() {
  const ViewState::CasePtr loaded_case = content_->one;
  if (!loaded_case || backdrop_of_.lock() == loaded_case) return;
  backdrop_of_ = loaded_case;
  backdrop_ = QImage();
  if (loaded_case->source.camera.model == CameraModel::kPinhole) {
    backdrop_ = grayImage(loaded_case->image.view());
    return;
  }
  runner_.replace(
      undistorting_,
      [loaded_case](const std::stop_token&) {
        return grayImage(
            sessions::undistort(loaded_case->source.camera, loaded_case->image.view()).view());
      },
      [this, loaded_case](const QImage& gray) {
        if (backdrop_of_.lock() != loaded_case) return;
        backdrop_ = gray;
        updateView();
      },
      reportTo(this, &SceneView::failed));
}

void SceneView::updateNote() {
  QString note;
  if (navigation_->throughCamera() && !content_->empty()) {
    if (backdrop_.isNull())
      note = tr("Removing the lens distortion from the image ...");
    else if (content_->one->source.camera.model != CameraModel::kPinhole)
      note = tr("Undistorted: the image is shown without lens distortion");
    if (role_ == PoseRole::kTruth && !content_->one->source.camera_from_station_truth)
      note = tr("This case has no truth; the view uses the shown pose");
  } else if (backend_ == SceneBackend::kPicture && !content_->empty()) {
    note = tr("Drawn without OpenGL");
  }
  const QString step = annotator_ && !content_->empty() ? annotator_->nextStep() : QString();
  if (!step.isEmpty()) note = step;
  overlay_->note = note;
  overlay_->update();
}

void SceneView::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  if (refresh_pending_) refresh();
}

void SceneView::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() != QEvent::PaletteChange) return;
  updateLook();
  refreshSoon();  // the colours of poses are those of the ground
}

void SceneView::pick(const QPointF& at, Qt::KeyboardModifiers modifiers) {
  if (content_->empty()) return;
  if (annotator_ && annotator_->click(at, modifiers)) return;
  pickInScene(at - QPointF(0.5, 0.5));  // the centre of the top-left pixel is (0, 0)
}

void SceneView::pickInScene(const QPointF& pixel) {
  const Viewpoint view = viewpoint();
  const int picked = look_.shown.points ? pickTemplate(*content_, view, pixel) : -1;
  if (picked >= 0) {
    ui_.sceneReadout->setText(tr("Template %1").arg(picked));
    state_.selectTemplate(picked);
    return;
  }
  std::optional<SceneAim> aim = annotator_ ? annotator_->aimAt(pixel) : std::nullopt;
  if (!aim) {
    if (const auto surface = surfaceAt(pixel)) {
      aim.emplace().point_in_station_m = *surface;
      aim->text = tr("surface");
    }
  }
  overlay_->clicked = aim ? std::optional(aim->point_in_station_m) : std::nullopt;
  overlay_->update();
  ui_.sceneReadout->setText(aim ? stationPlaceText(aim->point_in_station_m, aim->text)
                                : tr("No object there: click a template or a point of the mesh."));
}

void SceneView::hover(const QPointF& at) {
  showStationPlace(std::nullopt);  // of another view
  if (content_->empty()) return;
  Q_EMIT stationPlaceHovered(surfaceAt(at - QPointF(0.5, 0.5)));
}

/// By the tree of faces once it is there: every move of the pointer asks.
std::optional<Eigen::Vector3d> SceneView::surfaceAt(const QPointF& pixel) const {
  const Viewpoint view = viewpoint();
  if (snapper_ && snapper_->mesh())
    return snapper_->mesh()->surfaceAt(view.camera, view.view_from_station, vectorOf(pixel));
  const auto surface = sessions::surfacePointAt(view.camera, content_->mesh(),
                                                view.view_from_station, vectorOf(pixel));
  return surface ? std::optional(surface->in_station_m) : std::nullopt;
}

void SceneView::showStationPlace(const std::optional<Eigen::Vector3d>& point_in_station_m) {
  if (point_in_station_m == overlay_->hovered) return;
  overlay_->hovered = point_in_station_m;
  overlay_->update();
}

}  // namespace boresight::ui
