// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <QDialog>
#include <QWidget>

#include "ui_input_sheet_panel.h"
#include "ui_input_sigmas_dialog.h"
#include "ui_judgement_dialog.h"

#include "sessions/session/input_sheet.h"
#include "sessions/session/session.h"
#include "sessions/session/stated_inputs.h"
#include "ui/widgets/stated_number.h"

namespace boresight::ui {

/// Asks for the uncertainty of the mesh's scale and the camera's calibration, which one image
/// cannot determine. Values that are not stated are assumed; the boxes show the assumed ones.
/// Checking a group states all its values as shown. In a group that was checked before, a value
/// stays stated or assumed until it is changed.
class InputSigmasDialog : public QDialog {
  Q_OBJECT

 public:
  InputSigmasDialog(const sessions::SessionCase& session_case, QWidget* parent);

  std::optional<double> meshScaleSigma() const;
  std::optional<sessions::StatedCalibration> calibrationSigma() const;

 private:
  Ui::InputSigmasDialog ui_;
  sessions::InputSigmas former_;
  std::optional<sessions::StatedCalibration> former_calibration_;
  StatedNumber mesh_scale_;  ///< relative
  StatedNumber focal_;       ///< relative
  StatedNumber centre_px_;
  bool camera_toggled_ = false;  ///< the operator has checked or cleared the camera's group
};

/// Asks for the point at which a pose is judged, its allowed errors, and the station's symmetries.
/// The limits of a case's own requirement replace all those of the preset: of a case without one
/// the preset's are shown, and the first change states all of them. Cannot be accepted while the
/// text of the symmetries has no meaning.
class JudgementDialog : public QDialog {
  Q_OBJECT

 public:
  /// `limits`: those that apply to the case, requirementOf() it.
  JudgementDialog(const sessions::SessionCase& session_case, const sessions::Requirement& limits,
                  QWidget* parent);

  /// With its former orientation; empty: poses are judged at the camera.
  std::optional<Pose> cameraFromEndEffector() const;
  /// Empty: that of the preset. A limit in pixels is kept.
  std::optional<sessions::Requirement> requirement() const;
  /// The former ones where the text is unchanged.
  const sessions::Symmetries& symmetries() const { return symmetries_; }

 private:
  void readSymmetries();

  Pose former_end_effector_;
  std::optional<sessions::Requirement> former_requirement_;
  sessions::Requirement limits_;
  sessions::Symmetries former_symmetries_;
  sessions::Symmetries symmetries_;
  Ui::JudgementDialog ui_;
  std::array<StatedNumber, 3> place_m_;
  StatedNumber normal_mm_, lateral_mm_, rotation_deg_;
};

/// Figures of the case's inputs with units; probable errors come first, as sentences. Ctrl+C copies
/// the chosen lines. A button asks for data that no image shows.
class InputSheetPanel : public QWidget {
  Q_OBJECT

 public:
  InputSheetPanel();

  /// Empty: no case is open.
  void setSheet(const std::optional<sessions::InputSheet>& sheet);

 Q_SIGNALS:
  /// The operator asks to state the uncertainty of mesh and camera.
  void sigmasRequested();
  /// The same for end effector, requirement and symmetries.
  void judgementRequested();

 private:
  void copyChosen() const;

  Ui::InputSheetPanel ui_;
};

}  // namespace boresight::ui
