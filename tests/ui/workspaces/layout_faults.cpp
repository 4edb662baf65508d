// SPDX-License-Identifier: Apache-2.0
#include "tests/ui/workspaces/layout_faults.h"

#include <algorithm>
#include <vector>

#include <QtWidgets>

namespace boresight::test {
namespace {

/// QMainWindow moves such docks out of sight, where Qt still counts them as visible.
bool isBehindATab(const QWidget& widget) {
  for (const QWidget* each = &widget; each; each = each->parentWidget())
    if (const auto* dock = qobject_cast<const QDockWidget*>(each))
      return dock->geometry().right() < 0 || dock->geometry().bottom() < 0;
  return false;
}

bool isShown(const QWidget& widget) { return widget.isVisible() && !isBehindATab(widget); }

bool scrolls(const QWidget& widget) {
  const auto* area = qobject_cast<const QAbstractScrollArea*>(widget.parentWidget());
  return area && area->viewport() == &widget;
}

/// "QLabel count < AnnotationPanel < annotation".
QString pathOf(const QWidget& widget) {
  QStringList names;
  const QWidget* each = &widget;
  for (; each && names.size() < 4; each = each->parentWidget()) {
    QString name =
        QString::fromLatin1(each->metaObject()->className()).section(QStringLiteral("::"), -1);
    if (!each->objectName().isEmpty()) name += QLatin1Char(' ') + each->objectName();
    names << name;
    if (qobject_cast<const QDockWidget*>(each)) break;
  }
  return names.join(QStringLiteral(" < "));
}

QString textOf(const QRect& rect) {
  return QStringLiteral("%1 x %2 at %3, %4")
      .arg(rect.width())
      .arg(rect.height())
      .arg(rect.x())
      .arg(rect.y());
}

QString withoutMnemonic(QString text) {
  return text.replace(QLatin1String("&&"), QLatin1String("\1"))
      .remove(QLatin1Char('&'))
      .replace(QLatin1Char('\1'), QLatin1Char('&'));
}

int widthOf(const QFontMetrics& metrics, const QString& text) {
  int width = 0;
  for (const QString& line : text.split(QLatin1Char('\n')))
    width = std::max(width, metrics.horizontalAdvance(line));
  return width;
}

bool beginsAsNumber(const QString& text) {
  static const QRegularExpression kNumber(QStringLiteral("^[-+−±≤≥<>~] ?\\d|^\\d"));
  return kNumber.match(text).hasMatch();
}

class Inspector {
 public:
  explicit Inspector(QWidget& window) : window_(window) {}

  QStringList look() {
    inspect(window_);
    for (QWidget* each : window_.findChildren<QWidget*>())
      if (each->window() == &window_ && isShown(*each)) inspect(*each);
    return faults_;
  }

 private:
  void add(const QWidget& widget, const QString& what) {
    faults_ << QStringLiteral("%1: %2").arg(pathOf(widget), what);
  }

  /// A text that needs some pixels more than it has.
  void require(const QWidget& widget, const QString& text, int needed, int room) {
    if (needed > room)
      add(widget, QStringLiteral("'%1' needs %2 px of %3").arg(text).arg(needed).arg(room));
  }

  void inspect(QWidget& widget) {
    if (&widget != &window_) inspectPlace(widget);
    if (const QLayout* layout = widget.layout()) {
      inspectSize(widget, *layout);
      inspectOverlaps(widget, *layout);
    }
    inspectText(widget);
  }

  void inspectPlace(const QWidget& widget) {
    const QWidget& parent = *widget.parentWidget();
    // Qt widens the handles of docks and splitters by a pixel or two to be caught.
    const bool handle = qobject_cast<const QSplitterHandle*>(&widget) ||
                        widget.objectName() == QLatin1String("qt_qmainwindow_extended_splitter");
    if (handle || scrolls(parent) || parent.rect().contains(widget.geometry())) return;
    add(widget, QStringLiteral("%1 is outside of %2")
                    .arg(textOf(widget.geometry()), textOf(parent.rect())));
  }

  void inspectSize(const QWidget& widget, const QLayout& layout) {
    // A scroll bar has no text to cut: it may be shorter than its style asks for.
    if (widget.objectName().startsWith(QLatin1String("qt_scrollarea_"))) return;
    const QSize least = layout.totalMinimumSize();
    if (layout.sizeConstraint() == QLayout::SetNoConstraint) return;
    if (widget.width() < least.width() || widget.height() < least.height())
      add(widget, QStringLiteral("%1 is less than its contents: %2")
                      .arg(textOf(widget.geometry()), textOf({{}, least})));
  }

