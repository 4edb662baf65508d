// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/input_sheet_panel.h"

#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QTableWidget>
#include <QVBoxLayout>

#include "ui/models/number_text.h"
#include "ui/panels/table_style.h"

namespace boresight::ui {

InputSheetPanel::InputSheetPanel(QWidget* parent) : QWidget(parent) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  flags_ = new QLabel(this);
  flags_->setObjectName(QStringLiteral("flags"));
  flags_->setWordWrap(true);
  flags_->setTextFormat(Qt::PlainText);
  flags_->setMargin(6);
  flags_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  column->addWidget(flags_);
  table_ = new QTableWidget(0, 2, this);
  table_->setObjectName(QStringLiteral("sheet"));
  table_->setAccessibleName(tr("Inputs"));
  styleTable(*table_);
  table_->setWordWrap(true);
  table_->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  table_->setHorizontalHeaderLabels({tr("Input"), tr("Value")});
  table_->horizontalHeader()->setStretchLastSection(true);
  column->addWidget(table_, 1);
  auto* copy = new QAction(tr("Copy"), table_);
  copy->setShortcut(QKeySequence::Copy);
  copy->setShortcutContext(Qt::WidgetShortcut);
  table_->addAction(copy);
  table_->setContextMenuPolicy(Qt::ActionsContextMenu);
  connect(copy, &QAction::triggered, this, &InputSheetPanel::copyChosen);
  sigmas_ = new QPushButton(tr("How well mesh and camera are known ..."), this);
  sigmas_->setObjectName(QStringLiteral("inputSigmas"));
  connect(sigmas_, &QPushButton::clicked, this, &InputSheetPanel::sigmasRequested);
  column->addWidget(sigmas_);
  setSheet(std::nullopt);
}

void InputSheetPanel::showFlags(const std::vector<sessions::RedFlag>& flags) {
  QStringList sentences;
  for (const sessions::RedFlag& flag : flags)
    sentences.append(QStringLiteral("⚠ ") + fromText(flag.text));
  flags_->setText(flags.empty() ? tr("✓ Nothing looks wrong with the inputs.")
                                : sentences.join(QLatin1Char('\n')));
  QFont font = this->font();
  font.setBold(!flags.empty());
  flags_->setFont(font);
}

void InputSheetPanel::setSheet(const std::optional<sessions::InputSheet>& sheet) {
  sigmas_->setEnabled(sheet.has_value());
  if (!sheet) {
    flags_->setText(tr("No case is open."));
    table_->setRowCount(0);
    return;
  }
  showFlags(sheet->flags);
  table_->setRowCount(static_cast<int>(sheet->lines.size()));
  for (int row = 0; row < table_->rowCount(); ++row) {
    const sessions::SheetLine& line = sheet->lines[static_cast<std::size_t>(row)];
    table_->setItem(row, 0, new QTableWidgetItem(fromText(line.label)));
    auto* value = new QTableWidgetItem(fromText(line.value));
    value->setToolTip(fromText(line.value));  // it may be longer than the panel is wide
    table_->setItem(row, 1, value);
  }
  table_->resizeColumnToContents(0);
}

QString InputSheetPanel::text() const {
  QString text = flags_->text() + QLatin1Char('\n');
  for (int row = 0; row < table_->rowCount(); ++row)
    text += table_->item(row, 0)->text() + QStringLiteral(": ") + table_->item(row, 1)->text() +
            QLatin1Char('\n');
  return text;
}

void InputSheetPanel::copyChosen() const {
  QString text;
  const QModelIndexList rows = table_->selectionModel()->selectedRows();
  for (const QModelIndex& row : rows)
    text += row.data().toString() + QLatin1Char('\t') + row.siblingAtColumn(1).data().toString() +
            QLatin1Char('\n');
  QApplication::clipboard()->setText(text);
}

}  // namespace boresight::ui
