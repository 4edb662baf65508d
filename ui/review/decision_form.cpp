// SPDX-License-Identifier: Apache-2.0
#include "ui/review/decision_form.h"

#include <utility>

#include <QtWidgets>

#include "ui/models/text.h"

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

QString entry(const std::string& time, const QString& what, const std::string& by,
              const std::string& comment) {
  return DecisionForm::tr("<b>%1 by %2</b> · %3 UTC<br>%4")
      .arg(what, fromText(by).toHtmlEscaped(), timeText(time), fromText(comment).toHtmlEscaped());
}

QString verdictText(const Decision& decision) {
  return decision.verdict == Verdict::kValidated  ? DecisionForm::tr("★ Validated")
         : decision.verdict == Verdict::kRejected ? DecisionForm::tr("⊘ Rejected")
                                                  : DecisionForm::tr("↺ Withdrawn");
}

/// Failed checks that were waived, each with its reason.
QString waiversHtml(const Decision& decision) {
  QString html;
  for (const sessions::JudgedCheck& judged : decision.checks)
    if (!judged.waiver_reason.empty())
      html += DecisionForm::tr("<br>✗ %1 waived: %2")
                  .arg(fromText(judged.check.title).toHtmlEscaped(),
                       fromText(judged.waiver_reason).toHtmlEscaped());
  return html;
}

QString decisionHtml(const Decision& decision) {
  if (decision.approval)
    return entry(decision.approval->time, DecisionForm::tr("★ Approved"), decision.approval->by,
                 decision.approval->comment);
  QString html = entry(decision.time, verdictText(decision), decision.by, decision.comment);
  if (!decision.digest.empty())
    html += DecisionForm::tr(" (run %1)").arg(fromText(decision.digest).left(kDigestDigits));
  else if (decision.pose)
    html += DecisionForm::tr(" (the annotations)");
  return html + waiversHtml(decision);
}

QString doneText(ReviewController::Act act) {
  using Act = ReviewController::Act;
  return act == Act::kValidate  ? DecisionForm::tr("%1 is validated.")
         : act == Act::kApprove ? DecisionForm::tr("The validation of %1 is approved.")
         : act == Act::kReject  ? DecisionForm::tr("%1 is rejected.")
                                : DecisionForm::tr("The decision on %1 is withdrawn.");
}

}  // namespace

DecisionForm::DecisionForm(ReviewController& controller) : controller_(controller) {
  ui_.setupUi(this);
  buttons_ = {{Act::kValidate, ui_.validate},
              {Act::kApprove, ui_.approve},
              {Act::kReject, ui_.reject},
              {Act::kTakeBack, ui_.takeBack}};
  for (const auto& [act, button] : buttons_) {
    tips_[act] = button->toolTip();
    connect(button, &QPushButton::clicked, this, [this, chosen = act] { decide(chosen, false); });
  }
  connect(ui_.validateNext, &QPushButton::clicked, this, [this] { decide(Act::kValidate, true); });
  for (QLineEdit* each : {ui_.decisionName, ui_.decisionComment}) {
    each->installEventFilter(this);
    connect(each, &QLineEdit::textChanged, this, &DecisionForm::showWhatIsPossible);
    connect(each, &QLineEdit::returnPressed, this, &DecisionForm::answer);
  }
  ui_.reading->setMinimumHeight(2 * fontMetrics().lineSpacing());
  connect(&controller_, &ReviewController::checksChanged, this, &DecisionForm::showWhatIsPossible);
  connect(&controller_, &ReviewController::reviewStatusChanged, this, &DecisionForm::followCase);
  followCase();
}

void DecisionForm::forgetName() {
  ui_.decisionName->clear();
  ui_.decisionComment->clear();
  drafts_.clear();
}

sessions::Signature DecisionForm::signature() const {
  return {ui_.decisionName->text().trimmed().toStdString(),
          ui_.decisionComment->text().trimmed().toStdString()};
}

void DecisionForm::ask(Act act) {
  const sessions::Signature who = signature();
  QLineEdit* missing = who.by.empty()        ? ui_.decisionName
                       : who.comment.empty() ? ui_.decisionComment
                                             : nullptr;
  if (!missing && decide(act, true)) return endQuestion();
  question_ = {act, controller_.openedId(), controller_.shownRun()};
  ui_.decisionComment->setPlaceholderText(act == Act::kReject ? tr("Why reject this result?")
                                                              : tr("Why validate this pose?"));
  (missing ? missing : ui_.decisionComment)->setFocus();
}

/// A run may end while the reason is typed: the answer is to the run of the question.
void DecisionForm::answer() {
  if (!question_) return;
  if (std::exchange(question_->run, controller_.shownRun()) == question_->run)
    ask(question_->act);
  else
    refuse(tr("Another run of %1 is shown by now: look at it, then press Enter again.")
               .arg(fromText(controller_.caseId())));
}

