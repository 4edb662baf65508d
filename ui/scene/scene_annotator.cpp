// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_annotator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <QtWidgets>

#include "ui/annotation/annotation_aim.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/annotation/loupe.h"
#include "ui/annotation/station_snapper.h"
#include "ui/views/overlay_painters.h"
#include "ui/views/view_transform.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

/// Pixel (0, 0) of the canvas has its centre at (0.5, 0.5).
QPointF pixelAt(const QPointF& at) { return at - QPointF(0.5, 0.5); }

/// magnifiedView() for the camera's image behind the scene, cut to the part that the square shows.
std::optional<Backdrop> magnifiedBackdrop(const std::optional<Backdrop>& backdrop,
                                          const QPointF& pixel, double magnification, int side) {
  if (!backdrop) return std::nullopt;
  const double scale = magnification * backdrop->where.width() / backdrop->gray.width();
  const QPointF corner = magnification * (backdrop->where.topLeft() - pixel - QPointF(0.5, 0.5)) +
                         QPointF(0.5 * side, 0.5 * side);
  // Painters lose their way on pictures a million pixels wide.
  const QRectF shown(-corner / scale, QSizeF(side, side) / scale);
  const QRect cut = shown.toAlignedRect().intersected(backdrop->gray.rect());
  if (cut.isEmpty()) return std::nullopt;
  return Backdrop{backdrop->gray.copy(cut),
                  QRectF(corner + scale * QPointF(cut.topLeft()), scale * QSizeF(cut.size()))};
}

}  // namespace

Viewpoint magnifiedView(const Viewpoint& view, const QPointF& pixel, double magnification,
                        int side) {
  Viewpoint viewpoint = view;
  const double middle = 0.5 * (side - 1);
  viewpoint.camera.width = viewpoint.camera.height = side;
  viewpoint.camera.fx *= magnification;
  viewpoint.camera.fy *= magnification;
  viewpoint.camera.cx = (view.camera.cx - pixel.x()) * magnification + middle;
  viewpoint.camera.cy = (view.camera.cy - pixel.y()) * magnification + middle;
  if (prepareCamera(viewpoint.camera) != Status::kOk) viewpoint.camera.valid_radius = 0.0;
  return viewpoint;
}

SceneLoupe::SceneLoupe(QWidget* canvas, Over over) : QWidget(canvas), over_(std::move(over)) {
  setObjectName(QStringLiteral("sceneLoupe"));
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setFocusPolicy(Qt::NoFocus);
  hide();
}

void SceneLoupe::setMagnification(double magnification) {
  const double next = std::clamp(magnification, kLeastMagnification, kMostMagnification);
  if (next == magnification_) return;
  magnification_ = next;
  if (isVisible()) order();
}

void SceneLoupe::lookAt(const SceneShot& shot, const std::optional<QPointF>& pixel) {
  shot_ = shot;
  pixel_ = pixel;
  const bool shown = pixel_ && shot_.content && !shot_.content->empty();
  if (shown) {
    putLoupeAside(*this, {0.42, 120.0, 280.0}, pixel_->toPoint(), left_);
    order();
  }
  setVisible(shown);
}

void SceneLoupe::order() {
  const Viewpoint view = magnifiedView(shot_.view, *pixel_, magnification_, width());
  const auto backdrop = magnifiedBackdrop(shot_.backdrop, *pixel_, magnification_, width());
  runner_.replace(
      drawing_,
      [content = shot_.content, look = shot_.look, view, backdrop,
       ratio = devicePixelRatioF()](const std::stop_token&) {
        return drawScenePicture(*content, look, view, backdrop, ratio);
      },
      [this, view](const QImage& picture) {
        picture_ = picture;
        picture_view_ = view;
        problem_.clear();
        update();
      },
      [this](const QString& message) {
        picture_ = {};
        problem_ = message;
        update();
      });
}

void SceneLoupe::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), shot_.look.background);
  if (!picture_.isNull()) {
    painter.drawImage(0, 0, picture_);
    over_(painter, picture_view_);
  }
  painter.setRenderHint(QPainter::Antialiasing, true);
  paintLoupeCross(painter, size());
  paintLoupeFoot(painter, *this,
                 problem_.isEmpty() ? tr("%1x").arg(magnification_, 0, 'g', 3) : problem_);
}

