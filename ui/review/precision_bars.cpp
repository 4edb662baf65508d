// SPDX-License-Identifier: Apache-2.0
#include "ui/review/precision_bars.h"

#include <utility>

#include <QHBoxLayout>
#include <QLabel>
#include <QVBoxLayout>

#include "ui/models/text.h"
#include "ui/review/check_cards.h"
#include "ui/style/tokens.h"
#include "ui/widgets/limit_bar.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

bool isPrecision(const sessions::Check& check) {
  return check.id.starts_with("covariance_") && check.figure && check.limit;
}

QWidget* precisionRow(const sessions::Check& check) {
  auto* row = new QWidget;
  row->setToolTip(fromText(check.sentence));
  auto* bar = new LimitBar;
  bar->setFixedHeight(bar->sizeHint().height());
  bar->setFigure(*check.figure, *check.limit, check.state == sessions::CheckState::kPassed);
  auto* head = new QHBoxLayout;
  head->setSpacing(kBlockGap);
  head->addWidget(new QLabel(fromText(check.title)), 1);
  head->addWidget(named(new QLabel(foundAndLimit(check)), "precisionFigure"));
  auto* column = new QVBoxLayout(row);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(kBlockGap / 2);
  column->addLayout(head);
  column->addWidget(bar);
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
    while (QLayoutItem* item = rows_->takeAt(0)) {
      delete item->widget();
      delete item;
    }
    for (const sessions::Check& check : shown_) rows_->addWidget(precisionRow(check));
  }
  setVisible(!shown_.empty());
}

}  // namespace boresight::ui
