// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <memory>

#include <QWidget>

#include "sessions/io/pose_text.h"
#include "ui/panels/nudge_controller.h"
#include "ui/panels/pose_comparison.h"
#include "ui/panels/pose_table_model.h"

class QMenu;

namespace boresight::ui {

namespace Ui {
class PosePanel;
}

class NudgeBox;

/// The poses of the case side by side, to read, copy and paste; how sure the current one is; how
/// far any two are apart; and the nudging of one in six degrees of freedom.
class PosePanel : public QWidget {
  Q_OBJECT

 public:
  explicit PosePanel(ViewState& state, QWidget* parent = nullptr);
  ~PosePanel() override;

  void setJudgement(const PoseJudgement& judgement);
  /// For other widgets that take the nudging keys: install it on them as an event filter.
  NudgeController& nudgeController() { return controller_; }
  const PoseTableModel& model() const { return model_; }

  /// To the clipboard; nothing when there is no such pose.
  void copyPose(PoseRole role, sessions::PoseForm form);
  /// Asks what the clipboard's text means and nudges to it.
  void pastePose();

 Q_SIGNALS:
  /// One edit for the document: a key held down, a drag, a pasted pose, a pose dropped.
  void gestureFinished(const boresight::Pose& before, const boresight::Pose& after);
  void useAsSeedRequested(const boresight::Pose& camera_from_station);

 private:
  void buildTable();
  void connectAll();
  void addCopyActions(QMenu& menu, PoseRole role);
  void showMenu(const QPoint& at);
  void refresh();
  void showMatrix();
  void showNamedPoses(PoseRole role);

  ViewState& state_;
  NudgeController controller_;
  PoseTableModel model_;
  const std::unique_ptr<Ui::PosePanel> ui_;
};

}  // namespace boresight::ui
