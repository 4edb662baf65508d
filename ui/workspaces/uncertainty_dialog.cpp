// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/uncertainty_dialog.h"

#include <QtWidgets>

namespace boresight::ui {

UncertaintyDialog::UncertaintyDialog(const sessions::DeclaredUncertainty& uncertainty,
                                     QWidget* parent)
    : QDialog(parent), stated_(uncertainty) {
  ui_.setupUi(this);
  ui_.buttons->button(QDialogButtonBox::Ok)->setText(tr("Run again"));
  QDoubleSpinBox* const along[] = {ui_.xAlong, ui_.yAlong, ui_.zAlong};
  QDoubleSpinBox* const about[] = {ui_.xAbout, ui_.yAbout, ui_.zAbout};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    translation_m_[i] = {*along[i], 1e3, uncertainty.translation_m[axis]};
    rotation_deg_[i] = {*about[i], 1.0, uncertainty.rotation_deg[axis]};
  }
}

sessions::DeclaredUncertainty UncertaintyDialog::uncertainty() const {
  sessions::DeclaredUncertainty result = stated_;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    result.translation_m[axis] = translation_m_[i].value().value_or(0.0);
    result.rotation_deg[axis] = rotation_deg_[i].value().value_or(0.0);
  }
  return result;
}

}  // namespace boresight::ui
