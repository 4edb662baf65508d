// SPDX-License-Identifier: Apache-2.0
#include "ui/review/onboard_panel.h"

#include <QtWidgets>

#include "ui/models/number_text.h"
#include "ui/panels/widgets.h"
#include "ui/plots/plot_colors.h"
#include "ui/run/run_controller.h"

namespace boresight::ui {
namespace {

using sessions::IterationComparison;
using sessions::RunVerdict;

constexpr int kShownWidth_px = 120;  // the least; it has as many lines as it takes

enum Column { kIteration, kAlike, kInliers, kTranslation, kRotation, kColumns };

QLabel* wrapped(const char* name, QWidget* parent) {
  auto* made = named(new QLabel(parent), name);
  made->setWordWrap(true);
  made->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  made->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  return made;
}

/// "78 of 80 (98 %)"; a dash where there is nothing to count.
QString shareText(int part, int whole) {
  if (whole == 0) return QStringLiteral("–");
  return OnboardPanel::tr("%1 of %2 (%3 %)")
      .arg(part)
      .arg(whole)
      .arg(numberText(100.0 * part / whole, 0));
}

QString signOf(const sessions::RecordComparison& comparison) {
  return comparison.verdict == RunVerdict::kEqual          ? QStringLiteral("✓ ")
         : comparison.verdict == RunVerdict::kWithinLimits ? QStringLiteral("≈ ")
                                                           : QStringLiteral("✗ ");
}

}  // namespace

OnboardPanel::OnboardPanel(OnboardController& onboard, ViewState& state, RunController& run,
                           QWidget* parent)
    : QWidget(parent), onboard_(onboard), state_(state), run_(run) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  column->addWidget(buildButtons());
  auto* halves = new QSplitter(Qt::Horizontal, this);
  halves->setChildrenCollapsible(false);
  halves->addWidget(buildRecord());
  halves->addWidget(buildComparison());
  halves->setStretchFactor(0, 2);
  halves->setStretchFactor(1, 3);
  column->addWidget(halves, 1);
  connect(&onboard_, &OnboardController::changed, this, &OnboardPanel::update);
  connect(&run_, &RunController::stateChanged, this, &OnboardPanel::updateButtons);
  update();
}

QWidget* OnboardPanel::buildButtons() {
  banner_ = new QFrame(this);
  banner_->setFrameShape(QFrame::StyledPanel);
  banner_->setAutoFillBackground(true);
  auto* row = new QHBoxLayout(banner_);
  row->setContentsMargins(8, 3, 4, 3);
  const auto button = [this](const char* name, const QString& text, const QString& tip) {
    return named(new QPushButton(text, this), name, tip);
  };
  shown_ = named(new QLabel(banner_), "shownRun");
  shown_->setWordWrap(true);
  shown_->setMinimumWidth(kShownWidth_px);
  show_onboard_ = button("showOnboard", tr("Show onboard"),
                         tr("Every view shows the run as its record has it"));
  show_ground_ =
      button("showGround", tr("Show ground"), tr("Every view shows the run on the ground"));
  rerun_ = button("rerunOnGround", tr("Re-run"),
                  tr("Run the case here by the options of the record; the run is stored"));
  load_ = button("loadRecord", tr("Load..."),
                 tr("Attach the onboard record of this case (.whsr); it can be dropped on the "
                    "window, too"));
  remove_ = button("removeRecord", tr("Remove"),
                   tr("Take the record from the case; its file stays where it is"));
  row->addWidget(shown_, 1);
  for (QPushButton* each : {show_onboard_, show_ground_, rerun_, load_, remove_})
    row->addWidget(each);
  connect(show_onboard_, &QPushButton::clicked, &onboard_, &OnboardController::showOnboard);
  connect(show_ground_, &QPushButton::clicked, &onboard_, &OnboardController::showGround);
  connect(rerun_, &QPushButton::clicked, &onboard_, &OnboardController::rerun);
  connect(load_, &QPushButton::clicked, this, [this] { askForOnboardRecord(onboard_, this); });
  connect(remove_, &QPushButton::clicked, &onboard_, &OnboardController::detach);
  return banner_;
}

QWidget* OnboardPanel::buildRecord() {
  auto* content = new QWidget;
  auto* column = new QVBoxLayout(content);
  column->setContentsMargins(6, 4, 6, 4);
  sheet_ = wrapped("recordSheet", content);
  sheet_->setTextFormat(Qt::RichText);
  remarks_ = wrapped("recordRemarks", content);
  remarks_->setTextFormat(Qt::PlainText);
  column->addWidget(sheet_);
  column->addWidget(remarks_);
  column->addStretch(1);
  auto* scroll = new QScrollArea(this);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setWidget(content);
  return scroll;
}

