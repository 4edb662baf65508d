// SPDX-License-Identifier: Apache-2.0
#include "ui/vtk/scene_view.h"

#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QMenu>
#include <QMouseEvent>
#include <QSlider>
#include <QToolButton>
#include <QVBoxLayout>
#include <QWheelEvent>
#include <QWidgetAction>
#include <array>
#include <cmath>

#include "sessions/report/undistort.h"
#include "ui/views/pointer_place.h"
#include "ui/vtk/scene_overlay.h"

namespace boresight::ui {
namespace {

constexpr double kZoomPerNotch = 1.2;
constexpr double kKeyTurn_px = 24.0;

QImage copyOf(const ImageView& image) {
  QImage gray(image.width, image.height, QImage::Format_Grayscale8);
  for (int y = 0; y < image.height; ++y) std::copy_n(image.row(y), image.width, gray.scanLine(y));
  return gray;
}

struct StandardKey {
  int key;
  StandardView view;
  const char* name;
};
constexpr std::array<StandardKey, 7> kStandardKeys = {{
    {Qt::Key_1, StandardView::kTop, QT_TRANSLATE_NOOP("SceneView", "Top (along -z)")},
    {Qt::Key_2, StandardView::kFront, QT_TRANSLATE_NOOP("SceneView", "Front (along +y)")},
    {Qt::Key_3, StandardView::kRight, QT_TRANSLATE_NOOP("SceneView", "Right (along -x)")},
    {Qt::Key_4, StandardView::kBack, QT_TRANSLATE_NOOP("SceneView", "Back (along -y)")},
    {Qt::Key_5, StandardView::kLeft, QT_TRANSLATE_NOOP("SceneView", "Left (along +x)")},
    {Qt::Key_6, StandardView::kBottom, QT_TRANSLATE_NOOP("SceneView", "Bottom (along +z)")},
    {Qt::Key_7, StandardView::kOblique, QT_TRANSLATE_NOOP("SceneView", "Oblique")},
}};

struct ShowEntry {
  bool SceneShown::*member;
  const char* name;
};
constexpr std::array<ShowEntry, 6> kShowEntries = {{
    {&SceneShown::mesh, QT_TRANSLATE_NOOP("SceneView", "Mesh")},
    {&SceneShown::mesh_edges, QT_TRANSLATE_NOOP("SceneView", "Edges of the mesh")},
    {&SceneShown::frusta, QT_TRANSLATE_NOOP("SceneView", "Cameras")},
    {&SceneShown::trail, QT_TRANSLATE_NOOP("SceneView", "Trail of the iterations")},
    {&SceneShown::points, QT_TRANSLATE_NOOP("SceneView", "Template points")},
    {&SceneShown::axes, QT_TRANSLATE_NOOP("SceneView", "Axes of the station")},
}};

}  // namespace

SceneView::SceneView(ViewState& state, QWidget* parent, SceneBackend backend)
    : QWidget(parent),
      state_(state),
      backend_(backend),
      content_(std::make_shared<const SceneContent>()) {
  build();
  updateLook();
  for (auto signal :
       {&ViewState::caseChanged, &ViewState::snapshotChanged, &ViewState::cursorChanged,
        &ViewState::nudgedPoseChanged, &ViewState::annotatedPoseChanged})
    connect(&state_, signal, this, &SceneView::refreshSoon);
  connect(&state_, &ViewState::templateSelected, this, &SceneView::refreshSoon);
  refreshSoon();
}

SceneView::~SceneView() = default;

void SceneView::build() {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addWidget(buildBar());
  canvas_ = backend_ == SceneBackend::kVtk ? makeVtkCanvas(this) : makePictureCanvas(this);
  QWidget* drawn = canvas_->widget();
  drawn->setObjectName(QStringLiteral("sceneCanvas"));
  drawn->setAccessibleName(tr("Scene"));
  drawn->setFocusPolicy(Qt::StrongFocus);
  drawn->setMouseTracking(false);
  drawn->setMinimumSize(160, 120);
  drawn->installEventFilter(this);
  layout->addWidget(drawn, 1);
  overlay_ = new SceneOverlay(drawn);
  readout_ = new QLabel(this);
  readout_->setObjectName(QStringLiteral("sceneReadout"));
  readout_->setContentsMargins(6, 2, 6, 2);
  readout_->setWordWrap(true);
  readout_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  readout_->setText(tr("Click a template or a point of the mesh."));
  layout->addWidget(readout_);
}

QWidget* SceneView::buildBar() {
  auto* bar = new QWidget(this);
  auto* layout = new QHBoxLayout(bar);
  layout->setContentsMargins(4, 2, 4, 2);

  auto* reset = new QToolButton(bar);
  reset->setText(tr("Reset"));
  reset->setToolTip(tr("Show the whole scene (Home)"));
  connect(reset, &QToolButton::clicked, this, &SceneView::resetView);
  layout->addWidget(reset);

  auto* views = new QToolButton(bar);
  views->setText(tr("View"));
  views->setToolTip(tr("Look from a fixed direction (keys 1 to 7)"));
  views->setPopupMode(QToolButton::InstantPopup);
  auto* menu = new QMenu(views);
  for (const StandardKey& key : kStandardKeys)
    menu->addAction(tr(key.name) + QLatin1Char('\t') + QKeySequence(key.key).toString(), this,
                    [this, key] { lookFrom(key.view); });
  views->setMenu(menu);
  layout->addWidget(views);

  addShowActions(bar, *layout);

  through_action_ = new QAction(tr("Camera"), this);
  through_action_->setCheckable(true);
  through_action_->setToolTip(tr("Look through the camera, with its image behind the mesh (V)"));
  connect(through_action_, &QAction::toggled, this, &SceneView::setThroughCamera);
  auto* through = new QToolButton(bar);
  through->setDefaultAction(through_action_);
  through->setObjectName(QStringLiteral("throughCamera"));
  layout->addWidget(through);

  through_role_ = new QComboBox(bar);
  through_role_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  through_role_->setMinimumContentsLength(7);
  through_role_->setToolTip(tr("Whose pose the camera has while you look through it"));
  through_role_->addItem(tr("shown pose"), static_cast<int>(PoseRole::kEstimate));
  through_role_->addItem(tr("seed"), static_cast<int>(PoseRole::kSeed));
  through_role_->addItem(tr("truth"), static_cast<int>(PoseRole::kTruth));
  through_role_->addItem(tr("annotated"), static_cast<int>(PoseRole::kAnnotated));
  connect(through_role_, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this] { setThroughRole(static_cast<PoseRole>(through_role_->currentData().toInt())); });
  layout->addWidget(through_role_);
  layout->addStretch(1);
  return bar;
}

