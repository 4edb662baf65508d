// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/history_panel.h"

#include <QtWidgets>

#include "ui/state/document.h"

namespace boresight::ui {

HistoryPanel::HistoryPanel(Document& document, QWidget* parent)
    : QWidget(parent), document_(document), list_(new QListWidget) {
  auto* column = new QVBoxLayout(this);
  column->addWidget(list_);
  list_->setObjectName(QStringLiteral("history"));
  list_->setFrameShape(QFrame::NoFrame);
  connect(&document_, &Document::opened, this, &HistoryPanel::fill);
  connect(&document_, &Document::changed, this, &HistoryPanel::fill);
  connect(list_, &QListWidget::currentRowChanged, this, [this](int row) {
    if (!filling_ && row >= 0) document_.goToEdit(static_cast<std::size_t>(row));
  });
  fill();
}

void HistoryPanel::fill() {
  filling_ = true;
  list_->clear();
  const QStringList texts = document_.editTexts();
  const auto done = static_cast<int>(document_.editsDone());
  list_->addItem(document_.isOpen() ? tr("Session as opened") : tr("No session is open"));
  for (int i = 0; i < texts.size(); ++i) {
    list_->addItem(texts[i]);
    if (i >= done)
      list_->item(i + 1)->setForeground(palette().color(QPalette::Disabled, QPalette::Text));
  }
  list_->setCurrentRow(document_.isOpen() ? done : -1);
  if (list_->currentItem()) list_->scrollToItem(list_->currentItem());
  filling_ = false;
}

}  // namespace boresight::ui
