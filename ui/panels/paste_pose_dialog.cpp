// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/paste_pose_dialog.h"

#include <QtWidgets>

#include "core/base/math.h"
#include "ui/panels/widgets.h"

namespace boresight::ui {

using sessions::PoseForm;

PastePoseDialog::PastePoseDialog(const QString& text, QWidget* parent) : QDialog(parent) {
  setWindowTitle(tr("Paste a pose"));
  auto* layout = new QVBoxLayout(this);
  auto* hint = new QLabel(tr("A 4x4 or 3x4 matrix, a quaternion and a translation, or a rotation "
                             "vector (deg) and a translation."),
                          this);
  hint->setWordWrap(true);
  layout->addWidget(hint);
  text_ = named(new QPlainTextEdit(text, this), "text");
  text_->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  text_->setAccessibleName(tr("Pose as text"));
  layout->addWidget(text_);

  auto* form = new QFormLayout;
  direction_ = addChoice(tr("Direction"), "direction",
                         {tr("camera_from_station (p_camera = R p_station + t)"),
                          tr("station_from_camera (the camera's place in the station)")},
                         *form);
  matrix_order_ =
      addChoice(tr("Matrix"), "matrixOrder", {tr("row by row"), tr("column by column")}, *form);
  quaternion_order_ =
      addChoice(tr("Quaternion"), "quaternionOrder", {tr("w x y z"), tr("x y z w")}, *form);
  unit_ = addChoice(tr("Translation"), "unit", {tr("metres"), tr("millimetres")}, *form);
  layout->addLayout(form);

  verdict_ = named(new QLabel(this), "verdict");
  verdict_->setWordWrap(true);
  verdict_->setMinimumHeight(3 * verdict_->fontMetrics().lineSpacing());
  layout->addWidget(verdict_);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel, this);
  take_ = buttons->addButton(tr("Nudge to this pose"), QDialogButtonBox::AcceptRole);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  layout->addWidget(buttons);

  connect(text_, &QPlainTextEdit::textChanged, this, [this] {
    guess();
    parse();
  });
  guess();
  parse();
  resize(560, 420);
}

QComboBox* PastePoseDialog::addChoice(const QString& label, const char* name,
                                      const QStringList& choices, QFormLayout& form) {
  auto* box = new QComboBox(this);
  box->setObjectName(QString::fromUtf8(name));
  box->addItems(choices);
  form.addRow(label, box);
  connect(box, QOverload<int>::of(&QComboBox::currentIndexChanged), this, &PastePoseDialog::parse);
  return box;
}

void PastePoseDialog::guess() {
  const sessions::PoseReading guess = sessions::guessReading(text_->toPlainText().toStdString());
  const auto choose = [](QComboBox* box, auto value) {
    const QSignalBlocker blocker(box);
    box->setCurrentIndex(static_cast<int>(value));
  };
  choose(direction_, guess.direction);
  choose(matrix_order_, guess.matrix_order);
  choose(quaternion_order_, guess.quaternion_order);
  choose(unit_, guess.unit);
}

sessions::PoseReading PastePoseDialog::reading() const {
  sessions::PoseReading reading;
  reading.direction = static_cast<sessions::PoseDirection>(direction_->currentIndex());
  reading.matrix_order = static_cast<sessions::MatrixOrder>(matrix_order_->currentIndex());
  reading.quaternion_order =
      static_cast<sessions::QuaternionOrder>(quaternion_order_->currentIndex());
  reading.unit = static_cast<sessions::LengthUnit>(unit_->currentIndex());
  return reading;
}

void PastePoseDialog::parse() {
  parsed_ = sessions::parsePose(text_->toPlainText().toStdString(), reading());
  matrix_order_->setEnabled(parsed_.form == PoseForm::kMatrix);
  quaternion_order_->setEnabled(parsed_.form == PoseForm::kQuaternion);
  take_->setEnabled(parsed_.valid);
  if (!parsed_.valid) {
    verdict_->setText(QString(QChar(0x26A0)) + QLatin1Char(' ') +
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
  verdict_->setText(text);
}

}  // namespace boresight::ui
