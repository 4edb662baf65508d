// SPDX-License-Identifier: Apache-2.0
#include "ui/review/limits_dialog.h"

#include <QtWidgets>

#include "sessions/session/check_limits.h"
#include "ui/models/number_text.h"
#include "ui/review/review_controller.h"

#include "ui_limits_dialog.h"

namespace boresight::ui {

LimitsDialog::LimitsDialog(ReviewController& controller, QWidget* parent)
    : QDialog(parent), controller_(controller), ui_(std::make_unique<Ui::LimitsDialog>()) {
  ui_->setupUi(this);
  setObjectName(QStringLiteral("limitsDialog"));
  for (const sessions::CheckPreset& preset : sessions::checkPresets()) {
    ui_->preset->addItem(fromText(preset.name));
    ui_->preset->setItemData(ui_->preset->count() - 1, fromText(preset.help), Qt::ToolTipRole);
  }
  ui_->limitHelp->setMinimumHeight(2 * ui_->limitHelp->fontMetrics().lineSpacing());
  connect(ui_->preset, QOverload<int>::of(&QComboBox::activated), this,
          [this] { controller_.setPreset(ui_->preset->currentText()); });
  connect(ui_->secondPerson, &QCheckBox::clicked, &controller_, &ReviewController::setSecondPerson);
  connect(ui_->resetAll, &QPushButton::clicked, this, [this] {
    if (const auto* preset = sessions::findCheckPreset(controller_.settings().preset))
      controller_.setLimits(preset->limits);
  });
  connect(ui_->close, &QPushButton::clicked, this, &QDialog::close);
  connect(&ui_->limits->options(), &OptionsModel::edited, this, &LimitsDialog::change);
  connect(ui_->limits, &OptionsTable::helpChanged, this, [this](const QString& help) {
    ui_->limitHelp->setText(help.isEmpty() ? tr("Choose a limit to read what it is for.") : help);
  });
  connect(&controller_, &ReviewController::reviewStatusChanged, this, &LimitsDialog::showSettings);
  showSettings();
  resize(640, 460);
}

LimitsDialog::~LimitsDialog() = default;

void LimitsDialog::change(const std::string& name, const std::string& value) {
  const sessions::ReviewSettings& settings = controller_.settings();
  sessions::CheckLimits changed = sessions::checkLimits(settings.preset, settings.limits);
  try {
    sessions::applyOptionText(changed, name, value);
  } catch (const sessions::OptionError& error) {
    ui_->limitHelp->setText(tr("✗ Not changed: %1.").arg(fromText(error.what())));
    return;
  }
  controller_.setLimits(changed);
}

void LimitsDialog::showSettings() {
  const sessions::ReviewSettings& settings = controller_.settings();
  const sessions::CheckPreset* preset = sessions::findCheckPreset(settings.preset);
  if (preset == nullptr) return;
  ui_->limits->setOptions(
      sessions::listOptions(sessions::checkLimits(settings.preset, settings.limits)),
      sessions::listOptions(preset->limits));
  ui_->preset->setCurrentText(fromText(preset->name));
  ui_->preset->setToolTip(fromText(preset->help));
  ui_->presetHelp->setText(fromText(preset->help));
  ui_->secondPerson->setChecked(settings.second_person);
  ui_->resetAll->setEnabled(!settings.limits.empty());
}

}  // namespace boresight::ui
