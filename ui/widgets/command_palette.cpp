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

CommandPalette::CommandPalette(QMenuBar& menus, QWidget* parent)
    : QDialog(parent), line_(new QLineEdit), list_(new QListWidget) {
  setWindowTitle(tr("Find a command"));
  resize(kWidth, kHeight);
  auto* column = new QVBoxLayout(this);
  column->addWidget(line_);
  column->addWidget(list_, 1);
  line_->setObjectName(QStringLiteral("commandLine"));
  list_->setObjectName(QStringLiteral("commands"));
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  line_->setPlaceholderText(tr("Parts of a name, such as \"step iter\""));
  line_->setClearButtonEnabled(true);
  line_->installEventFilter(this);
  for (QAction* action : menus.actions())
    if (const QMenu* menu = action->menu()) collect(*menu, plain(menu->title()));
  connect(line_, &QLineEdit::textChanged, this, &CommandPalette::filter);
  connect(line_, &QLineEdit::returnPressed, this, &CommandPalette::run);
  connect(list_, &QListWidget::itemActivated, this, &CommandPalette::run);
  filter({});
}

void CommandPalette::collect(const QMenu& menu, const QString& path) {
  for (QAction* action : menu.actions()) {
    const QString name = path + QStringLiteral(" > ") + plain(action->text());
    if (const QMenu* inner = action->menu())
      collect(*inner, path + QStringLiteral(" > ") + plain(inner->title()));
    else if (!action->isSeparator() && !action->text().isEmpty() && action->isVisible())
      commands_.push_back({name, action});
  }
}

QStringList CommandPalette::names() const {
  QStringList result;
  for (int i = 0; i < list_->count(); ++i)
    result << commands_[static_cast<std::size_t>(list_->item(i)->data(kCommand).toInt())].name;
  return result;
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
  list_->clear();
  for (const auto& [rank, index] : found) {
    const Command& command = commands_[index];
    const QString keys = command.action->shortcut().toString(QKeySequence::NativeText);
    auto* item = new QListWidgetItem(
        command.action->icon(),
        keys.isEmpty() ? command.name : QStringLiteral("%1    (%2)").arg(command.name, keys),
        list_);
    item->setData(kCommand, static_cast<int>(index));
    item->setToolTip(command.action->toolTip());
    if (!command.action->isEnabled()) item->setFlags(item->flags() & ~Qt::ItemIsEnabled);
  }
  for (int i = 0; i < list_->count() && list_->currentRow() < 0; ++i)
    if ((list_->item(i)->flags() & Qt::ItemIsEnabled) != 0) list_->setCurrentRow(i);
}

/// After the dialog is gone: what the action opens has the focus then.
void CommandPalette::run() {
  const QListWidgetItem* item = list_->currentItem();
  if (!item) return;
  const QPointer<QAction> action =
      commands_[static_cast<std::size_t>(item->data(kCommand).toInt())].action;
  accept();
  if (action && action->isEnabled())
    QMetaObject::invokeMethod(action, &QAction::trigger, Qt::QueuedConnection);
}

/// Arrows move in the list while the line has the focus.
bool CommandPalette::eventFilter(QObject* watched, QEvent* event) {
  if (watched == line_ && event->type() == QEvent::KeyPress) {
    const int key = static_cast<QKeyEvent*>(event)->key();
    if (key == Qt::Key_Up || key == Qt::Key_Down || key == Qt::Key_PageUp ||
        key == Qt::Key_PageDown)
      return QCoreApplication::sendEvent(list_, event);
  }
  return QDialog::eventFilter(watched, event);
}

}  // namespace boresight::ui
