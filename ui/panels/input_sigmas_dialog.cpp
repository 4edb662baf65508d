// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/input_sigmas_dialog.h"

#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QGroupBox>
#include <QVBoxLayout>

#include "sessions/session/input_sigmas.h"

namespace boresight::ui {
namespace {

constexpr double kPercent = 100.0;

}  // namespace

InputSigmasDialog::InputSigmasDialog(const sessions::SessionCase& one, QWidget* parent)
    : QDialog(parent) {
  setWindowTitle(tr("How well mesh and camera are known"));
  const sessions::InputSigmas sigmas(one);
  auto* column = new QVBoxLayout(this);
  mesh_ = group(tr("Stated for the mesh, one sigma"), QStringLiteral("meshStated"),
                sigmas.mesh_scale_stated);
  mesh_scale_percent_ =
      box(mesh_, tr("Scale"), QStringLiteral("meshScale"), kPercent * sigmas.mesh_scale,
          kPercent * sessions::kMaxScaleSigma, tr(" %"));
  camera_ = group(tr("Stated for the camera, one sigma"), QStringLiteral("cameraStated"),
                  sigmas.calibration_stated);
  focal_percent_ = box(camera_, tr("Focal length"), QStringLiteral("focal"),
                       kPercent * sigmas.calibration.focal_relative,
                       kPercent * sessions::kMaxFocalSigma, tr(" %"));
  principal_point_px_ =
      box(camera_, tr("Principal point"), QStringLiteral("principalPoint"),
          sigmas.calibration.principal_point_px, sessions::kMaxPrincipalPointSigma_px, tr(" px"));
  column->addWidget(mesh_);
  column->addWidget(camera_);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  column->addWidget(buttons);
}

QGroupBox* InputSigmasDialog::group(const QString& title, const QString& name, bool stated) {
  auto* made = new QGroupBox(title, this);
  made->setObjectName(name);
  made->setCheckable(true);
  made->setChecked(stated);
  made->setToolTip(tr("Off: the values shown are assumed"));
  new QFormLayout(made);
  return made;
}

QDoubleSpinBox* InputSigmasDialog::box(QGroupBox* group, const QString& label, const QString& name,
                                       double value, double maximum, const QString& unit) {
  auto* made = new QDoubleSpinBox(group);
  made->setObjectName(name);
  made->setDecimals(4);
  made->setRange(0.0, maximum);
  made->setSingleStep(0.01);
  made->setValue(value);
  made->setSuffix(unit);
  static_cast<QFormLayout*>(group->layout())->addRow(label, made);
  return made;
}

std::optional<double> InputSigmasDialog::meshScaleSigma() const {
  if (!mesh_->isChecked()) return std::nullopt;
  return mesh_scale_percent_->value() / kPercent;
}

std::optional<sessions::CalibrationSigma> InputSigmasDialog::calibrationSigma() const {
  if (!camera_->isChecked()) return std::nullopt;
  return sessions::CalibrationSigma{focal_percent_->value() / kPercent,
                                    principal_point_px_->value()};
}

}  // namespace boresight::ui
