// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/uncertainty_dialog.h"

#include <QtWidgets>

namespace boresight::ui {
namespace {

constexpr double kMost_mm = 10'000.0;
constexpr double kMost_deg = 180.0;

QDoubleSpinBox* field(double value, double most, const QString& unit) {
  auto* box = new QDoubleSpinBox;
  box->setRange(0.0, most);
  box->setDecimals(2);
  box->setValue(value);
  box->setSuffix(QLatin1Char(' ') + unit);
  return box;
}

}  // namespace

UncertaintyDialog::UncertaintyDialog(const sessions::DeclaredUncertainty& uncertainty,
                                     QWidget* parent)
    : QDialog(parent), stated_(uncertainty) {
  setWindowTitle(tr("Uncertainty of the seed"));
  auto* form = new QGridLayout;
  const QStringList axes = {tr("x, to the right"), tr("y, down"), tr("z, along the view")};
  form->addWidget(new QLabel(tr("Along")), 0, 1);
  form->addWidget(new QLabel(tr("About")), 0, 2);
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    translation_mm_[axis] = field(1e3 * uncertainty.translation_m[i], kMost_mm, tr("mm"));
    rotation_deg_[axis] = field(uncertainty.rotation_deg[i], kMost_deg, tr("deg"));
    form->addWidget(new QLabel(axes[i]), i + 1, 0);
    form->addWidget(translation_mm_[axis], i + 1, 1);
    form->addWidget(rotation_deg_[axis], i + 1, 2);
  }
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
  buttons->button(QDialogButtonBox::Ok)->setText(tr("Run again"));
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* column = new QVBoxLayout(this);
  auto* help = new QLabel(tr("The seed may be off by at most this, each way. A rotation of 180 deg "
                             "about z allows any turn in the image."));
  help->setWordWrap(true);
  column->addWidget(help);
  column->addLayout(form);
  column->addWidget(buttons);
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
