// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_input.h"

#include <array>
#include <cmath>

#include <QtWidgets>

#include "ui/views/view_transform.h"

namespace boresight::ui {
namespace {

constexpr double kZoomPerNotch = 1.2;
constexpr double kKeyTurn_px = 24.0;

/// A fixed direction with its key and its name, to be translated in the context "SceneView".
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

QString nameOf(const char* name) { return QCoreApplication::translate("SceneView", name); }

}  // namespace

void SceneNavigation::setThroughCamera(bool through) {
  through_ = through;
  image_fitted_ = true;
}

void SceneNavigation::setStationAlone(bool alone, const SceneContent& content) {
  if (alone == station_alone_) return;
  station_alone_ = alone;
  if (framed_ && !content.empty()) frame(content);
}

void SceneNavigation::startOver(const SceneContent& content) {
  orbit_ = OrbitCamera();
  frame(content);
}

void SceneNavigation::reset(const SceneContent& content) {
  image_fitted_ = true;
  if (!through_) frame(content);
}

void SceneNavigation::frame(const SceneContent& content) {
  framed_ = true;
  BoundingBox all = content.bounds;
  for (const Frustum& frustum : content.frusta) {
    if (station_alone_) break;
    all.minimum_m = all.minimum_m.cwiseMin(frustum.apex_m);
    all.maximum_m = all.maximum_m.cwiseMax(frustum.apex_m);
  }
  orbit_.frame(all);
}

void SceneNavigation::fitImage(const SceneContent& content, const QSizeF& canvas) {
  if (!through_ || !image_fitted_ || content.empty()) return;
  const Camera& camera = content.one->source.camera;
  image_.fit(QSizeF(camera.width, camera.height), canvas);
}

void SceneNavigation::drag(const QPointF& moved, Qt::MouseButtons buttons,
                           Qt::KeyboardModifiers modifiers, double canvas_height) {
  framed_ = framed_ && through_;
  const bool pans = (buttons & Qt::MiddleButton) != 0 || modifiers.testFlag(Qt::ShiftModifier);
  if (through_) {
    turn(moved, canvas_height);
  } else if ((buttons & Qt::RightButton) != 0) {
    orbit_.dolly(std::pow(2.0, moved.y() / 100.0));
  } else if (pans) {
    orbit_.pan(moved, canvas_height);
  } else if ((buttons & Qt::LeftButton) != 0) {
    turn(moved, canvas_height);
  }
}

void SceneNavigation::turn(const QPointF& by, double canvas_height) {
  if (through_) {
    image_.pan(by);
    image_fitted_ = false;
  } else {
    framed_ = false;
    orbit_.orbit(by, canvas_height);
  }
}

void SceneNavigation::zoom(const QPointF& at, double notches) {
  if (through_) {
    image_.zoomAt(at, image_.scale() * std::pow(kZoomPerNotch, notches));
    image_fitted_ = false;
  } else {
    framed_ = false;
    orbit_.dolly(std::pow(kZoomPerNotch, -notches));
  }
}

Viewpoint SceneNavigation::viewpoint(const SceneContent& content, const Pose& through_pose,
                                     const QSizeF& canvas) const {
  if (!through_ || content.empty()) return orbit_.viewpoint(canvas);
  return ui::throughCamera(content.one->source.camera, through_pose, image_, canvas);
}

SceneInput::SceneInput(QWidget& canvas) : QObject(&canvas), canvas_(canvas) {
  canvas_.installEventFilter(this);
}

bool SceneInput::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
    case QEvent::Resize:
      Q_EMIT resized();
      return false;
    case QEvent::MouseButtonPress:
      press(*static_cast<QMouseEvent*>(event));
      return true;
    case QEvent::MouseMove:
      move(*static_cast<QMouseEvent*>(event));
      return true;
    case QEvent::MouseButtonRelease:
      release(*static_cast<QMouseEvent*>(event));
      return true;
    case QEvent::MouseButtonDblClick:
      Q_EMIT resetAsked();
      return true;
    case QEvent::Wheel: {
      const auto* wheel = static_cast<QWheelEvent*>(event);
      Q_EMIT zoomed(wheel->position(), wheel->angleDelta().y() / 120.0);
      return true;
    }
    case QEvent::ShortcutOverride:
      if (actOf(*static_cast<QKeyEvent*>(event))) event->accept();
      return false;
    case QEvent::KeyPress: {
      const auto act = actOf(*static_cast<QKeyEvent*>(event));
      if (act) act();
      return act != nullptr;
    }
    default:
      return QObject::eventFilter(watched, event);
  }
}

