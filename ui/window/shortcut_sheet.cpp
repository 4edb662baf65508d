// SPDX-License-Identifier: Apache-2.0
#include "ui/window/shortcut_sheet.h"

#include <array>

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

struct Fixed {
  const char* keys;
  const char* text;
};

/// Keys that are no actions of a menu: those of the image, the scene, tables and the field for
/// nudging, each where the pointer or the focus is.
constexpr std::array<Fixed, 33> kFixed = {{
    {QT_TR_NOOP("Esc"), QT_TR_NOOP("Stop all jobs")},
    {QT_TR_NOOP("Image: wheel"), QT_TR_NOOP("Zoom at the cursor")},
    {QT_TR_NOOP("Image: drag"), QT_TR_NOOP("Move the image")},
    {QT_TR_NOOP("Image: double click, 0"), QT_TR_NOOP("Show the whole image")},
    {QT_TR_NOOP("Image: 1"), QT_TR_NOOP("One image pixel on one screen pixel")},
    {QT_TR_NOOP("Image: +, -, arrows"), QT_TR_NOOP("Zoom and move")},
    {QT_TR_NOOP("Image: click"), QT_TR_NOOP("Select a template")},
    {QT_TR_NOOP("Mask tool: middle drag"), QT_TR_NOOP("Move the image")},
    {QT_TR_NOOP("Mask tool: Enter, Backspace"),
     QT_TR_NOOP("Close a polygon of the mask, drop its last corner")},
    {QT_TR_NOOP("Mask tool: Escape"), QT_TR_NOOP("Discard the polygon; leave the mask tool")},
    {QT_TR_NOOP("Scene: drag"), QT_TR_NOOP("Turn; with Shift or the middle button move")},
    {QT_TR_NOOP("Scene: right drag, wheel"), QT_TR_NOOP("Nearer and farther")},
    {QT_TR_NOOP("Scene: click"), QT_TR_NOOP("Select a template, or read a point of the mesh")},
    {QT_TR_NOOP("Scene: Home, double click"), QT_TR_NOOP("Show the whole scene")},
    {QT_TR_NOOP("Scene: 1 to 7"), QT_TR_NOOP("Look from a fixed direction")},
    {QT_TR_NOOP("Scene: V"), QT_TR_NOOP("Look through the camera")},
    {QT_TR_NOOP("Scene: +, -, arrows"), QT_TR_NOOP("Zoom and turn")},
    {QT_TR_NOOP("Scene, annotating: click"), QT_TR_NOOP("Annotate a point, in line mode an edge")},
    {QT_TR_NOOP("Scene, annotating: Tab, Alt held"), QT_TR_NOOP("Next snap target; surface only")},
    {QT_TR_NOOP("Scene, annotating: Ctrl+wheel"), QT_TR_NOOP("Magnification of the loupe")},
    {QT_TR_NOOP("Scene, annotating: Escape, Del"),
     QT_TR_NOOP("Clear the selection, then the mode; remove the annotation")},
    {QT_TR_NOOP("Nudging: arrows"), QT_TR_NOOP("Move right, left, up, down")},
    {QT_TR_NOOP("Nudging: Page Up, Page Down"), QT_TR_NOOP("Move away, nearer")},
    {QT_TR_NOOP("Nudging: with Ctrl"), QT_TR_NOOP("Turn instead of moving")},
    {QT_TR_NOOP("Nudging: with Shift, Alt"), QT_TR_NOOP("Ten times, a tenth of the step")},
    {QT_TR_NOOP("Queue: Enter"), QT_TR_NOOP("Show the case at the iteration that failed")},
    {QT_TR_NOOP("Queue: A, R"), QT_TR_NOOP("Validate or reject the result; next case")},
    {QT_TR_NOOP("Queue: J, K, arrows"), QT_TR_NOOP("Next case, previous case")},
    {QT_TR_NOOP("Queue: D"), QT_TR_NOOP("Compare each case's last two runs")},
    {QT_TR_NOOP("Inputs: Ctrl+C"), QT_TR_NOOP("Copy the selected lines")},
    {QT_TR_NOOP("Manual: Alt+Left, Alt+Right"), QT_TR_NOOP("Previous page, next page")},
    {QT_TR_NOOP("Configuration: F2"), QT_TR_NOOP("Change the option")},
    {QT_TR_NOOP("Configuration: Del"), QT_TR_NOOP("Restore the option's default")},
}};

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
  for (const Fixed& each : kFixed)
    rows.push_back({ShortcutSheet::tr(each.keys), ShortcutSheet::tr(each.text)});
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
