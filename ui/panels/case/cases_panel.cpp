// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/cases_panel.h"

#include <algorithm>
#include <utility>

#include <QIcon>
#include <QPixmap>
#include <QtWidgets>

#include "sessions/text/units.h"
#include "ui/style/icons.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

/// In the order of `CaseState`.
constexpr const char* kStateTexts[kCaseStateCount] = {
    QT_TR_NOOP("○ new"),       QT_TR_NOOP("✓ converged"), QT_TR_NOOP("✗ failed"),
    QT_TR_NOOP("✎ annotated"), QT_TR_NOOP("★ validated"), QT_TR_NOOP("⊘ rejected"),
    QT_TR_NOOP("… running")};

QString tooltipOf(const CaseRow& row) {
  QString text = row.id;
  if (!row.station.isEmpty()) text += CasesModel::tr(", station %1").arg(row.station);
  text += QLatin1Char('\n') + CasesModel::stateText(row.state);
  if (row.stale)
    text += CasesModel::tr("\nOutdated: the run was made with other inputs or options.");
  if (!row.detail.isEmpty()) text += QLatin1Char('\n') + row.detail;
  return text;
}

std::vector<TableColumn<CaseRow>> caseColumns() {
  using Row = const CaseRow&;
  constexpr auto tr = [](const char* text) { return CasesModel::tr(text); };
  const auto error = [](std::optional<double> CaseRow::*value) {
    return [value](Row row) { return (row.*value).value_or(sessions::kUnknown); };
  };
  return {
      {tr("Case"), tr("The image's name."), -1, [](Row row) { return row.id; }},
      {tr("State"),
       tr("State of the case: new, running, converged, failed, annotated, validated, rejected. "
          "Outdated: the run was made with other inputs or options."),
       -1,
       [](Row row) {
         return CasesModel::stateText(row.state) +
                (row.stale ? CasesModel::tr(", outdated") : QString());
       },
       [](Row row) { return static_cast<int>(row.state); }},
      {tr("Normal,\nmm"),
       tr("Error of the result along the view axis at the end effector (at the camera if that is "
          "unknown), in mm, if the truth is known."),
       3, error(&CaseRow::normal_mm)},
      {tr("Lateral,\nmm"),
       tr("Error of the result across the view axis at the end effector (at the camera if that is "
          "unknown), in mm, if the truth is known."),
       3, error(&CaseRow::lateral_mm)},
      {tr("Turned,\ndeg"),
       tr("Angle between the view axes of the result and the truth, in degrees, if the truth is "
          "known."),
       3, error(&CaseRow::rotation_deg)},
  };
}

constexpr int kThumbnail_px = 40;
constexpr int kUsualName = 20;      ///< letters
constexpr int kMeasuredRows = 100;  ///< of a list of thousands, for the widths of columns

/// A case's name with its state below it: both stay visible in a narrow list. Names of one dataset
/// begin alike and differ at their end.
class NameAndState final : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

 protected:
  void initStyleOption(QStyleOptionViewItem* option, const QModelIndex& index) const override {
    QStyledItemDelegate::initStyleOption(option, index);
    option->textElideMode = Qt::ElideMiddle;
    option->text +=
        QChar(QChar::LineSeparator) + index.siblingAtColumn(CasesModel::kState).data().toString();
  }
};

}  // namespace

CasesModel::CasesModel() : RowsModel(caseColumns()) {}

void CasesModel::setRows(std::vector<CaseRow> rows) {
  if (rows != this->rows())
    setRowsByKey(std::move(rows), [](const CaseRow& row) { return row.id; });
}

int CasesModel::rowOf(const QString& id) const {
  return firstRow([&id](const CaseRow& row) { return row.id == id; });
}

QString CasesModel::stateText(CaseState state) {
  return tr(kStateTexts[static_cast<std::size_t>(state)]);
}

QVariant CasesModel::look(const CaseRow& row, int column, int role) const {
  if (role == Qt::ToolTipRole) return tooltipOf(row);
  if (role != Qt::DecorationRole || column != kCase || row.thumbnail.isNull()) return {};
  return pictureIcon(row.thumbnail);  // drawn in the view's size
}

CasesPanel::CasesPanel() {
  filter_.setSourceModel(&model_);
  ui_.setupUi(this);
  for (int i = 0; i < kCaseStateCount; ++i)
    ui_.state->addItem(CasesModel::stateText(static_cast<CaseState>(i)));
  buildTable();
  connect(ui_.text, &QLineEdit::textChanged, this, &CasesPanel::applyFilter);
  connect(ui_.state, kIndexChanged, this, &CasesPanel::applyFilter);
  connect(ui_.run, &QPushButton::clicked, this, [this] { Q_EMIT runRequested(chosen()); });
  connect(ui_.runAll, &QPushButton::clicked, this, [this] { Q_EMIT runAllRequested(listed()); });
  showCount();
}

/// Cases whose id or station holds the text, in the state or in any.
void CasesPanel::applyFilter() {
  const int state = ui_.state->currentIndex() - 1;
  filter_.setCondition([this, state, text = ui_.text->text().trimmed()](int row) {
    const CaseRow& case_row = model_.at(row);
    return (state < 0 || case_row.state == static_cast<CaseState>(state)) &&
           (case_row.id.contains(text, Qt::CaseInsensitive) ||
            case_row.station.contains(text, Qt::CaseInsensitive));
  });
  setCurrent(current_);
}

