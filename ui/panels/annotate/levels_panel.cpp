// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/annotate/levels_panel.h"

#include <QtWidgets>

#include "ui/panels/annotate/levels_histogram.h"
#include "ui/views/display_image.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

/// Rules that the operator chooses among; a table can be kept but not made here.
enum Rule { kLinear, kLevels, kTable };

}  // namespace

LevelsPanel::LevelsPanel(DisplayImage& display) : display_(display) {
  ui_.setupUi(this);
  ui_.layout2->insertRow(1, new LevelsHistogram(display));
  connect(&display_, &DisplayImage::levelsChanged, this, &LevelsPanel::showLevels);
  connect(ui_.showCore, &QCheckBox::toggled, &display_, &DisplayImage::setShowsCore);
  const auto change = [this] {
    display_.setLevels({ui_.displayBlack->value(), ui_.displayWhite->value()});
  };
  for (QSpinBox* box : {ui_.displayBlack, ui_.displayWhite})
    connect(box, QOverload<int>::of(&QSpinBox::valueChanged), this, change);
  connect(ui_.automaticLevels, &QPushButton::clicked, &display_, &DisplayImage::setAutomaticLevels);
  connect(ui_.fullLevels, &QPushButton::clicked, &display_, &DisplayImage::setFullLevels);
  connect(ui_.conversionKind, kIndexChanged, this, &LevelsPanel::updateConversion);
  for (QSpinBox* box : {ui_.conversionBits, ui_.conversionBlack, ui_.conversionWhite})
    connect(box, QOverload<int>::of(&QSpinBox::valueChanged), this, &LevelsPanel::updateConversion);
  connect(ui_.conversionFromDisplay, &QPushButton::clicked, this, [this] {
    ui_.conversionKind->setCurrentIndex(kLevels);
    if (display_.samples()) ui_.conversionBits->setValue(display_.samples()->sample_bits);
    ui_.conversionBlack->setValue(display_.levels().black);
    ui_.conversionWhite->setValue(display_.levels().white);
  });
  connect(ui_.applyConversion, &QPushButton::clicked, this, [this] {
    Q_EMIT conversionRequested(chosenConversion(), ui_.conversionWholeCamera->isEnabled() &&
                                                       ui_.conversionWholeCamera->isChecked());
  });
  showLevels();
  setCase(nullptr, nullptr, 0);
}

int LevelsPanel::sampleBits() const {
  return display_.samples() ? display_.samples()->sample_bits : 8;
}

void LevelsPanel::showLevels() {
  const bool stretched = display_.samples() && !display_.showsCore();
  for (QWidget* each : std::initializer_list<QWidget*>{ui_.displayBlack, ui_.displayWhite,
                                                       ui_.automaticLevels, ui_.fullLevels})
    each->setEnabled(stretched);
  const int largest = (1 << sampleBits()) - 1;
  const QSignalBlocker no_black(ui_.displayBlack), no_white(ui_.displayWhite),
      no_core(ui_.showCore);
  ui_.showCore->setChecked(display_.showsCore());
  ui_.displayBlack->setRange(0, largest - 1);
  ui_.displayWhite->setRange(1, largest);
  ui_.displayBlack->setValue(display_.levels().black);
  ui_.displayWhite->setValue(display_.levels().white);
  // What the operator has begun to choose stays while the display changes.
  if (shown_bits_ != sampleBits()) showConversion();
  updateConversion();
}

void LevelsPanel::setCase(const sessions::SessionCase* session_case,
                          const sessions::GrayImage* image, int cases_of_camera) {
  const int bits = image ? image->bit_depth : 8;
  const auto rule = session_case ? std::optional(session_case->image.eight_bit) : std::nullopt;
  const bool keeps =
      rule == current_ && cases_of_camera == cases_of_camera_ && bits == current_bits_;
  current_ = rule;
  current_bits_ = bits;
  bits_of_label_ = image && image->bit_depth_of_label;
  cases_of_camera_ = cases_of_camera;
  ui_.conversionRule->setText(session_case && image
                                  ? tr("Now: %1").arg(QString::fromStdString(image->rule))
                                  : tr("No editable case is open."));
  if (!keeps) showConversion();
  updateConversion();
}

void LevelsPanel::showConversion() {
  const QSignalBlocker no_kind(ui_.conversionKind), no_bits(ui_.conversionBits),
      no_black(ui_.conversionBlack), no_white(ui_.conversionWhite);
  shown_bits_ = sampleBits();
  ui_.conversionBits->setRange(1, shown_bits_);
  ui_.conversionWholeCamera->setVisible(cases_of_camera_ > 0);
  ui_.conversionWholeCamera->setText(tr("Also the camera's %1 other cases").arg(cases_of_camera_));
  if (current_) {
    const bool by_table = !current_->table.empty();
    ui_.conversionKind->removeItem(kTable);
    if (by_table) ui_.conversionKind->addItem(tr("A given table"));
    ui_.conversionKind->setCurrentIndex(by_table ? kTable : current_->levels ? kLevels : kLinear);
    ui_.conversionBits->setValue(current_->bit_depth.value_or(current_bits_));
    const int largest = (1 << ui_.conversionBits->value()) - 1;
    ui_.conversionBlack->setMaximum(largest);
    ui_.conversionWhite->setMaximum(largest);
    const sessions::GrayLevels levels = current_->levels.value_or(sessions::GrayLevels{0, largest});
    ui_.conversionBlack->setValue(levels.black);
    ui_.conversionWhite->setValue(levels.white);
  }
}

sessions::ImageReadOptions LevelsPanel::chosenConversion() const {
  sessions::ImageReadOptions chosen;
  if (current_) chosen.bayer = current_->bayer;
  chosen.bit_depth = ui_.conversionBits->value();
  if (ui_.conversionKind->currentIndex() == kTable) return *current_;
  // What the label states need not be stated again; other images have labels of their own.
  if (ui_.conversionKind->currentIndex() == kLinear && bits_of_label_ && !current_->bit_depth &&
      ui_.conversionBits->value() == current_bits_)
    chosen.bit_depth.reset();
  if (ui_.conversionKind->currentIndex() == kLevels)
    chosen.levels =
        sessions::GrayLevels{ui_.conversionBlack->value(), ui_.conversionWhite->value()};
  return chosen;
}

void LevelsPanel::updateConversion() {
  const bool editable = current_.has_value();
  const bool by_levels = ui_.conversionKind->currentIndex() == kLevels;
  const int largest = (1 << ui_.conversionBits->value()) - 1;
  ui_.conversionBlack->setMaximum(largest - 1);
  ui_.conversionWhite->setMaximum(largest);
  ui_.conversionKind->setEnabled(editable);
  ui_.conversionBits->setEnabled(editable && ui_.conversionKind->currentIndex() != kTable);
  for (QWidget* each : {ui_.conversionBlack, ui_.conversionWhite})
    each->setEnabled(editable && by_levels);
  ui_.conversionFromDisplay->setEnabled(editable && display_.samples());
  ui_.conversionWholeCamera->setEnabled(editable && cases_of_camera_ > 0);
  const bool sensible = !by_levels || ui_.conversionBlack->value() < ui_.conversionWhite->value();
  const bool differs = editable && !(chosenConversion() == *current_);
  ui_.applyConversion->setEnabled(
      sensible && (differs || (editable && ui_.conversionWholeCamera->isEnabled())));
}

}  // namespace boresight::ui
