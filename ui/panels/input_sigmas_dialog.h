// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QDialog>

#include "sessions/session/session.h"

QT_BEGIN_NAMESPACE
class QDoubleSpinBox;
class QGroupBox;
QT_END_NAMESPACE

namespace boresight::ui {

/// Asks how well the mesh's scale and the camera's calibration are known, which one image cannot
/// tell. What is not stated is assumed, and the boxes show with which values.
class InputSigmasDialog : public QDialog {
  Q_OBJECT

 public:
  InputSigmasDialog(const sessions::SessionCase& one, QWidget* parent);

  std::optional<double> meshScaleSigma() const;
  std::optional<sessions::CalibrationSigma> calibrationSigma() const;

 private:
  QGroupBox* group(const QString& title, const QString& name, bool stated);
  QDoubleSpinBox* box(QGroupBox* group, const QString& label, const QString& name, double value,
                      double maximum, const QString& unit);

  QGroupBox* mesh_ = nullptr;
  QDoubleSpinBox* mesh_scale_percent_ = nullptr;
  QGroupBox* camera_ = nullptr;
  QDoubleSpinBox* focal_percent_ = nullptr;
  QDoubleSpinBox* principal_point_px_ = nullptr;
};

}  // namespace boresight::ui
