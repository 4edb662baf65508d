// SPDX-License-Identifier: Apache-2.0
#include "ui/review/review_panel.h"

#include <algorithm>
#include <array>

#include <QtWidgets>

#include "ui_review_panel.h"

#include "ui/models/number_text.h"
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
    : QWidget(parent), controller_(document, state), ui_(std::make_unique<Ui::ReviewPanel>()) {
  ui_->setupUi(this);
  decision_ = new DecisionForm(controller_);
  ui_->splitter->addWidget(decision_);
  ui_->splitter->setStretchFactor(0, 1);
  ui_->splitter->setSizes({640, 280});
  ui_->basinSeeds->setValue(sessions::kBasinSeeds);
  buildTable();
  connect(ui_->judged, QOverload<int>::of(&QComboBox::activated), this, [this] {
    controller_.setSource(static_cast<PoseSource>(ui_->judged->currentData().toInt()));
  });
  connect(ui_->openLimits, &QPushButton::clicked, this, &ReviewPanel::openLimits);
  connect(ui_->basin, &QPushButton::clicked, this, &ReviewPanel::askForBasin);
  connect(&controller_, &ReviewController::reviewStatusChanged, this,
          &ReviewPanel::showReviewStatus);
  connect(&controller_, &ReviewController::checksChanged, this, &ReviewPanel::showChecks);
  connect(&controller_, &ReviewController::basinChanged, this, &ReviewPanel::showBasin);
  connect(&model_, &ChecksModel::reasonEdited, &controller_, &ReviewController::setReason);
  showReviewStatus();
  showChecks();
}

ReviewPanel::~ReviewPanel() = default;

QTableView& ReviewPanel::table() { return *ui_->checks; }

void ReviewPanel::buildTable() {
  setUpTable(*ui_->checks, model_);
  ui_->checks->setEditTriggers(QAbstractItemView::DoubleClicked |
                               QAbstractItemView::SelectedClicked |
                               QAbstractItemView::EditKeyPressed);
  ui_->checks->setMinimumHeight(4 * ui_->checks->verticalHeader()->defaultSectionSize());
  QHeaderView& header = *ui_->checks->horizontalHeader();
  header.setSectionResizeMode(QHeaderView::ResizeToContents);
  header.setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
  for (const int column : {ChecksModel::kCheck, ChecksModel::kReason})
    header.setSectionResizeMode(column, QHeaderView::Stretch);
  hint_ = new EmptyHint(*ui_->checks);
  connect(ui_->checks->selectionModel(), &QItemSelectionModel::currentChanged, this,
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

void ReviewPanel::showReviewStatus() {
  const sessions::ReviewStatus status = controller_.reviewStatus();
  ui_->caseReviewStatus->showReviewStatus(controller_.caseId().empty() ? nullptr : &status);
  const sessions::ReviewSettings& settings = controller_.settings();
  ui_->openLimits->setText(settings.limits.empty() ? tr("Limits...") : tr("Limits (edited)..."));
  const sessions::CheckPreset* preset = sessions::findCheckPreset(settings.preset);
  ui_->openLimits->setToolTip(
      tr("What the checks are held against, and whether a second person approves. "
         "Now: %1%2. %3")
          .arg(fromText(settings.preset), settings.limits.empty() ? QString() : tr(", edited"),
               preset ? fromText(preset->help) : QString()));
  showSources();
}

void ReviewPanel::showSources() {
  const QSignalBlocker blocked(ui_->judged);
  ui_->judged->clear();
  if (controller_.hasRun())
    ui_->judged->addItem(tr("Run %1").arg(fromText(controller_.runDigest()).left(kShownDigits)),
                         static_cast<int>(PoseSource::kRun));
  if (controller_.hasMarks())
    ui_->judged->addItem(tr("Annotation"), static_cast<int>(PoseSource::kAnnotation));
  if (ui_->judged->count() == 0) ui_->judged->addItem(tr("No pose"));
  ui_->judged->setCurrentIndex(
      std::max(0, ui_->judged->findData(static_cast<int>(controller_.source()))));
  ui_->judged->setEnabled(ui_->judged->count() > 1);
  ui_->judged->setToolTip(
      tr("Which pose is judged: that of the last run (%1), or that of the marks")
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
  if (!had_rows && model_.rowCount() > 0) ui_->checks->setCurrentIndex(model_.index(0, 0));
  // Failed ones come first; without any there is nothing to give a reason for.
  ui_->checks->setColumnHidden(ChecksModel::kReason, model_.rowCount() > 0 && !model_.isFailed(0));
  showChosen();
  showBasin();
}

void ReviewPanel::showChosen() {
  const QModelIndex index = ui_->checks->currentIndex();
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
  ui_->basinSeeds->setEnabled(!running);
  ui_->basin->setText(running ? tr("Stop (%1/%2)").arg(so_far.seeds).arg(ui_->basinSeeds->value())
                              : tr("Basin test"));
  ui_->basin->setEnabled(running || controller_.isCurrent());
  ui_->basin->setToolTip(
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
    controller_.startBasin(ui_->basinSeeds->value());
}

void ReviewPanel::openLimits() {
  auto* dialog = findChild<LimitsDialog*>();
  if (!dialog) dialog = new LimitsDialog(controller_, this);
  dialog->show();
  dialog->raise();
  dialog->activateWindow();
}

}  // namespace boresight::ui
