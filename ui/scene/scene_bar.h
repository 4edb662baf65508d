// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <QWidget>

#include "ui/scene/scene_content.h"
#include "ui/scene/viewpoint.h"
#include "ui/state/view_state.h"

class QAction;
class QBoxLayout;
class QComboBox;
class QMenu;
class QSlider;
class QToolButton;

namespace boresight::ui {

/// A fixed direction with its key and its name, to be translated in the context "SceneView".
struct StandardKey {
  int key;
  StandardView view;
  const char* name;
};
std::span<const StandardKey> standardKeys();

/// The scene's buttons: what is shown, from where, and how opaque the mesh is. It only tells what
/// was asked for.
class SceneBar : public QWidget {
  Q_OBJECT

 public:
  explicit SceneBar(const SceneShown& shown, QWidget* parent = nullptr);

  /// What they show, without telling anybody.
  void setShown(const SceneShown& shown);
  void setThroughCamera(bool through);
  void setThroughRole(PoseRole role);
  void setMeshOpacity(double opacity);

 Q_SIGNALS:
  void resetAsked();
  void lookFromAsked(StandardView view);
  void throughCameraAsked(bool through);
  void throughRoleAsked(PoseRole role);
  void shownAsked(const SceneShown& shown);
  void meshOpacityAsked(double opacity);

 private:
  QToolButton* addMenu(const QString& text, const QString& tip, QMenu*& menu);
  void addReset();
  void addViews();
  void addShow();
  void addOpacity(QMenu& menu);
  void addThroughCamera();

  SceneShown shown_;
  QBoxLayout* row_;
  std::vector<QAction*> show_;
  QAction* through_ = nullptr;
  QComboBox* through_role_ = nullptr;
  QSlider* opacity_ = nullptr;
};

}  // namespace boresight::ui
