// SPDX-License-Identifier: Apache-2.0
#include "ui/review/queue_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <QIcon>
#include <QPixmap>
#include <QtWidgets>

#include "sessions/text/units.h"
#include "ui/models/text.h"
#include "ui/panels/case/cases_panel.h"
#include "ui/style/icons.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

using sessions::kUnknown;
using sessions::QueueGroup;
using sessions::QueueRow;
using sessions::RunChange;
using sessions::RunDifference;

namespace {

QString signOf(RunChange change) {
  return change == RunChange::kBetter  ? DifferencesModel::tr("▲ better")
         : change == RunChange::kWorse ? DifferencesModel::tr("▼ worse")
                                       : DifferencesModel::tr("= same");
}

QString apartText(const RunDifference& run_difference) {
  if (!run_difference.before.converged || !run_difference.after.converged) return {};
  return DifferencesModel::tr("%1 mm, %2 mrad")
      .arg(numberText(run_difference.comparison.translation_mm, 3),
           numberText(run_difference.comparison.rotation_mrad, 3));
}

using Difference = const RunDifference&;

/// A cell of a case that has a difference; nothing of others.
template <class Value>
auto ofDifference(Value value) {
  return [value](const DifferenceEntry& entry) {
    return entry.difference ? QVariant(value(*entry.difference)) : QVariant();
  };
}

/// A count of a run; kUnknown: none.
using Count = double (*)(const sessions::RunSide& side);

double failedChecksOf(const sessions::RunSide& side) { return side.checks_failed; }

double inliersOf(const sessions::RunSide& side) { return side.inliers ? *side.inliers : kUnknown; }

QString countOrDash(double count) {
  return std::isnan(count) ? QStringLiteral("-") : numberText(count, 0);
}

/// A count of both runs, and its sort key.
auto bothRuns(Count count) {
  return ofDifference([count](Difference difference) {
    return QStringLiteral("%1 → %2").arg(countOrDash(count(difference.before)),
                                         countOrDash(count(difference.after)));
  });
}
auto increase(Count count) {
  return ofDifference([count](Difference difference) {
    return count(difference.after) - count(difference.before);
  });
}

/// Sorted with the worse ones first when it ascends.
std::vector<TableColumn<DifferenceEntry>> differenceColumns() {
  constexpr auto tr = [](const char* text) { return DifferencesModel::tr(text); };
  return {
      {tr("Case"), tr("The case."), -1,
       [](const DifferenceEntry& entry) { return fromText(entry.case_id); }},
      {tr("Change"),
       tr("Whether the last run is better than the previous run: by the truth if known, else by "
          "the checks."),
       -1, ofDifference([](Difference difference) { return signOf(difference.change); }),
       ofDifference([](Difference difference) {
         return difference.change == RunChange::kWorse    ? 0
                : difference.change == RunChange::kBetter ? 1
                                                          : 2;
       })},
      {tr("Failed checks"), tr("Number of failed checks: before and after."), 0,
       bothRuns(failedChecksOf), increase(failedChecksOf)},
      {tr("Inliers"),
       tr("Inliers of the last matching iteration that led to the pose: before and after."), 0,
       bothRuns(inliersOf), increase(inliersOf)},
      {tr("Poses apart"), tr("Distance of the two results at the camera, in mm and mrad."), 0,
       ofDifference(apartText),
       ofDifference([](Difference difference) { return difference.comparison.translation_mm; })},
      {tr("Reason and first difference"),
       tr("Basis of the verdict, and the first value in which the runs differ."), -1,
       ofDifference(
           [](Difference difference) { return fromText(sessions::changeText(difference)); })},
  };
}

QString tableHtml(const RunDifference& run_difference) {
  QVector<QStringList> rows = {
      {QString(), DifferencesModel::tr("before"), DifferencesModel::tr("now")}};
  for (const sessions::DifferenceLine& line : sessions::differenceLines(run_difference))
    rows.append({fromText(line.label).toHtmlEscaped(), fromText(line.before).toHtmlEscaped(),
                 fromText(line.after).toHtmlEscaped()});
  return htmlTable(rows) + QStringLiteral("<p>%1</p>")
                               .arg(fromText(sessions::changeText(run_difference)).toHtmlEscaped());
}

constexpr double kToPercent = 100.0;

/// States that the row's checks are not of the document's current state; empty when they are.
QString remarkOf(const QueueEntry& entry) {
  if (entry.checked) return {};
  return entry.row.checks.empty() ? QueueModel::tr("… being checked")
                                  : QueueModel::tr(" … being checked again");
}

QString troubleOf(const QueueEntry& entry) {
  const QueueRow& row = entry.row;
  const bool unknown = !entry.checked && row.checks.empty() && row.group == QueueGroup::kOpen;
  QString text = unknown ? QString() : fromText(sessions::troubleText(row));
  if (!text.isEmpty()) text[0] = text[0].toUpper();
  return text + (row.group == QueueGroup::kOpen ? remarkOf(entry) : QString());
}

QString fromSeedText(const QueueRow& row) {
  if (!row.from_seed) return {};
  return QueueModel::tr("%1 %\n%2 mm\n%3 mrad")
      .arg(numberText(kToPercent * row.from_seed->share, 0),
           numberText(row.from_seed->translation_mm, 1),
           numberText(row.from_seed->rotation_mrad, 1));
}

QString tooltipOf(const QueueEntry& entry, int column) {
  const QueueRow& row = entry.row;
  if (column == QueueModel::kMargin && !row.margin_of.empty())
    return QueueModel::tr("Of the check '%1'").arg(fromText(row.margin_of));
  QString text = fromText(row.case_id) + QLatin1Char('\n') + fromText(row.review_status_text) +
                 QLatin1Char('\n') + troubleOf(entry);
  for (const sessions::Check& check : row.checks)
    if (check.state == sessions::CheckState::kFailed)
      text += QStringLiteral("\n✗ ") + fromText(check.title) + QStringLiteral(": ") +
              fromText(check.sentence);
  return text;
}

std::vector<TableColumn<QueueEntry>> queueColumns() {
  using Entry = const QueueEntry&;
  constexpr auto tr = [](const char* text) { return QueueModel::tr(text); };
  return {
      {tr("Case"),
       tr("The case, with the edges of its result over the image; orange: edges of the seed, "
          "without a result."),
       -1, [](Entry entry) { return fromText(entry.row.case_id); }},
      {tr("State"), tr("State of the case."), -1,
       [](Entry entry) { return QueueModel::reviewStatusText(entry.row); }},
      {tr("Trouble"),
       tr("Reason for review; sort order: failed runs, failed checks, smallest margin, largest "
          "distance from the seed. Decided cases come last."),
       -1, troubleOf},
      {tr("Margin,\n%"),
       tr("Margin of the worst check to its limit, in percent of the limit; negative: limit "
          "exceeded."),
       0, [](Entry entry) { return kToPercent * entry.row.margin.value_or(kUnknown); }},
      {tr("From\nseed"),
       tr("Distance of the result from the seed, in mm and mrad, and relative to the seed's "
          "uncertainty (100 %: on its border)."),
       0, [](Entry entry) { return fromSeedText(entry.row); },
       [](Entry entry) { return entry.row.from_seed ? entry.row.from_seed->share : kUnknown; }},
      {tr("Inliers"), tr("Inliers of the last matching iteration that led to the pose."), 0,
       [](Entry entry) { return entry.row.inliers ? *entry.row.inliers : kUnknown; }},
  };
}

constexpr QSize kQueueThumbnail_px{76, 57};  // of a screen without scaling
constexpr int kUsualQueueName = 18;          // letters
constexpr int kAllColumns_px = 560;          // width from which all columns fit
constexpr std::size_t kRowsAtOnce = 64;      // that are sorted again at once
constexpr int kTroubleTab = 0;
constexpr int kDifferencesTab = 1;

/// In a narrow list a case has its state and its trouble below its name.
class CaseWithTrouble final : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

