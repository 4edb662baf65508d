// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_bar.h"

#include <array>
#include <cmath>

#include <QtWidgets>

namespace boresight::ui {
namespace {

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

std::span<const StandardKey> standardKeys() { return kStandardKeys; }

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

QToolButton* SceneBar::addMenu(const QString& text, const QString& tip, QMenu*& menu) {
  auto* button = new QToolButton(this);
  button->setText(text);
  button->setToolTip(tip);
  button->setPopupMode(QToolButton::InstantPopup);
  menu = new QMenu(button);
  button->setMenu(menu);
  row_->addWidget(button);
  return button;
}

void SceneBar::addViews() {
  QMenu* menu = nullptr;
  addMenu(tr("View"), tr("Look from a fixed direction (keys 1 to 7)"), menu);
  for (const StandardKey& key : kStandardKeys)
    menu->addAction(nameOf(key.name) + QLatin1Char('\t') + QKeySequence(key.key).toString(), this,
                    [this, key] { Q_EMIT lookFromAsked(key.view); });
}

void SceneBar::addShow() {
  QMenu* menu = nullptr;
  addMenu(tr("Show"), tr("What of the scene is drawn, and how opaque the mesh is"), menu);
  for (const ShowEntry& entry : kShowEntries) {
    QAction* action = menu->addAction(nameOf(entry.name));
    action->setCheckable(true);
    action->setChecked(shown_.*entry.member);
    connect(action, &QAction::toggled, this, [this, entry](bool on) {
      shown_.*entry.member = on;
      Q_EMIT shownAsked(shown_);
    });
    show_.push_back(action);
  }
  menu->addSeparator();
  addOpacity(*menu);
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