void DecisionForm::endQuestion() {
  question_.reset();
  ui_.decisionComment->setPlaceholderText(tr("Why validate this pose?"));
  Q_EMIT questionEnded();
}

bool DecisionForm::refuse(const QString& reason) {
  refusal_ = reason;
  showReading();
  return false;
}

/// A decision that holds is overruled by the second of two equal requests.
bool DecisionForm::overrules(Act act) {
  const sessions::ReviewStatus status = controller_.reviewStatus();
  const bool opposite = status.holds() && (act == Act::kValidate || act == Act::kReject);
  return opposite && std::exchange(overruling_, act) != act;
}

bool DecisionForm::decide(Act act, bool then_next) {
  const QString id = fromText(controller_.caseId());
  // As the cases are listed now.
  const std::optional<QString> following = then_next && next_ ? next_() : std::nullopt;
  const QString reason = controller_.obstacle(act, signature());
  if (!reason.isEmpty()) return refuse(sentence(reason));
  if (overrules(act))
    return refuse(tr("%1 has a decision by %2. Press or click again to overrule it.")
                      .arg(id, fromText(controller_.reviewStatus().decision->by)));
  if (!controller_.decide(act, signature())) return refuse(tr("No decision was stored."));
  ui_.decisionComment->clear();  // the next decision has a comment of its own
  const bool last = following && following->isEmpty();
  Q_EMIT decided(doneText(act).arg(id) + (last ? tr(" No other case is undecided.") : QString()));
  if (following && !last) Q_EMIT nextRequested(*following);
  return true;
}

/// A reason is given for one case, whose draft is kept.
void DecisionForm::followCase() {
  // What is typed while the case is read is its own.
  const std::string id = controller_.openedId();
  if (id != shown_id_) {
    drafts_[std::exchange(shown_id_, id)] = ui_.decisionComment->text();
    ui_.decisionComment->setText(drafts_[id]);
  }
  if (question_ && question_->case_id != id) endQuestion();
  showWhatIsPossible();
}

bool DecisionForm::eventFilter(QObject* watched, QEvent* event) {
  const bool override = event->type() == QEvent::ShortcutOverride;
  if (!question_ || !(override || event->type() == QEvent::KeyPress) ||
      static_cast<QKeyEvent*>(event)->key() != Qt::Key_Escape)
    return QWidget::eventFilter(watched, event);
  if (override)
    event->accept();  // before it stops jobs
  else
    endQuestion();
  return true;
}

/// The most likely next step, whose obstacle is always shown.
ReviewController::Act DecisionForm::nextStep() const {
  const sessions::ReviewStatus status = controller_.reviewStatus();
  if (status.awaits_approval) return Act::kApprove;
  return status.holds() ? Act::kTakeBack : Act::kValidate;
}

void DecisionForm::showWhatIsPossible() {
  refusal_.clear();
  overruling_.reset();
  // A row of whole words has room for what can be decided now, and not for all that ever can.
  const auto history = controller_.history();  // the newest first
  const bool decided = !history.empty() && history.front()->verdict != Verdict::kReopened;
  ui_.takeBack->setVisible(decided);
  ui_.approve->setVisible(decided && controller_.settings().second_person);
  const sessions::Signature who = signature();
  const Act next = nextStep();
  obstacle_.clear();
  for (const auto& [act, each] : buttons_) {
    // Each obstacle is a decision that is tried: only of what can be seen.
    const bool needed = act == next || each->isVisibleTo(this);
    const QString reason = needed ? controller_.obstacle(act, who) : tr("there is no decision");
    each->setEnabled(reason.isEmpty());
    each->setToolTip(reason.isEmpty()
                         ? tips_[act]
                         : tr("%1. Not available: %2").arg(tips_[act], sentence(reason)));
    if (act == next && act != Act::kTakeBack) obstacle_ = sentence(reason);
  }
  ui_.validateNext->setEnabled(ui_.validate->isEnabled());
  ui_.validateNext->setVisible(!decided && controller_.hasOtherCases());
  showReading();
}

/// One page that scrolls: of several labels in so little room one would be cut off.
void DecisionForm::showReading() {
  QStringList parts;
  for (const QString& reason : {refusal_, obstacle_})
    if (!reason.isEmpty()) parts << QStringLiteral("⚠ %1").arg(reason.toHtmlEscaped());
  parts.removeDuplicates();
  if (controller_.awaitsConvergenceTest() && nextStep() == Act::kValidate)
    parts << tr("○ No convergence test: a competing pose is not excluded.");
  for (const Decision* decision : controller_.history()) parts << decisionHtml(*decision);
  if (controller_.history().empty()) parts << tr("<i>No decision on this case yet.</i>");
  const QString html = parts.join(QStringLiteral("<hr>"));
  if (std::exchange(read_, html) != html) ui_.reading->setHtml(html);
}

}  // namespace boresight::ui
