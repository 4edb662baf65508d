// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <QWidget>

#include "ui/panels/nudge_controller.h"

class QComboBox;
class QDoubleSpinBox;
class QGridLayout;
class QLabel;
class QPushButton;

namespace boresight::ui {

/// The controls of a nudge: six values, the axes and the pivot they are meant in, the size of a
/// step, and a field that takes the keys while it has the focus.
class NudgeBox : public QWidget {
  Q_OBJECT

 public:
  NudgeBox(NudgeController& controller, ViewState& state, QWidget* parent = nullptr);

 Q_SIGNALS:
  void useAsSeedRequested(const boresight::Pose& camera_from_station);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void addValues(QGridLayout& grid);
  void addFrame(QGridLayout& grid);
  void addSteps(QGridLayout& grid);
  QWidget* buildButtons();
  void takeStep();
  void showOffset();

  NudgeController& controller_;
  ViewState& state_;
  std::array<QDoubleSpinBox*, 6> values_{};  ///< rotation in deg, then translation in mm
  QComboBox* axes_ = nullptr;
  QComboBox* pivot_ = nullptr;
  QDoubleSpinBox* translation_step_ = nullptr;
  QDoubleSpinBox* rotation_step_ = nullptr;
  QLabel* pad_ = nullptr;
  QPushButton* use_ = nullptr;
  QPushButton* back_ = nullptr;
  QPushButton* drop_ = nullptr;
};

}  // namespace boresight::ui