  static std::vector<std::pair<QString, QRect>> itemsOf(const QLayout& layout) {
    std::vector<std::pair<QString, QRect>> items;
    for (int i = 0; i < layout.count(); ++i) {
      QLayoutItem* item = layout.itemAt(i);
      if (item->isEmpty() || item->spacerItem()) continue;
      const QWidget* widget = item->widget();
      if (widget && !isShown(*widget)) continue;
      items.emplace_back(widget ? pathOf(*widget) : QStringLiteral("a layout"),
                         widget ? widget->geometry() : item->geometry());
    }
    return items;
  }

  void inspectOverlaps(const QWidget& widget, const QLayout& layout) {
    const auto items = itemsOf(layout);
    for (const auto& [name, rect] : items)
      for (const auto& [other_name, other] : items)
        if (&rect < &other && rect.intersects(other))
          add(widget, QStringLiteral("%1 (%2) overlaps %3 (%4)")
                          .arg(name, textOf(rect), other_name, textOf(other)));
    for (int i = 0; i < layout.count(); ++i)
      if (const QLayout* inner = layout.itemAt(i)->layout()) inspectOverlaps(widget, *inner);
  }

  void inspectText(const QWidget& widget) {
    if (const auto* label = qobject_cast<const QLabel*>(&widget)) return inspectLabel(*label);
    if (const auto* button = qobject_cast<const QAbstractButton*>(&widget))
      return inspectButton(*button);
    if (const auto* field = qobject_cast<const QLineEdit*>(&widget)) return inspectField(*field);
    if (const auto* box = qobject_cast<const QComboBox*>(&widget)) return inspectComboBox(*box);
    if (const auto* tabs = qobject_cast<const QTabBar*>(&widget)) return inspectTabs(*tabs);
    if (const auto* head = qobject_cast<const QHeaderView*>(&widget)) return inspectHead(*head);
    if (const auto* view = qobject_cast<const QTableView*>(&widget)) return inspectCells(*view);
    if (const auto* dock = qobject_cast<const QDockWidget*>(&widget)) return inspectTitle(*dock);
    if (const auto* group = qobject_cast<const QGroupBox*>(&widget))
      require(widget, group->title(), widthOf(group->fontMetrics(), group->title()),
              group->width() - 16);
  }

  void inspectLabel(const QLabel& label) {
    if (label.text().isEmpty()) return;
    if (label.wordWrap()) {
      const int needed = label.heightForWidth(label.width());
      if (needed > label.height() && label.minimumSizeHint().height() > 0)
        add(label, QStringLiteral("'%1' is %2 px high, of %3")
                       .arg(label.text().left(60))
                       .arg(label.height())
                       .arg(needed));
      return;
    }
    require(label, label.text(), label.sizeHint().width(), label.width());
    if (label.sizeHint().height() > label.height())
      add(label, QStringLiteral("'%1' is too low").arg(label.text().left(60)));
  }

  void inspectButton(const QAbstractButton& button) {
    const QString text = withoutMnemonic(button.text());
    const auto* tool = qobject_cast<const QToolButton*>(&button);
    if (text.isEmpty() || (tool && tool->toolButtonStyle() == Qt::ToolButtonIconOnly &&
                           !(tool->icon().isNull() && tool->arrowType() == Qt::NoArrow)))
      return;
    if (const auto* push = qobject_cast<const QPushButton*>(&button))
      return inspectPushButton(*push, text);
    // Tool buttons ask for a blank at each side of their text.
    const int slack = tool ? 2 * button.fontMetrics().horizontalAdvance(QLatin1Char(' ')) : 0;
    require(button, text, button.sizeHint().width() - slack, button.width());
  }

  void inspectPushButton(const QPushButton& button, const QString& text) {
    QStyleOptionButton option;
    option.initFrom(&button);
    option.text = button.text();
    option.icon = button.icon();
    const QRect contents =
        button.style()->subElementRect(QStyle::SE_PushButtonContents, &option, &button);
    const int icon = button.icon().isNull() ? 0 : button.iconSize().width() + 4;
    require(button, text, icon + widthOf(button.fontMetrics(), text), contents.width());
    if (button.fontMetrics().height() > contents.height() + 4)
      add(button, QStringLiteral("'%1' is too low").arg(text));
  }

