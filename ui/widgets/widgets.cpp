// SPDX-License-Identifier: Apache-2.0
#include "ui/widgets/widgets.h"

#include <QtWidgets>

#include "sessions/trace/run_text.h"
#include "ui/models/text.h"
#include "ui/plots/plot_colors.h"

namespace boresight::ui {

namespace {

constexpr int kMostWarnings = 2;  ///< of a banner

QString rowText(const QAbstractItemModel& model, int row) {
  QStringList cells;
  for (int column = 0; column < model.columnCount(); ++column)
    cells << model.index(row, column).data().toString();
  return cells.join(QLatin1Char('\t'));
}

/// Rows as text that a spreadsheet takes.
QString tableText(const QAbstractItemModel& model) {
  QStringList lines = {QString()};
  for (int column = 0; column < model.columnCount(); ++column)
    lines[0] += (column > 0 ? QStringLiteral("\t") : QString()) +
                model.headerData(column, Qt::Horizontal)
                    .toString()
                    .replace(QLatin1Char('\n'), QLatin1Char(' '));
  for (int row = 0; row < model.rowCount(); ++row) lines << rowText(model, row);
  return lines.join(QLatin1Char('\n'));
}

void showTableMenu(QTableView& table, const QPoint& at) {
  const QPersistentModelIndex index = table.indexAt(at);  // rows may go while the menu is open
  const auto copy = [](const QString& text) { QGuiApplication::clipboard()->setText(text); };
  QMenu menu(&table);
  if (index.isValid()) {
    menu.addAction(EmptyHint::tr("Copy cell"), [=] { copy(index.data().toString()); });
    menu.addAction(EmptyHint::tr("Copy row"), [=] {
      if (index.isValid()) copy(rowText(*index.model(), index.row()));
    });
  }
  menu.addAction(EmptyHint::tr("Copy table"), [&] { copy(tableText(*table.model())); });
  menu.addAction(EmptyHint::tr("Fit columns"), [&] { table.resizeColumnsToContents(); });
  menu.exec(table.viewport()->mapToGlobal(at));
}

QString hiddenColumnsKey(const QAbstractItemView& table) {
  return QStringLiteral("tables/%1/hidden").arg(table.objectName());
}

void rememberColumns(const QTableView& table) {
  QStringList hidden;
  for (int column = 0; column < table.horizontalHeader()->count(); ++column)
    if (table.isColumnHidden(column)) hidden << QString::number(column);
  QSettings().setValue(hiddenColumnsKey(table), hidden);
}

/// As the operator left them; without a choice the panel's own stays.
void restoreColumns(QTableView& table) {
  if (!hasChosenColumns(table)) return;
  const QStringList hidden = QSettings().value(hiddenColumnsKey(table)).toStringList();
  const int count = table.horizontalHeader()->count();
  if (hidden.size() >= count) return;  // of another version
  for (int column = 0; column < count; ++column)
    table.setColumnHidden(column, hidden.contains(QString::number(column)));
}

/// Columns on and off; one always stays.
void showColumnsMenu(QTableView& table, const QPoint& at) {
  QHeaderView& header = *table.horizontalHeader();
  const bool one_left = header.count() - header.hiddenSectionCount() == 1;
  QMenu menu(&table);
  for (int column = 0; column < header.count(); ++column) {
    const bool shown = !table.isColumnHidden(column);
    const QString name = table.model()->headerData(column, Qt::Horizontal).toString().simplified();
    QAction* action = menu.addAction(name.isEmpty() ? QString::number(column + 1) : name);
    action->setCheckable(true);
    action->setChecked(shown);
    action->setEnabled(!(shown && one_left));
    QObject::connect(action, &QAction::toggled, &table, [&table, column](bool on) {
      table.setColumnHidden(column, !on);
      if (on) table.resizeColumnToContents(column);
      rememberColumns(table);
    });
  }
  menu.exec(header.mapToGlobal(at));
}

/// Lies over the row that the lower edge of a table would cut, at the end of the table the upper
/// one: all rows in sight are whole.
class RowCover final : public QWidget {
 public:
  explicit RowCover(QTableView& table) : QWidget(table.viewport()), table_(table) {
    setObjectName(QStringLiteral("rowCover"));
    setAttribute(Qt::WA_TransparentForMouseEvents);
    setBackgroundRole(QPalette::Base);
    setAutoFillBackground(true);
    hide();
    table.viewport()->installEventFilter(this);
  }

  bool eventFilter(QObject* watched, QEvent* event) override {
    if (event->type() == QEvent::Paint) place();
    return QWidget::eventFilter(watched, event);
  }

