// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <QWidget>

#include "ui_frames_panel.h"

#include "sessions/io/cameras/frame_tree.h"

namespace boresight::ui {

class ViewState;

/// The tree of the case's frames, each below its parent, with pose, sigmas and source of the
/// transform between them.
class FramesPanel : public QWidget {
  Q_OBJECT

 public:
  explicit FramesPanel(ViewState& state);

 Q_SIGNALS:
  void addRequested();
  void removeRequested(const boresight::sessions::FrameTransform& transform);

 private:
  void showCase();
  void showChosen();
  /// The chosen row's transform if it belongs to the case; the camera model's does not.
  std::optional<sessions::FrameTransform> removable() const;

  ViewState& state_;
  std::vector<sessions::FrameRow> rows_;
  Ui::FramesPanel ui_;
};

}  // namespace boresight::ui