void SceneView::addShowActions(QWidget* bar, QBoxLayout& layout) {
  auto* show = new QToolButton(bar);
  show->setText(tr("Show"));
  show->setToolTip(tr("What of the scene is drawn, and how opaque the mesh is"));
  show->setPopupMode(QToolButton::InstantPopup);
  auto* menu = new QMenu(show);
  for (const ShowEntry& entry : kShowEntries) {
    QAction* action = menu->addAction(tr(entry.name));
    action->setCheckable(true);
    action->setChecked(look_.shown.*entry.member);
    connect(action, &QAction::toggled, this, [this, entry](bool on) {
      SceneShown shown = look_.shown;
      shown.*entry.member = on;
      setShown(shown);
    });
  }
  menu->addSeparator();
  addOpacity(*menu);
  show->setMenu(menu);
  layout.addWidget(show);
}

void SceneView::addOpacity(QMenu& menu) {
  auto* line = new QWidget(&menu);
  auto* row = new QHBoxLayout(line);
  row->setContentsMargins(28, 2, 8, 2);
  opacity_ = new QSlider(Qt::Horizontal, line);
  opacity_->setRange(0, 100);
  opacity_->setToolTip(tr("Opacity of the mesh, in percent"));
  opacity_->setAccessibleName(tr("Opacity of the mesh"));
  connect(opacity_, &QSlider::valueChanged, this,
          [this](int value) { setMeshOpacity(0.01 * value); });
  row->addWidget(new QLabel(tr("Opacity of the mesh"), line));
  row->addWidget(opacity_, 1);
  auto* action = new QWidgetAction(&menu);
  action->setDefaultWidget(line);
  menu.addAction(action);
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
  content_ = std::make_shared<const SceneContent>(sceneContent(state_));
  if (content_->one != before->one) {
    overlay_->setMark(std::nullopt);
    backdrop_ = QImage();
    backdrop_of_.reset();
    // Another image of the same station leaves the view where somebody has put it.
    const bool same_place = !before->empty() && !content_->empty() &&
                            before->bounds.minimum_m == content_->bounds.minimum_m &&
                            before->bounds.maximum_m == content_->bounds.maximum_m;
    if (!same_place) {
      orbit_ = OrbitCamera();
      frameScene();
    }
    image_fitted_ = true;
  }
  canvas_->setContent(content_, look_);
  overlay_->setContent(content_, look_);
  if (through_) orderBackdrop();
  updateView();
}