 private:
  void place() {
    const int height = table_.viewport()->height();
    const int first = table_.rowAt(0);
    const int last = table_.rowAt(height - 1);
    const int from = table_.rowViewportPosition(last);
    const int to = table_.rowViewportPosition(first) + table_.rowHeight(first);
    // The only row stays, also where it is cut.
    const bool cut_below = last > first && from + table_.rowHeight(last) > height;
    const bool cut_above =
        !cut_below && first >= 0 && first != last && table_.rowViewportPosition(first) < 0;
    const bool cut = cut_below || cut_above;
    if (cut)
      setGeometry(0, cut_below ? from : 0, table_.viewport()->width(),
                  cut_below ? height - from : to);
    if (cut == isHidden()) setVisible(cut);
  }

  QTableView& table_;
};

}  // namespace

bool hasChosenColumns(const QAbstractItemView& view) {
  return !view.objectName().isEmpty() && QSettings().contains(hiddenColumnsKey(view));
}

void styleTable(QTableView& table) {
  table.setSelectionBehavior(QAbstractItemView::SelectRows);
  table.setSelectionMode(QAbstractItemView::SingleSelection);
  table.setEditTriggers(QAbstractItemView::NoEditTriggers);
  table.setAlternatingRowColors(true);
  table.setWordWrap(false);
  table.setTabKeyNavigation(false);
  table.setShowGrid(false);
  table.setHorizontalScrollMode(QAbstractItemView::ScrollPerPixel);
  table.verticalHeader()->hide();
  table.verticalHeader()->setDefaultSectionSize(table.fontMetrics().height() + 6);
  table.horizontalHeader()->setHighlightSections(false);
  table.horizontalHeader()->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
  table.horizontalHeader()->setContextMenuPolicy(Qt::CustomContextMenu);
  QObject::connect(table.horizontalHeader(), &QWidget::customContextMenuRequested, &table,
                   [&table](const QPoint& at) { showColumnsMenu(table, at); });
  new RowCover(table);
  // When the panel has hidden what it hides at first.
  QMetaObject::invokeMethod(
      &table, [&table] { restoreColumns(table); }, Qt::QueuedConnection);
  if (table.contextMenuPolicy() != Qt::DefaultContextMenu) return;  // it has a menu of its own
  table.setContextMenuPolicy(Qt::CustomContextMenu);
  QObject::connect(&table, &QWidget::customContextMenuRequested, &table,
                   [&table](const QPoint& at) { showTableMenu(table, at); });
}

void setUpTable(QTableView& table, QAbstractItemModel& model) {
  table.setModel(&model);
  styleTable(table);
}

void followRow(QTableView& table, const QModelIndex& row, bool& following) {
  const QScopedValueRollback<bool> from_here(following, true);
  if (row.row() == table.currentIndex().row()) return;  // where the operator has scrolled stays
  table.setCurrentIndex(row);
  if (row.isValid()) table.scrollTo(row);
}

void addRow(QTableWidget& table, const QStringList& texts) {
  const int row = table.rowCount();
  table.setRowCount(row + 1);
  for (int column = 0; column < texts.size(); ++column) {
    auto* item = new QTableWidgetItem(texts[column]);
    const auto alignment =
        static_cast<int>((column > 0 ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignVCenter);
    item->setTextAlignment(alignment);
    table.setItem(row, column, item);
    if (QTableWidgetItem* head = table.horizontalHeaderItem(column))
      head->setTextAlignment(alignment);
  }
}

bool isTyping() {
  const QWidget* focus = QApplication::focusWidget();
  return focus && focus->testAttribute(Qt::WA_InputMethodEnabled) &&
         !qobject_cast<const QAbstractItemView*>(focus);  // it has the attribute for its cells
}

void setTip(QAction& action, const QString& tip) {
  const QKeySequence keys = action.shortcut();
  action.setToolTip(
      keys.isEmpty() ? tip
                     : QStringLiteral("%1 (%2)").arg(tip, keys.toString(QKeySequence::NativeText)));
  action.setStatusTip(tip);
}

void clearLayout(QLayout& layout) {
  while (QLayoutItem* item = layout.takeAt(0)) {
    delete item->widget();
    delete item;
  }
}

void clearLayoutLater(QLayout& layout) {
  while (QLayoutItem* item = layout.takeAt(0)) {
    if (QWidget* widget = item->widget()) {
      widget->hide();
      widget->deleteLater();
    }
    delete item;
  }
}

void restyle(std::initializer_list<QWidget*> widgets) {
  for (QWidget* each : widgets) {
    each->style()->unpolish(each);
    each->style()->polish(each);
  }
}

QLabel* captionLabel(const QString& text) {
  auto* label = new QLabel(text);
  label->setProperty("caption", true);
  label->setWordWrap(true);
  return label;
}

void IconLabel::setIcon(Icon icon, QRgb Theme::*color) {
  icon_ = icon;
  color_ = color;
  update();
}

void IconLabel::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  paintIcon(painter, rect(), icon_, QColor(theme().*color_));
}

FoldButton::FoldButton(QWidget* parent) : QToolButton(parent) {
  setCheckable(true);
  setAutoRaise(true);
  setArrowType(Qt::RightArrow);
  setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  connect(this, &QToolButton::toggled, this, [this](bool open) {
    setArrowType(open ? Qt::DownArrow : Qt::RightArrow);
    Q_EMIT foldedChanged();
  });
  connect(this, &QToolButton::clicked, this, [this] { QSettings().setValue(key(), isFolded()); });
}

QString FoldButton::key() const { return QStringLiteral("folds/") + objectName(); }

void FoldButton::restore(bool folded) { setChecked(!QSettings().value(key(), folded).toBool()); }

void FoldButton::setContent(const QString& text) {
  setText(text);
  setVisible(!text.isEmpty());
}

EmptyHint::EmptyHint(QAbstractItemView& view, int least_rows)
    : QLabel(view.viewport()), view_(view), least_rows_(least_rows) {
  setObjectName(QStringLiteral("emptyHint"));
  setAlignment(Qt::AlignCenter);
  setWordWrap(true);
  setMargin(12);
  setAttribute(Qt::WA_TransparentForMouseEvents);
  view.viewport()->installEventFilter(this);
  connectEach(*view.model(), this, &EmptyHint::showOrHide, &QAbstractItemModel::modelReset,
              &QAbstractItemModel::rowsInserted, &QAbstractItemModel::rowsRemoved,
              &QAbstractItemModel::layoutChanged);
  showOrHide();
}

/// Below the rows that are always there.
void EmptyHint::place() {
  QRect area = view_.viewport()->rect();
  const int rows = view_.model()->rowCount();
  if (rows > 0) area.setTop(view_.visualRect(view_.model()->index(rows - 1, 0)).bottom() + 1);
  setGeometry(area);
}

void EmptyHint::showOrHide() {
  place();
  setVisible(view_.model()->rowCount() <= least_rows_);
}

bool EmptyHint::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize) place();
  return QLabel::eventFilter(watched, event);
}