 protected:
  void initStyleOption(QStyleOptionViewItem* option, const QModelIndex& index) const override {
    QStyledItemDelegate::initStyleOption(option, index);
    option->textElideMode = Qt::ElideRight;
    const auto* view = qobject_cast<const QTableView*>(option->widget);
    if (!view || !view->isColumnHidden(QueueModel::kTrouble)) return;
    const QChar line(QChar::LineSeparator);
    option->text += line + index.siblingAtColumn(QueueModel::kStatus).data().toString() + line +
                    index.siblingAtColumn(QueueModel::kTrouble).data().toString();
  }
};

}  // namespace

DifferencesModel::DifferencesModel() : RowsModel(differenceColumns()) {}

int DifferencesModel::rowOf(const QString& id) const {
  return firstRow([wanted = id.toStdString()](const DifferenceEntry& entry) {
    return entry.case_id == wanted;
  });
}

QVariant DifferencesModel::look(const DifferenceEntry& entry, int column, int role) const {
  const bool tip = role == Qt::ToolTipRole;
  if (entry.difference) return tip ? tableHtml(*entry.difference) : QVariant();
  if (!tip && (role != Qt::DisplayRole || column != kWhy)) return {};
  return entry.problem.isEmpty() ? tr("… being compared") : entry.problem;
}

