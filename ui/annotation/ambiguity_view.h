// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <memory>

#include <QImage>
#include <QWidget>

#include "ui/annotation/annotation_controller.h"
#include "ui/annotation/station_snapper.h"

namespace boresight::ui {

namespace Ui {
class AmbiguityView;
}

/// Both poses that marks in a plane may mean, side by side: the image round the marks with the
/// model's edges as each pose has them. Hidden while there is one pose only.
class AmbiguityView : public QWidget {
  Q_OBJECT

 public:
  AmbiguityView(AnnotationController& controller, ViewState& state, StationSnapper& snapper,
                QWidget* parent = nullptr);
  ~AmbiguityView() override;

 Q_SIGNALS:
  /// The other pose is to be looked at in all views.
  void otherRequested(const boresight::Pose& camera_from_station);

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void showSolution();
  void showPictures();
  std::optional<Pose> other() const;

  AnnotationController& controller_;
  ViewState& state_;
  StationSnapper& snapper_;
  std::array<QImage, 2> drawn_;  ///< the solved pose's picture and the other's
  TaskRunner runner_;
  const std::unique_ptr<Ui::AmbiguityView> ui_;
};

}  // namespace boresight::ui