SceneAnnotator::SceneAnnotator(QWidget& canvas, AnnotationController& annotation,
                               StationSnapper& snapper)
    : QObject(&canvas),
      canvas_(canvas),
      annotation_(annotation),
      snapper_(snapper),
      loupe_(new SceneLoupe(&canvas, [this](QPainter& painter, const Viewpoint& view) {
        const SceneAnnotationPainter annotations(painter, view, mesh());
        annotations.paintMarks(annotations_);
        const double middle = 0.5 * (view.camera.width - 1);
        if (aim_) annotations.paintAim(*aim_, {middle, middle});
      })) {
  canvas_.installEventFilter(this);
  connect(&annotation_, &AnnotationController::modeChanged, this, &SceneAnnotator::showMode);
  using Controller = AnnotationController;
  connectEach(annotation_, this, &SceneAnnotator::showAnnotations, &Controller::annotationsChanged,
              &Controller::selectionChanged, &Controller::solutionChanged);
  connect(&snapper_, &StationSnapper::meshChanged, this, &SceneAnnotator::updateAim);
  showMode();
  showAnnotations();
}

bool SceneAnnotator::places() const { return annotation_.mode() != PlaceMode::kOff; }

const sessions::MeshSnapper* SceneAnnotator::mesh() const {
  return shot_.look.shown.mesh ? snapper_.mesh().get() : nullptr;
}

void SceneAnnotator::setShot(const SceneShot& shot) {
  shot_ = shot;
  updateAim();
}

void SceneAnnotator::showMode() {
  if (places() && canvas_.underMouse()) takeFocus();
  turn_ = 0;
  updateAim();
}

/// For the keys; what is being typed elsewhere goes on.
void SceneAnnotator::takeFocus() {
  if (!isTyping()) canvas_.setFocus(Qt::MouseFocusReason);
}

void SceneAnnotator::showAnnotations() {
  annotations_ = sceneAnnotations(annotation_);
  updateAim();
}

bool SceneAnnotator::eventFilter(QObject* watched, QEvent* event) {
  if (!places()) return QObject::eventFilter(watched, event);
  switch (event->type()) {
    case QEvent::MouseMove:
      hover(*static_cast<QMouseEvent*>(event));
      return false;
    case QEvent::Enter:
      takeFocus();
      return false;
    case QEvent::Leave:
      leave();
      return false;
    case QEvent::MouseButtonDblClick:
      return true;  // the second place follows with a click of its own, not with another view
    case QEvent::Wheel: {
      const auto& wheel = *static_cast<QWheelEvent*>(event);
      if (!loupe_->isVisible() || !wheel.modifiers().testFlag(Qt::ControlModifier)) return false;
      loupe_->setMagnification(loupe_->magnification() *
                               std::pow(SceneLoupe::kStep, wheel.angleDelta().y() / 120.0));
      return true;
    }
    case QEvent::ShortcutOverride:
      if (takesKey(*static_cast<QKeyEvent*>(event))) event->accept();
      return false;
    case QEvent::KeyPress:
    case QEvent::KeyRelease: {
      const auto& key = *static_cast<QKeyEvent*>(event);
      if (key.key() == Qt::Key_Alt) {
        modifiers_ = event->type() == QEvent::KeyPress ? Qt::AltModifier : Qt::NoModifier;
        updateAim();
      }
      return event->type() == QEvent::KeyPress && pressKey(key);
    }
    default:
      return QObject::eventFilter(watched, event);
  }
}

void SceneAnnotator::hover(const QMouseEvent& event) {
  if (event.buttons() != Qt::NoButton) return leave();  // the view is being turned
  pointer_ = pixelAt(pointerPlace(event, canvas_));
  modifiers_ = event.modifiers();
  if (distance_px(*pointer_, turned_at_) > kSceneSnap_px) turn_ = 0;
  updateAim();
}

void SceneAnnotator::leave() {
  pointer_.reset();
  updateAim();
}

/// Tab where there is something else to take; otherwise it leads on to the next widget.
bool SceneAnnotator::takesKey(const QKeyEvent& event) const {
  if (event.key() == Qt::Key_Tab) return pointer_ && aim_ && aim_->found > 1;
  constexpr std::array kKeys = {Qt::Key_Escape, Qt::Key_Delete, Qt::Key_Alt};
  return std::find(kKeys.begin(), kKeys.end(), event.key()) != kKeys.end();
}

bool SceneAnnotator::pressKey(const QKeyEvent& event) {
  if (!takesKey(event)) return false;
  if (event.key() == Qt::Key_Tab) {
    ++turn_;
    turned_at_ = *pointer_;
    updateAim();
  } else if (event.key() == Qt::Key_Escape) {  // first the choice, then the mode
    if (annotation_.selected().empty())
      annotation_.setMode(PlaceMode::kOff);
    else
      annotation_.select({});
  } else if (event.key() == Qt::Key_Delete && !annotation_.selected().empty()) {
    annotation_.remove(annotation_.selected());
  }
  return true;
}

