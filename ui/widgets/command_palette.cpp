// SPDX-License-Identifier: Apache-2.0
#include "ui/widgets/command_palette.h"

#include <algorithm>

#include <QtWidgets>

namespace boresight::ui {
namespace {

constexpr int kWidth = 560;
constexpr int kHeight = 420;
constexpr int kCommand = Qt::UserRole;

QString plain(QString text) { return text.remove(QLatin1Char('&')); }

/// Lower is better; -1 when a word is not in the name. A word at the beginning of a word of the
/// action itself counts most.
int rankOf(const QString& name, const QStringList& words) {
  int rank = 0;
  const QString own = name.section(QStringLiteral(" > "), -1);
  for (const QString& word : words) {
    if (own.startsWith(word, Qt::CaseInsensitive)) continue;
    if (own.contains(QLatin1Char(' ') + word, Qt::CaseInsensitive))
      rank += 1;
    else if (own.contains(word, Qt::CaseInsensitive))
      rank += 2;
    else if (name.contains(word, Qt::CaseInsensitive))
      rank += 3;
    else
      return -1;
  }
  return rank;
}

}  // namespace

CommandPalette::CommandPalette(QMenuBar& menus, QWidget* parent) : QDialog(parent) {
  ui_.setupUi(this);
  resize(kWidth, kHeight);
  ui_.commandLine->installEventFilter(this);
  for (QAction* action : menus.actions())
    if (const QMenu* menu = action->menu()) collect(*menu, plain(menu->title()));
  connect(ui_.commandLine, &QLineEdit::textChanged, this, &CommandPalette::filter);
  connect(ui_.commandLine, &QLineEdit::returnPressed, this, &CommandPalette::run);
  connect(ui_.commands, &QListWidget::itemActivated, this, &CommandPalette::run);
  filter({});
}

void CommandPalette::collect(const QMenu& menu, const QString& path) {
  for (QAction* action : menu.actions()) {
    const QString name = path + QStringLiteral(" > ") + plain(action->text());
    if (const QMenu* inner = action->menu())
      collect(*inner, name);
    else if (!action->isSeparator() && !action->text().isEmpty() && action->isVisible())
      commands_.push_back({name, action});
  }
}

void CommandPalette::filter(const QString& text) {
  const QStringList words = text.split(QLatin1Char(' '), Qt::SkipEmptyParts);
  std::vector<std::pair<int, std::size_t>> found;
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    const int rank = rankOf(commands_[i].name, words);
    if (rank >= 0 && commands_[i].action) found.emplace_back(rank, i);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  ui_.commands->clear();
  for (const auto& [rank, index] : found) {
    const Command& command = commands_[index];
    const QString keys = command.action->shortcut().toString(QKeySequence::NativeText);
    auto* item = new QListWidgetItem(
        command.action->icon(),
        keys.isEmpty() ? command.name : QStringLiteral("%1    (%2)").arg(command.name, keys),
        ui_.commands);
    item->setData(kCommand, static_cast<int>(index));
    item->setToolTip(command.action->toolTip());
    if (!command.action->isEnabled()) item->setFlags(item->flags() & ~Qt::ItemIsEnabled);
  }
  for (int i = 0; i < ui_.commands->count() && ui_.commands->currentRow() < 0; ++i)
    if ((ui_.commands->item(i)->flags() & Qt::ItemIsEnabled) != 0) ui_.commands->setCurrentRow(i);
}

/// After the dialog is gone: what the action opens has the focus then.
void CommandPalette::run() {
  const QListWidgetItem* item = ui_.commands->currentItem();
  if (!item) return;
  const QPointer<QAction> action =
      commands_[static_cast<std::size_t>(item->data(kCommand).toInt())].action;
  accept();
  if (action && action->isEnabled())
    QMetaObject::invokeMethod(action, &QAction::trigger, Qt::QueuedConnection);
}

/// Arrows move in the list while the line has the focus.
bool CommandPalette::eventFilter(QObject* watched, QEvent* event) {
  if (watched == ui_.commandLine && event->type() == QEvent::KeyPress) {
    const int key = static_cast<QKeyEvent*>(event)->key();
    if (key == Qt::Key_Up || key == Qt::Key_Down || key == Qt::Key_PageUp ||
        key == Qt::Key_PageDown)
      return QCoreApplication::sendEvent(ui_.commands, event);
  }
  return QDialog::eventFilter(watched, event);
}

}  // namespace boresight::ui
