// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <QWidget>

#include "ui_calibration_panel.h"

#include "sessions/calibration/camera_calibration.h"
#include "ui/run/task_runner.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

class Document;

/// Calibrates the shown case's camera from all cases that have it; the result can be applied to
/// these cases.
class CalibrationPanel : public QWidget {
  Q_OBJECT

 public:
  CalibrationPanel(Document& document, ViewState& state, TaskRunner& tasks);

 private:
  void calibrate();
  void take(const sessions::CameraCalibration& calibration);
  void use();
  void forget(const QString& reason);
  void followCamera();

  Document& document_;
  ViewState& state_;
  TaskRunner& tasks_;
  TaskKind calibrating_;
  std::optional<sessions::CameraCalibration> calibration_;
  std::optional<Camera> calibrated_;  ///< the shown case's, as it was before the calibration
  bool calibrates_ = false;
  CaseOpening opening_;  ///< case of the calibrated camera
  Ui::CalibrationPanel ui_;
};

}  // namespace boresight::ui
