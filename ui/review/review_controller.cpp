// SPDX-License-Identifier: Apache-2.0
#include "ui/review/review_controller.h"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "sessions/decision/check_limits.h"
#include "ui/models/text.h"
#include "ui/state/document.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

using sessions::PoseSource;
using sessions::Verdict;

namespace {

/// Whether the loaded case equals the document's; a nudged pose is not compared.
bool isReadAs(const sessions::SessionCase& read, sessions::SessionCase current) {
  current.camera_from_station_working = read.camera_from_station_working;
  return read == current;
}

}  // namespace

ReviewController::ReviewController(Document& document, ViewState& state)
    : document_(document), state_(state) {
  connect(&document_, &Document::left, this, [this] { reasons_.clear(); });
  state_.onChange(ViewChange::kOtherCase, this, [this] { wanted_source_.reset(); });
  connectEach(document_, this, &ReviewController::follow, &Document::opened, &Document::changed);
  state_.onChange(ViewChange::kCase, this, &ReviewController::follow);
  state_.onChange(ViewChange::kSnapshot, this, [this] {
    if (std::exchange(shown_run_, shownRun()) != shown_run_) Q_EMIT reviewStatusChanged();
  });
  connect(&convergence_runner_, &TaskRunner::busyChanged, this,
          &ReviewController::convergenceChanged);
  follow();
}

void ReviewController::setInSight(bool in_sight) {
  in_sight_ = in_sight;
  if (isActive() && !current_) ask();
}

void ReviewController::setFollowsRuns(bool follows) {
  follows_runs_ = follows;
  if (isActive() && !current_) ask();
}

bool ReviewController::hasOtherCases() const { return document_.session().cases.size() > 1; }

bool ReviewController::hasRun() const { return document_.session().lastRunOf(caseId()) != nullptr; }

bool ReviewController::hasAnnotations() const {
  return document_.session().annotations.count(caseId()) > 0;
}

std::string ReviewController::runDigest() const {
  return sessions::lastRunDigest(document_.session(), caseId());
}

void ReviewController::setSource(PoseSource source) {
  wanted_source_ = source;
  follow();
}

/// The operator's choice for this case, else the source of its decision, else an existing one.
void ReviewController::chooseSource() {
  const std::string id = caseId();
  const sessions::RunRecord* run = document_.session().lastRunOf(id);
  source_ = hasAnnotations() && (!run || run->status != "converged") ? PoseSource::kAnnotation
                                                                     : PoseSource::kRun;
  const sessions::ReviewStatus current = reviewStatus();
  if (current.holds() && current.decision->pose) source_ = current.decision->pose->source;
  if (wanted_source_ == PoseSource::kRun && run) source_ = PoseSource::kRun;
  if (wanted_source_ == PoseSource::kAnnotation && hasAnnotations())
    source_ = PoseSource::kAnnotation;
}

QString ReviewController::missing() const {
  if (!document_.isOpen()) return tr("No session is open.");
  const std::string id = caseId();
  if (id.empty()) return tr("No case is shown: select one in the list of cases.");
  if (!hasRun() && !hasAnnotations())
    return tr("%1 has no pose: run it (F5) or annotate it (F2) first.").arg(fromText(id));
  return {};
}

/// Nothing while the views do not have the case as it is now.
std::optional<ReviewController::Question> ReviewController::question() const {
  const std::string id = caseId();
  const sessions::Session& session = document_.session();
  const sessions::SessionCase* session_case = session.findCase(id);
  if (!session_case || !missing().isEmpty() ||
      !isReadAs(state_.currentCase()->source, *session_case))
    return {};
  Question question;
  question.loaded = state_.currentCase();
  question.source = source_;
  if (source_ == PoseSource::kRun) question.run_digest = runDigest();
  question.input_fingerprint = sessions::inputFingerprint(session, id, question.run_digest);
  return question;
}

void ReviewController::follow() {
  chooseSource();
  shown_run_ = shownRun();
  problem_ = missing();
  auto current = question();
  if (!current || current != question_) {
    drop();
    question_ = std::move(current);
    if (isActive()) ask();
  }
  Q_EMIT checksChanged();
  Q_EMIT reviewStatusChanged();
}

/// Cancels the evaluation. Its last checks stay visible as outdated ones, unless they are of
/// another case.
void ReviewController::drop() {
  checks_runner_.cancel(checking_);
  convergence_runner_.cancel(testing_);
  if (!problem_.isEmpty() || !subject_ || subject_->loaded->source.id != caseId()) checks_.clear();
  convergence_ = {};
  convergence_so_far_ = {};
  current_ = false;
  asked_ = false;
}

