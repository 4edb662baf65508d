// SPDX-License-Identifier: Apache-2.0
#include "ui/review/review_panel.h"

#include <algorithm>
#include <array>
#include <utility>

#include <QtWidgets>

#include "sessions/checks/pose_quality.h"
#include "sessions/decision/check_limits.h"
#include "ui/models/text.h"
#include "ui/panels/case/cases_panel.h"
#include "ui/review/check_cards.h"
#include "ui/state/document.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

using sessions::CheckState;
using sessions::PoseSource;

namespace {

constexpr int kChecksColumns_px = 560;  // width of the panel from which all columns fit

int rank(CheckState state) {
  return state == CheckState::kFailed ? 0 : state == CheckState::kPassed ? 1 : 2;
}

/// In a side pane the limit is shown next to the figure found.
class FoundCell final : public QStyledItemDelegate {
 public:
  FoundCell(const ChecksModel& model, QTableView& view)
      : QStyledItemDelegate(&view), model_(model), view_(view) {}

 protected:
  void initStyleOption(QStyleOptionViewItem* option, const QModelIndex& index) const override {
    QStyledItemDelegate::initStyleOption(option, index);
    if (view_.isColumnHidden(ChecksModel::kLimit))
      option->text = foundAndLimit(model_.at(index.row()));
  }

 private:
  const ChecksModel& model_;
  const QTableView& view_;
};

std::vector<TableColumn<sessions::Check>> columns() {
  using Row = const sessions::Check&;
  constexpr auto tr = [](const char* text) { return ChecksModel::tr(text); };
  return {
      {tr("Check"), tr("Check of the pose: ✗ failed, ✓ passed, – not applicable."), -1,
       [](Row row) {
         return ChecksModel::sign(row.state) + QLatin1Char(' ') + fromText(row.title);
       }},
      {tr("Found"), tr("Measured value with its unit; empty if the check has no figure."), 0,
       [](Row row) { return fromText(sessions::foundText(row)); }},
      {tr("Limit"), tr("Limit of the measured value, from the preset or as edited under Limits."),
       -1, [](Row row) { return shortLimit(row); }},
  };
}

/// Whether a decision that was relied on no longer holds, or is outdated.
bool isUnreliable(const sessions::ReviewStatus& status) {
  return !status.dropped.empty() || !status.outdated.empty();
}

/// A tick next to "NOT VALIDATED" would be read as a yes: a pose that converged or was annotated,
/// but is not validated, has an open circle here.
QString signOf(const sessions::ReviewStatus& status) {
  using sessions::ReviewState;
  if (isUnreliable(status)) return QStringLiteral("⚠");
  const bool open =
      status.state == ReviewState::kConverged || status.state == ReviewState::kAnnotated;
  return CasesModel::stateText(open ? CaseState::kNew : caseStateOf(status.state)).left(1);
}

Banner::Tone toneOf(const sessions::ReviewStatus& status) {
  using sessions::ReviewState;
  if (status.state == ReviewState::kFailed || status.state == ReviewState::kRejected ||
      isUnreliable(status))
    return Banner::Tone::kBad;
  return status.state == ReviewState::kValidated ? Banner::Tone::kGood : Banner::Tone::kPlain;
}

}  // namespace

LimitsDialog::LimitsDialog(ReviewController& controller, QWidget* parent)
    : QDialog(parent), controller_(controller) {
  ui_.setupUi(this);
  setObjectName(QStringLiteral("limitsDialog"));
  for (const sessions::CheckPreset& preset : sessions::checkPresets()) {
    ui_.preset->addItem(fromText(preset.name));
    ui_.preset->setItemData(ui_.preset->count() - 1, fromText(preset.help), Qt::ToolTipRole);
  }
  ui_.limits->describeIn(*ui_.limitHelp, tr("Select a limit to read its description."));
  // A refused edit shows the session's settings again.
  connect(ui_.preset, &QComboBox::textActivated, this, [this](const QString& preset) {
    controller_.setPreset(preset);
    showSettings();
  });
  connect(ui_.secondPerson, &QCheckBox::clicked, this, [this](bool asked) {
    controller_.setSecondPerson(asked);
    showSettings();
  });
  connect(ui_.resetAll, &QPushButton::clicked, this, [this] {
    if (const auto* preset = sessions::findCheckPreset(controller_.settings().preset))
      controller_.setLimits(preset->limits);
  });
  connect(ui_.close, &QPushButton::clicked, this, &QDialog::close);
  connect(&ui_.limits->options(), &OptionsModel::edited, this, &LimitsDialog::change);
  connect(&controller_, &ReviewController::reviewStatusChanged, this, &LimitsDialog::showSettings);
  showSettings();
  resize(640, 460);
}

void LimitsDialog::change(const std::string& name, const std::string& value) {
  const sessions::ReviewSettings& settings = controller_.settings();
  sessions::CheckLimits changed = sessions::checkLimits(settings.preset, settings.limits);
  if (ui_.limits->apply(changed, name, value)) controller_.setLimits(changed);
}