  /// What a person typed may be long; what the program says must be seen.
  void inspectField(const QLineEdit& field) {
    const auto* box = qobject_cast<const QAbstractSpinBox*>(field.parentWidget());
    const QString text = field.text().isEmpty()      ? field.placeholderText()
                         : box || field.isReadOnly() ? field.text()
                                                     : QString();
    QStyleOptionFrame option;
    option.initFrom(&field);
    option.lineWidth =
        field.hasFrame() ? field.style()->pixelMetric(QStyle::PM_DefaultFrameWidth) : 0;
    const QRect contents =
        field.style()->subElementRect(QStyle::SE_LineEditContents, &option, &field);
    require(field, text, widthOf(field.fontMetrics(), text), contents.width() - 4);
  }

  void inspectComboBox(const QComboBox& box) {
    if (box.isEditable()) return;
    QStyleOptionComboBox option;
    option.initFrom(&box);
    const QRect room = box.style()->subControlRect(QStyle::CC_ComboBox, &option,
                                                   QStyle::SC_ComboBoxEditField, &box);
    require(box, box.currentText(), widthOf(box.fontMetrics(), box.currentText()), room.width());
  }

  void inspectTabs(const QTabBar& tabs) {
    for (int i = 0; i < tabs.count(); ++i) {
      const QRect tab = tabs.tabRect(i);
      const QString text = withoutMnemonic(tabs.tabText(i));
      if (!tabs.isTabVisible(i)) continue;
      require(tabs, text, widthOf(tabs.fontMetrics(), text) + 8, tab.width());
      if (!tabs.rect().contains(tab))
        add(tabs, QStringLiteral("tab '%1' is out of sight").arg(text));
    }
  }

  void inspectHead(const QHeaderView& head) {
    if (head.orientation() == Qt::Vertical || !head.model()) return;
    for (int i = 0; i < head.count(); ++i) {
      if (head.isSectionHidden(i)) continue;
      const QString text = head.model()->headerData(i, Qt::Horizontal).toString();
      const bool sorts = head.isSortIndicatorShown() && head.sortIndicatorSection() == i;
      const int sign = sorts ? head.style()->pixelMetric(QStyle::PM_HeaderMarkSize) : 0;
      constexpr int kPadding = 12;  // both sides, of the style sheet
      require(head, text, widthOf(head.fontMetrics(), text) + kPadding + sign, head.sectionSize(i));
    }
    if (head.sizeHint().height() > head.height()) add(head, QStringLiteral("heads are cut below"));
  }

  void inspectCells(const QTableView& view) {
    const QAbstractItemModel* model = view.model();
    if (!model) return;
    for (int row = 0; row < model->rowCount(); ++row)
      for (int column = 0; column < model->columnCount(); ++column) {
        if (view.isRowHidden(row) || view.isColumnHidden(column)) continue;
        const QModelIndex index = model->index(row, column);
        view.wordWrap() ? inspectLines(view, index) : inspectCell(view, index);
      }
  }

  /// Where texts take further lines.
  void inspectLines(const QTableView& view, const QModelIndex& index) {
    const QString text = index.data().toString();
    const QRect room(0, 0, view.columnWidth(index.column()), view.rowHeight(index.row()));
    const int needed = view.fontMetrics().boundingRect(room, Qt::TextWordWrap, text).height();
    if (beginsAsNumber(text) && needed > room.height())
      add(view, QStringLiteral("'%1' needs %2 px of height, of %3")
                    .arg(text)
                    .arg(needed)
                    .arg(room.height()));
  }

  void inspectCell(const QTableView& view, const QModelIndex& index) {
    const QString text = index.data().toString();
    if (!beginsAsNumber(text) || view.columnSpan(index.row(), index.column()) > 1) return;
    require(view, text, view.sizeHintForIndex(index).width(), view.columnWidth(index.column()));
  }

  void inspectTitle(const QDockWidget& dock) {
    if (dock.titleBarWidget()) return;
    QFont bold = dock.font();
    bold.setBold(true);
    constexpr int kButtonsAndMargins = 8 + 2 * 20;
    require(dock, dock.windowTitle(), widthOf(QFontMetrics(bold), dock.windowTitle()),
            dock.width() - kButtonsAndMargins);
  }

  QWidget& window_;
  QStringList faults_;
};

}  // namespace

QStringList layoutFaults(QWidget& window) { return Inspector(window).look(); }

}  // namespace boresight::test
