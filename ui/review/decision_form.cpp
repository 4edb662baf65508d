// SPDX-License-Identifier: Apache-2.0
#include "ui/review/decision_form.h"

#include <utility>

#include <QtWidgets>

#include "ui_decision_form.h"

#include "ui/models/number_text.h"

namespace boresight::ui {

using sessions::Decision;
using sessions::Verdict;

namespace {

constexpr int kDigestDigits = 12;

QString sentence(QString clause) {
  if (clause.isEmpty()) return clause;
  clause[0] = clause[0].toUpper();
  const bool ended = clause.endsWith(QLatin1Char('.')) || clause.endsWith(QLatin1Char('?'));
  return ended ? clause : clause + QLatin1Char('.');
}

QString entry(const QString& time, const QString& what, const std::string& by,
              const std::string& comment) {
  QString when = time;
  when.replace(QLatin1Char('T'), QLatin1Char(' ')).remove(QLatin1Char('Z'));
  return DecisionForm::tr("<b>%1 by %2</b> · %3 UTC<br>%4")
      .arg(what, fromText(by).toHtmlEscaped(), when, fromText(comment).toHtmlEscaped());
}

QString verdictText(const Decision& decision) {
  return decision.verdict == Verdict::kValidated  ? DecisionForm::tr("★ Validated")
         : decision.verdict == Verdict::kRejected ? DecisionForm::tr("⊘ Rejected")
                                                  : DecisionForm::tr("↺ Taken back");
}

/// Failed checks that were passed over, each with its reason.
QString overridesHtml(const Decision& decision) {
  QString html;
  for (const sessions::JudgedCheck& one : decision.checks)
    if (!one.override_reason.empty())
      html += DecisionForm::tr("<br>✗ %1 passed over: %2")
                  .arg(fromText(one.check.title).toHtmlEscaped(),
                       fromText(one.override_reason).toHtmlEscaped());
  return html;
}

QString decisionHtml(const Decision& decision) {
  if (decision.approval)
    return entry(fromText(decision.approval->time), DecisionForm::tr("★ Approved"),
                 decision.approval->by, decision.approval->comment);
  QString html =
      entry(fromText(decision.time), verdictText(decision), decision.by, decision.comment);
  if (!decision.digest.empty())
    html += DecisionForm::tr(" (run %1)").arg(fromText(decision.digest).left(kDigestDigits));
  else if (decision.pose)
    html += DecisionForm::tr(" (the marks)");
  return html + overridesHtml(decision);
}

}  // namespace

DecisionForm::DecisionForm(ReviewController& controller, QWidget* parent)
    : QWidget(parent), controller_(controller), ui_(std::make_unique<Ui::DecisionForm>()) {
  ui_->setupUi(this);
  buttons_ = {{Act::kValidate, ui_->validate},
              {Act::kApprove, ui_->approve},
              {Act::kReject, ui_->reject},
              {Act::kTakeBack, ui_->takeBack}};
  for (const auto& [act, button] : buttons_) {
    tips_[act] = button->toolTip();
    button->setMinimumWidth(fontMetrics().horizontalAdvance(button->text()) + 16);
    connect(button, &QPushButton::clicked, this, [this, chosen = act] { decide(chosen); });
  }
  ui_->decisionName->setText(QSettings().value(QLatin1String(kNameKey)).toString());
  for (QLineEdit* each : {ui_->decisionName, ui_->decisionComment})
    connect(each, &QLineEdit::textChanged, this, &DecisionForm::showWhatIsPossible);
  ui_->reading->setMinimumHeight(2 * fontMetrics().lineSpacing());
  connect(&controller_, &ReviewController::checksChanged, this, &DecisionForm::showWhatIsPossible);
  connect(&controller_, &ReviewController::reviewStatusChanged, this,
          &DecisionForm::showWhatIsPossible);
  showWhatIsPossible();
}

DecisionForm::~DecisionForm() = default;

void DecisionForm::setNote(const QString& html) {
  note_ = html;
  showReading();
}

sessions::Signature DecisionForm::signature() const {
  return {ui_->decisionName->text().trimmed().toStdString(),
          ui_->decisionComment->text().trimmed().toStdString()};
}

void DecisionForm::decide(Act act) {
  if (!controller_.decide(act, signature())) return;
  QSettings().setValue(QLatin1String(kNameKey), ui_->decisionName->text().trimmed());
  ui_->decisionComment->clear();  // the next decision has grounds of its own
}

/// What a person most likely wants to do, whose obstacle is told without being asked.
ReviewController::Act DecisionForm::nextStep() const {
  const sessions::ReviewStatus status = controller_.reviewStatus();
  if (status.awaits_approval) return Act::kApprove;
  return status.holds() ? Act::kTakeBack : Act::kValidate;
}

void DecisionForm::showWhatIsPossible() {
  const sessions::Signature who = signature();
  for (const auto& [act, each] : buttons_) {
    const QString reason = controller_.obstacle(act, who);
    each->setEnabled(reason.isEmpty());
    each->setToolTip(reason.isEmpty() ? tips_[act]
                                      : tr("%1. Not now: %2").arg(tips_[act], sentence(reason)));
  }
  // Nobody is asked for a second person's yes where one person is enough.
  buttons_[Act::kApprove]->setVisible(controller_.settings().second_person);
  const bool told = nextStep() != Act::kTakeBack;
  obstacle_ = told ? sentence(controller_.obstacle(nextStep(), who)) : QString();
  showReading();
}

/// One page that scrolls: of several labels in so little room one would be cut off.
void DecisionForm::showReading() {
  QStringList parts;
  if (!obstacle_.isEmpty()) parts << QStringLiteral("⚠ %1").arg(obstacle_.toHtmlEscaped());
  if (controller_.awaitsBasin() && nextStep() == Act::kValidate)
    parts << tr(
        "○ The basin test has not been run: a second answer to this image is not excluded.");
  if (!note_.isEmpty()) parts << note_;
  for (const Decision* decision : controller_.history()) parts << decisionHtml(*decision);
  if (controller_.history().empty()) parts << tr("<i>Nobody has decided on this case yet.</i>");
  const QString html = parts.join(QStringLiteral("<hr>"));
  if (std::exchange(read_, html) != html) ui_->reading->setHtml(html);
}

}  // namespace boresight::ui
