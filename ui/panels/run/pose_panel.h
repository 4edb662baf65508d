// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QDialog>
#include <QWidget>

#include "ui_paste_pose_dialog.h"
#include "ui_pose_panel.h"

#include "sessions/io/cameras/pose_text.h"
#include "ui/panels/run/nudge_box.h"
#include "ui/panels/run/pose_comparison.h"

class QPushButton;

namespace boresight::ui {

/// Takes a pose as text and asks for data that the text does not state: direction, order, unit.
/// Shows the resulting pose, or the problem, during input.
class PastePoseDialog : public QDialog {
  Q_OBJECT

 public:
  explicit PastePoseDialog(const QString& text, QWidget* parent = nullptr);

  const sessions::ParsedPose& parsed() const { return parsed_; }

 private:
  /// Chooses the reading that the text indicates, then parses.
  void guess();
  void parse();

  QPushButton* take_ = nullptr;
  sessions::ParsedPose parsed_;
  Ui::PastePoseDialog ui_;
};

/// The poses of the case side by side, to copy and paste; the uncertainty of the current one; the
/// distance between any two; and nudging in six degrees of freedom.
class PosePanel : public QWidget {
  Q_OBJECT

 public:
  explicit PosePanel(ViewState& state);
  ~PosePanel() override;

  void setJudgement(const PoseJudgement& judgement);
  /// Emits gestureFinished once a gesture: a key held down, a drag, a pasted pose, a dropped pose.
  /// Install it as an event filter on other widgets that take the nudging keys.
  NudgeController& nudgeController() { return controller_; }

  /// Copies a pose to the clipboard, if it exists.
  void copyPose(PoseRole role, sessions::PoseForm form);
  /// Asks how to read the clipboard's text and nudges to that pose.
  void pastePose();

 Q_SIGNALS:
  /// The case of a dialog is no longer shown; one sentence.
  void failed(const QString& message);

 private:
  const std::optional<Pose>& pose(PoseRole role) const {
    return poses_[static_cast<std::size_t>(role)];
  }
  void buildTable();
  void connectAll();
  void showMenu(const QPoint& at);
  void refresh();
  void showMatrix();

  ViewState& state_;
  NudgeController controller_;
  Poses poses_;
  Ui::PosePanel ui_;
};

}  // namespace boresight::ui
