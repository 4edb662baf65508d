// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "app/commands.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/record/compare_records.h"
#include "sessions/record/onboard_record.h"
#include "sessions/session/case_run.h"
#include "sessions/trace/trace_file.h"

namespace boresight::app {
namespace {

using sessions::InputError;
using sessions::OnboardRecord;

void addLimits(CLI::App& command, sessions::ComparisonLimits& limits) {
  const auto add = [&command](const char* name, double& limit, double most, const char* help) {
    command.add_option(name, limit, help)->check(numberIn(0.0, most))->capture_default_str();
  };
  add("--found-px", limits.found_px, 1e6,
      "Largest distance of two template positions that count as equal, px at their level");
  add("--found-share", limits.found_share, 1.0,
      "Required share of equal template positions, 0 to 1");
  add("--inlier-share", limits.inlier_share, 1.0,
      "Required share of the inliers of either run that both have, 0 to 1");
  add("--sigmas", limits.pose_sigmas, 1e6,
      "Largest distance of the final poses, in sigmas of A's covariance");
}

struct CompareArguments {
  std::string one, other, case_id, digest;
  bool rerun = false;
  sessions::ComparisonLimits limits;

  void addTo(CLI::App& command) {
    addFile(command, "A", one, "Record, trace or session")->required();
    addFile(command, "B", other,
            "Record, trace or session; without it, the onboard record of A's case is compared with "
            "the case's run");
    addOption(command, "--case", "ID", case_id, "Case of the session");
    CLI::Option* run =
        addOption(command, "--run", "DIGEST", digest,
                  "First digits of the digest of the case's run (default: the last run)");
    command
        .add_flag("--rerun", rerun,
                  "Run the case with the options of the onboard record, without storing the run")
        ->excludes(run);
    addLimits(command, limits);
  }
};

enum class SideKind { kRecord, kTrace, kSession };

/// By its first bytes. The reader of records rejects other files.
SideKind kindOf(const std::string& file) {
  const auto begin = sessions::readBeginning(file, 8);
  const std::string_view text = sessions::asText(begin);
  if (text.starts_with("BSTRACE\n")) return SideKind::kTrace;
  return text.starts_with("{") ? SideKind::kSession : SideKind::kRecord;
}

OnboardRecord readSide(const std::string& file) {
  return kindOf(file) == SideKind::kTrace ? sessions::recordOf(sessions::loadTrace(file), nullptr)
                                          : sessions::readRecord(file);
}

/// A case of the session, and the requested run of it.
class GroundSide {
 public:
  GroundSide(const std::string& session, const CompareArguments& arguments)
      : document_(openToRead(session)), arguments_(arguments) {
    if (arguments.case_id.empty())
      throw CLI::RequiredError("--case (which case of " + session + ")");
    (void)requireCase(document_, arguments.case_id);
  }

  /// What is attached to the case.
  OnboardRecord attached() const {
    const auto& file = one().onboard_record;
    if (!file)
      throw InputError(
          document_.file(), "case " + one().id,
          "no onboard record is attached; give one, or attach it in the desktop program");
    return sessions::readRecord(file->file);
  }

  /// The stored run, or with --rerun a new run with the record's options.
  OnboardRecord run(const OnboardRecord& onboard) const {
    const auto loaded = sessions::loadCase(one());
    const LocalizationProblem given = loaded->problem();
    return sessions::recordOf(arguments_.rerun ? runAnew(onboard, *loaded) : stored(), &given);
  }

 private:
  const sessions::SessionCase& one() const { return requireCase(document_, arguments_.case_id); }

  static sessions::LocalizationTrace runAnew(const OnboardRecord& onboard,
                                             const sessions::LoadedCase& loaded) {
    const sessions::RecordedPlan recorded = sessions::planOf(onboard);
    for (const std::string& remark : recorded.remarks) note(remark);
    return sessions::runCase(loaded, recorded.plan);
  }

  const sessions::RunRecord& chosen() const {
    if (!arguments_.digest.empty()) return recordedRun(document_, arguments_.digest);
    const sessions::RunRecord* last = document_.session().lastRunOf(one().id);
    if (last == nullptr)
      throw InputError(document_.file(), "case " + one().id,
                       "it has no run; run it, or use --rerun to run it with the record's options");
    return *last;
  }

  sessions::LocalizationTrace stored() const {
    const sessions::RunRecord& run = chosen();
    if (run.case_id != one().id)
      throw InputError(document_.file(), "run " + run.digest,
                       "it is a run of case " + run.case_id + ", not of " + one().id);
    if (run.inputs_sha256 != sessions::inputsDigest(one()))
      throw InputError(document_.file(), "run " + run.digest,
                       "the inputs of case " + one().id +
                           " have changed since the run; run it again, or use --rerun to run it "
                           "with the record's options");
    return sessions::loadRun(run);
  }

  sessions::SessionDocument document_;
  const CompareArguments& arguments_;
};

sessions::RecordComparison compareSides(const CompareArguments& arguments) {
  const bool session_first = kindOf(arguments.one) == SideKind::kSession;
  const bool session_second =
      !arguments.other.empty() && kindOf(arguments.other) == SideKind::kSession;
  if (session_first && session_second)
    throw CLI::ValidationError("A, B", "only one of the two can be a session");
  if (!session_first && arguments.other.empty()) throw CLI::RequiredError("B");
  if (!session_first && !session_second)
    return sessions::compareRecords(readSide(arguments.one), readSide(arguments.other),
                                    arguments.limits);
  const GroundSide ground(session_first ? arguments.one : arguments.other, arguments);
  const OnboardRecord onboard = !session_first            ? readSide(arguments.one)
                                : arguments.other.empty() ? ground.attached()
                                                          : readSide(arguments.other);
  const OnboardRecord run = ground.run(onboard);
  const bool onboard_first = !session_first || arguments.other.empty();
  return sessions::compareRecords(onboard_first ? onboard : run, onboard_first ? run : onboard,
                                  arguments.limits);
}

int compare(const CompareArguments& arguments) {
  const sessions::RecordComparison found = compareSides(arguments);
  std::cout << sessions::comparisonText(found);
  if (found.verdict == sessions::RunVerdict::kEqual) return kDone;
  return found.verdict == sessions::RunVerdict::kWithinLimits ? kWithinLimits : kDifferent;
}

}  // namespace

void addCompare(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "compare",
             "Compares two runs and prints their first difference. Exit status: 0 equal to the "
             "bit, 5 within the limits for other pixels or a cut record, 6 different or not "
             "comparable. A run is "
             "an onboard record (run.whsr), a trace, or a run of a session's case (--case)",
             compare);
}

}  // namespace boresight::app
