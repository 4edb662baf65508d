// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <QImage>
#include <QWidget>

#include "ui/annotation/annotation_controller.h"
#include "ui/annotation/station_snapper.h"

class QLabel;

namespace boresight::ui {

/// Both poses that marks in a plane may mean, side by side: the image round the marks with the
/// model's edges as each pose has them. Hidden while there is one pose only.
class TwinView : public QWidget {
  Q_OBJECT

 public:
  TwinView(AnnotationController& controller, ViewState& state, StationSnapper& snapper,
           QWidget* parent = nullptr);

 Q_SIGNALS:
  /// The other pose is to be looked at in all views.
  void otherRequested(const boresight::Pose& camera_from_station);

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  struct Half {
    QLabel* picture = nullptr;
    QLabel* caption = nullptr;
    QImage drawn;
  };

  Half half(const char* name);
  void showSolution();
  void showPictures();
  std::optional<Pose> other() const;

  AnnotationController& controller_;
  ViewState& state_;
  StationSnapper& snapper_;
  std::array<Half, 2> halves_;  ///< the solved pose's and the other's
  TaskRunner runner_;
};

}  // namespace boresight::ui
