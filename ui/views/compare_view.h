// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QStringList>
#include <QWidget>

#include "sessions/session/run_record.h"
#include "ui/run/task_runner.h"
#include "ui/state/view_state.h"
#include "ui/views/layer.h"

class QComboBox;

namespace boresight::ui {

class Document;
class ImagePanel;
class ImageView;

/// A second canvas next to the image: the seed, the truth, another run of the case or another
/// camera of its rig. Zoom and pointer of both are linked.
class CompareView : public QWidget {
  Q_OBJECT

 public:
  CompareView(ImagePanel& image, Document& document, ViewState& state, TaskRunner& tasks);

  ImageView& view() { return *view_; }
  /// Names of the choices, in the order of the box.
  QStringList choices() const;
  /// Distance of the second canvas' pose from the shown one, and the options in which their runs
  /// differ, one per line.
  const QStringList& difference() const { return picture_.difference; }
  /// Shows the canvas with this run of the case.
  void showRun(const std::string& digest);
  /// Sets the onboard run of the case; nullptr: none.
  void setOnboardRun(ViewState::SnapshotPtr run);
  /// Shows the canvas with the onboard run, if there is one.
  void showOnboardRun();

 Q_SIGNALS:
  /// Another choice was made; `onboard_run`: whether it is the onboard run.
  void chosen(bool onboard_run);

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  /// One choice to compare with: a pose of this case, a run whose pose is to be read, or a camera.
  struct Choice {
    QString name = {};
    LineToken line = kPoseLine;
    std::optional<Pose> camera_from_station = {};
    std::optional<sessions::RunRecord> run = {};
    std::string case_id = {};  ///< of another camera
    bool onboard = false;
  };
  /// The picture of a choice.
  struct Picture {
    std::shared_ptr<const sessions::LoadedCase> loaded_case;
    Pose camera_from_station;
    LinesPtr lines;
    LineToken line = kPoseLine;
    QStringList difference;
  };

  std::vector<Choice> choicesNow() const;
  void fill();
  template <class Wanted>
  void choose(const Wanted& wanted);
  void order();
  void take(Picture picture);
  bool showsOtherCase() const;
  void follow(ImageView& follower, const ImageView& leader);
  void paintDifference(QPainter& painter) const;

  ImagePanel& image_;
  Document& document_;
  ViewState& state_;
  TaskRunner& tasks_;
  TaskKind comparing_;
  QComboBox* box_;
  ImageView* view_;
  ViewState::SnapshotPtr onboard_;
  std::vector<Choice> choices_;
  Picture picture_;
  bool following_ = false;
};

}  // namespace boresight::ui