void CasesPanel::buildTable() {
  connect(ui_.cases, &QWidget::customContextMenuRequested, this, [this](const QPoint& at) {
    const QModelIndex index = ui_.cases->indexAt(at);
    if (index.isValid())
      Q_EMIT menuRequested(index.siblingAtColumn(CasesModel::kCase).data().toString(),
                           ui_.cases->viewport()->mapToGlobal(at));
  });
  setUpTable(*ui_.cases, filter_);
  ui_.cases->horizontalHeader()->setResizeContentsPrecision(kMeasuredRows);
  ui_.cases->verticalHeader()->setDefaultSectionSize(kThumbnail_px + 4);
  ui_.cases->setItemDelegateForColumn(CasesModel::kCase, new NameAndState(ui_.cases));
  // The state is in the first column too; its own one is there to sort by.
  ui_.cases->horizontalHeader()->moveSection(CasesModel::kState, CasesModel::kRotation_deg);
  ui_.cases->sortByColumn(CasesModel::kCase, Qt::AscendingOrder);
  connect(ui_.cases->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          &CasesPanel::chooseRow);
  hint_ = new EmptyHint(*ui_.cases);
}

void CasesPanel::setRows(std::vector<CaseRow> rows) {
  const bool same_cases = std::ranges::equal(rows, model_.rows(), {}, &CaseRow::id, &CaseRow::id);
  showing_ = true;
  model_.setRows(std::move(rows));
  showing_ = false;
  if (!same_cases) fitColumns();
  setCurrent(current_);
}

void CasesPanel::setRow(int row, const CaseRow& value) {
  if (model_.at(row) == value) return;
  {
    const QScopedValueRollback<bool> showing(showing_, true);
    model_.setRow(row, value);
  }
  setCurrent(current_);
}

/// For other cases only: widths that the operator has chosen stay while these run.
void CasesPanel::fitColumns() {
  ui_.cases->resizeColumnsToContents();
  whole_case_ = ui_.cases->columnWidth(CasesModel::kCase);
  // Headers would keep room for the sign of the order in every column.
  const QFontMetrics metrics = ui_.cases->fontMetrics();
  const int error_width = 13 + std::max(metrics.horizontalAdvance(QStringLiteral("Normal,")),
                                        metrics.horizontalAdvance(QStringLiteral("-00.000")));
  for (int column = CasesModel::kNormal_mm; column <= CasesModel::kRotation_deg; ++column)
    ui_.cases->setColumnWidth(column, error_width);
  fitCaseColumn();
}

/// States are shown in full; a usual name may hide all error columns but the first, a longer one
/// none (the tooltip has it in full).
void CasesPanel::fitCaseColumn() {
  const QFontMetrics metrics = ui_.cases->fontMetrics();
  int state = 0;
  for (int i = 0; i < kCaseStateCount; ++i)
    state = std::max(state,
                     metrics.horizontalAdvance(CasesModel::stateText(static_cast<CaseState>(i))));
  // The style keeps this margin on both sides of picture and text.
  const int margin = style()->pixelMetric(QStyle::PM_FocusFrameHMargin, nullptr, ui_.cases) + 1;
  const int beside_text = kThumbnail_px + 4 * margin + 1;
  const int view = ui_.cases->width() - 2 * ui_.cases->frameWidth() -
                   style()->pixelMetric(QStyle::PM_ScrollBarExtent, nullptr, ui_.cases);
  const int error = ui_.cases->columnWidth(CasesModel::kNormal_mm);
  const int usual = beside_text + kUsualName * metrics.averageCharWidth();
  const int most = std::max({beside_text + state, std::min(view - error, usual), view - 3 * error});
  ui_.cases->setColumnWidth(CasesModel::kCase, std::min(whole_case_, most));
}

void CasesPanel::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  if (whole_case_ > 0) fitCaseColumn();
}

void CasesPanel::setCurrent(const QString& id) {
  current_ = id;
  followRow(*ui_.cases, filter_.mapFromSource(model_.index(model_.rowOf(id), 0)), showing_);
  showCount();
}

void CasesPanel::setRunnable(bool runnable) {
  runnable_ = runnable;
  showCount();
}

QStringList CasesPanel::listed() const {
  QStringList ids;
  for (int row = 0; row < filter_.rowCount(); ++row)
    ids.append(filter_.index(row, CasesModel::kCase).data().toString());
  return ids;
}

QString CasesPanel::chosen() const {
  return ui_.cases->currentIndex().siblingAtColumn(CasesModel::kCase).data().toString();
}

void CasesPanel::chooseRow(const QModelIndex& current) {
  if (showing_ || !current.isValid()) return;
  current_ = chosen();
  showCount();
  Q_EMIT openRequested(current_);
}

void CasesPanel::showCount() {
  ui_.count->setText(tr("%1 of %2").arg(filter_.rowCount()).arg(model_.rowCount()));
  hint_->setText(model_.rowCount() > 0
                     ? tr("No matching cases.")
                     : tr("No case yet. Open a session (Ctrl+O), or drop an image, a camera, a "
                          "mesh and a seed, or a dataset.json, anywhere on the window."));
  ui_.run->setEnabled(runnable_ && ui_.cases->currentIndex().isValid());
  ui_.runAll->setEnabled(runnable_ && filter_.rowCount() > 0);
}

}  // namespace boresight::ui
