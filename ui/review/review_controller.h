// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <QObject>
#include <QString>

#include "sessions/checks/checks.h"
#include "sessions/checks/review_subject.h"
#include "sessions/review/review_status.h"
#include "ui/run/task_runner.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

class Document;

/// The pose of the shown case under review: its checks, evaluated on a worker thread while visible,
/// the reasons for waiving failed ones, and the possible decisions. Every decision and every change
/// of a limit is one edit of the document.
class ReviewController : public QObject {
  Q_OBJECT

 public:
  enum class Act { kValidate, kApprove, kReject, kTakeBack };

  ReviewController(Document& document, ViewState& state);

  /// Checks are evaluated only while they are in sight, or runs are looked at.
  void setInSight(bool in_sight);
  void setFollowsRuns(bool follows);
  /// Id of the shown case, or empty.
  std::string caseId() const { return shownCaseId(document_, state_); }
  /// The case that is open, also while it is read.
  const std::string& openedId() const { return state_.opening().id; }
  /// Whether the session has cases other than the shown one.
  bool hasOtherCases() const;
  bool hasRun() const;
  bool hasAnnotations() const;
  /// The digest of the case's last run, which can be judged; or empty.
  std::string runDigest() const;
  /// The digest of the run that the operator sees or that is reported as missing, or empty.
  std::string shownRun() const { return state_.shownRun(); }
  sessions::PoseSource source() const { return source_; }
  void setSource(sessions::PoseSource source);

  const std::vector<sessions::Check>& checks() const { return checks_; }
  /// Whether the checks are of the document's current state.
  bool isCurrent() const { return current_; }
  bool isBusy() const { return checks_runner_.isBusy() || convergence_runner_.isBusy(); }
  /// Why there is nothing to check and what to do, or empty.
  const QString& problem() const { return problem_; }

  /// Reason to waive a failed check; valid only for the figure for which it was given.
  QString reasonFor(const sessions::Check& check) const;
  /// `check` has the figure that the operator saw, which may have changed since.
  void setReason(const sessions::Check& check, const QString& reason);

  sessions::ReviewStatus reviewStatus() const;
  /// The decisions on the case, the newest first; they point into the document's session.
  std::vector<const sessions::Decision*> history() const;
  /// Why an act is not possible now, or empty. Every act but the withdrawal of a decision is on
  /// what the operator sees at this moment.
  QString obstacle(Act act, const sessions::Signature& who) const;
  /// Returns false without effect when there is an obstacle.
  bool decide(Act act, const sessions::Signature& who);

  const sessions::ReviewSettings& settings() const;
  void setPreset(const QString& preset);
  void setLimits(const sessions::CheckLimits& limits);
  void setSecondPerson(bool asked);

  /// Whether a pose is ready to be judged and its convergence test has not been run yet.
  bool awaitsConvergenceTest() const {
    return current_ && convergence_.seeds == 0 && !isConvergenceTestRunning();
  }
  bool isConvergenceTestRunning() const { return convergence_runner_.isBusy(); }
  /// Result so far of the test under way.
  const sessions::ConvergenceResult& convergenceSoFar() const { return convergence_so_far_; }
  /// Runs further seeds and includes the result in the checks. Does nothing while the checks are
  /// not current.
  void startConvergenceTest(int seeds);
  /// Stops the test; the seeds run so far are used.
  void stopConvergenceTest();

 Q_SIGNALS:
  /// Checks, reasons, or isCurrent() have changed.
  void checksChanged();
  /// Case, decisions, limits, or the poses that can be judged have changed.
  void reviewStatusChanged();
  void convergenceChanged();
  /// The convergence test has failed; one sentence.
  void failed(const QString& message);

 private:
  /// All inputs of the answer.
  struct Question {
    ViewState::CasePtr loaded;
    sessions::PoseSource source = sessions::PoseSource::kRun;
    std::string run_digest;
    std::map<std::string, std::string> input_fingerprint;

    bool operator==(const Question&) const = default;
  };
  struct Answer {
    std::shared_ptr<const sessions::ReviewSubject> subject;
    std::vector<sessions::Check> checks;
  };
  struct Reason {
    sessions::Check check;
    QString text;
  };

  void follow();
  void chooseSource();
  std::optional<Question> question() const;
  QString missing() const;
  void drop();
  void ask();
  void take(const Answer& answer, const QString& problem);
  sessions::CheckWaivers waivers() const;
  sessions::Session after(Act act, const sessions::Signature& who) const;
  bool isActive() const { return in_sight_ || follows_runs_; }
  QString settled(Act act) const;
  std::string concerned(Act act) const;
  std::string seen(Act act) const;
  QString unready(Act act) const;
  QString unseen(Act act) const;
  void editSettings(const sessions::ReviewSettings& settings, const QString& text);

  Document& document_;
  ViewState& state_;
  bool in_sight_ = false;
  bool follows_runs_ = false;
  std::string shown_run_;                              ///< at the last reviewStatusChanged
  std::optional<sessions::PoseSource> wanted_source_;  ///< for the shown case
  sessions::PoseSource source_ = sessions::PoseSource::kRun;
  std::optional<Question> question_;
  bool asked_ = false;
  bool current_ = false;
  QString problem_;
  std::shared_ptr<const sessions::ReviewSubject> subject_;  ///< of `question_` when not nullptr
  std::vector<sessions::Check> checks_;
  sessions::ConvergenceResult convergence_;  ///< without seeds: not run yet
  sessions::ConvergenceResult convergence_so_far_;
  std::map<std::string, std::map<std::string, Reason>> reasons_;  ///< by case and check id
  TaskRunner checks_runner_;
  TaskKind checking_;
  TaskRunner convergence_runner_;
  TaskKind testing_;
};

}  // namespace boresight::ui
