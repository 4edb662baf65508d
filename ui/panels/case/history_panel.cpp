// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/history_panel.h"

#include <QtWidgets>

#include "ui/state/document.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

HistoryPanel::HistoryPanel(Document& document) : document_(document) {
  ui_.setupUi(this);
  connectEach(document_, this, &HistoryPanel::fill, &Document::opened, &Document::changed);
  connect(ui_.history, &QListWidget::currentRowChanged, this, [this](int row) {
    if (!filling_ && row >= 0) document_.goToEdit(static_cast<std::size_t>(row));
  });
  fill();
}

void HistoryPanel::fill() {
  filling_ = true;
  ui_.history->clear();
  const QStringList texts = document_.editTexts();
  const auto done = static_cast<int>(document_.editsDone());
  ui_.history->addItem(document_.isOpen() ? tr("Session as opened") : tr("No session is open"));
  for (int i = 0; i < texts.size(); ++i) {
    ui_.history->addItem(texts[i]);
    if (i >= done)
      ui_.history->item(i + 1)->setForeground(palette().color(QPalette::Disabled, QPalette::Text));
  }
  ui_.history->setCurrentRow(document_.isOpen() ? done : -1);
  if (ui_.history->currentItem()) ui_.history->scrollToItem(ui_.history->currentItem());
  filling_ = false;
}

}  // namespace boresight::ui
