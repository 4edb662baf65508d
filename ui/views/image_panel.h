// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include <QTimer>
#include <QWidget>

#include "ui_image_panel.h"

#include "sessions/run/picture_data.h"
#include "ui/state/view_state.h"
#include "ui/views/layer.h"

namespace boresight::ui {

class DisplayImage;
class ImageView;
class TaskRunner;

/// The image of the current case with the layers of the current iteration, and the bar above it:
/// fit, 1:1, what the core sees, blink, swipe. Follows the view state; renders of seed and truth
/// and the agreement are made by the task runner when their layer is shown first.
class ImagePanel : public QWidget {
  Q_OBJECT

 public:
  ImagePanel(ViewState& state, TaskRunner& tasks, QWidget* parent = nullptr);

  ImageView& view();
  DisplayImage& display() { return *display_; }
  void setStyle(LayerId id, const LayerStyle& style);
  const LayerStyle& style(LayerId id) const;
  /// Edges of the pose being nudged; nullptr takes them away.
  void setNudgedRender(std::shared_ptr<const sessions::RenderTrace> render, int level);
  /// What is said while there is no image; nothing: what can be dropped here.
  void setHint(const QString& hint);
  /// Marks of a layer that no run fills.
  void setMarks(LayerId id, std::vector<Mark> marks);
  void setBits(LayerId id, std::vector<LayerBits> bits);

 public Q_SLOTS:
  void toggleBlink();
  void toggleSwipe();
  void toggleCoreView();

 Q_SIGNALS:
  void stylesChanged();
  /// For the status bar: pixel, gray value, and the station point where the shown pose covers it.
  void placeText(const QString& text);

 private:
  void connectBar();
  void showCase();
  void showIteration();
  void showTemplates();
  void showPlace(const QPointF& pixel);
  void askForRenders();
  void askForRender(LayerId id, const char* key, const Pose& camera_from_station);
  void forget(LayerId id);
  void showAlternative();
  void askForAgreement();
  void showImage();

  ViewState& state_;
  TaskRunner& tasks_;
  DisplayImage* display_ = nullptr;
  QTimer blink_timer_;
  ViewState::CasePtr shown_case_;
  std::array<bool, kLayerCount> asked_{};  ///< renders of this case that were asked for
  std::shared_ptr<const sessions::IterationTrace> agreement_of_;
  Ui::ImagePanel ui_;
};

}  // namespace boresight::ui
