// SPDX-License-Identifier: Apache-2.0
#include "ui/review/review_panel.h"

#include <algorithm>
#include <array>

#include <QtWidgets>

#include "ui/models/number_text.h"
#include "ui/panels/banner.h"
#include "ui/panels/widgets.h"
#include "ui/review/decision_form.h"
#include "ui/review/limits_dialog.h"

namespace boresight::ui {

using sessions::CheckState;
using sessions::PoseSource;

namespace {

constexpr int kShownDigits = 8;  // of a digest

int rank(CheckState state) {
  return state == CheckState::kFailed ? 0 : state == CheckState::kPassed ? 1 : 2;
}

QString shortLimit(const sessions::Check& check) {
  return fromText(sessions::limitText(check))
      .replace(QStringLiteral("at most"), QStringLiteral("≤"))
      .replace(QStringLiteral("at least"), QStringLiteral("≥"));
}

QString reasonText(const CheckRow& row) {
  if (row.check.state != CheckState::kFailed) return {};
  return row.reason.isEmpty() ? ChecksModel::tr("✎ type a reason") : row.reason;
}

std::vector<TableColumn<CheckRow>> columns() {
  using Row = const CheckRow&;
  constexpr auto tr = [](const char* text) { return ChecksModel::tr(text); };
  return {
      {tr("Check"), tr("What is asked of the pose: ✗ failed, ✓ passed, – could not be asked."), -1,
       [](Row row) {
         return ChecksModel::sign(row.check.state) + QLatin1Char(' ') + fromText(row.check.title);
       }},
      {tr("Found"), tr("What was measured, with its unit; nothing where the sentence alone tells."),
       0, [](Row row) { return fromText(sessions::foundText(row.check)); }},
      {tr("Limit"), tr("What the figure must keep to: of the preset, or as edited under Limits."),
       -1, [](Row row) { return shortLimit(row.check); }},
      {tr("Reason to pass over"),
       tr("A pose with a failed check can be validated only with a reason to pass over the check. "
          "The reason is stored with the pose, and dropped when the measured value changes."),
       -1, reasonText},
  };
}

}  // namespace

ChecksModel::ChecksModel(QObject* parent) : RowsModel(columns(), parent) {}

QString ChecksModel::sign(CheckState state) {
  return state == CheckState::kPassed   ? QStringLiteral("✓")
         : state == CheckState::kFailed ? QStringLiteral("✗")
                                        : QStringLiteral("–");
}

void ChecksModel::setRows(std::vector<CheckRow> rows, bool current) {
  std::stable_sort(rows.begin(), rows.end(), [](const CheckRow& a, const CheckRow& b) {
    return rank(a.check.state) < rank(b.check.state);
  });
  if (rows == this->rows() && current == current_) return;
  current_ = current;
  setRowsByKey(std::move(rows), [](const CheckRow& row) { return row.check.id; });
  Q_EMIT headerDataChanged(Qt::Horizontal, kCheck, kCheck);
}

QVariant ChecksModel::look(const CheckRow& row, int column, int role) const {
  const bool placeholder = column == kReason && row.reason.isEmpty();
  switch (role) {
    case Qt::EditRole:
      return column == kReason ? row.reason : valueOf(row, column);
    case Qt::ToolTipRole:
      return tr("%1: %2. %3")
          .arg(fromText(row.check.title), fromText(sessions::checkStateText(row.check.state)),
               fromText(row.check.sentence));
    case Qt::ForegroundRole:
      if (current_ && row.check.state != CheckState::kNotApplicable && !placeholder) return {};
      return QGuiApplication::palette().brush(QPalette::Disabled, QPalette::Text);
    case Qt::FontRole: {
      QFont font;
      font.setBold(row.check.state == CheckState::kFailed && column == kCheck);
      font.setItalic(placeholder);
      return font;
    }
    default:
      return {};
  }
}

bool ChecksModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::EditRole || !(flags(index) & Qt::ItemIsEditable)) return false;
  const std::string id = at(index.row()).check.id;
  Q_EMIT reasonEdited(id, value.toString());
  return true;
}

