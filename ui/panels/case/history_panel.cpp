// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/history_panel.h"

#include <algorithm>

#include <QtWidgets>

#include "ui/state/document.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

HistoryPanel::HistoryPanel(Document& document) : document_(document) {
  ui_.setupUi(this);
  connect(&document_, &Document::opened, this, &HistoryPanel::fillAgain);
  connect(&document_, &Document::changed, this, &HistoryPanel::fill);
  connect(ui_.history, &QListWidget::currentRowChanged, this, [this](int row) {
    if (!filling_ && row >= 0) document_.goToEdit(static_cast<std::size_t>(row));
  });
  fillAgain();
}

void HistoryPanel::fillAgain() {
  filling_ = true;
  ui_.history->clear();
  ui_.history->addItem(document_.isOpen() ? tr("Session as opened") : tr("No session is open"));
  done_ = 0;
  fill();
}

/// Edits that were in effect and still are have their items: in a long session there are many.
void HistoryPanel::fill() {
  filling_ = true;
  QListWidget& list = *ui_.history;
  const auto count = static_cast<int>(document_.editCount());
  const auto done = static_cast<int>(document_.editsDone());
  while (list.count() > count + 1) delete list.takeItem(list.count() - 1);
  for (int i = std::min(static_cast<int>(done_), done); i < count; ++i) {
    if (i + 1 == list.count()) list.addItem(QString());
    QListWidgetItem& item = *list.item(i + 1);
    item.setText(document_.editText(static_cast<std::size_t>(i)));
    const bool undone = i >= done;
    item.setForeground(undone ? palette().brush(QPalette::Disabled, QPalette::Text) : QBrush());
  }
  done_ = static_cast<std::size_t>(done);
  list.setCurrentRow(document_.isOpen() ? done : -1);
  if (list.currentItem()) list.scrollToItem(list.currentItem());
  filling_ = false;
}

}  // namespace boresight::ui