Banner::Banner(QWidget* parent) : QFrame(parent) {
  ui_.setupUi(this);
  QFont large = font();
  large.setPointSizeF(1.4 * large.pointSizeF());
  large.setBold(true);
  ui_.bannerSign->setFont(large);
  connect(ui_.bannerAction, &QToolButton::clicked, this, &Banner::actionRequested);
}

void Banner::setAction(const QString& text, const QString& tip) {
  ui_.bannerAction->setText(text);
  ui_.bannerAction->setToolTip(tip);
  ui_.bannerAction->show();
}

QString Banner::text() const { return ui_.bannerText->text(); }

void Banner::showRun(const sessions::LocalizationTrace* run) {
  if (!run) return setMessage(QStringLiteral("○"), tr("No run yet."), Tone::kPlain);
  const QString text = fromText(sessions::runStatusText(*run));
  if (run->converged())
    setMessage(QStringLiteral("✓"), text, Tone::kGood);
  else if (run->finished)
    setMessage(QStringLiteral("✗"), text, Tone::kBad);
  else
    setMessage(QStringLiteral("…"), text, Tone::kPlain);
}

void Banner::setMessage(const QString& sign, const QString& text, Tone tone) {
  ui_.bannerSign->setText(sign);
  ui_.bannerSign->setVisible(!sign.isEmpty());
  ui_.bannerText->setText(text);
  ui_.bannerText->setToolTip(text);
  tone_ = tone;
  applyPalette();
}

void Banner::showWarnings(const QStringList& sentences) {
  const int more = static_cast<int>(sentences.size()) - kMostWarnings;
  QStringList shown = sentences.mid(0, kMostWarnings);
  if (more > 0) shown.append(tr("and %1 more").arg(more));
  setMessage(QStringLiteral("⚠"), shown.join(QLatin1Char('\n')), Tone::kBad);
  ui_.bannerText->setToolTip(sentences.join(QLatin1Char('\n')));
  setVisible(!sentences.isEmpty());
}

void Banner::applyPalette() {
  tinting_ = true;
  const QPalette base = QApplication::palette();
  const PlotColors colors = plotColors(base);
  setPalette(tone_ == Tone::kGood  ? tinted(base, colors.first)
             : tone_ == Tone::kBad ? tinted(base, colors.second)
                                   : base);
  tinting_ = false;
}

void Banner::changeEvent(QEvent* event) {
  QFrame::changeEvent(event);
  const bool look =
      event->type() == QEvent::ApplicationPaletteChange || event->type() == QEvent::StyleChange;
  if (look && !tinting_ && ui_.bannerAction != nullptr) applyPalette();
}

}  // namespace boresight::ui
