// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/paste_pose_dialog.h"

#include <QtWidgets>

#include "ui_paste_pose_dialog.h"

#include "core/base/math.h"

namespace boresight::ui {

using sessions::PoseForm;

PastePoseDialog::PastePoseDialog(const QString& text, QWidget* parent)
    : QDialog(parent), ui_(std::make_unique<Ui::PastePoseDialog>()) {
  ui_->setupUi(this);
  ui_->text->setPlainText(text);
  ui_->text->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  ui_->verdict->setMinimumHeight(3 * ui_->verdict->fontMetrics().lineSpacing());
  take_ = ui_->buttons->addButton(tr("Nudge to this pose"), QDialogButtonBox::AcceptRole);
  connect(ui_->buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(ui_->buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  for (QComboBox* box : {ui_->direction, ui_->matrixOrder, ui_->quaternionOrder, ui_->unit})
    connect(box, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
            &PastePoseDialog::parse);
  connect(ui_->text, &QPlainTextEdit::textChanged, this, [this] {
    guess();
    parse();
  });
  guess();
  parse();
  resize(560, 420);
}

PastePoseDialog::~PastePoseDialog() = default;

void PastePoseDialog::guess() {
  const sessions::PoseReading guess =
      sessions::guessReading(ui_->text->toPlainText().toStdString());
  const auto choose = [](QComboBox* box, auto value) {
    const QSignalBlocker blocker(box);
    box->setCurrentIndex(static_cast<int>(value));
  };
  choose(ui_->direction, guess.direction);
  choose(ui_->matrixOrder, guess.matrix_order);
  choose(ui_->quaternionOrder, guess.quaternion_order);
  choose(ui_->unit, guess.unit);
}

sessions::PoseReading PastePoseDialog::reading() const {
  sessions::PoseReading reading;
  reading.direction = static_cast<sessions::PoseDirection>(ui_->direction->currentIndex());
  reading.matrix_order = static_cast<sessions::MatrixOrder>(ui_->matrixOrder->currentIndex());
  reading.quaternion_order =
      static_cast<sessions::QuaternionOrder>(ui_->quaternionOrder->currentIndex());
  reading.unit = static_cast<sessions::LengthUnit>(ui_->unit->currentIndex());
  return reading;
}

void PastePoseDialog::parse() {
  parsed_ = sessions::parsePose(ui_->text->toPlainText().toStdString(), reading());
  ui_->matrixOrder->setEnabled(parsed_.form == PoseForm::kMatrix);
  ui_->quaternionOrder->setEnabled(parsed_.form == PoseForm::kQuaternion);
  take_->setEnabled(parsed_.valid);
  if (!parsed_.valid) {
    ui_->verdict->setText(QString(QChar(0x26A0)) + QLatin1Char(' ') +
                          QString::fromStdString(parsed_.problem));
    return;
  }
  const Eigen::Vector3d mm = 1e3 * parsed_.camera_from_station.translation_m;
  QString text =
      tr("The station's origin lies %1, %2, %3 mm right of, below and ahead of the "
         "camera, turned by %4 deg.")
          .arg(mm.x(), 0, 'f', 2)
          .arg(mm.y(), 0, 'f', 2)
          .arg(mm.z(), 0, 'f', 2)
          .arg(rotationLog(parsed_.camera_from_station.rotation).norm() / kDegree_rad, 0, 'f', 2);
  if (mm.z() <= 0.0) text += tr(" That is behind the camera.");
  if (parsed_.rotation_deviation > 1e-6)
    text += tr(" The matrix was %1 off a rotation and was projected to the nearest one.")
                .arg(parsed_.rotation_deviation, 0, 'g', 2);
  ui_->verdict->setText(text);
}

}  // namespace boresight::ui
