// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/calibration_panel.h"

#include <QtWidgets>

#include "sessions/calibration/calibrated_values.h"
#include "ui/models/text.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

/// Pixels with three decimals; coefficients with four digits.
QString figureText(const sessions::CalibratedValue& value, double figure) {
  return value.unit.empty() ? QString::number(figure, 'g', 4) : numberText(figure, 3);
}

QStringList rowOf(const sessions::CalibratedValue& value) {
  QString name = fromText(value.name);
  name[0] = name[0].toUpper();
  if (!value.unit.empty()) name += QStringLiteral(", ") + fromText(value.unit);
  QStringList row = {name, figureText(value, value.before)};
  const QString none = QStringLiteral("\u2013");
  if (!value.isDetermined()) return row << none << CalibrationPanel::tr("not determined") << none;
  return row << figureText(value, value.after) << figureText(value, value.sigma)
             << numberText(value.changeInSigmas(), 1);
}

QString purpose() {
  return CalibrationPanel::tr(
      "Estimates the camera from many images of the station, annotated or localized.");
}

QString summaryText(const sessions::CameraCalibration& calibration,
                    const std::vector<sessions::CalibratedValue>& values) {
  QStringList lines = {
      CalibrationPanel::tr(
          "%n image(s), rms %1 px, noise factor %2 (1: residuals as the sigmas state).", "",
          static_cast<int>(calibration.camera_from_station.size()))
          .arg(numberText(calibration.rms_px, 3), numberText(calibration.noise_factor, 2))};
  if (const std::string change = sessions::changeText(values); !change.empty())
    lines.prepend(fromText(change));
  for (const sessions::OutlyingView& view : calibration.outlying)
    lines << fromText(sessions::outlyingText(view));
  for (const sessions::Undetermined& direction : calibration.undetermined)
    lines << CalibrationPanel::tr(
                 "Not determined by these images: %1. Add images from other "
                 "distances and turned about the view axis.")
                 .arg(fromText(sessions::directionText(direction)));
  return lines.join(QLatin1Char('\n'));
}

}  // namespace

CalibrationPanel::CalibrationPanel(Document& document, ViewState& state, TaskRunner& tasks)
    : document_(document), state_(state), tasks_(tasks) {
  ui_.setupUi(this);
  styleTable(*ui_.calibrationParameters);
  ui_.calibrationParameters->horizontalHeader()->setSectionResizeMode(
      QHeaderView::ResizeToContents);
  connect(ui_.calibrate, &QPushButton::clicked, this, &CalibrationPanel::calibrate);
  connect(ui_.use, &QPushButton::clicked, this, &CalibrationPanel::use);
  state_.onChange(ViewChange::kCase, this, [this] {
    if (opening_ == state_.opening()) return;  // an edit, or the case is there
    forget(purpose());
    opening_ = state_.opening();
  });
  state_.onChange(ViewChange::kCase, this,
                  [this] { ui_.calibrate->setEnabled(state_.currentCase() && !calibrates_); });
  connect(&document_, &Document::changed, this, &CalibrationPanel::followCamera);
  forget(purpose());
}

/// Drops the calibration: it is of another camera, or there is none.
void CalibrationPanel::forget(const QString& reason) {
  tasks_.cancel(calibrating_);
  calibration_.reset();
  calibrated_.reset();
  calibrates_ = false;
  ui_.calibrationParameters->setRowCount(0);
  ui_.use->setEnabled(false);
  ui_.calibrate->setEnabled(state_.currentCase() != nullptr);
  ui_.summary->setText(reason);
}

/// The cases of another camera would get the calibration of this one.
void CalibrationPanel::followCamera() {
  const sessions::SessionCase* shown = shownCase(document_, state_);
  const bool is_used = calibration_ && shown && shown->camera == calibration_->camera;
  if (calibrated_ && shown && !is_used && !(shown->camera == *calibrated_))
    forget(tr("The camera of the case has changed: calibrate again."));
}

void CalibrationPanel::calibrate() {
  const sessions::FreeParameters free{ui_.focal->isChecked(), ui_.centre->isChecked(),
                                      ui_.distortion->isChecked()};
  const auto source = ui_.source->currentIndex() == 0 ? sessions::ObservationSource::kAnnotations
                                                      : sessions::ObservationSource::kRuns;
  const sessions::SessionCase* shown = shownCase(document_, state_);
  if (shown == nullptr) return;
  forget(tr("Calibrating ..."));
  calibrates_ = true;
  calibrated_ = shown->camera;
  ui_.calibrate->setEnabled(false);
  tasks_.replace(
      calibrating_,
      [session = document_.session(), id = shown->id, source, free](const std::stop_token&) {
        return sessions::calibrateCameraOf(session, id, source, free);
      },
      [this](const sessions::CameraCalibration& calibration) { take(calibration); },
      [this](const QString& problem) { forget(tr("Not calibrated: %1.").arg(problem)); });
}

void CalibrationPanel::take(const sessions::CameraCalibration& calibration) {
  const Camera before = *calibrated_;
  const auto values = sessions::calibratedValues(before, calibration);
  forget(summaryText(calibration, values));
  calibration_ = calibration;
  calibrated_ = before;
  for (const sessions::CalibratedValue& value : values)
    addRow(*ui_.calibrationParameters, rowOf(value));
  ui_.use->setEnabled(calibration.undetermined.empty());
}

void CalibrationPanel::use() {
  const std::string id = shownCaseId(document_, state_);
  if (!calibration_ || id.empty()) return;
  document_.edit(sessions::withCalibration(document_.session(), id, *calibration_),
                 tr("Use the calibrated camera"));
}

}  // namespace boresight::ui
