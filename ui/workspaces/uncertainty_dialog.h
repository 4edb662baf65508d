// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <QDialog>

#include "ui_uncertainty_dialog.h"

#include "sessions/io/cameras/pose_file.h"
#include "ui/widgets/stated_number.h"

namespace boresight::ui {

/// Asks for the seed's uncertainty along and about each axis of the camera.
class UncertaintyDialog : public QDialog {
  Q_OBJECT

 public:
  UncertaintyDialog(const sessions::DeclaredUncertainty& uncertainty, QWidget* parent);

  sessions::DeclaredUncertainty uncertainty() const;

 private:
  Ui::UncertaintyDialog ui_;
  sessions::DeclaredUncertainty stated_;
  std::array<StatedNumber, 3> translation_m_;
  std::array<StatedNumber, 3> rotation_deg_;
};

}  // namespace boresight::ui
