// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/uncertainty_dialog.h"

#include <QtWidgets>

namespace boresight::ui {

UncertaintyDialog::UncertaintyDialog(const sessions::DeclaredUncertainty& uncertainty,
                                     QWidget* parent)
    : QDialog(parent), stated_(uncertainty) {
  ui_.setupUi(this);
  ui_.buttons->button(QDialogButtonBox::Ok)->setText(tr("Run again"));
  translation_mm_ = {ui_.xAlong, ui_.yAlong, ui_.zAlong};
  rotation_deg_ = {ui_.xAbout, ui_.yAbout, ui_.zAbout};
  for (std::size_t i = 0; i < 3; ++i) {
    translation_mm_[i]->setValue(1e3 * uncertainty.translation_m[static_cast<int>(i)]);
    rotation_deg_[i]->setValue(uncertainty.rotation_deg[static_cast<int>(i)]);
  }
}

sessions::DeclaredUncertainty UncertaintyDialog::uncertainty() const {
  sessions::DeclaredUncertainty result = stated_;
  for (std::size_t i = 0; i < 3; ++i) {
    result.translation_m[static_cast<int>(i)] = 1e-3 * translation_mm_[i]->value();
    result.rotation_deg[static_cast<int>(i)] = rotation_deg_[i]->value();
  }
  return result;
}

}  // namespace boresight::ui