void SceneView::frameScene() {
  BoundingBox all = content_->bounds;
  for (const Frustum& frustum : content_->frusta) {
    all.minimum_m = all.minimum_m.cwiseMin(frustum.apex_m);
    all.maximum_m = all.maximum_m.cwiseMax(frustum.apex_m);
  }
  orbit_.frame(all);
}

void SceneView::fitImage() {
  if (content_->empty()) return;
  const Camera& camera = content_->one->source.camera;
  image_.fit(QSizeF(camera.width, camera.height), canvas()->size());
}

void SceneView::resetView() {
  image_fitted_ = true;
  if (!through_) frameScene();
  updateView();
}

void SceneView::lookFrom(StandardView view) {
  setThroughCamera(false);
  orbit_.lookFrom(view);
  updateView();
}

void SceneView::setThroughCamera(bool through) {
  if (through == through_) return;
  through_ = through;
  through_action_->setChecked(through);
  image_fitted_ = true;
  if (through_) orderBackdrop();
  updateLook();
  Q_EMIT throughCameraChanged(through);
}

void SceneView::setThroughRole(PoseRole role) {
  role_ = role;
  through_role_->setCurrentIndex(through_role_->findData(static_cast<int>(role)));
  updateView();
}

void SceneView::setShown(const SceneShown& shown) {
  look_.shown = shown;
  updateLook();
}

void SceneView::setMeshOpacity(double opacity) {
  (through_ ? through_opacity_ : free_opacity_) = std::clamp(opacity, 0.0, 1.0);
  updateLook();
}

void SceneView::updateLook() {
  look_.mesh_opacity = through_ ? through_opacity_ : free_opacity_;
  const bool dark = palette().color(QPalette::Window).lightnessF() < 0.5;
  look_.background = dark ? QColor(38, 40, 44) : QColor(226, 229, 233);
  look_.mesh_lines = through_ ? QColor(255, 215, 70) : QColor(24, 26, 30);
  const QSignalBlocker blocker(opacity_);
  opacity_->setValue(static_cast<int>(std::lround(100.0 * look_.mesh_opacity)));
  canvas_->setContent(content_, look_);
  overlay_->setContent(content_, look_);
  updateView();
}

Pose SceneView::throughPose() const {
  if (role_ == PoseRole::kEstimate) return state_.shownPose();
  return poseOf(state_, role_).value_or(state_.shownPose());
}

Viewpoint SceneView::viewpoint() const {
  if (!through_ || content_->empty()) return orbit_.viewpoint(canvas()->size());
  return ui::throughCamera(content_->one->source.camera, throughPose(), image_, canvas()->size());
}

void SceneView::updateView() {
  overlay_->setGeometry(canvas()->rect());
  if (through_ && image_fitted_) fitImage();
  const Viewpoint view = viewpoint();
  std::optional<Backdrop> backdrop;
  if (through_ && !backdrop_.isNull())
    backdrop = Backdrop{backdrop_,
                        image_.toWidget(QRectF(-0.5, -0.5, backdrop_.width(), backdrop_.height()))};
  canvas_->setView(view, backdrop);
  overlay_->setView(view);
  updateNote();
}

