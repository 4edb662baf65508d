// SPDX-License-Identifier: Apache-2.0
#include "ui/window/shortcut_sheet.h"

#include <utility>

#include <QtWidgets>

#include "ui/models/text.h"

namespace boresight::ui {
namespace {

/// Actions of the menus, in their order.
void collect(const QList<QAction*>& actions, QList<KeyRow>& rows) {
  for (const QAction* action : actions) {
    if (action->menu()) {
      collect(action->menu()->actions(), rows);
    } else if (!action->shortcut().isEmpty()) {
      rows.push_back({action->shortcut().toString(QKeySequence::NativeText),
                      action->text().remove(QLatin1Char('&'))});
    }
  }
}

/// Keys that are no actions of a menu: those of the image, the scene, tables and the field for
/// nudging, each where the pointer or the focus is.
struct FixedKey {
  const char* keys;
  const char* text;
};
constexpr FixedKey kFixed[] = {
    {"Esc", "Stop all jobs"},
    {"Image: wheel", "Zoom at the cursor"},
    {"Image: drag", "Move the image"},
    {"Image: double click, 0", "Show the whole image"},
    {"Image: 1", "One image pixel on one screen pixel"},
    {"Image: +, -, arrows", "Zoom and move"},
    {"Image: click", "Select a template"},
    {"Mask tool: middle drag", "Move the image"},
    {"Mask tool: Enter, Backspace", "Close a polygon of the mask, drop its last corner"},
    {"Mask tool: Escape", "Discard the polygon; leave the mask tool"},
    {"Scene: drag", "Turn; with Shift or the middle button move"},
    {"Scene: right drag, wheel", "Nearer and farther"},
    {"Scene: click", "Select a template, or read a point of the mesh"},
    {"Scene: Home, double click", "Show the whole scene"},
    {"Scene: 1 to 7", "Look from a fixed direction"},
    {"Scene: V", "Look through the camera"},
    {"Scene: +, -, arrows", "Zoom and turn"},
    {"Scene, annotating: click", "Annotate a point, in line mode an edge"},
    {"Scene, annotating: Tab, Alt held", "Next snap target; surface only"},
    {"Scene, annotating: Ctrl+wheel", "Magnification of the loupe"},
    {"Scene, annotating: Escape, Del", "Clear the selection, then the mode; remove the annotation"},
    {"Nudging: arrows", "Move right, left, up, down"},
    {"Nudging: Page Up, Page Down", "Move away, nearer"},
    {"Nudging: with Ctrl", "Turn instead of moving"},
    {"Nudging: with Shift, Alt", "Ten times, a tenth of the step"},
    {"Queue: Enter", "Show the case at the iteration that failed"},
    {"Queue: A, R", "Validate or reject the result; next case"},
    {"Queue: J, K, arrows", "Next case, previous case"},
    {"Queue: D", "Compare each case's last two runs"},
    {"Inputs: Ctrl+C", "Copy the selected lines"},
    {"Manual: Alt+Left, Alt+Right", "Previous page, next page"},
    {"Configuration: F2", "Change the option"},
    {"Configuration: Del", "Restore the option's default"},
};

/// Some of the keys, as HTML.
QString keysHtml(const QList<KeyRow>& keys) {
  QVector<QStringList> rows;
  for (const KeyRow& each : keys)
    rows.append(
        {QStringLiteral("<b>%1</b>").arg(each.keys.toHtmlEscaped()), each.text.toHtmlEscaped()});
  return htmlTable(rows);
}

}  // namespace

QList<KeyRow> keysOf(const QWidget& window) {
  QList<KeyRow> rows;
  if (auto* bar = window.findChild<QMenuBar*>()) collect(bar->actions(), rows);
  for (const auto& [keys, text] : kFixed)
    rows.push_back({ShortcutSheet::tr(keys), ShortcutSheet::tr(text)});
  return rows;
}

ShortcutSheet::ShortcutSheet(QWidget& window) : QDialog(&window) {
  ui_.setupUi(this);
  const QList<KeyRow> keys = keysOf(window);
  const int half = (keys.size() + 1) / 2;
  ui_.firstKeys->setText(keysHtml(keys.mid(0, half)));
  ui_.furtherKeys->setText(keysHtml(keys.mid(half)));
  connect(ui_.buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  QPushButton* manual = ui_.buttons->addButton(tr("&Manual"), QDialogButtonBox::HelpRole);
  manual->setShortcut(Qt::Key_F1);
  manual->setToolTip(tr("User manual, task by task (F1)"));
  connect(manual, &QPushButton::clicked, this, [this] {
    accept();
    Q_EMIT manualRequested();
  });
  // As wide as its text, so that nothing is cut off.
  const int bar = style()->pixelMetric(QStyle::PM_ScrollBarExtent);
  resize(ui_.sheet->sizeHint().width() + bar + 40, 620);
}

}  // namespace boresight::ui