QWidget* OnboardPanel::buildComparison() {
  auto* content = new QWidget(this);
  auto* column = new QVBoxLayout(content);
  column->setContentsMargins(6, 4, 6, 4);
  verdict_ = wrapped("verdict", content);
  verdict_->setTextFormat(Qt::PlainText);
  QFont bold = font();
  bold.setBold(true);
  verdict_->setFont(bold);
  first_ = wrapped("firstDifference", content);
  first_->setTextFormat(Qt::RichText);
  first_->setTextInteractionFlags(Qt::TextBrowserInteraction);
  connect(first_, &QLabel::linkActivated, &onboard_, &OnboardController::goToFirstDifference);
  table_ = named(new QTableWidget(0, kColumns, content), "comparison");
  table_->setAccessibleName(tr("Onboard and ground run by iteration"));
  styleTable(*table_);
  table_->setHorizontalHeaderLabels({tr("Iteration"), tr("Found alike"), tr("Inliers in both"),
                                     tr("Apart, mm"), tr("Apart, mrad")});
  const QStringList tips = {
      tr("Number of the iteration; the last row is the final pose"),
      tr("Templates taken at one pixel and found at one place, of those that both searched"),
      tr("Of the templates at one pixel that are inliers of either run, those of both"),
      tr("Distance between the poses after the iteration, mm at the camera"),
      tr("Angle between the poses after the iteration, mrad")};
  for (int i = 0; i < kColumns; ++i) table_->horizontalHeaderItem(i)->setToolTip(tips[i]);
  connect(table_, &QTableWidget::cellActivated, this, [this](int row, int) {
    if (state_.snapshot() && row < static_cast<int>(state_.snapshot()->iterations.size()))
      state_.setCursor({row, Stage::kFinished});
  });
  limits_ = wrapped("limits", content);
  limits_->setTextFormat(Qt::PlainText);
  column->addWidget(verdict_);
  column->addWidget(first_);
  column->addWidget(table_, 1);
  column->addWidget(limits_);
  return content;
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
  show_onboard_->setEnabled(has && !onboard && idle);
  show_ground_->setEnabled(onboard && idle);
  rerun_->setEnabled(has && idle && onboard_.review()->plan.has_options);
  load_->setEnabled(state_.currentCase() != nullptr);
  remove_->setEnabled(!onboard_.file().empty());
  shown_->setText(onboard             ? tr("▲ ONBOARD run in every view, replayed")
                  : state_.snapshot() ? tr("▼ Ground run in every view")
                                      : tr("No run is shown."));
  const QPalette base = palette();
  banner_->setPalette(onboard ? tinted(base, plotColors(base).second) : base);
}

void OnboardPanel::showRecord() {
  const std::filesystem::path file = onboard_.file();
  remarks_->clear();
  if (file.empty()) {
    sheet_->setText(state_.currentCase()
                        ? tr("No onboard record is attached to this case. Drop one (.whsr) on the "
                             "window, or load it.")
                        : tr("No case is open."));
    return;
  }
  if (!onboard_.review()) {
    sheet_->setText(onboard_.problem().isEmpty() ? tr("Reading the record ...")
                                                 : onboard_.problem().toHtmlEscaped());
    return;
  }
  QString html = QStringLiteral("<table>");
  const auto line = [&html](const QString& label, const QString& value) {
    html += QStringLiteral(
                "<tr><td style='padding-right:10px; white-space:nowrap'>%1</td><td>%2</td></tr>")
                .arg(label.toHtmlEscaped(), value.toHtmlEscaped());
  };
  line(tr("File"), QString::fromStdString(file.filename().string()));
  for (const auto& [label, value] : sessions::recordSheet(onboard_.review()->record))
    line(fromText(label), fromText(value).replace(QLatin1Char('_'), QLatin1Char(' ')));
  sheet_->setText(html + QStringLiteral("</table>"));
  QString whole = QString::fromStdString(file.string());
  if (const auto& end = onboard_.review()->record.end)
    whole += QLatin1Char('\n') + tr("Digest %1").arg(fromText(end->digest));
  sheet_->setToolTip(whole);
  QStringList remarks;
  for (const std::string& text : onboard_.review()->replay->remarks)
    remarks << QStringLiteral("• ") + fromText(text);
  remarks_->setText(remarks.join(QLatin1Char('\n')));
}

void OnboardPanel::showComparison() {
  const OnboardController::ComparisonPtr& found = onboard_.comparison();
  showTable(found.get());
  limits_->setVisible(found && found->verdict != RunVerdict::kEqual);
  first_->setVisible(found && found->verdict != RunVerdict::kEqual);
  if (!found) {
    verdict_->setText(onboard_.whyNotCompared());
    return;
  }
  verdict_->setText(signOf(*found) + fromText(sessions::verdictText(*found)));
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
  first_->setText(text);
  limits_->setText(fromText(sessions::limitsText({})));
}

void OnboardPanel::showTable(const sessions::RecordComparison* comparison) {
  table_->setVisible(comparison != nullptr);
  table_->setRowCount(0);
  if (comparison == nullptr) return;
  const auto add = [this](const QStringList& cells) {
    const int row = table_->rowCount();
    table_->setRowCount(row + 1);
    for (int i = 0; i < cells.size(); ++i) {
      auto* item = new QTableWidgetItem(cells[i]);
      item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
      table_->setItem(row, i, item);
    }
  };
  for (const IterationComparison& one : comparison->iterations)
    add({QString::number(one.index + 1), shareText(one.found_alike, one.templates),
         shareText(one.inliers_both, one.inliers_either), numberText(one.translation_mm, 4),
         numberText(one.rotation_mrad, 4)});
  const QString sigmas = comparison->pose_sigmas
                             ? tr("%1 sigmas").arg(numberText(*comparison->pose_sigmas, 2))
                             : QStringLiteral("–");
  add({tr("Final"), sigmas, QString(), numberText(comparison->translation_mm, 4),
       numberText(comparison->rotation_mrad, 4)});
  table_->resizeColumnsToContents();
}

void askForOnboardRecord(OnboardController& onboard, QWidget* parent) {
  const QString file =
      QFileDialog::getOpenFileName(parent, OnboardPanel::tr("Load an onboard record"), {},
                                   OnboardPanel::tr("Onboard records (*.whsr);;All files (*)"));
  if (!file.isEmpty()) onboard.attach(file.toStdString());
}

void OnboardPanel::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && banner_ != nullptr) updateButtons();
}

}  // namespace boresight::ui