void LimitsDialog::showSettings() {
  const sessions::ReviewSettings& settings = controller_.settings();
  const sessions::CheckPreset* preset = sessions::findCheckPreset(settings.preset);
  if (preset == nullptr) return;
  ui_.limits->setOptions(
      sessions::listOptions(sessions::checkLimits(settings.preset, settings.limits)),
      sessions::listOptions(preset->limits));
  ui_.preset->setCurrentText(fromText(preset->name));
  ui_.preset->setToolTip(fromText(preset->help));
  ui_.presetHelp->setText(fromText(preset->help));
  ui_.secondPerson->setChecked(settings.second_person);
  ui_.resetAll->setEnabled(!settings.limits.empty());
}

ChecksModel::ChecksModel() : RowsModel(columns()) {}

QString ChecksModel::sign(CheckState state) {
  return state == CheckState::kPassed   ? QStringLiteral("✓")
         : state == CheckState::kFailed ? QStringLiteral("✗")
                                        : QStringLiteral("–");
}

void ChecksModel::setChecks(std::vector<sessions::Check> checks, bool current) {
  std::ranges::stable_sort(checks, {}, [](const auto& check) { return rank(check.state); });
  if (checks == rows() && current == current_) return;
  current_ = current;
  setRowsByKey(std::move(checks), &sessions::Check::id);
}

QVariant ChecksModel::look(const sessions::Check& row, int /*column*/, int role) const {
  if (role == Qt::ToolTipRole)
    return tr("%1: %2. %3")
        .arg(fromText(row.title), fromText(sessions::checkStateText(row.state)),
             fromText(row.sentence));
  const bool pale = !current_ || row.state == CheckState::kNotApplicable;
  return role == Qt::ForegroundRole && pale
             ? QGuiApplication::palette().brush(QPalette::Disabled, QPalette::Text)
             : QVariant();
}

ReviewPanel::ReviewPanel(Document& document, ViewState& state) : controller_(document, state) {
  ui_.setupUi(this);
  decision_ = new DecisionForm(controller_);
  connect(&document, &Document::left, decision_, &DecisionForm::forgetName);
  ui_.splitter->addWidget(decision_);
  ui_.splitter->setStretchFactor(0, 1);
  ui_.splitter->setSizes({600, 200});
  ui_.convergenceSeeds->setValue(sessions::kConvergenceSeeds);
  buildTable();
  for (FoldButton* fold : {ui_.passedFold, ui_.notApplicableFold}) {
    fold->restore(true);
    connect(fold, &FoldButton::foldedChanged, this, [this] {
      showFolds();
      showChosen();
    });
  }
  connect(ui_.judged, QOverload<int>::of(&QComboBox::activated), this, [this] {
    controller_.setSource(static_cast<PoseSource>(ui_.judged->currentData().toInt()));
  });
  connect(ui_.openLimits, &QPushButton::clicked, this, &ReviewPanel::openLimits);
  connect(ui_.convergence, &QPushButton::clicked, this, [this] {
    if (controller_.isConvergenceTestRunning())
      controller_.stopConvergenceTest();
    else
      controller_.startConvergenceTest(ui_.convergenceSeeds->value());
  });
  connect(&controller_, &ReviewController::reviewStatusChanged, this,
          &ReviewPanel::showReviewStatus);
  connect(&controller_, &ReviewController::checksChanged, this, &ReviewPanel::showChecks);
  connect(&controller_, &ReviewController::convergenceChanged, this, &ReviewPanel::showConvergence);
  connect(ui_.failed, &CheckCards::reasonEdited, &controller_, &ReviewController::setReason);
  connect(ui_.failed, &CheckCards::showRequested, this, &ReviewPanel::checkShowRequested);
  showReviewStatus();
  showChecks();
}

void ReviewPanel::buildTable() {
  setUpTable(*ui_.checks, model_);
  QHeaderView& header = *ui_.checks->horizontalHeader();
  header.setSectionResizeMode(QHeaderView::ResizeToContents);
  header.setSectionResizeMode(ChecksModel::kCheck, QHeaderView::Stretch);
  // Long names take a second line.
  ui_.checks->setWordWrap(true);
  ui_.checks->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  ui_.checks->setItemDelegateForColumn(ChecksModel::kFound, new FoundCell(model_, *ui_.checks));
  connect(ui_.checks->selectionModel(), &QItemSelectionModel::currentChanged, this,
          &ReviewPanel::showChosen);
  connect(&model_, &QAbstractItemModel::modelReset, this, &ReviewPanel::showChosen);
}

void ReviewPanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  controller_.setInSight(true);
}

void ReviewPanel::hideEvent(QHideEvent* event) {
  QWidget::hideEvent(event);
  controller_.setInSight(false);
}

