// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/cases_panel.h"

#include <algorithm>
#include <utility>

#include <QtWidgets>

#include "ui/panels/widgets.h"

namespace boresight::ui {
namespace {

constexpr int kThumbnail_px = 40;
constexpr int kUsualName = 20;  ///< letters

/// A case's name with its state below it: both stay in sight in a narrow list. Names of one dataset
/// begin alike and end in what tells them apart.
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

CasesPanel::CasesPanel(QWidget* parent) : QWidget(parent) {
  filter_.setSourceModel(&model_);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  auto* top = new QHBoxLayout;
  text_ = new QLineEdit(this);
  text_->setPlaceholderText(tr("Find a case"));
  text_->setClearButtonEnabled(true);
  state_ = new QComboBox(this);
  state_->setAccessibleName(tr("State"));
  state_->addItem(tr("Any state"));
  for (int i = 0; i < kCaseStateCount; ++i)
    state_->addItem(CasesModel::stateText(static_cast<CaseState>(i)));
  top->addWidget(text_, 1);
  top->addWidget(state_);
  column->addLayout(top);
  buildTable();
  column->addWidget(table_, 1);
  auto* bottom = new QHBoxLayout;
  count_ = new QLabel(this);
  run_ = named(new QPushButton(tr("Run"), this), "run",
               tr("Run the chosen case from its seed to the end."));
  run_all_ = named(new QPushButton(tr("Run all"), this), "runAll",
                   tr("Run the cases that are listed, one after the other."));
  bottom->addWidget(count_, 1);
  bottom->addWidget(run_);
  bottom->addWidget(run_all_);
  column->addLayout(bottom);
  connect(text_, &QLineEdit::textChanged, this, [this](const QString& text) {
    text_shown_ = text.trimmed();
    applyFilter();
  });
  connect(state_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this](int index) {
    state_shown_ = index > 0 ? std::optional(static_cast<CaseState>(index - 1)) : std::nullopt;
    applyFilter();
  });
  connect(run_, &QPushButton::clicked, this, [this] { Q_EMIT runRequested(chosen()); });
  connect(run_all_, &QPushButton::clicked, this, [this] { Q_EMIT runAllRequested(listed()); });
  showCount();
}

/// Cases whose id or station holds the text, in the state or in any.
void CasesPanel::applyFilter() {
  filter_.setCondition([this](int row) {
    const CaseRow& one = model_.at(row);
    return (!state_shown_ || one.state == *state_shown_) &&
           (one.id.contains(text_shown_, Qt::CaseInsensitive) ||
            one.station.contains(text_shown_, Qt::CaseInsensitive));
  });
  setCurrent(current_);
}

void CasesPanel::buildTable() {
  table_ = newTable("cases", tr("Cases"), filter_, this);
  table_->setIconSize({kThumbnail_px, kThumbnail_px});
  table_->verticalHeader()->setDefaultSectionSize(kThumbnail_px + 4);
  table_->setItemDelegateForColumn(CasesModel::kCase, new NameAndState(table_));
  // The state is in the first column too; its own one is there to sort by.
  table_->horizontalHeader()->moveSection(CasesModel::kState, CasesModel::kRotation_deg);
  table_->setSortingEnabled(true);
  table_->sortByColumn(CasesModel::kCase, Qt::AscendingOrder);
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          &CasesPanel::chooseRow);
  hint_ = new EmptyHint(*table_);
}

void CasesPanel::setRows(std::vector<CaseRow> rows) {
  showing_ = true;
  model_.setRows(std::move(rows));
  showing_ = false;
  table_->resizeColumnsToContents();
  whole_case_ = table_->columnWidth(CasesModel::kCase);
  // Headers would keep room for the sign of the order in every column.
  const QFontMetrics metrics = table_->fontMetrics();
  for (const int error :
       {CasesModel::kNormal_mm, CasesModel::kLateral_mm, CasesModel::kRotation_deg})
    table_->setColumnWidth(error, std::max(metrics.horizontalAdvance(QStringLiteral("Normal,")),
                                           metrics.horizontalAdvance(QStringLiteral("-00.000"))) +
                                      8);
  fitCaseColumn();
  setCurrent(current_);
}

/// States are told whole; a usual name may push all errors but the first out of sight, a longer one
/// none (the tooltip has it whole).
void CasesPanel::fitCaseColumn() {
  const QFontMetrics metrics = table_->fontMetrics();
  int state = 0;
  for (int i = 0; i < kCaseStateCount; ++i)
    state = std::max(state,
                     metrics.horizontalAdvance(CasesModel::stateText(static_cast<CaseState>(i))));
  // The style keeps this margin on both sides of picture and text.
  const int margin = style()->pixelMetric(QStyle::PM_FocusFrameHMargin, nullptr, table_) + 1;
  const int beside_text = kThumbnail_px + 4 * margin + 1;
  const int view = table_->width() - 2 * table_->frameWidth() -
                   style()->pixelMetric(QStyle::PM_ScrollBarExtent, nullptr, table_);
  const int error = table_->columnWidth(CasesModel::kNormal_mm);
  const int usual = beside_text + kUsualName * metrics.averageCharWidth();
  const int most = std::max({beside_text + state, std::min(view - error, usual), view - 3 * error});
  table_->setColumnWidth(CasesModel::kCase, std::min(whole_case_, most));
}

void CasesPanel::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  if (whole_case_ > 0) fitCaseColumn();
}

void CasesPanel::setCurrent(const QString& id) {
  current_ = id;
  showing_ = true;
  const QModelIndex row = filter_.mapFromSource(model_.index(model_.rowOf(id), 0));
  table_->setCurrentIndex(row);
  if (row.isValid()) table_->scrollTo(row);
  showing_ = false;
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
  return table_->currentIndex().siblingAtColumn(CasesModel::kCase).data().toString();
}

void CasesPanel::chooseRow(const QModelIndex& current) {
  if (showing_ || !current.isValid()) return;
  current_ = chosen();
  showCount();
  Q_EMIT openRequested(current_);
}

void CasesPanel::showCount() {
  count_->setText(tr("%1 of %2").arg(filter_.rowCount()).arg(model_.rowCount()));
  hint_->setText(model_.rowCount() > 0
                     ? tr("No case is called so, or is in this state.")
                     : tr("No case yet. Open a session (Ctrl+O), or drop an image, a camera, a "
                          "mesh and a seed, or a dataset.json, anywhere on the window."));
  run_->setEnabled(runnable_ && table_->currentIndex().isValid());
  run_all_->setEnabled(runnable_ && filter_.rowCount() > 0);
}

}  // namespace boresight::ui
