// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <memory>

#include <QWidget>

#include "ui/panels/nudge_controller.h"

class QDoubleSpinBox;

namespace boresight::ui {

namespace Ui {
class NudgeBox;
}

/// The controls of a nudge: six values, the axes and the pivot they are meant in, the size of a
/// step, and a field that takes the keys while it has the focus.
class NudgeBox : public QWidget {
  Q_OBJECT

 public:
  NudgeBox(NudgeController& controller, ViewState& state, QWidget* parent = nullptr);
  ~NudgeBox() override;

 Q_SIGNALS:
  void useAsSeedRequested(const boresight::Pose& camera_from_station);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void connectValues();
  void connectSettings();
  void takeStep();
  void showOffset();

  NudgeController& controller_;
  ViewState& state_;
  std::array<QDoubleSpinBox*, 6> values_{};  ///< rotation in deg, then translation in mm
  const std::unique_ptr<Ui::NudgeBox> ui_;
};

}  // namespace boresight::ui
