// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/levels_panel.h"

#include <QtWidgets>

#include "ui/panels/widgets.h"
#include "ui/views/display_image.h"

namespace boresight::ui {
namespace {

/// Rules that people choose among; a table can be kept but not made here.
enum Rule { kLinear, kLevels, kTable };

QSpinBox* spinBox(const QString& name, int least, int most, const QString& tip) {
  auto* box = new QSpinBox;
  box->setObjectName(name);
  box->setRange(least, most);
  box->setToolTip(tip);
  box->setAccessibleName(tip);
  box->setKeyboardTracking(false);
  return box;
}

QPushButton* button(const QString& name, const QString& text, const QString& tip) {
  auto* made = new QPushButton(text);
  made->setObjectName(name);
  made->setToolTip(tip);
  return made;
}

}  // namespace

LevelsPanel::LevelsPanel(DisplayImage& display, QWidget* parent)
    : QWidget(parent), display_(display) {
  auto* outer = new QVBoxLayout(this);
  outer->setContentsMargins(0, 0, 0, 0);
  auto* scroll = new QScrollArea;  // a small screen has no room for all of it
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  outer->addWidget(scroll);
  auto* page = new QWidget;
  auto* layout = new QVBoxLayout(page);
  layout->setContentsMargins(6, 6, 6, 6);
  buildDisplay(*layout);
  buildConversion(*layout);
  layout->addStretch(1);
  scroll->setWidget(page);
  connect(&display_, &DisplayImage::levelsChanged, this, &LevelsPanel::showLevels);
  showLevels();
  setCase(nullptr, nullptr, 0);
}

void LevelsPanel::buildDisplay(QBoxLayout& layout) {
  auto* group = new QGroupBox(tr("Display"));
  group->setToolTip(tr("For the eye only: it never changes a run"));
  auto* form = new QFormLayout(group);
  core_ = named(new QCheckBox(tr("What the core sees")), "showCore",
                tr("Show the 8-bit image that the core is given, not stretched (C)"));
  black_ = spinBox(QStringLiteral("displayBlack"), 0, 65535,
                   tr("Samples of this value or less are shown black"));
  white_ = spinBox(QStringLiteral("displayWhite"), 0, 65535,
                   tr("Samples of this value or more are shown white"));
  automatic_ = button(QStringLiteral("automaticLevels"), tr("Auto"),
                      tr("Leave half a percent of the pixels black and as many white"));
  full_ = button(QStringLiteral("fullLevels"), tr("Full range"),
                 tr("From 0 to the largest value that the file can hold"));
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(automatic_);
  buttons->addWidget(full_);
  form->addRow(core_);
  form->addRow(tr("Black"), black_);
  form->addRow(tr("White"), white_);
  form->addRow(buttons);
  layout.addWidget(group);
  connect(core_, &QCheckBox::toggled, &display_, &DisplayImage::setShowsCore);
  const auto change = [this] { display_.setLevels({black_->value(), white_->value()}); };
  for (QSpinBox* box : {black_, white_})
    connect(box, QOverload<int>::of(&QSpinBox::valueChanged), this, change);
  connect(automatic_, &QPushButton::clicked, &display_, &DisplayImage::setAutomaticLevels);
  connect(full_, &QPushButton::clicked, &display_, &DisplayImage::setFullLevels);
}

void LevelsPanel::buildConversion(QBoxLayout& layout) {
  auto* group = new QGroupBox(tr("What the core is given: 8 bit"));
  auto* column = new QVBoxLayout(group);
  rule_ = new QLabel;
  rule_->setObjectName(QStringLiteral("conversionRule"));
  rule_->setWordWrap(true);
  rule_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  kind_ = new QComboBox;
  kind_->setObjectName(QStringLiteral("conversionKind"));
  kind_->addItem(tr("All of the bits"), kLinear);
  kind_->addItem(tr("Between two levels"), kLevels);
  kind_->setToolTip(tr("Which samples become 0 and 255; those between them follow linearly"));
  bit_depth_ = spinBox(QStringLiteral("conversionBits"), 1, 16,
                       tr("How many bits of the samples are used; a sample beyond is an error"));
  bit_depth_->setSuffix(tr(" bit"));
  core_black_ = spinBox(QStringLiteral("conversionBlack"), 0, 65535, tr("Samples that become 0"));
  core_white_ = spinBox(QStringLiteral("conversionWhite"), 1, 65535, tr("Samples that become 255"));
  from_display_ = button(QStringLiteral("conversionFromDisplay"), tr("As displayed"),
                         tr("Take the display's levels"));
  whole_camera_ = new QCheckBox;
  whole_camera_->hide();  // until there are other cases
  whole_camera_->setObjectName(QStringLiteral("conversionWholeCamera"));
  whole_camera_->setToolTip(tr("Images of one camera are usually converted by one rule"));
  apply_ = button(QStringLiteral("applyConversion"), tr("Apply"),
                  tr("Convert by this rule from now on; runs made before are stale"));
  column->addWidget(rule_);
  auto* form = new QFormLayout;
  column->addLayout(form);
  form->addRow(tr("Rule"), kind_);
  form->addRow(tr("Bits used"), bit_depth_);
  form->addRow(tr("Black"), core_black_);
  form->addRow(tr("White"), core_white_);
  form->addRow(from_display_);
  form->addRow(whole_camera_);
  form->addRow(apply_);
  layout.addWidget(group);
  connect(kind_, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          &LevelsPanel::updateConversion);
  for (QSpinBox* box : {bit_depth_, core_black_, core_white_})
    connect(box, QOverload<int>::of(&QSpinBox::valueChanged), this, &LevelsPanel::updateConversion);
  connect(from_display_, &QPushButton::clicked, this, [this] {
    kind_->setCurrentIndex(kLevels);
    if (display_.samples()) bit_depth_->setValue(display_.samples()->sample_bits);
    core_black_->setValue(display_.levels().black);
    core_white_->setValue(display_.levels().white);
  });
  connect(apply_, &QPushButton::clicked, this, [this] {
    Q_EMIT conversionRequested(chosenConversion(),
                               whole_camera_->isEnabled() && whole_camera_->isChecked());
  });
}

int LevelsPanel::sampleBits() const {
  return display_.samples() ? display_.samples()->sample_bits : 8;
}

void LevelsPanel::showLevels() {
  const bool ready = display_.samples() != nullptr;
  const bool stretched = ready && !display_.showsCore();
  for (QWidget* each : {static_cast<QWidget*>(black_), static_cast<QWidget*>(white_),
                        static_cast<QWidget*>(automatic_), static_cast<QWidget*>(full_)})
    each->setEnabled(stretched);
  const int largest = (1 << sampleBits()) - 1;
  const QSignalBlocker no_black(black_), no_white(white_), no_core(core_);
  core_->setChecked(display_.showsCore());
  black_->setRange(0, largest - 1);
  white_->setRange(1, largest);
  black_->setValue(display_.levels().black);
  white_->setValue(display_.levels().white);
  // What somebody has begun to choose stays while the display changes.
  if (shown_bits_ != sampleBits()) showConversion();
  updateConversion();
}

void LevelsPanel::setCase(const sessions::SessionCase* one, const sessions::GrayImage* image,
                          int cases_of_camera) {
  const int bits = image ? image->bit_depth : 8;
  const bool same_rule = one ? current_ == one->image.eight_bit : !current_;
  const bool keeps = same_rule && cases_of_camera == cases_of_camera_ && bits == current_bits_;
  current_.reset();
  if (one) current_ = one->image.eight_bit;
  current_bits_ = bits;
  bits_of_label_ = image && image->bit_depth_of_label;
  cases_of_camera_ = cases_of_camera;
  rule_->setText(one && image ? tr("Now: %1").arg(QString::fromStdString(image->rule))
                              : tr("No case that can be edited is open."));
  if (!keeps) showConversion();
  updateConversion();
}

void LevelsPanel::showConversion() {
  const QSignalBlocker no_kind(kind_), no_bits(bit_depth_), no_black(core_black_),
      no_white(core_white_);
  shown_bits_ = sampleBits();
  bit_depth_->setRange(1, shown_bits_);
  whole_camera_->setVisible(cases_of_camera_ > 0);
  whole_camera_->setText(tr("Also the camera's %1 other cases").arg(cases_of_camera_));
  if (current_) {
    const bool by_table = !current_->table.empty();
    if (by_table != (kind_->count() == 3)) {
      if (by_table)
        kind_->addItem(tr("A given table"), kTable);
      else
        kind_->removeItem(kTable);
    }
    kind_->setCurrentIndex(by_table ? kTable : current_->levels ? kLevels : kLinear);
    bit_depth_->setValue(current_->bit_depth.value_or(current_bits_));
    const int largest = (1 << bit_depth_->value()) - 1;
    core_black_->setMaximum(largest);
    core_white_->setMaximum(largest);
    const sessions::GrayLevels levels = current_->levels.value_or(sessions::GrayLevels{0, largest});
    core_black_->setValue(levels.black);
    core_white_->setValue(levels.white);
  }
  updateConversion();
}

sessions::ImageReadOptions LevelsPanel::chosenConversion() const {
  sessions::ImageReadOptions chosen;
  chosen.bit_depth = bit_depth_->value();
  if (kind_->currentIndex() == kTable) return *current_;
  // What the label states need not be stated again; other images have labels of their own.
  if (kind_->currentIndex() == kLinear && bits_of_label_ && !current_->bit_depth &&
      bit_depth_->value() == current_bits_)
    chosen.bit_depth.reset();
  if (kind_->currentIndex() == kLevels)
    chosen.levels = sessions::GrayLevels{core_black_->value(), core_white_->value()};
  return chosen;
}

void LevelsPanel::updateConversion() {
  const bool editable = current_.has_value();
  const bool by_levels = kind_->currentIndex() == kLevels;
  const int largest = (1 << bit_depth_->value()) - 1;
  core_black_->setMaximum(std::max(0, largest - 1));
  core_white_->setMaximum(std::max(1, largest));
  kind_->setEnabled(editable);
  bit_depth_->setEnabled(editable && kind_->currentIndex() != kTable);
  for (QWidget* each : {core_black_, core_white_}) each->setEnabled(editable && by_levels);
  from_display_->setEnabled(editable && display_.samples());
  whole_camera_->setEnabled(editable && cases_of_camera_ > 0);
  const bool sensible = !by_levels || core_black_->value() < core_white_->value();
  const bool differs = editable && !(chosenConversion() == *current_);
  apply_->setEnabled(sensible && (differs || (editable && whole_camera_->isEnabled())));
}

}  // namespace boresight::ui