std::optional<SceneAim> SceneAnnotator::aimAt(const QPointF& pixel) const {
  return snapper_.mesh()
             ? sceneAim(*snapper_.mesh(), {}, shot_.view, pixel, {.radius_px = kSceneSnap_px})
             : std::nullopt;
}

void SceneAnnotator::updateAim() {
  aim_.reset();
  const bool aims = places() && pointer_ && snapper_.mesh() && shot_.content;
  if (aims) {
    const AimRules rules = {.snaps = !modifiers_.testFlag(Qt::AltModifier),
                            .line = annotation_.mode() == PlaceMode::kLine,
                            .radius_px = kSceneSnap_px,
                            .turn = turn_};
    aim_ = sceneAim(*snapper_.mesh(), annotation_.answer().proposals, shot_.view, *pointer_, rules);
  }
  loupe_->lookAt(shot_, places() ? pointer_ : std::nullopt);
  Q_EMIT changed();
}

bool SceneAnnotator::click(const QPointF& at, Qt::KeyboardModifiers modifiers) {
  if (!places()) {
    if (!snapper_.mesh()) return false;
    const std::string id = pickAnnotation(annotations_, shot_.view, *snapper_.mesh(), pixelAt(at));
    if (!id.empty()) annotation_.select(id);
    return !id.empty();
  }
  pointer_ = pixelAt(at);
  modifiers_ = modifiers;
  updateAim();
  placeAim();
  return true;
}

bool SceneAnnotator::completesPoint() const {
  const auto* point = annotation_.selectedPoint();
  return point && !point->point_in_station_m;
}

void SceneAnnotator::placeAim() {
  if (!snapper_.mesh()) {
    Q_EMIT annotation_.told(
        tr("The station's corners and edges are still being computed; click again in a moment."));
  } else if (!aim_) {
    Q_EMIT annotation_.told(annotation_.mode() == PlaceMode::kLine
                                ? tr("No edge is near; click on an edge of the station.")
                                : tr("No surface there; click on the station."));
  } else if (annotation_.mode() == PlaceMode::kLine) {
    annotation_.placeEdgeOnStation(*aim_->edge);
  } else if (aim_->landmark && !completesPoint()) {
    annotation_.begin(*aim_->landmark);
  } else {
    annotation_.placeOnStation(aim_->point_in_station_m);
  }
  turn_ = 0;
}

std::vector<Frustum> SceneAnnotator::rigFrusta(const Eigen::Vector3d& centre_m) const {
  std::vector<Frustum> frustums;
  const auto& solution = annotation_.solution();
  if (!solution || !solution->result.solution) return frustums;
  const auto& poses = solution->result.solution->camera_from_station;
  const auto& views = solution->annotations.views;
  for (std::size_t i = 1; i < std::min(views.size(), poses.size()); ++i)
    frustums.push_back(frustumOf(PoseRole::kAnnotated, QString::fromStdString(views[i].name),
                                 views[i].camera, poses[i], centre_m));
  return frustums;
}

QString SceneAnnotator::place() const {
  if (!aim_)
    return tr("Point at the station: Tab selects the next snap target, Alt disables snapping.");
  return stationPlaceText(aim_->point_in_station_m, aim_->text);
}

QString SceneAnnotator::nextStep() const {
  if (!places()) return {};
  if (!snapper_.mesh()) return tr("Computing the station's corners and edges ...");
  if (annotation_.mode() == PlaceMode::kLine) {
    const auto* line = annotation_.selectedLine();
    if (line && !line->edge)
      return tr("Click the edge of %1").arg(QString::fromStdString(line->id));
    return tr("Click an edge of the station");
  }
  if (completesPoint())
    return tr("Click %1 on the station").arg(QString::fromStdString(annotation_.selected()));
  return tr("Click a point of the station");
}

void SceneAnnotator::paint(QPainter& painter, const QRectF& area) const {
  const SceneAnnotationPainter annotations(painter, shot_.view, mesh());
  annotations.paintMarks(annotations_);
  if (!pointer_ || !aim_) return;
  annotations.paintAim(*aim_, *pointer_);
  QString text = aim_->text;
  if (aim_->found > 1) text = tr("%1 (Tab: %2 more)").arg(text).arg(aim_->found - 1);
  paintNote(painter, area, QRectF(), *pointer_, text);
}

}  // namespace boresight::ui