void ReviewController::ask() {
  if (!question_ || asked_) return;
  asked_ = true;
  current_ = false;
  const sessions::Session session = document_.session();
  checks_runner_.replace(
      checking_,
      [session, asked = *question_, convergence = convergence_](const std::stop_token&) {
        Answer answer;
        answer.subject = std::make_shared<const sessions::ReviewSubject>(
            reviewSubject(session, asked.loaded, asked.source, asked.run_digest));
        const auto limits = sessions::checkLimits(session.review.preset, session.review.limits);
        answer.checks = checkPose(*answer.subject, limits, convergence);
        return answer;
      },
      [this](const Answer& answer) { take(answer, {}); },
      [this](const QString& message) { take({}, message); });
}

void ReviewController::take(const Answer& answer, const QString& problem) {
  subject_ = answer.subject;
  checks_ = answer.checks;
  problem_ = problem;
  current_ = subject_ != nullptr;
  Q_EMIT checksChanged();
  Q_EMIT reviewStatusChanged();
}

QString ReviewController::reasonFor(const sessions::Check& check) const {
  const auto of_case = reasons_.find(caseId());
  if (of_case == reasons_.end()) return {};
  const auto found = of_case->second.find(check.id);
  const bool same = found != of_case->second.end() && found->second.check == check;
  return same ? found->second.text : QString();
}

void ReviewController::setReason(const sessions::Check& check, const QString& reason) {
  reasons_[caseId()][check.id] = {check, reason.trimmed()};
  Q_EMIT checksChanged();
}

sessions::CheckWaivers ReviewController::waivers() const {
  sessions::CheckWaivers check_waivers;
  for (const sessions::Check& check : checks_) {
    const QString reason = reasonFor(check);
    if (check.state == sessions::CheckState::kFailed && !reason.isEmpty())
      check_waivers[check.id] = reason.toStdString();
  }
  return check_waivers;
}

sessions::ReviewStatus ReviewController::reviewStatus() const {
  return sessions::reviewStatusOf(document_.session(), caseId());
}

std::vector<const sessions::Decision*> ReviewController::history() const {
  std::vector<const sessions::Decision*> decisions =
      document_.session().decisions.findAll(caseId());
  std::ranges::reverse(decisions);
  return decisions;
}

sessions::Session ReviewController::after(Act act, const sessions::Signature& who) const {
  const sessions::Session& session = document_.session();
  const std::string id = caseId();
  switch (act) {
    case Act::kValidate:
      return sessions::validated(session, *subject_, checks_, waivers(), who, convergence_.seeds);
    case Act::kApprove:
      return sessions::approved(session, id, seen(act), who);
    case Act::kReject: {
      // A decision that names a run has the checks of its pose, not those of the annotations.
      const bool of_result = current_ && (source_ == PoseSource::kRun || !hasRun());
      return sessions::rejected(session, id, seen(act),
                                of_result ? checks_ : std::vector<sessions::Check>(), who);
    }
    case Act::kTakeBack:
      return sessions::reopened(session, id, who);
  }
  throw std::logic_error("no such act");
}

/// A decision that holds is not repeated: a second validation would replace one that awaits its
/// second person.
QString ReviewController::settled(Act act) const {
  const sessions::ReviewStatus current = reviewStatus();
  if (!current.holds()) return {};
  const QString by = fromText(current.decision->by);
  if (act == Act::kValidate && current.decision->verdict == Verdict::kValidated)
    return tr("it is validated already, by %1").arg(by);
  if (act == Act::kReject && current.decision->verdict == Verdict::kRejected)
    return tr("it is rejected already, by %1").arg(by);
  return {};
}

/// The run that an act is on; empty: on none.
std::string ReviewController::concerned(Act act) const {
  const sessions::ReviewStatus current = reviewStatus();
  switch (act) {
    case Act::kValidate:
      return source_ == PoseSource::kRun ? runDigest() : std::string();
    case Act::kApprove:
      return current.holds() ? current.decision->digest : std::string();
    case Act::kReject:  // of the case's result, whatever else is judged
      return runDigest();
    case Act::kTakeBack:  // whatever is shown: the case is undecided then
      return {};
  }
  throw std::logic_error("no such act");
}

/// The run that the operator has seen for an act. One whose trace is reported as missing can only
/// be rejected.
std::string ReviewController::seen(Act act) const {
  if (act == Act::kReject) return shownRun();
  return state_.snapshot() ? state_.snapshot()->digest : std::string();
}

