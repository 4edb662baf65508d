// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>

#include <QRectF>
#include <QWidget>

#include "ui_ambiguity_view.h"

#include "ui/annotation/annotation_controller.h"
#include "ui/annotation/station_snapper.h"

namespace boresight::ui {

/// Both poses that annotations in a plane allow, side by side: the image round the annotations with
/// the model's edges under each pose. Hidden while there is only one pose.
class AmbiguityView : public QWidget {
  Q_OBJECT

 public:
  AmbiguityView(AnnotationController& controller, ViewState& state, StationSnapper& snapper,
                QWidget* parent = nullptr);

 Q_SIGNALS:
  /// The operator asks to show the other pose in all views.
  void otherRequested(const boresight::Pose& camera_from_station);

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void showSolution();
  void showImage();
  void drawEdges(const std::array<Pose, 2>& camera_from_station);
  void zoomToAnnotations();
  std::array<ImageView*, 2> pictures() const { return {ui_.bestPicture, ui_.otherPicture}; }
  std::optional<Pose> other() const;

  AnnotationController& controller_;
  ViewState& state_;
  StationSnapper& snapper_;
  std::weak_ptr<const sessions::LoadedCase> image_of_;  ///< the case in the pictures
  QRectF area_;  ///< a square round the annotations in the image, px
  TaskRunner runner_;
  TaskKind drawing_;
  Ui::AmbiguityView ui_;
};

}  // namespace boresight::ui
