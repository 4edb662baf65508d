// SPDX-License-Identifier: Apache-2.0
#include "ui/review/decision_form.h"

#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSettings>
#include <QTextBrowser>
#include <QVBoxLayout>

#include "ui/models/number_text.h"

namespace boresight::ui {

using sessions::Decision;
using sessions::Verdict;

namespace {

constexpr const char* kNameKey = "review/name";
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
  switch (decision.verdict) {
    case Verdict::kValidated:
      return DecisionForm::tr("★ Validated");
    case Verdict::kRejected:
      return DecisionForm::tr("⊘ Rejected");
    case Verdict::kReopened:
      break;
  }
  return DecisionForm::tr("↺ Taken back");
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
  auto* grid = new QGridLayout;
  buildFields(*grid);
  column->addLayout(grid);
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
  obstacle_ = new QLabel(this);
  obstacle_->setObjectName(QStringLiteral("obstacle"));
  obstacle_->setWordWrap(true);
  obstacle_->setTextFormat(Qt::PlainText);
  column->addWidget(obstacle_);
  history_ = new QTextBrowser(this);
  history_->setObjectName(QStringLiteral("history"));
  history_->setAccessibleName(tr("Decisions on this case"));
  history_->setMinimumHeight(2 * fontMetrics().lineSpacing());
  column->addWidget(history_, 1);
  connect(&controller_, &ReviewController::checksChanged, this, &DecisionForm::showWhatIsPossible);
  connect(&controller_, &ReviewController::standingChanged, this, [this] {
    showWhatIsPossible();
    showHistory();
  });
  showWhatIsPossible();
  showHistory();
}

void DecisionForm::buildFields(QGridLayout& grid) {
  grid.setSpacing(3);
  name_ = new QLineEdit(QSettings().value(QLatin1String(kNameKey)).toString(), this);
  name_->setObjectName(QStringLiteral("decisionName"));
  name_->setPlaceholderText(tr("Who decides"));
  name_->setToolTip(tr("Your name; it goes with the decision into every file"));
  comment_ = new QLineEdit(this);
  comment_->setObjectName(QStringLiteral("decisionComment"));
  comment_->setPlaceholderText(tr("On what grounds"));
  comment_->setToolTip(tr("On what grounds; it goes with the decision into every file"));
  auto* name = new QLabel(tr("&Name"), this);
  auto* comment = new QLabel(tr("Co&mment"), this);
  name->setBuddy(name_);
  comment->setBuddy(comment_);
  grid.addWidget(name, 0, 0);
  grid.addWidget(name_, 0, 1);
  grid.addWidget(comment, 1, 0);
  grid.addWidget(comment_, 1, 1);
  for (QLineEdit* each : {name_, comment_})
    connect(each, &QLineEdit::textChanged, this, &DecisionForm::showWhatIsPossible);
}

QPushButton* DecisionForm::button(Act act, const char* name, const QString& text,
                                  const QString& tip) {
  auto* made = new QPushButton(text, this);
  made->setObjectName(QLatin1String(name));
  made->setMinimumWidth(fontMetrics().horizontalAdvance(text) + 16);
  buttons_[act] = made;
  tips_[act] = tip;
  connect(made, &QPushButton::clicked, this, [this, act] { decide(act); });
  return made;
}

sessions::Signature DecisionForm::signature() const {
  return {name_->text().trimmed().toStdString(), comment_->text().trimmed().toStdString()};
}

void DecisionForm::decide(Act act) {
  if (!controller_.decide(act, signature())) return;
  QSettings().setValue(QLatin1String(kNameKey), name_->text().trimmed());
  comment_->clear();  // the next decision has grounds of its own
}

QString DecisionForm::obstacle() const { return obstacle_->text(); }

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
  const QString reason = controller_.obstacle(nextStep(), who);
  const bool told = nextStep() != Act::kTakeBack && !reason.isEmpty();
  obstacle_->setText(told ? QStringLiteral("⚠ ") + sentence(reason) : QString());
  obstacle_->setVisible(told);
}

void DecisionForm::showHistory() {
  QStringList entries;
  for (const Decision* decision : controller_.history()) entries << decisionHtml(*decision);
  history_->setHtml(entries.isEmpty() ? tr("<i>Nobody has decided on this case yet.</i>")
                                      : entries.join(QStringLiteral("<hr>")));
}

}  // namespace boresight::ui
