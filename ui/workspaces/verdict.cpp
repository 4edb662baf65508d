// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/verdict.h"

#include <algorithm>
#include <utility>

#include <QCoreApplication>

#include "sessions/record/onboard_review.h"
#include "sessions/trace/run_text.h"
#include "ui/models/text.h"
#include "ui/workspaces/remedies.h"

namespace boresight::ui {
namespace {

using sessions::ReviewState;

QString tr(const char* text) { return QCoreApplication::translate("Verdict", text); }

/// In the order of `VerdictTone`.
constexpr Icon kToneIcons[] = {Icon::kInfo, Icon::kCheck, Icon::kCross, Icon::kWarning};
static_assert(std::size(kToneIcons) == static_cast<std::size_t>(VerdictTone::kCaution) + 1);

/// Sets the tone, and the icon of that tone.
void setTone(Verdict& verdict, VerdictTone tone) {
  verdict.tone = tone;
  verdict.icon = kToneIcons[static_cast<std::size_t>(tone)];
}

QString stageName(Stage stage) {
  const char* name = stage == Stage::kRender      ? "rendering"
                     : stage == Stage::kTemplates ? "templates"
                     : stage == Stage::kMatch     ? "matching"
                     : stage == Stage::kPose      ? "pose"
                     : stage == Stage::kRefine    ? "refinement"
                     : stage == Stage::kEdges     ? "edges of the image"
                                                  : "search";
  return tr(name);
}

/// Green only where the requirement holds, the checks are measured and none fails.
void toneOfPose(const Situation& situation, Verdict& verdict) {
  if (!situation.quality || !situation.review.current) return;  // being measured
  const bool good = situation.quality->holds() && situation.review.failed == 0;
  setTone(verdict, good ? VerdictTone::kGood : VerdictTone::kCaution);
}

QString qualityText(const sessions::PoseQuality& quality) {
  return (quality.worst() ? tr(" Pose known to %1.") : tr(" %1.")).arg(fromText(quality.text()));
}

QString failedText(int failed) {
  return failed == 1 ? tr("1 check failed") : tr("%1 checks failed").arg(failed);
}

/// "Iteration 2: rendering done; next, templates."
QString progressText(const sessions::LocalizationTrace* trace) {
  // A finished one is the run before.
  if (!trace || trace->finished || trace->iterations.empty())
    return tr("The edges of the image are found first.");
  const auto number = trace->iterations.size();
  if (!trace->last_under_way) return tr("Iteration %1 is complete.").arg(number);
  const Stage reached = trace->iterations.back()->reached;
  const bool refines = trace->iterations.back()->kind == IterationKind::kRefine;
  const Stage next = reached == Stage::kRender ? (refines ? Stage::kRefine : Stage::kTemplates)
                                               : static_cast<Stage>(static_cast<int>(reached) + 1);
  return tr("Iteration %1: %2 done; next, %3.")
      .arg(number)
      .arg(stageName(reached), stageName(next));
}

Verdict ofFiles(const FilesSituation& files, bool case_is_open) {
  if (files.added == 0)
    return {.head = case_is_open ? tr("New case.") : tr("No case is open."),
            .sentence = tr("Add an image, a camera, a mesh and a seed, or open a session."),
            .step = Step::kChooseFiles};
  Verdict verdict{.head = tr("%1 of 4 files added").arg(files.added),
                  .sentence = files.missing,
                  .step = Step::kChooseFiles};
  if (!files.next.isEmpty()) verdict.step_text = tr("Choose %1...").arg(files.next);
  if (!files.problem.isEmpty()) {
    setTone(verdict, VerdictTone::kBad);
    verdict.sentence = files.problem;
  } else if (files.next.isEmpty()) {
    verdict.step_text = tr("Make the case");
  }
  return verdict;
}

Verdict ofReading(const QString& case_id) {
  return {.icon = Icon::kClock,
          .head = tr("Opening %1.").arg(case_id),
          .sentence = tr("Its files are being read.")};
}

/// "p2, p5 and 3 others"
QString suspectsText(const QStringList& suspects) {
  constexpr int kMostNamed = 4;
  if (suspects.size() <= kMostNamed) return suspects.join(tr(", "));
  return tr("%1 and %2 others")
      .arg(QStringList(suspects.mid(0, kMostNamed - 1)).join(tr(", ")))
      .arg(suspects.size() - kMostNamed + 1);
}

/// Annotations that pull the pose: which, and how to solve without them.
void addSuspects(const AnnotationSituation& annotation, Verdict& verdict) {
  const QString names = suspectsText(annotation.suspects);
  if (annotation.robust) {
    verdict.sentence += tr(" Little weight: %1; check or remove them.").arg(names);
    return;
  }
  verdict.sentence += tr(" Suspected: %1.").arg(names);
  verdict.step = Step::kRobust;
  verdict.others = {Step::kSeedFromAnnotation};
}

void addAnnotatedPose(const AnnotationSituation& annotation, bool has_seed, Verdict& verdict) {
  const bool good = annotation.concern.isEmpty();
  setTone(verdict, good ? VerdictTone::kGood : VerdictTone::kCaution);
  verdict.sentence = good       ? tr("The annotations give a pose.")
                     : has_seed ? annotation.concern
                                : annotation.concern + tr(" The case has no seed yet.");
  if (good && !has_seed)
    verdict.sentence = tr("The annotations give a pose; the case has no seed yet.");
  verdict.step = Step::kSeedFromAnnotation;
  if (!annotation.suspects.isEmpty()) addSuspects(annotation, verdict);
}

Verdict ofAnnotation(const AnnotationSituation& annotation, bool has_seed) {
  Verdict verdict;
  verdict.icon = Icon::kPencil;
  const QString pairs = annotation.pairs == 1 ? tr("1 pair") : tr("%1 pairs").arg(annotation.pairs);
  verdict.head =
      annotation.rms_px ? tr("%1, rms %2 px").arg(pairs, numberText(*annotation.rms_px, 2)) : pairs;
  if (annotation.blind) {
    verdict.head = tr("Blind round: %1").arg(pairs);
    verdict.sentence = tr("Place or remove the %1 that are left; until then nothing is predicted.")
                           .arg(annotation.unplaced);
  } else if (!annotation.bad_pair.isEmpty() && annotation.suspects.size() < 2) {
    setTone(verdict, VerdictTone::kCaution);
    verdict.sentence = tr("%1 stands out by %2 sigma.")
                           .arg(annotation.bad_pair, numberText(annotation.bad_sigmas, 1));
    verdict.step = Step::kDisablePair;
    verdict.step_text = tr("Switch off %1").arg(annotation.bad_pair);
  } else if (annotation.has_pose) {
    addAnnotatedPose(annotation, has_seed, verdict);
  } else {
    verdict.sentence =
        tr("Click a point in the image and the same point on the station; four pairs give a pose.");
  }
  return verdict;
}

Verdict ofOnboard(const Situation& situation) {
  if (!situation.comparison)
    return {.head = tr("Not compared."),
            .sentence = situation.not_compared,
            .step = situation.can_repeat ? Step::kRepeatRecord : Step::kLoadRecord};
  Verdict verdict;
  const sessions::RecordComparison& comparison = *situation.comparison;
  const bool different = comparison.verdict == sessions::RunVerdict::kDifferent;
  const bool good = comparison.showsAgreement();
  setTone(verdict, good        ? VerdictTone::kGood
                   : different ? VerdictTone::kBad
                               : VerdictTone::kCaution);
  verdict.head = comparison.verdict == sessions::RunVerdict::kEqual ? tr("Agrees bit for bit.")
                 : good                                             ? tr("Agrees within limits.")
                 : different                                        ? tr("Differs.")
                                                                    : tr("Not decided.");
  if (comparison.verdict != sessions::RunVerdict::kEqual)
    verdict.sentence = fromText(sessions::verdictText(comparison));
  verdict.step = comparison.first ? Step::kFirstDifference : Step::kNextCase;
  return verdict;
}

/// A validation, also one that a second person must approve.
Verdict ofValidation(const Situation& situation) {
  const ReviewSituation& review = situation.review;
  Verdict verdict;
  toneOfPose(situation, verdict);
  verdict.sentence = review.decision;
  if (!review.outdated.isEmpty()) verdict.sentence += tr(" Outdated: %1.").arg(review.outdated);
  if (situation.quality) verdict.sentence += qualityText(*situation.quality);
  if (review.failed > 0) verdict.sentence += tr(" %1, waived.").arg(failedText(review.failed));
  if (review.state == ReviewState::kValidated) {
    verdict.head = tr("Validated");
    verdict.step = Step::kExportPose;
    verdict.others = {Step::kReport, Step::kNextCase};
    if (verdict.tone == VerdictTone::kGood) verdict.icon = Icon::kShield;
  } else {
    verdict.head = tr("To be approved");
    verdict.step = situation.workspace == Workspace::kReview ? Step::kNextCase : Step::kReview;
    setTone(verdict, VerdictTone::kCaution);
  }
  if (review.outdated.isEmpty()) return verdict;
  setTone(verdict, VerdictTone::kCaution);
  verdict.head += tr("; outdated");
  verdict.others.insert(verdict.others.begin(), std::exchange(verdict.step, Step::kRunAgain));
  return verdict;
}

/// A decision that holds.
Verdict ofDecision(const Situation& situation) {
  if (situation.review.state != ReviewState::kRejected) return ofValidation(situation);
  return {.tone = VerdictTone::kBad,
          .icon = Icon::kCross,
          .head = tr("Rejected in review"),
          .sentence = situation.review.decision,
          .step = Step::kNextCase};
}

bool decisionIsOfShownRun(const Situation& situation) {
  const bool under_way = situation.run == RunState::kWorking || situation.in_batch;
  return !situation.review.decision.isEmpty() && !under_way && situation.trace &&
         situation.trace->finished;
}

Verdict ofConvergenceTest(const ReviewSituation& review) {
  Verdict verdict{.icon = Icon::kRing,
                  .head = tr("Convergence test running"),
                  .sentence = tr("No seed is done yet."),
                  .step = Step::kStopTest,
                  .plain = true};
  if (review.seeds_done > 0)
    verdict.sentence = tr("%1 seeds done; %2 end at this pose.")
                           .arg(review.seeds_done)
                           .arg(review.seeds_returned == review.seeds_done
                                    ? tr("all")
                                    : QString::number(review.seeds_returned));
  return verdict;
}

std::optional<Verdict> ofReview(const Situation& situation) {
  const ReviewSituation& review = situation.review;
  if (!review.decision.isEmpty()) return ofDecision(situation);
  if (review.testing) return ofConvergenceTest(review);
  // A failed run has remedies, not checks to pass.
  if (!review.current || (situation.trace && !situation.trace->converged())) return std::nullopt;
  Verdict verdict;
  QStringList open;
  if (review.failed > 0) open << failedText(review.failed);
  if (!review.tested)
    open << tr("the convergence test has not run: a competing pose is not excluded");
  toneOfPose(situation, verdict);
  if (verdict.tone == VerdictTone::kGood && !review.tested) setTone(verdict, VerdictTone::kPlain);
  verdict.head = tr("Converged; not yet validated");
  verdict.sentence =
      open.isEmpty() ? tr("All checks passed.") : open.join(tr("; ")) + QLatin1Char('.');
  verdict.sentence[0] = verdict.sentence[0].toUpper();
  verdict.step = !review.tested       ? Step::kConvergenceTest
                 : review.failed == 0 ? Step::kValidate
                                      : Step::kNone;
  return verdict;
}

Verdict ofRun(const Situation& situation) {
  const sessions::LocalizationTrace& trace = *situation.trace;
  const sessions::RunHeadline headline = sessions::runHeadline(trace);
  Verdict verdict{.head = fromText(headline.head), .sentence = fromText(headline.sentence)};
  if (trace.converged()) {
    toneOfPose(situation, verdict);
    if (situation.quality) verdict.sentence += qualityText(*situation.quality);
    if (situation.review.failed > 0)
      verdict.sentence += tr(" %1.").arg(failedText(situation.review.failed));
    verdict.sentence += tr(" Not yet validated.");
    verdict.step = Step::kReview;
    return verdict;
  }
  setTone(verdict, VerdictTone::kBad);
  const std::vector<Remedy> remedies = remediesFor(trace, situation.tried);
  if (const QString tried = triedText(remedies); !tried.isEmpty())
    verdict.sentence += tr(" Tried: %1.").arg(tried);
  if (!remedies.empty()) verdict.step = remedies.front().step;
  for (std::size_t i = 1; i < std::min<std::size_t>(remedies.size(), 5); ++i)
    verdict.others.push_back(remedies[i].step);
  return verdict;
}

/// Under way, halted, ready, or of a case that cannot be run.
std::optional<Verdict> ofProgress(const Situation& situation) {
  const sessions::LocalizationTrace* trace = situation.trace.get();
  if (situation.run == RunState::kWorking || situation.in_batch)
    return Verdict{.icon = Icon::kRing,
                   .head = tr("Running."),
                   .sentence = progressText(situation.run == RunState::kWorking ? trace : nullptr),
                   .step = Step::kStop,
                   .plain = true};
  if (situation.run == RunState::kHalted && trace && !trace->finished) {
    const auto complete = trace->complete();
    return Verdict{
        .icon = Icon::kClock,
        .head = complete > 0 ? tr("Paused after iteration %1.").arg(complete) : tr("Paused."),
        .sentence = trace->last_under_way ? progressText(trace) : QString(),
        .step = Step::kGoOn};
  }
  if (!situation.has_seed)
    return Verdict{
        .head = tr("No seed yet."),
        .sentence = tr("Annotate four or more points: their pose becomes the seed."),
        .step = situation.annotation.has_pose ? Step::kSeedFromAnnotation : Step::kAnnotate};
  if (!situation.input_problem.isEmpty())
    return Verdict{.tone = VerdictTone::kBad,
                   .icon = Icon::kCross,
                   .head = tr("Not ready to run."),
                   .sentence = situation.input_problem,
                   .step = Step::kChangeInput,
                   .step_text = situation.input_step};
  if (!trace && !situation.run_problem.isEmpty())
    return Verdict{.tone = VerdictTone::kBad,
                   .icon = Icon::kCross,
                   .head = tr("There is no run to show."),
                   .sentence = situation.run_problem,
                   .step = Step::kRunAgain};
  if (!trace) return Verdict{.head = tr("Ready to run."), .step = Step::kRun};
  if (situation.stale.isEmpty()) return std::nullopt;
  return Verdict{.tone = VerdictTone::kCaution,
                 .icon = Icon::kWarning,
                 .head = trace->converged() ? tr("Converged; outdated.") : tr("Failed; outdated."),
                 .sentence = situation.stale,
                 .step = Step::kRunAgain};
}

Verdict ofSituation(const Situation& situation) {
  if (!situation.has_case && situation.load_problem.isEmpty() && situation.file_problem.isEmpty())
    return situation.reading.isEmpty() ? ofFiles(situation.files, false)
                                       : ofReading(situation.reading);
  // The open case is not on the screen: nothing is done to it.
  if (situation.workspace == Workspace::kStart) return ofFiles(situation.files, true);
  if (!situation.has_case) {
    const bool files_found = situation.file_problem.isEmpty();
    return {.tone = VerdictTone::kBad,
            .icon = Icon::kCross,
            .head = tr("The case cannot be read."),
            .sentence = files_found ? situation.load_problem : situation.file_problem,
            .step = files_found ? Step::kInputs : Step::kFixFiles};
  }
  if (situation.workspace == Workspace::kAnnotate)
    return ofAnnotation(situation.annotation, situation.has_seed);
  if (situation.workspace == Workspace::kOnboard && situation.run != RunState::kWorking)
    return ofOnboard(situation);
  if (!situation.reading.isEmpty() && !situation.trace) return ofReading(situation.reading);
  if (situation.workspace == Workspace::kReview)
    if (auto verdict = ofReview(situation)) return *verdict;
  if (decisionIsOfShownRun(situation)) return ofDecision(situation);
  if (auto verdict = ofProgress(situation)) return *verdict;
  return ofRun(situation);
}

}  // namespace

Verdict verdictOf(const Situation& situation) {
  Verdict verdict = ofSituation(situation);
  if (situation.has_next) return verdict;
  if (verdict.step == Step::kNextCase) verdict.step = Step::kNone;
  std::erase(verdict.others, Step::kNextCase);
  return verdict;
}

}  // namespace boresight::ui