/// A pose is validated with its checks, and approved with what it was validated by.
QString ReviewController::unready(Act act) const {
  const QString id = fromText(caseId());
  if (act == Act::kValidate && !problem_.isEmpty()) return problem_;
  if (act == Act::kValidate && !current_)
    return tr("the checks of %1 are not complete yet: wait for them").arg(id);
  const sessions::Decision* judged = reviewStatus().judgedPose();
  if (act != Act::kApprove || !judged || judged->pose->source == source_) return {};
  return source_ == PoseSource::kRun
             ? tr("the validation of %1 is of the annotation: select it as the judged pose").arg(id)
             : tr("the validation of %1 is of its run: select it as the judged pose").arg(id);
}

/// Only a run that is shown can be decided on.
QString ReviewController::unseen(Act act) const {
  const std::string run = concerned(act);
  if (run.empty() || run == seen(act)) return {};
  const QString id = fromText(caseId());
  return state_.snapshot()
             ? tr("the image shows another run than the decision is on: show the last run of %1")
                   .arg(id)
             : tr("the image shows no run: show the last run of %1").arg(id);
}

QString ReviewController::obstacle(Act act, const sessions::Signature& who) const {
  if (!document_.isOpen()) return tr("no session is open");
  if (!document_.readOnlyReason().isEmpty()) return document_.readOnlyReason();
  const std::string& open_id = state_.opening().id;
  if (caseId().empty())
    return open_id.empty() ? tr("no case is shown: select one in the list of cases")
                           : tr("%1 is still being read").arg(fromText(open_id));
  if (const QString said = settled(act); !said.isEmpty()) return said;
  if (const QString reason = unready(act); !reason.isEmpty()) return reason;
  if (const QString reason = unseen(act); !reason.isEmpty()) return reason;
  try {
    // An obstacle that remains with a signature is told first.
    if (who.by.empty() || who.comment.empty()) (void)after(act, {"a second person", "?"});
    (void)after(act, who);
  } catch (const std::exception& error) {
    return QString::fromUtf8(error.what());
  }
  return {};
}

bool ReviewController::decide(Act act, const sessions::Signature& who) {
  if (!obstacle(act, who).isEmpty()) return false;
  const QString id = fromText(caseId());
  const QString text = act == Act::kValidate  ? tr("Validate %1").arg(id)
                       : act == Act::kApprove ? tr("Approve %1").arg(id)
                       : act == Act::kReject  ? tr("Reject %1").arg(id)
                                              : tr("Withdraw the decision on %1").arg(id);
  return document_.edit(after(act, who), text);
}

const sessions::ReviewSettings& ReviewController::settings() const {
  return document_.session().review;
}

void ReviewController::editSettings(const sessions::ReviewSettings& settings, const QString& text) {
  if (!document_.isOpen() || settings == this->settings()) return;
  sessions::Session next = document_.session();
  next.review = settings;
  document_.edit(next, text);
}

void ReviewController::setPreset(const QString& preset) {
  editSettings(sessions::withPreset(settings(), preset.toStdString()),
               tr("Check by %1").arg(preset));
}

void ReviewController::setLimits(const sessions::CheckLimits& limits) {
  editSettings(sessions::withLimits(settings(), limits), tr("Change the limits of the checks"));
}

void ReviewController::setSecondPerson(bool asked) {
  sessions::ReviewSettings next = settings();
  next.second_person = asked;
  editSettings(next, asked ? tr("Ask for a second person") : tr("Ask for one person"));
}

void ReviewController::startConvergenceTest(int seeds) {
  if (!current_ || isConvergenceTestRunning()) return;
  convergence_so_far_ = {};
  convergence_runner_.replace(
      testing_,
      [this, subject = subject_, seeds](const std::stop_token& stop,
                                        const TaskRunner::Report& report) {
        const auto tell = [this, &report](const sessions::ConvergenceResult& so_far) {
          report([this, so_far] {
            convergence_so_far_ = so_far;
            Q_EMIT convergenceChanged();
          });
        };
        sessions::ConvergenceResult result = sessions::convergenceTest(*subject, seeds, stop, tell);
        report([this, result = std::move(result)] {
          if (result.seeds == 0) return;
          convergence_ = result;
          asked_ = false;
          ask();
          Q_EMIT checksChanged();
        });
      },
      [this](const QString& message) {
        Q_EMIT failed(tr("The convergence test of %1 ended: %2").arg(fromText(caseId()), message));
      });
}

void ReviewController::stopConvergenceTest() { convergence_runner_.stop(testing_); }

}  // namespace boresight::ui
