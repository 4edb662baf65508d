// SPDX-License-Identifier: Apache-2.0
#include "ui/window/shortcut_sheet.h"

#include <array>

#include <QAction>
#include <QDialogButtonBox>
#include <QGridLayout>
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QScrollArea>
#include <QVBoxLayout>

#include "ui/views/layer.h"

namespace boresight::ui {
namespace {

struct Row {
  QString keys;
  QString text;
};

QString plainText(const QAction& action) {
  QString text = action.text();
  text.remove(QLatin1Char('&'));
  return text;
}

/// Actions of the menus, in their order.
void collect(const QList<QAction*>& actions, QList<Row>& rows) {
  for (const QAction* action : actions) {
    if (action->menu()) {
      collect(action->menu()->actions(), rows);
    } else if (!action->shortcut().isEmpty()) {
      rows.push_back({action->shortcut().toString(QKeySequence::NativeText), plainText(*action)});
    }
  }
}

QList<Row> viewRows() {
  const std::array<const char*, 7> keys = {
      "Wheel", "Drag", "Double click, 0", "1", "+, -, arrows", "Enter, Backspace", "Escape"};
  const std::array<const char*, 7> texts = {"Zoom at the cursor",
                                            "Move the image (with a mask tool: the middle button)",
                                            "Show the whole image",
                                            "One image pixel on one screen pixel",
                                            "Zoom and move by keys",
                                            "Close a polygon of the mask, drop its last corner",
                                            "Drop the polygon; leave the mask tool"};
  QList<Row> rows;
  for (std::size_t i = 0; i < keys.size(); ++i)
    rows.push_back({QObject::tr(keys[i]), QObject::tr(texts[i])});
  return rows;
}

}  // namespace

ShortcutSheet::ShortcutSheet(QWidget& window) : QDialog(&window) {
  setWindowTitle(tr("Keys"));
  QList<Row> rows;
  if (auto* bar = window.findChild<QMenuBar*>()) collect(bar->actions(), rows);
  rows += viewRows();
  auto* sheet = new QWidget;
  auto* grid = new QGridLayout(sheet);
  grid->setHorizontalSpacing(16);
  const int half = (static_cast<int>(rows.size()) + 1) / 2;
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    auto* key = new QLabel(QStringLiteral("<b>%1</b>").arg(rows[i].keys.toHtmlEscaped()));
    const int column = i < half ? 0 : 2;
    grid->addWidget(key, i % half, column);
    grid->addWidget(new QLabel(rows[i].text), i % half, column + 1);
  }
  auto* scroll = new QScrollArea;
  scroll->setWidget(sheet);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(scroll);
  layout->addWidget(buttons);
  resize(760, 520);
}

}  // namespace boresight::ui
