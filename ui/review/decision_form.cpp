// SPDX-License-Identifier: Apache-2.0
#include "ui/review/decision_form.h"

#include <utility>

#include <QtWidgets>

#include "ui/models/number_text.h"
#include "ui/panels/widgets.h"

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
    : QWidget(parent), controller_(controller) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(4);
  auto* fields = new QHBoxLayout;
  buildFields(*fields);
  column->addLayout(fields);
  auto* row = new QHBoxLayout;
  row->setSpacing(3);
  row->addWidget(button(Act::kValidate, "validate", tr("Validate"),
                        tr("Vouch for this pose, with your name, a comment and the checks")));
  row->addWidget(button(Act::kApprove, "approve", tr("Approve"),
                        tr("The second person's yes to a validation")));
  row->addWidget(button(Act::kReject, "reject", tr("Reject"),
                        tr("Refuse the case's result, with your name and the reason")));
  row->addWidget(button(Act::kTakeBack, "takeBack", tr("Take back"),
                        tr("Take the last decision back; it stays in the history")));
  column->addLayout(row);
  reading_ = named(new QTextBrowser(this), "reading");
  reading_->setAccessibleName(tr("What stands in the way, the chosen check, former decisions"));
  reading_->setMinimumHeight(2 * fontMetrics().lineSpacing());
  column->addWidget(reading_, 1);
  connect(&controller_, &ReviewController::checksChanged, this, &DecisionForm::showWhatIsPossible);
  connect(&controller_, &ReviewController::standingChanged, this,
          &DecisionForm::showWhatIsPossible);
  showWhatIsPossible();
}

void DecisionForm::buildFields(QHBoxLayout& row) {
  row.setSpacing(3);
  name_ = named(new QLineEdit(QSettings().value(QLatin1String(kNameKey)).toString(), this),
                "decisionName");
  name_->setPlaceholderText(tr("Who decides"));
  name_->setToolTip(tr("Your name; it goes with the decision into every file"));
  comment_ = named(new QLineEdit(this), "decisionComment");
  comment_->setPlaceholderText(tr("On what grounds"));
  comment_->setToolTip(tr("On what grounds; it goes with the decision into every file"));
  name_->setAccessibleName(tr("Who decides"));
  comment_->setAccessibleName(tr("On what grounds"));
  row.addWidget(name_, 2);
  row.addWidget(comment_, 3);
  for (QLineEdit* each : {name_, comment_})
    connect(each, &QLineEdit::textChanged, this, &DecisionForm::showWhatIsPossible);
}

QPushButton* DecisionForm::button(Act act, const char* name, const QString& text,
                                  const QString& tip) {
  auto* made = named(new QPushButton(text, this), name);
  made->setMinimumWidth(fontMetrics().horizontalAdvance(text) + 16);
  buttons_[act] = made;
  tips_[act] = tip;
  connect(made, &QPushButton::clicked, this, [this, act] { decide(act); });
  return made;
}

void DecisionForm::setNote(const QString& html) {
  note_ = html;
  showReading();
}

sessions::Signature DecisionForm::signature() const {
  return {name_->text().trimmed().toStdString(), comment_->text().trimmed().toStdString()};
}

void DecisionForm::decide(Act act) {
  if (!controller_.decide(act, signature())) return;
  QSettings().setValue(QLatin1String(kNameKey), name_->text().trimmed());
  comment_->clear();  // the next decision has grounds of its own
}

/// What a person most likely wants to do, whose obstacle is told without being asked.
ReviewController::Act DecisionForm::nextStep() const {
  const sessions::Standing standing = controller_.standing();
  if (standing.awaits_approval) return Act::kApprove;
  return standing.holds() ? Act::kTakeBack : Act::kValidate;
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
  if (std::exchange(read_, html) != html) reading_->setHtml(html);
}

}  // namespace boresight::ui
