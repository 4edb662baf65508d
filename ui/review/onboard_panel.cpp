// SPDX-License-Identifier: Apache-2.0
#include "ui/review/onboard_panel.h"

#include <QtWidgets>

#include "ui/models/rows_model.h"
#include "ui/run/run_controller.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

using sessions::IterationComparison;
using sessions::RunVerdict;

/// "78 of 80 (98 %)"; a dash where there is nothing to count.
QString shareText(int part, int whole) {
  if (whole == 0) return QStringLiteral("–");
  return OnboardPanel::tr("%1 of %2 (%3 %)")
      .arg(part)
      .arg(whole)
      .arg(numberText(100.0 * part / whole, 0));
}

QString signOf(const sessions::RecordComparison& comparison) {
  return comparison.verdict == RunVerdict::kEqual       ? QStringLiteral("✓ ")
         : comparison.showsAgreement()                  ? QStringLiteral("≈ ")
         : comparison.verdict == RunVerdict::kDifferent ? QStringLiteral("✗ ")
                                                        : QStringLiteral("– ");
}

}  // namespace

OnboardPanel::OnboardPanel(OnboardController& onboard, ViewState& state, RunController& run)
    : onboard_(onboard), state_(state), run_(run) {
  ui_.setupUi(this);
  ui_.halves->setStretchFactor(0, 2);
  ui_.halves->setStretchFactor(1, 3);
  styleTable(*ui_.comparison);
  ui_.verdict->setFont(boldFont(font()));
  connect(ui_.showOnboard, &QPushButton::clicked, &onboard_, &OnboardController::showOnboard);
  connect(ui_.showGround, &QPushButton::clicked, &onboard_, &OnboardController::showGround);
  connect(ui_.rerunOnGround, &QPushButton::clicked, &onboard_, &OnboardController::rerun);
  connect(ui_.loadRecord, &QPushButton::clicked, this,
          [this] { askForOnboardRecord(onboard_, this); });
  connect(ui_.removeRecord, &QPushButton::clicked, &onboard_, &OnboardController::detach);
  connect(ui_.firstDifference, &QLabel::linkActivated, &onboard_,
          &OnboardController::goToFirstDifference);
  connect(ui_.comparison, &QTableWidget::cellActivated, this, [this](int row, int) {
    if (state_.snapshot() && row < static_cast<int>(state_.snapshot()->iterations.size()))
      state_.setCursor({row, Stage::kFinished});
  });
  connect(&onboard_, &OnboardController::changed, this, &OnboardPanel::update);
  connect(&run_, &RunController::stateChanged, this, &OnboardPanel::updateButtons);
  update();
}

void OnboardPanel::update() {
  updateButtons();
  showRecord();
  showComparison();
}

void OnboardPanel::updateButtons() {
  const bool has = onboard_.review() != nullptr;
  const bool onboard = onboard_.showsOnboard();
  const bool idle = run_.state() != RunState::kWorking;
  ui_.showOnboard->setEnabled(has && !onboard && idle);
  ui_.showGround->setEnabled(onboard && idle);
  ui_.rerunOnGround->setEnabled(has && idle && onboard_.review()->plan.has_options);
  ui_.loadRecord->setEnabled(state_.currentCase() != nullptr);
  ui_.removeRecord->setEnabled(!onboard_.file().empty());
  using Tone = Banner::Tone;
  if (onboard)
    ui_.shownRun->setMessage(QStringLiteral("▲"), tr("ONBOARD run in every view, replayed"),
                             Tone::kBad);
  else if (state_.snapshot())
    ui_.shownRun->setMessage(QStringLiteral("▼"), tr("Ground run in every view"), Tone::kPlain);
  else
    ui_.shownRun->setMessage({}, tr("No run is shown."), Tone::kPlain);
}