void SceneInput::press(const QMouseEvent& event) {
  canvas_.setFocus(Qt::MouseFocusReason);
  press_ = last_ = pointerPlace(event, canvas_);
  pressed_ = true;
  dragging_ = false;
}

void SceneInput::move(const QMouseEvent& event) {
  if (!pressed_ || event.buttons() == Qt::NoButton) return;
  const QPointF at = pointerPlace(event, canvas_);
  if (!dragging_ && (at - press_).manhattanLength() < QApplication::startDragDistance()) return;
  dragging_ = true;
  const QPointF moved = at - last_;
  last_ = at;
  Q_EMIT dragged(moved, event.buttons(), event.modifiers());
}

/// A double click's second release is no click.
void SceneInput::release(const QMouseEvent& event) {
  const bool click = pressed_ && !dragging_ && event.button() == Qt::LeftButton;
  pressed_ = dragging_ = false;
  if (click) Q_EMIT clicked(pointerPlace(event, canvas_), event.modifiers());
}

std::function<void()> SceneInput::actOf(const QKeyEvent& event) {
  if ((event.modifiers() & ~Qt::KeypadModifier) != 0) return nullptr;
  for (const StandardKey& standard : kStandardKeys)
    if (standard.key == event.key())
      return [this, view = standard.view] { Q_EMIT lookFromAsked(view); };
  const auto zoom = [this](double notches) {
    return [this, notches] {
      Q_EMIT zoomed({0.5 * canvas_.width(), 0.5 * canvas_.height()}, notches);
    };
  };
  const auto turn = [this](double right, double down) {
    return [this, by = kKeyTurn_px * QPointF(right, down)] { Q_EMIT turned(by); };
  };
  switch (event.key()) {
    case Qt::Key_Home:
      return [this] { Q_EMIT resetAsked(); };
    case Qt::Key_V:
      return [this] { Q_EMIT throughCameraToggled(); };
    case Qt::Key_Plus:
      return zoom(1.0);
    case Qt::Key_Minus:
      return zoom(-1.0);
    case Qt::Key_Left:
      return turn(-1.0, 0.0);
    case Qt::Key_Right:
      return turn(1.0, 0.0);
    case Qt::Key_Up:
      return turn(0.0, -1.0);
    case Qt::Key_Down:
      return turn(0.0, 1.0);
    default:
      return nullptr;
  }
}

SceneBar::SceneBar(const SceneShown& shown, QWidget* parent)
    : QWidget(parent), shown_(shown), row_(new QHBoxLayout(this)) {
  row_->setContentsMargins(4, 2, 4, 2);
  addReset();
  addViews();
  addShow();
  addThroughCamera();
  row_->addStretch(1);
}

void SceneBar::addReset() {
  auto* reset = new QToolButton(this);
  reset->setText(tr("Reset"));
  reset->setToolTip(tr("Show the whole scene (Home)"));
  connect(reset, &QToolButton::clicked, this, &SceneBar::resetAsked);
  row_->addWidget(reset);
}

QMenu& SceneBar::addMenu(const QString& text, const QString& tip) {
  auto* button = new QToolButton(this);
  button->setText(text);
  button->setToolTip(tip);
  button->setPopupMode(QToolButton::InstantPopup);
  button->setMenu(new QMenu(button));
  row_->addWidget(button);
  return *button->menu();
}

