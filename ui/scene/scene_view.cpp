// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_view.h"

#include <algorithm>

#include <QtWidgets>

#include "sessions/io/undistort.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/panels/widgets.h"
#include "ui/scene/scene_annotator.h"
#include "ui/scene/scene_input.h"
#include "ui/scene/scene_overlay.h"

namespace boresight::ui {
namespace {

QImage grayOf(const boresight::ImageView& image) {
  QImage gray(image.width, image.height, QImage::Format_Grayscale8);
  for (int y = 0; y < image.height; ++y) std::copy_n(image.row(y), image.width, gray.scanLine(y));
  return gray;
}

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
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  buildBar();
  layout->addWidget(bar_);
  canvas_ = backend_ == SceneBackend::kVtk ? makeVtkCanvas(this) : makePictureCanvas(this);
  QWidget* drawn = canvas_->widget();
  drawn->setObjectName(QStringLiteral("sceneCanvas"));
  drawn->setAccessibleName(tr("Scene"));
  drawn->setFocusPolicy(Qt::StrongFocus);
  drawn->setMouseTracking(false);
  drawn->setMinimumSize(160, 120);
  layout->addWidget(drawn, 1);
  overlay_ = new SceneOverlay(drawn);
  connectInput(*new SceneInput(*drawn));
  readout_ = named(new QLabel(this), "sceneReadout");
  readout_->setContentsMargins(6, 2, 6, 2);
  readout_->setWordWrap(true);
  readout_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  readout_->setText(tr("Click a template or a point of the mesh."));
  layout->addWidget(readout_);
}

void SceneView::buildBar() {
  bar_ = new SceneBar(look_.shown, this);
  connect(bar_, &SceneBar::resetAsked, this, &SceneView::resetView);
  connect(bar_, &SceneBar::lookFromAsked, this, &SceneView::lookFrom);
  connect(bar_, &SceneBar::throughCameraAsked, this, &SceneView::setThroughCamera);
  connect(bar_, &SceneBar::throughRoleAsked, this, &SceneView::setThroughRole);
  connect(bar_, &SceneBar::shownAsked, this, &SceneView::setShown);
  connect(bar_, &SceneBar::meshOpacityAsked, this, &SceneView::setMeshOpacity);
}

void SceneView::connectInput(const SceneInput& input) {
  connect(&input, &SceneInput::resetAsked, this, &SceneView::resetView);
  connect(&input, &SceneInput::lookFromAsked, this, &SceneView::lookFrom);
  connect(&input, &SceneInput::throughCameraToggled, this,
          [this] { setThroughCamera(!throughCamera()); });
  connect(&input, &SceneInput::clicked, this, &SceneView::pick);
  connect(&input, &SceneInput::dragged, this,
          [this](const QPointF& moved, Qt::MouseButtons buttons, Qt::KeyboardModifiers modifiers) {
            navigation_.drag(moved, buttons, modifiers, canvas()->height());
            updateView();
          });
  connect(&input, &SceneInput::turned, this, [this](const QPointF& by) {
    navigation_.turn(by, canvas()->height());
    updateView();
  });
  connect(&input, &SceneInput::zoomed, this, [this](const QPointF& at, double notches) {
    navigation_.zoom(at, notches);
    updateView();
  });
  connect(&input, &SceneInput::resized, this, [this] { overlay_->resize(canvas()->size()); });
  // After the canvas itself has taken note.
  connect(&input, &SceneInput::resized, this, &SceneView::updateView, Qt::QueuedConnection);
}

void SceneView::setAnnotation(AnnotationController& annotation, StationSnapper& snapper) {
  annotator_ = new SceneAnnotator(*canvas(), annotation, snapper);
  overlay_->setOver(
      [this](QPainter& painter) { annotator_->paint(painter, QRectF(overlay_->rect())); });
  connect(annotator_, &SceneAnnotator::changed, this, [this] {
    overlay_->update();
    updateNote();
    if (annotator_->places()) readout_->setText(annotator_->place());
  });
  connect(&annotation, &AnnotationController::modeChanged, this, [this] {
    navigation_.setStationAlone(annotator_->places(), *content_);
    readout_->setText(tr("Click a template, a mark or a point of the mesh."));
    updateView();
  });
  connect(annotator_, &SceneAnnotator::told, this, &SceneView::told);
  refreshSoon();
}

void SceneView::refreshSoon() {
  if (refresh_pending_) return;
  refresh_pending_ = true;
  QMetaObject::invokeMethod(
      this,
      [this] {
        if (isVisible()) refresh();  // else when it is shown
      },
      Qt::QueuedConnection);
}

void SceneView::refresh() {
  refresh_pending_ = false;
  const std::shared_ptr<const SceneContent> before = content_;
  SceneContent now = sceneContent(state_);
  if (annotator_ && !now.empty())
    for (Frustum& frustum : annotator_->rigFrusta(now.bounds.centre()))
      now.frusta.push_back(std::move(frustum));
  content_ = std::make_shared<const SceneContent>(std::move(now));
  if (content_->one != before->one) {
    overlay_->setMark(std::nullopt);
    backdrop_ = QImage();
    backdrop_of_.reset();
    // Another image of the same station leaves the view where somebody has put it.
    const bool same_place = !before->empty() && !content_->empty() &&
                            before->bounds.minimum_m == content_->bounds.minimum_m &&
                            before->bounds.maximum_m == content_->bounds.maximum_m;
    if (!same_place) navigation_.startOver(*content_);
    navigation_.showWholeImage();
  }
  canvas_->setContent(content_, look_);
  overlay_->setContent(content_, look_);
  if (throughCamera()) orderBackdrop();
  updateView();
}

void SceneView::resetView() {
  navigation_.reset(*content_);
  updateView();
}

void SceneView::lookFrom(StandardView view) {
  setThroughCamera(false);
  navigation_.lookFrom(view);
  updateView();
}

void SceneView::setThroughCamera(bool through) {
  if (through == throughCamera()) return;
  navigation_.setThroughCamera(through);
  bar_->setThroughCamera(through);
  if (through) orderBackdrop();
  updateLook();
}

void SceneView::setThroughRole(PoseRole role) {
  role_ = role;
  bar_->setThroughRole(role);
  updateView();
}

void SceneView::setShown(const SceneShown& shown) {
  look_.shown = shown;
  bar_->setShown(shown);
  updateLook();
}

void SceneView::setMeshOpacity(double opacity) {
  (throughCamera() ? through_opacity_ : free_opacity_) = std::clamp(opacity, 0.0, 1.0);
  updateLook();
}

void SceneView::updateLook() {
  look_.mesh_opacity = throughCamera() ? through_opacity_ : free_opacity_;
  const bool dark = palette().color(QPalette::Window).lightnessF() < 0.5;
  look_.background = dark ? QColor(38, 40, 44) : QColor(226, 229, 233);
  look_.mesh_lines = throughCamera() ? QColor(255, 215, 70) : QColor(24, 26, 30);
  bar_->setMeshOpacity(look_.mesh_opacity);
  canvas_->setContent(content_, look_);
  overlay_->setContent(content_, look_);
  updateView();
}

Pose SceneView::throughPose() const {
  if (role_ == PoseRole::kEstimate) return state_.shownPose();
  return poseOf(state_, role_).value_or(state_.shownPose());
}

Viewpoint SceneView::viewpoint() const {
  return navigation_.viewpoint(*content_, throughPose(), canvas()->size());
}

void SceneView::updateView() {
  overlay_->setGeometry(canvas()->rect());
  navigation_.fitImage(*content_, canvas()->size());
  const Viewpoint view = viewpoint();
  std::optional<Backdrop> backdrop;
  if (backdropReady())
    backdrop = Backdrop{backdrop_, imageTransform().toWidget(
                                       QRectF(-0.5, -0.5, backdrop_.width(), backdrop_.height()))};
  canvas_->setView(view, backdrop);
  overlay_->setView(view);
  if (annotator_) annotator_->setShot({content_, look_, view, backdrop});
  updateNote();
}

/// Taking out the distortion takes a while: it is done off the UI's thread, and once per case.
void SceneView::orderBackdrop() {
  const ViewState::CasePtr one = content_->one;
  if (!one || backdrop_of_.lock() == one) return;
  backdrop_of_ = one;
  backdrop_ = QImage();
  if (one->source.camera.model == CameraModel::kPinhole) {
    backdrop_ = grayOf(one->image.view());
    return;
  }
  runner_.start(
      QStringLiteral("backdrop"),
      [one](const std::stop_token&) {
        return grayOf(sessions::undistort(one->source.camera, one->image.view()).view());
      },
      [this, one](const QImage& gray) {
        if (backdrop_of_.lock() != one) return;
        backdrop_ = gray;
        updateView();
      });
}

void SceneView::updateNote() {
  QString note;
  if (throughCamera() && !content_->empty()) {
    if (backdrop_.isNull())
      note = tr("Taking the lens distortion out of the image ...");
    else if (content_->one->source.camera.model != CameraModel::kPinhole)
      note = tr("Undistorted: the image is shown as a camera without lens distortion sees it");
    if (role_ == PoseRole::kTruth && !content_->one->source.camera_from_station_truth)
      note = tr("This case has no truth; you look through the shown pose");
  } else if (backend_ == SceneBackend::kPicture && !content_->empty()) {
    note = tr("Drawn without OpenGL");
  }
  const QString step = annotator_ && !content_->empty() ? annotator_->nextStep() : QString();
  if (!step.isEmpty()) note = step;
  overlay_->setNote(note);
}

void SceneView::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  if (refresh_pending_) refresh();
}

void SceneView::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange) updateLook();
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
    readout_->setText(tr("Template %1").arg(picked));
    state_.selectTemplate(picked);
    return;
  }
  const std::optional<MeshPick> place = pickMesh(*content_, view, pixel);
  overlay_->setMark(place ? std::optional(place->at_m) : std::nullopt);
  if (!place) {
    readout_->setText(tr("Nothing there: click a template or a point of the mesh."));
    return;
  }
  const QString where = place->vertex >= 0 ? tr("vertex %1").arg(place->vertex) : tr("on a face");
  readout_->setText(stationPlaceText(place->at_m, where));
  Q_EMIT meshPointPicked(place->at_m, place->vertex);
}

}  // namespace boresight::ui