void ReviewPanel::showReviewStatus() {
  const sessions::ReviewStatus status = controller_.reviewStatus();
  QString text = fromText(sessions::reviewStatusText(status));
  if (!text.isEmpty()) text[0] = text[0].toUpper();
  if (controller_.caseId().empty())
    ui_.caseReviewStatus->setMessage({}, tr("No case is shown."), Banner::Tone::kPlain);
  else
    ui_.caseReviewStatus->setMessage(signOf(status), text, toneOf(status));
  const sessions::ReviewSettings& settings = controller_.settings();
  ui_.openLimits->setText(settings.limits.empty() ? tr("Limits...") : tr("Limits (edited)..."));
  const sessions::CheckPreset* preset = sessions::findCheckPreset(settings.preset);
  ui_.openLimits->setToolTip(
      tr("Limits of the checks, and whether a second person must approve. Current: %1%2. %3")
          .arg(fromText(settings.preset), settings.limits.empty() ? QString() : tr(", edited"),
               preset ? fromText(preset->help) : QString()));
  showSources();
}

void ReviewPanel::showSources() {
  const QSignalBlocker blocked(ui_.judged);
  const std::array<bool, 2> sources = {controller_.hasRun(), controller_.hasAnnotations()};
  if (sources != sources_) {  // a list that is open stays
    sources_ = sources;
    ui_.judged->clear();
    if (sources[0]) ui_.judged->addItem(tr("Last run"), static_cast<int>(PoseSource::kRun));
    if (sources[1])
      ui_.judged->addItem(tr("Annotation"), static_cast<int>(PoseSource::kAnnotation));
    if (ui_.judged->count() == 0) ui_.judged->addItem(tr("No pose"));
  }
  ui_.judged->setCurrentIndex(
      std::max(0, ui_.judged->findData(static_cast<int>(controller_.source()))));
  ui_.judged->setEnabled(ui_.judged->count() > 1);
  ui_.judged->setToolTip(tr("Judged pose: that of the last run (%1), or that of the annotations")
                             .arg(fromText(controller_.runDigest())));
}

void ReviewPanel::showChecks() {
  std::vector<FailedCheck> failed;
  for (const sessions::Check& check : controller_.checks())
    if (check.state == CheckState::kFailed) failed.push_back({check, controller_.reasonFor(check)});
  ui_.failed->setChecks(failed, controller_.isCurrent());
  // Where none failed, the measure leads.
  ui_.precision->setChecks(failed.empty() ? controller_.checks() : std::vector<sessions::Check>());
  model_.setChecks(controller_.checks(), controller_.isCurrent());
  const QString& problem = controller_.problem();
  ui_.emptyHint->setText(!problem.isEmpty() ? problem
                         : model_.rowCount() == 0
                             ? tr("The pose is being checked ...")
                             : tr("Inputs have changed: the checks are out of date and run "
                                  "again."));
  ui_.emptyHint->setVisible(!controller_.isCurrent());
  showFolds();
  showChosen();
  showConvergence();
}

/// Failed checks are cards.
void ReviewPanel::showFolds() {
  std::array<int, 3> counts = {};
  const std::array<const FoldButton*, 3> folds = {nullptr, ui_.passedFold, ui_.notApplicableFold};
  bool any = false;
  for (int row = 0; row < model_.rowCount(); ++row) {
    const auto kind = static_cast<std::size_t>(rank(model_.at(row).state));
    const bool shown = folds[kind] && !folds[kind]->isFolded();
    ++counts[kind];
    any |= shown;
    ui_.checks->setRowHidden(row, !shown);
  }
  ui_.checks->setVisible(any);
  ui_.passedFold->setContent(counts[1] > 0 ? tr("%1 passed").arg(counts[1]) : QString());
  ui_.notApplicableFold->setContent(counts[2] > 0 ? tr("%1 not applicable").arg(counts[2])
                                                  : QString());
}

void ReviewPanel::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  ui_.checks->setColumnHidden(ChecksModel::kLimit, width() < kChecksColumns_px);
}

/// The sentence of the selected row.
void ReviewPanel::showChosen() {
  const QModelIndex index = ui_.checks->currentIndex();
  const bool shown = ui_.checks->isVisibleTo(this) && index.isValid() &&
                     index.row() < model_.rowCount() && !ui_.checks->isRowHidden(index.row());
  ui_.chosen->setVisible(shown);
  if (shown) ui_.chosen->setText(fromText(model_.at(index.row()).sentence));
}

void ReviewPanel::showConvergence() {
  const bool running = controller_.isConvergenceTestRunning();
  const sessions::ConvergenceResult& so_far = controller_.convergenceSoFar();
  ui_.convergenceSeeds->setEnabled(!running);
  ui_.convergence->setText(
      running ? tr("Stop (%1/%2)").arg(so_far.seeds).arg(ui_.convergenceSeeds->value())
              : tr("Convergence test"));
  ui_.convergence->setEnabled(running || controller_.isCurrent());
  ui_.convergence->setToolTip(
      running ? tr("%1 of %2 seeds returned to the pose so far. A stopped test counts, too.")
                    .arg(so_far.returned)
                    .arg(so_far.seeds)
              : tr("Runs from further seeds within the declared uncertainty and counts those that "
                   "return to this pose. Takes one run per seed; can be stopped."));
}

void ReviewPanel::openLimits() {
  auto* dialog = findChild<LimitsDialog*>();
  if (!dialog) dialog = new LimitsDialog(controller_, this);
  dialog->show();
  dialog->raise();
  dialog->activateWindow();
}

}  // namespace boresight::ui