QueueModel::QueueModel() : RowsModel(queueColumns()) {}

int QueueModel::rowOf(const QString& id) const {
  return firstRow(
      [wanted = id.toStdString()](const QueueEntry& entry) { return entry.row.case_id == wanted; });
}

void QueueModel::setUnchecked(int row) { changeable(row).checked = false; }

QString QueueModel::reviewStatusText(const QueueRow& row) {
  const QString state = row.group == QueueGroup::kAwaits
                            ? tr("☆ to be approved")
                            : CasesModel::stateText(caseStateOf(row.review_state));
  return row.outdated ? tr("%1, outdated").arg(state) : state;
}

QVariant QueueModel::look(const QueueEntry& entry, int column, int role) const {
  if (role == Qt::ToolTipRole) return tooltipOf(entry, column);
  if (role != Qt::DecorationRole || column != kCase || entry.thumbnail.isNull()) return {};
  return pictureIcon(entry.thumbnail);
}

QueueFilter::QueueFilter(QueueModel& model) : model_(model) { setSourceModel(&model); }

bool QueueFilter::lessThan(const QModelIndex& left, const QModelIndex& right) const {
  if (left.column() != QueueModel::kTrouble) return RowsFilter::lessThan(left, right);
  return sessions::moreTrouble(model_.at(left.row()).row, model_.at(right.row()).row);
}

QueuePanel::QueuePanel(Document& document)
    : controller_(document, kQueueThumbnail_px * qApp->devicePixelRatio()), filter_(model_) {
  ui_.setupUi(this);
  ui_.queueTabs->addTab(tr("Worst first"));
  ui_.queueTabs->addTab(tr("Last two runs"));
  ui_.queueTabs->setTabToolTip(kTroubleTab, tr("All cases, the worst first"));
  ui_.queueTabs->setTabToolTip(
      kDifferencesTab, tr("Last run of each case against the previous run (D in the list)"));
  buildTables();
  connect(ui_.queueTabs, &QTabBar::currentChanged, this, &QueuePanel::lookAt);
  connect(ui_.queueFilter, &QLineEdit::textChanged, this, [this](const QString& text) {
    const QScopedValueRollback following(following_, true);
    filter_.setCondition([this, words = text.trimmed()](int row) {
      constexpr std::array kSearched = {QueueModel::kCase, QueueModel::kStatus,
                                        QueueModel::kTrouble};
      return std::ranges::any_of(kSearched, [&](int column) {
        return model_.index(row, column).data().toString().contains(words, Qt::CaseInsensitive);
      });
    });
    differences_filter_.setFilterFixedString(text.trimmed());
    chooseShown();
  });
  connect(ui_.queueHalt, &QPushButton::clicked, this,
          [this] { controller_.setHalted(!controller_.isHalted()); });
  connect(&controller_, &QueueController::changed, this, &QueuePanel::showEntries);
  connect(&controller_, &QueueController::queueRowsChanged, this,
          [this](const std::vector<std::size_t>& places) {
            const QScopedValueRollback following(following_, true);
            const bool few = places.size() <= kRowsAtOnce;
            for (const std::size_t place : places)
              if (few || controller_.isChecked(place))
                model_.setRow(static_cast<int>(place), controller_.queueAt(place));
              else
                model_.setUnchecked(static_cast<int>(place));
            ui_.queue->viewport()->update();
            showRows();
          });
  connect(&controller_, &QueueController::differenceRowsChanged, this,
          [this](const std::vector<std::size_t>& places) {
            const QScopedValueRollback following(following_, true);
            for (const std::size_t place : places)
              differences_.setRow(static_cast<int>(place), controller_.differenceAt(place));
            showRows();
          });
  showEntries();
}