Qt::ItemFlags ChecksModel::flags(const QModelIndex& index) const {
  const Qt::ItemFlags flags = QAbstractTableModel::flags(index);
  if (!index.isValid() || index.column() != kReason || !current_) return flags;
  const bool failed = at(index.row()).check.state == CheckState::kFailed;
  return failed ? flags | Qt::ItemIsEditable : flags;
}

QString ChecksModel::countsText() const {
  if (rows().empty()) return tr("Check");
  if (!current_) return tr("Check (no longer of what is here)");
  std::array<int, 3> counts = {};
  for (const CheckRow& row : rows()) ++counts[static_cast<std::size_t>(rank(row.check.state))];
  return tr("Check: ✗ %1  ✓ %2  – %3").arg(counts[0]).arg(counts[1]).arg(counts[2]);
}

QVariant ChecksModel::headerData(int section, Qt::Orientation orientation, int role) const {
  const bool counts = orientation == Qt::Horizontal && section == kCheck;
  return counts && role == Qt::DisplayRole ? countsText()
                                           : RowsModel::headerData(section, orientation, role);
}

ReviewPanel::ReviewPanel(Document& document, ViewState& state, QWidget* parent)
    : QWidget(parent), controller_(document, state) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  column->setSpacing(4);
  column->addLayout(buildTop());
  auto* splitter = new QSplitter(Qt::Horizontal, this);
  decision_ = new DecisionForm(controller_, splitter);
  buildTable();
  splitter->addWidget(table_);
  splitter->addWidget(decision_);
  splitter->setStretchFactor(0, 1);
  splitter->setChildrenCollapsible(false);
  splitter->setSizes({640, 280});
  column->addWidget(splitter, 1);
  connect(&controller_, &ReviewController::standingChanged, this, &ReviewPanel::showStanding);
  connect(&controller_, &ReviewController::checksChanged, this, &ReviewPanel::showChecks);
  connect(&controller_, &ReviewController::basinChanged, this, &ReviewPanel::showBasin);
  connect(&model_, &ChecksModel::reasonEdited, &controller_, &ReviewController::setReason);
  showStanding();
  showChecks();
}

QHBoxLayout* ReviewPanel::buildTop() {
  auto* row = new QHBoxLayout;
  row->setSpacing(4);
  banner_ = new Banner(QStringLiteral("caseStanding"), this);
  source_ = named(new QComboBox(this), "judged");
  source_->setAccessibleName(tr("What is judged"));
  source_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  limits_ = named(new QPushButton(this), "openLimits");
  seeds_ = named(new QSpinBox(this), "basinSeeds");
  seeds_->setRange(1, 1000);
  seeds_->setValue(sessions::kBasinSeeds);
  seeds_->setToolTip(tr("How many further seeds the basin test runs from"));
  basin_ = named(new QPushButton(this), "basin");
  row->addWidget(banner_, 1);
  row->addWidget(source_);
  row->addWidget(limits_);
  row->addWidget(seeds_);
  row->addWidget(basin_);
  connect(source_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    controller_.setSource(static_cast<PoseSource>(source_->currentData().toInt()));
  });
  connect(limits_, &QPushButton::clicked, this, &ReviewPanel::openLimits);
  connect(basin_, &QPushButton::clicked, this, &ReviewPanel::askForBasin);
  return row;
}

void ReviewPanel::buildTable() {
  table_ = newTable("checks", tr("Checks"), model_, this);
  table_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::SelectedClicked |
                          QAbstractItemView::EditKeyPressed);
  table_->setMinimumHeight(4 * table_->verticalHeader()->defaultSectionSize());
  QHeaderView& header = *table_->horizontalHeader();
  header.setSectionResizeMode(QHeaderView::ResizeToContents);
  header.setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
  for (const int column : {ChecksModel::kCheck, ChecksModel::kReason})
    header.setSectionResizeMode(column, QHeaderView::Stretch);
  hint_ = new EmptyHint(*table_);
  connect(table_->selectionModel(), &QItemSelectionModel::currentChanged, this,
          &ReviewPanel::showChosen);
  connect(&model_, &QAbstractItemModel::modelReset, this, &ReviewPanel::showChosen);
}

void ReviewPanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  controller_.setActive(true);
}

void ReviewPanel::hideEvent(QHideEvent* event) {
  QWidget::hideEvent(event);
  controller_.setActive(false);
}