void SceneView::updateNote() {
  QString note;
  if (through_ && !content_->empty()) {
    if (backdrop_.isNull())
      note = tr("Taking the lens distortion out of the image ...");
    else if (content_->one->source.camera.model != CameraModel::kPinhole)
      note = tr("Undistorted: the image is shown as a camera without lens distortion sees it");
    if (role_ == PoseRole::kTruth && !content_->one->source.camera_from_station_truth)
      note = tr("This case has no truth; you look through the shown pose");
  } else if (backend_ == SceneBackend::kPicture && !content_->empty()) {
    note = tr("Drawn without OpenGL");
  }
  overlay_->setNote(note);
}

/// Taking out the distortion takes a while, so it is done off the UI's thread, and once per case.
void SceneView::orderBackdrop() {
  const std::shared_ptr<const sessions::LoadedCase> one = content_->one;
  if (!one || backdrop_of_.lock() == one) return;
  backdrop_of_ = one;
  if (one->source.camera.model == CameraModel::kPinhole) {
    backdrop_ = copyOf(one->image.view());
    return;
  }
  backdrop_ = QImage();
  runner_.start(
      QStringLiteral("backdrop"),
      [one](const std::stop_token&) {
        return copyOf(sessions::undistort(one->source.camera, one->image.view()).view());
      },
      [this, one](const QImage& gray) { takeBackdrop(one, gray); });
}

void SceneView::takeBackdrop(const std::shared_ptr<const sessions::LoadedCase>& one,
                             const QImage& gray) {
  if (backdrop_of_.lock() != one) return;
  backdrop_ = gray;
  updateView();
}

void SceneView::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  if (refresh_pending_) refresh();
}

void SceneView::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange) updateLook();
}

bool SceneView::eventFilter(QObject* watched, QEvent* event) {
  if (watched != canvas()) return QWidget::eventFilter(watched, event);
  switch (event->type()) {
    case QEvent::Resize:
      // After the canvas itself has taken note.
      QMetaObject::invokeMethod(
          this, [this] { updateView(); }, Qt::QueuedConnection);
      overlay_->resize(static_cast<QResizeEvent*>(event)->size());
      return false;
    case QEvent::MouseButtonPress: {
      const auto* mouse = static_cast<QMouseEvent*>(event);
      press(pointerPlace(*mouse, *canvas()), mouse->button());
      return true;
    }
    case QEvent::MouseMove: {
      const auto* mouse = static_cast<QMouseEvent*>(event);
      drag(pointerPlace(*mouse, *canvas()), mouse->buttons(), mouse->modifiers());
      return true;
    }
    case QEvent::MouseButtonRelease: {
      const auto* mouse = static_cast<QMouseEvent*>(event);
      release(pointerPlace(*mouse, *canvas()), mouse->button());
      return true;
    }
    case QEvent::MouseButtonDblClick:
      resetView();
      return true;
    case QEvent::Wheel: {
      const auto* wheel = static_cast<QWheelEvent*>(event);
      zoom(wheel->position(), wheel->angleDelta().y() / 120.0);
      return true;
    }
    case QEvent::ShortcutOverride: {
      const auto* key = static_cast<QKeyEvent*>(event);
      if (takesKey(key->key(), key->modifiers())) event->accept();
      return false;
    }
    case QEvent::KeyPress: {
      const auto* key = static_cast<QKeyEvent*>(event);
      return pressKey(key->key(), key->modifiers());
    }
    default:
      return QWidget::eventFilter(watched, event);
  }
}

void SceneView::press(const QPointF& at, Qt::MouseButton) {
  canvas()->setFocus(Qt::MouseFocusReason);
  press_ = last_ = at;
  dragging_ = false;
}