void QueuePanel::buildTables() {
  setUpTable(*ui_.queue, filter_);
  ui_.queue->verticalHeader()->setDefaultSectionSize(
      std::max(kQueueThumbnail_px.height(), 3 * fontMetrics().lineSpacing()) + 4);
  ui_.queue->setWordWrap(true);
  ui_.queue->sortByColumn(QueueModel::kTrouble, Qt::AscendingOrder);
  ui_.queue->setItemDelegateForColumn(QueueModel::kCase, new CaseWithTrouble(ui_.queue));
  queue_hint_ = new EmptyHint(*ui_.queue);
  differences_filter_.setSourceModel(&differences_);
  differences_filter_.setSortRole(kSortRole);
  differences_filter_.setFilterKeyColumn(-1);
  differences_filter_.setFilterCaseSensitivity(Qt::CaseInsensitive);
  setUpTable(*ui_.differences, differences_filter_);
  ui_.differences->sortByColumn(DifferencesModel::kChange, Qt::AscendingOrder);
  differences_hint_ = new EmptyHint(*ui_.differences);
  for (QTableView* each : {ui_.queue, ui_.differences}) {
    each->horizontalHeader()->setStretchLastSection(each == ui_.differences);
    each->installEventFilter(this);
    connect(each, &QTableView::doubleClicked, this, &QueuePanel::openChosen);
    connect(each->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
            &QueuePanel::showChosen);
  }
  ui_.queue->horizontalHeader()->setSectionResizeMode(QueueModel::kTrouble, QHeaderView::Stretch);
}

QTableView* QueuePanel::table() const {
  return ui_.queueTabs->currentIndex() == kDifferencesTab ? ui_.differences : ui_.queue;
}

QString QueuePanel::chosenCase() const {
  return table()->currentIndex().siblingAtColumn(0).data().toString();
}

void QueuePanel::setCurrent(const QString& id) {
  current_ = id;
  chooseShown();
}

void QueuePanel::focusList() { table()->setFocus(); }

void QueuePanel::showDifferences(bool shown) {
  ui_.queueTabs->setCurrentIndex(shown ? kDifferencesTab : kTroubleTab);
  focusList();
}

void QueuePanel::lookAt() {
  ui_.lists->setCurrentWidget(table());
  using List = QueueController::List;
  controller_.setLookedAt(!in_sight_             ? List::kNone
                          : table() == ui_.queue ? List::kTrouble
                                                 : List::kDifferences);
  showEntries();
}

void QueuePanel::setInSight(bool in_sight) {
  in_sight_ = in_sight;
  lookAt();
}

void QueuePanel::showEntries() {
  const QScopedValueRollback following(following_, true);
  model_.setRowsByKey(controller_.queue(), [](const auto& entry) { return entry.row.case_id; });
  differences_.setRowsByKey(controller_.differences(), &DifferenceEntry::case_id);
  queue_hint_->setText(model_.rowCount() > 0
                           ? tr("No matching cases.")
                           : tr("No case yet: open a session (Ctrl+O) and run it (Ctrl+F5)."));
  differences_hint_->setText(
      differences_.rowCount() > 0
          ? tr("No matching cases.")
          : tr("No case has two runs: change an option and run again (Ctrl+F5)."));
  showRows();
}

/// After rows were filled or changed.
void QueuePanel::showRows() {
  chooseShown();
  fitColumns();
  showProgress();
}

/// Once, as soon as there is something to fit: afterwards widths are the operator's.
void QueuePanel::fitColumns() {
  if (fitted_ || model_.rowCount() == 0) return;
  fitted_ = controller_.doneCount() > 0;
  // Headers would keep room for the sign of the order in every column.
  const auto fit = [this](int column, const QString& widest) {
    ui_.queue->setColumnWidth(column, fontMetrics().horizontalAdvance(widest) + 14);
  };
  fit(QueueModel::kStatus, QStringLiteral("✓ converged"));
  fit(QueueModel::kMargin, QStringLiteral("Margin,"));
  fit(QueueModel::kFromSeed, QStringLiteral("000.0 mrad"));
  fit(QueueModel::kInliers, QStringLiteral("Inliers"));
  ui_.queue->setColumnWidth(
      QueueModel::kCase,
      kQueueThumbnail_px.width() + 16 + kUsualQueueName * fontMetrics().averageCharWidth());
  ui_.differences->resizeColumnsToContents();
}