void OnboardPanel::showRecord() {
  const std::filesystem::path file = onboard_.file();
  ui_.recordRemarks->clear();
  if (file.empty()) {
    ui_.recordSheet->setText(
        state_.currentCase()
            ? tr("No onboard record is attached to this case. Drop one (.whsr) on the "
                 "window, or load it.")
            : tr("No case is open."));
    return;
  }
  if (!onboard_.review()) {
    ui_.recordSheet->setText(onboard_.problem().isEmpty() ? tr("Reading the record ...")
                                                          : onboard_.problem().toHtmlEscaped());
    return;
  }
  QVector<QStringList> rows = {{tr("File"), fromText(file.filename().string()).toHtmlEscaped()}};
  for (const auto& [label, value] : sessions::recordSheet(onboard_.review()->record))
    rows.append({fromText(label).toHtmlEscaped(),
                 fromText(value).replace(QLatin1Char('_'), QLatin1Char(' ')).toHtmlEscaped()});
  ui_.recordSheet->setText(htmlTable(rows));
  QString whole = QString::fromStdString(file.string());
  if (const auto& end = onboard_.review()->record.end)
    whole += QLatin1Char('\n') + tr("Digest %1").arg(fromText(end->digest));
  ui_.recordSheet->setToolTip(whole);
  QStringList remarks;
  for (const std::string& text : onboard_.review()->replay->remarks)
    remarks << QStringLiteral("• ") + fromText(text);
  ui_.recordRemarks->setText(remarks.join(QLatin1Char('\n')));
}

void OnboardPanel::showComparison() {
  const OnboardController::ComparisonPtr& found = onboard_.comparison();
  showTable(found.get());
  ui_.limits->setVisible(found && found->verdict != RunVerdict::kEqual);
  ui_.firstDifference->setVisible(found && found->verdict != RunVerdict::kEqual);
  if (!found) {
    ui_.verdict->setText(onboard_.whyNotCompared());
    return;
  }
  ui_.verdict->setText(signOf(*found) + fromText(sessions::verdictText(*found)));
  QString text;
  if (found->first) {
    const QString part = QString::fromLatin1(sessions::runPartText(found->first->part));
    const QString sentence =
        tr("First difference, in the %1: %2").arg(part, fromText(found->first->text));
    text = found->first->iteration >= 0
               ? QStringLiteral("<a href='first'>%1</a>").arg(sentence.toHtmlEscaped())
               : sentence.toHtmlEscaped();
  }
  for (const std::string& beyond : found->beyond)
    text +=
        QStringLiteral("<br>") + tr("Beyond the limits: %1").arg(fromText(beyond)).toHtmlEscaped();
  for (const std::string& missing : found->missing)
    text += QStringLiteral("<br>") + tr("Missing, %1").arg(fromText(missing)).toHtmlEscaped();
  ui_.firstDifference->setText(text);
  ui_.limits->setText(fromText(sessions::limitsText({})));
}

void OnboardPanel::showTable(const sessions::RecordComparison* comparison) {
  ui_.comparison->setVisible(comparison != nullptr);
  ui_.comparison->setRowCount(0);
  if (comparison == nullptr) return;
  for (const IterationComparison& each : comparison->iterations)
    addRow(*ui_.comparison,
           {QString::number(each.index + 1), shareText(each.found_alike, each.templates),
            shareText(each.inliers_both, each.inliers_either), numberText(each.translation_mm, 4),
            numberText(each.rotation_mrad, 4)});
  const QString sigmas = comparison->pose_sigmas
                             ? tr("%1 sigmas").arg(numberText(*comparison->pose_sigmas, 2))
                             : QStringLiteral("–");
  if (comparison->ends_compared)
    addRow(*ui_.comparison,
           {tr("Final"), sigmas, QString(), numberText(comparison->translation_mm, 4),
            numberText(comparison->rotation_mrad, 4)});
  ui_.comparison->resizeColumnsToContents();
}

void askForOnboardRecord(OnboardController& onboard, QWidget* parent) {
  const CaseOpening seen = onboard.opening();
  const QString file =
      QFileDialog::getOpenFileName(parent, OnboardPanel::tr("Load an onboard record"), {},
                                   OnboardPanel::tr("Onboard records (*.whsr);;All files (*)"));
  if (file.isEmpty()) return;
  if (seen == onboard.opening())
    onboard.attach(file.toStdString());
  else
    Q_EMIT onboard.failed(leftText(seen));
}

}  // namespace boresight::ui