void SceneView::drag(const QPointF& at, Qt::MouseButtons buttons, Qt::KeyboardModifiers modifiers) {
  if (!dragging_ && (at - press_).manhattanLength() < QApplication::startDragDistance()) return;
  dragging_ = true;
  const QPointF moved = at - last_;
  last_ = at;
  const double height = canvas()->height();
  const bool pans = (buttons & Qt::MiddleButton) != 0 || modifiers.testFlag(Qt::ShiftModifier);
  if (through_) {
    image_.pan(moved);
    image_fitted_ = false;
  } else if ((buttons & Qt::RightButton) != 0) {
    orbit_.dolly(std::pow(2.0, moved.y() / 100.0));
  } else if (pans) {
    orbit_.pan(moved, height);
  } else if ((buttons & Qt::LeftButton) != 0) {
    orbit_.orbit(moved, height);
  }
  updateView();
}

void SceneView::release(const QPointF& at, Qt::MouseButton button) {
  if (!dragging_ && button == Qt::LeftButton) pick(at);
  dragging_ = false;
}

void SceneView::zoom(const QPointF& at, double notches) {
  if (through_) {
    image_.zoomAt(at, image_.scale() * std::pow(kZoomPerNotch, notches));
    image_fitted_ = false;
  } else {
    orbit_.dolly(std::pow(kZoomPerNotch, -notches));
  }
  updateView();
}

void SceneView::pick(const QPointF& at) {
  if (content_->empty()) return;
  const Viewpoint view = viewpoint();
  const int picked = look_.shown.points ? pickTemplate(*content_, view, at) : -1;
  if (picked >= 0) {
    readout_->setText(tr("Template %1").arg(picked));
    state_.selectTemplate(picked);
    return;
  }
  const std::optional<MeshPick> place = pickMesh(*content_, view, at);
  overlay_->setMark(place ? std::optional(place->at_m) : std::nullopt);
  if (!place) {
    readout_->setText(tr("Nothing there: click a template or a point of the mesh."));
    return;
  }
  const Eigen::Vector3d mm = 1e3 * place->at_m;
  const QString where = place->vertex >= 0 ? tr("vertex %1").arg(place->vertex) : tr("on a face");
  readout_->setText(tr("Station x %1, y %2, z %3 mm (%4)")
                        .arg(mm.x(), 0, 'f', 2)
                        .arg(mm.y(), 0, 'f', 2)
                        .arg(mm.z(), 0, 'f', 2)
                        .arg(where));
  Q_EMIT meshPointPicked(place->at_m, place->vertex);
}

bool SceneView::takesKey(int key, Qt::KeyboardModifiers modifiers) const {
  if ((modifiers & ~Qt::KeypadModifier) != 0) return false;
  if (key >= Qt::Key_1 && key <= Qt::Key_7) return true;
  switch (key) {
    case Qt::Key_Home:
    case Qt::Key_V:
    case Qt::Key_Plus:
    case Qt::Key_Minus:
    case Qt::Key_Left:
    case Qt::Key_Right:
    case Qt::Key_Up:
    case Qt::Key_Down:
      return true;
    default:
      return false;
  }
}

bool SceneView::pressKey(int key, Qt::KeyboardModifiers modifiers) {
  if (!takesKey(key, modifiers)) return false;
  for (const StandardKey& standard : kStandardKeys)
    if (standard.key == key) {
      lookFrom(standard.view);
      return true;
    }
  const QPointF middle(0.5 * canvas()->width(), 0.5 * canvas()->height());
  const auto turn = [this](double x, double y) {
    if (through_) {
      image_.pan({x, y});
      image_fitted_ = false;
    } else {
      orbit_.orbit({x, y}, canvas()->height());
    }
    updateView();
  };
  switch (key) {
    case Qt::Key_Home:
      resetView();
      break;
    case Qt::Key_V:
      setThroughCamera(!through_);
      break;
    case Qt::Key_Plus:
      zoom(middle, 1.0);
      break;
    case Qt::Key_Minus:
      zoom(middle, -1.0);
      break;
    case Qt::Key_Left:
      turn(-kKeyTurn_px, 0.0);
      break;
    case Qt::Key_Right:
      turn(kKeyTurn_px, 0.0);
      break;
    case Qt::Key_Up:
      turn(0.0, -kKeyTurn_px);
      break;
    default:
      turn(0.0, kKeyTurn_px);
      break;
  }
  return true;
}

}  // namespace boresight::ui