void QueuePanel::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  const bool narrow = width() < kAllColumns_px;
  for (const int column : {QueueModel::kStatus, QueueModel::kTrouble, QueueModel::kMargin,
                           QueueModel::kFromSeed, QueueModel::kInliers})
    ui_.queue->setColumnHidden(column, narrow);
  ui_.queue->horizontalHeader()->setSectionResizeMode(
      QueueModel::kCase, narrow ? QHeaderView::Stretch : QHeaderView::Interactive);
  for (const int column : {DifferencesModel::kChecks, DifferencesModel::kInliers,
                           DifferencesModel::kApart, DifferencesModel::kWhy})
    ui_.differences->setColumnHidden(column, narrow);
}

void QueuePanel::showProgress() {
  const int done = controller_.doneCount();
  const int all = controller_.count();
  ui_.queueProgress->setText(done < all ? tr("%1 of %2 checked").arg(done).arg(all)
                                        : tr("%1 checked").arg(all));
  ui_.queueHalt->setText(controller_.isHalted() ? tr("Continue") : tr("Stop"));
  ui_.queueHalt->setEnabled(done < all);
}

void QueuePanel::openChosen() {
  const QString id = chosenCase();
  const int row = model_.rowOf(id);
  if (row < 0) return;  // no case is chosen, or it has left the queue
  const QueueRow& chosen = model_.at(row).row;
  Q_EMIT openRequested(id, fromText(chosen.run_digest), chosen.opens_at);
}

void QueuePanel::next() { step(1); }
void QueuePanel::previous() { step(-1); }

void QueuePanel::step(int rows) {
  const int count = table()->model()->rowCount();
  if (count == 0) return;
  const int row = std::clamp(table()->currentIndex().row() + rows, 0, count - 1);
  table()->setCurrentIndex(table()->model()->index(row, 0));
}

/// Requests the case that the operator has chosen; the window answers with `setCurrent`.
void QueuePanel::showChosen() {
  if (!following_ && chosenCase() != current_) openChosen();
}

/// A shown case that is not listed leaves no row chosen.
void QueuePanel::chooseShown() {
  const QScopedValueRollback following(following_, true);
  const auto choose = [](QTableView& view, const QModelIndex& shown) {
    if (shown != view.currentIndex().siblingAtColumn(0) || !shown.isValid())
      view.setCurrentIndex(shown);
  };
  choose(*ui_.queue, filter_.mapFromSource(model_.index(model_.rowOf(current_), 0)));
  choose(*ui_.differences,
         differences_filter_.mapFromSource(differences_.index(differences_.rowOf(current_), 0)));
}

QString QueuePanel::nextOpen() const {
  const int count = filter_.rowCount();
  const int current = ui_.queue->currentIndex().row();
  for (int i = 1; i <= count; ++i) {
    const QModelIndex index = filter_.index((current + i) % count, 0);
    const QueueRow& row = model_.at(filter_.mapToSource(index).row()).row;
    const QString id = fromText(row.case_id);
    if (id != current_ && (row.group == QueueGroup::kNoPose || row.group == QueueGroup::kOpen))
      return id;
  }
  return {};
}

void QueuePanel::switchList() { showDifferences(table() == ui_.queue); }

/// In the lists these letters are the queue's, elsewhere in the window the image's. While the
/// pointer is on the queue its rows keep their places: a click hits the row that was seen.
bool QueuePanel::eventFilter(QObject* watched, QEvent* event) {
  if (watched == ui_.queue && (event->type() == QEvent::Enter || event->type() == QEvent::Leave)) {
    const QScopedValueRollback following(following_, true);
    filter_.setDynamicSortFilter(event->type() == QEvent::Leave);
    chooseShown();
  }
  const bool pressed = event->type() == QEvent::KeyPress;
  if (!pressed && event->type() != QEvent::ShortcutOverride) return false;
  auto* key = static_cast<QKeyEvent*>(event);
  if ((key->modifiers() & ~Qt::KeypadModifier) != Qt::NoModifier) return false;
  static constexpr std::pair<int, void (QueuePanel::*)()> kKeys[] = {
      {Qt::Key_Return, &QueuePanel::openChosen},
      {Qt::Key_Enter, &QueuePanel::openChosen},
      {Qt::Key_A, &QueuePanel::validationRequested},
      {Qt::Key_R, &QueuePanel::rejectionRequested},
      {Qt::Key_J, &QueuePanel::next},
      {Qt::Key_K, &QueuePanel::previous},
      {Qt::Key_D, &QueuePanel::switchList},
  };
  for (const auto& [letter, act] : kKeys) {
    if (letter != key->key()) continue;
    if (pressed)
      (this->*act)();
    else
      event->accept();
    return true;
  }
  return false;
}

}  // namespace boresight::ui