void SceneBar::addViews() {
  QMenu& menu = addMenu(tr("View"), tr("Look from a fixed direction (keys 1 to 7)"));
  for (const StandardKey& key : kStandardKeys)
    menu.addAction(nameOf(key.name) + QLatin1Char('\t') + QKeySequence(key.key).toString(), this,
                   [this, key] { Q_EMIT lookFromAsked(key.view); });
}

void SceneBar::addShow() {
  QMenu& menu = addMenu(tr("Show"), tr("What of the scene is drawn, and how opaque the mesh is"));
  for (const ShowEntry& entry : kShowEntries) {
    QAction* action = menu.addAction(nameOf(entry.name));
    action->setCheckable(true);
    action->setChecked(shown_.*entry.member);
    connect(action, &QAction::toggled, this, [this, entry](bool on) {
      shown_.*entry.member = on;
      Q_EMIT shownAsked(shown_);
    });
    show_.push_back(action);
  }
  menu.addSeparator();
  addOpacity(menu);
}

void SceneBar::addOpacity(QMenu& menu) {
  auto* line = new QWidget(&menu);
  auto* row = new QHBoxLayout(line);
  row->setContentsMargins(28, 2, 8, 2);
  opacity_ = new QSlider(Qt::Horizontal, line);
  opacity_->setRange(0, 100);
  opacity_->setToolTip(tr("Opacity of the mesh, in percent"));
  opacity_->setAccessibleName(tr("Opacity of the mesh"));
  connect(opacity_, &QSlider::valueChanged, this,
          [this](int value) { Q_EMIT meshOpacityAsked(0.01 * value); });
  row->addWidget(new QLabel(tr("Opacity of the mesh"), line));
  row->addWidget(opacity_, 1);
  auto* action = new QWidgetAction(&menu);
  action->setDefaultWidget(line);
  menu.addAction(action);
}

void SceneBar::addThroughCamera() {
  through_ = new QAction(tr("Camera"), this);
  through_->setCheckable(true);
  through_->setToolTip(tr("Look through the camera, with its image behind the mesh (V)"));
  connect(through_, &QAction::toggled, this, &SceneBar::throughCameraAsked);
  auto* through = new QToolButton(this);
  through->setDefaultAction(through_);
  through->setObjectName(QStringLiteral("throughCamera"));
  row_->addWidget(through);

  through_role_ = new QComboBox(this);
  through_role_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  through_role_->setMinimumContentsLength(7);
  through_role_->setToolTip(tr("Whose pose the camera has while you look through it"));
  through_role_->addItem(tr("shown pose"), static_cast<int>(PoseRole::kEstimate));
  through_role_->addItem(tr("seed"), static_cast<int>(PoseRole::kSeed));
  through_role_->addItem(tr("truth"), static_cast<int>(PoseRole::kTruth));
  through_role_->addItem(tr("annotated"), static_cast<int>(PoseRole::kAnnotated));
  connect(through_role_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this] {
    Q_EMIT throughRoleAsked(static_cast<PoseRole>(through_role_->currentData().toInt()));
  });
  row_->addWidget(through_role_);
}

void SceneBar::setShown(const SceneShown& shown) {
  const QSignalBlocker blocker(this);
  for (std::size_t i = 0; i < show_.size(); ++i)
    show_[i]->setChecked(shown.*kShowEntries[i].member);
}

void SceneBar::setThroughCamera(bool through) {
  const QSignalBlocker blocker(this);
  through_->setChecked(through);
}

void SceneBar::setThroughRole(PoseRole role) {
  const QSignalBlocker blocker(this);
  through_role_->setCurrentIndex(through_role_->findData(static_cast<int>(role)));
}

void SceneBar::setMeshOpacity(double opacity) {
  const QSignalBlocker blocker(this);
  opacity_->setValue(static_cast<int>(std::lround(100.0 * opacity)));
}

}  // namespace boresight::ui
