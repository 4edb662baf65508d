// SPDX-License-Identifier: Apache-2.0
#include "ui/review/precision_bars.h"

#include <utility>

#include <QVBoxLayout>

#include "ui_precision_row.h"

#include "ui/models/text.h"
#include "ui/review/check_cards.h"
#include "ui/style/tokens.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

bool isPrecision(const sessions::Check& check) {
  return check.id.starts_with("covariance_") && check.figure && check.limit;
}

QWidget* precisionRow(const sessions::Check& check) {
  auto* row = new QWidget;
  row->setToolTip(fromText(check.sentence));
  Ui::PrecisionRow ui;
  ui.setupUi(row);
  ui.title->setText(fromText(check.title));
  ui.precisionFigure->setText(foundAndLimit(check));
  ui.bar->setFigure(*check.figure, *check.limit, check.state == sessions::CheckState::kPassed);
  return row;
}

}  // namespace

PrecisionBars::PrecisionBars(QWidget* parent) : QWidget(parent), rows_(new QVBoxLayout(this)) {
  rows_->setContentsMargins(0, kBlockGap, 0, kBlockGap);
  rows_->setSpacing(kBlockGap);
  hide();
}

void PrecisionBars::setChecks(const std::vector<sessions::Check>& checks) {
  std::vector<sessions::Check> shown;
  for (const sessions::Check& check : checks)
    if (isPrecision(check)) shown.push_back(check);
  if (std::exchange(shown_, shown) != shown_) {
    clearLayout(*rows_);
    for (const sessions::Check& check : shown_) rows_->addWidget(precisionRow(check));
  }
  setVisible(!shown_.empty());
}

}  // namespace boresight::ui