void ReviewPanel::showStanding() {
  const sessions::Standing standing = controller_.standing();
  banner_->showStanding(controller_.caseId().empty() ? nullptr : &standing);
  const sessions::ReviewSettings& settings = controller_.settings();
  limits_->setText(settings.limits.empty() ? tr("Limits...") : tr("Limits (edited)..."));
  const sessions::CheckPreset* preset = sessions::findCheckPreset(settings.preset);
  limits_->setToolTip(tr("What the checks are held against, and whether a second person approves. "
                         "Now: %1%2. %3")
                          .arg(fromText(settings.preset),
                               settings.limits.empty() ? QString() : tr(", edited"),
                               preset ? fromText(preset->help) : QString()));
  showSources();
}

void ReviewPanel::showSources() {
  const QSignalBlocker blocked(source_);
  source_->clear();
  if (controller_.hasRun())
    source_->addItem(tr("Run %1").arg(fromText(controller_.runDigest()).left(kShownDigits)),
                     static_cast<int>(PoseSource::kRun));
  if (controller_.hasMarks())
    source_->addItem(tr("Annotation"), static_cast<int>(PoseSource::kAnnotation));
  if (source_->count() == 0) source_->addItem(tr("No pose"));
  source_->setCurrentIndex(std::max(0, source_->findData(static_cast<int>(controller_.source()))));
  source_->setEnabled(source_->count() > 1);
  source_->setToolTip(tr("Which pose is judged: that of the last run (%1), or that of the marks")
                          .arg(fromText(controller_.runDigest())));
}

void ReviewPanel::showChecks() {
  const bool had_rows = model_.rowCount() > 0;
  std::vector<CheckRow> rows;
  for (const sessions::Check& check : controller_.checks())
    rows.push_back({check, controller_.reasonFor(check)});
  hint_->setText(controller_.problem().isEmpty() ? tr("The pose is being checked ...")
                                                 : controller_.problem());
  model_.setRows(std::move(rows), controller_.isCurrent());
  if (!had_rows && model_.rowCount() > 0) table_->setCurrentIndex(model_.index(0, 0));
  // Failed ones come first; without any there is nothing to give a reason for.
  table_->setColumnHidden(ChecksModel::kReason, model_.rowCount() > 0 && !model_.isFailed(0));
  showChosen();
  showBasin();
}

void ReviewPanel::showChosen() {
  const QModelIndex index = table_->currentIndex();
  QString html;
  if (!controller_.isCurrent() && model_.rowCount() > 0) {
    html = controller_.problem().isEmpty()
               ? tr("… Something has changed: these are the checks of what was before; they are "
                    "made anew.")
               : tr("⚠ %1").arg(controller_.problem().toHtmlEscaped());
  } else if (index.isValid() && index.row() < model_.rowCount()) {
    const sessions::Check& check = model_.at(index.row()).check;
    html = QStringLiteral("%1 <b>%2</b> %3")
               .arg(ChecksModel::sign(check.state), fromText(check.title).toHtmlEscaped(),
                    fromText(check.sentence).toHtmlEscaped());
  }
  decision_->setNote(html);
}

void ReviewPanel::showBasin() {
  const bool running = controller_.isBasinRunning();
  const sessions::BasinResult& so_far = controller_.basinSoFar();
  seeds_->setEnabled(!running);
  basin_->setText(running ? tr("Stop (%1/%2)").arg(so_far.seeds).arg(seeds_->value())
                          : tr("Basin test"));
  basin_->setEnabled(running || controller_.isCurrent());
  basin_->setToolTip(
      running ? tr("%1 of %2 seeds led back to the pose so far. What has been run counts.")
                    .arg(so_far.returned)
                    .arg(so_far.seeds)
              : tr("Run from further seeds within the declared uncertainty, and see how many lead "
                   "back to this pose. Takes as long as so many runs; it can be stopped."));
}

void ReviewPanel::askForBasin() {
  if (controller_.isBasinRunning())
    controller_.stopBasin();
  else
    controller_.startBasin(seeds_->value());
}

void ReviewPanel::openLimits() {
  auto* dialog = findChild<LimitsDialog*>();
  if (!dialog) dialog = new LimitsDialog(controller_, this);
  dialog->show();
  dialog->raise();
  dialog->activateWindow();
}

}  // namespace boresight::ui
