// SPDX-License-Identifier: Apache-2.0

#include <functional>

#include <nlohmann/json.hpp>

#include "sessions/checks/checks.h"
#include "sessions/decision/check_limits.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/review/validated_pose_file.h"
#include "tests/sessions/review/judged_case.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using namespace sessions;
using nlohmann::ordered_json;

HandedPose statedPose(PoseSource source) {
  Random random = randomFor("MeasuredPose");
  HandedPose pose;
  pose.source = source;
  pose.camera_from_station = randomPose(random);
  return pose;
}

TEST(PoseDifference, OfARunIsExactAndOfAnnotationsToANanometre) {
  for (const PoseSource source : {PoseSource::kRun, PoseSource::kAnnotation}) {
    const HandedPose stated = statedPose(source);
    const bool of_run = source == PoseSource::kRun;
    const auto difference = [&stated](int axis, double size) {
      Vector6d xi = Vector6d::Zero();
      xi[axis] = size;
      return poseDifference(stated, perturbed(xi, stated.camera_from_station));
    };
    for (int axis = 0; axis < 6; ++axis) {
      EXPECT_EQ(difference(axis, 0.0), "");
      EXPECT_EQ(difference(axis, 0.9e-9).empty(), !of_run) << axis;
      EXPECT_THAT(difference(axis, 1.1e-9), StartsWith("the pose differs: ")) << axis;
    }
    Pose negative = stated.camera_from_station;
    negative.rotation.coeffs() *= -1.0;
    EXPECT_EQ(poseDifference(stated, negative), "") << "one rotation";
  }
}

TEST(PoseDifference, Text_HasMillimetresAndMilliradians) {
  HandedPose stated;
  Pose measured;
  measured.translation_m = {0.0, 0.25, 0.0};
  EXPECT_EQ(poseDifference(stated, measured),
            "the pose differs: 250 mm and 0 mrad from the stated pose");
}

TEST(CovarianceDifference, EachCauseAndElement_IsCompared) {
  Random random = randomFor("CovarianceDifference");
  Vector6d sigma;
  for (int i = 0; i < 6; ++i) sigma[i] = random.uniform(1e-4, 1e-2);
  const Matrix6d covariance = sigma.cwiseAbs2().asDiagonal();
  for (const PoseSource source : {PoseSource::kRun, PoseSource::kAnnotation}) {
    HandedPose stated = statedPose(source);
    stated.covariance = {covariance, 2.0 * covariance, 3.0 * covariance};
    const double tolerance = source == PoseSource::kRun ? 1e-12 : 1e-6;
    for (const auto cause :
         {&PoseCovariance::picture, &PoseCovariance::mesh_scale, &PoseCovariance::calibration})
      for (int row = 0; row < 6; ++row)
        for (int column = 0; column < 6; ++column) {
          const Matrix6d& of_cause = stated.covariance.*cause;
          const double size = std::sqrt(of_cause(row, row) * of_cause(column, column));
          PoseCovariance measured = stated.covariance;
          EXPECT_EQ(covarianceDifference(stated, measured), "");
          (measured.*cause)(row, column) += 0.5 * tolerance * size;
          EXPECT_EQ(covarianceDifference(stated, measured), "");
          (measured.*cause)(row, column) += 1.5 * tolerance * size;
          EXPECT_THAT(covarianceDifference(stated, measured), StartsWith("the covariance differs"));
          (measured.*cause)(row, column) = NAN;
          EXPECT_NE(covarianceDifference(stated, measured), "");
        }
  }
}

TEST(CovarianceDifference, Text_HasBothSigmasOfTheTranslation) {
  HandedPose stated;
  stated.covariance.picture(3, 3) = 0.0625;
  PoseCovariance measured;
  measured.picture(3, 3) = 0.0625;
  measured.picture(4, 4) = 0.125;
  measured.picture(5, 5) = 0.0625;
  measured.picture(0, 0) = 9.0;
  EXPECT_EQ(covarianceDifference(stated, measured),
            "the covariance differs: the translation has a sigma of 500 mm, stated are 250 mm");
}

std::vector<Check> measuredChecks() {
  return {
      measuredCheck({"coverage", "Coverage"}, "%", 50.0, 30.0, LimitSide::kAtLeast, "Seen.", ""),
      measuredCheck({"sigma", "Sigma"}, "mm", 0.1, 0.4, LimitSide::kAtMost, "Known.", ""),
      notAskedCheck({"truth", "Truth"}, "No truth.")};
}

HandedPose statedChecks(const std::vector<Check>& checks) {
  HandedPose pose;
  for (const Check& check : checks) pose.checks.push_back({check, ""});
  return pose;
}

TEST(ChecksDifference, EachFigure_IsComparedAndNoWord) {
  const std::vector<Check> measured = measuredChecks();
  const auto difference = [&measured](const std::function<void(Check&)>& edit) {
    std::vector<Check> stated = measured;
    edit(stated[1]);
    return checksDifference(statedChecks(stated), measured, true);
  };
  EXPECT_EQ(difference([](Check&) {}), "");
  EXPECT_EQ(difference([](Check& check) { check.title = check.sentence = "other words"; }), "");
  EXPECT_EQ(difference([](Check& check) { *check.figure += 0.9e-7; }), "");
  EXPECT_EQ(difference([](Check& check) { *check.limit -= 3.5e-7; }), "");
  EXPECT_EQ(
      difference([](Check& check) { *check.figure += 1.5e-7; }),
      "check 'Sigma' is stated as passed, 0.1 mm (at most 0.4 mm) and measured as passed, 0.1 "
      "mm (at most 0.4 mm), with other digits");
  EXPECT_EQ(
      difference([](Check& check) { *check.figure = 0.2; }),
      "check 'Sigma' is stated as passed, 0.2 mm (at most 0.4 mm) and measured as passed, 0.1 "
      "mm (at most 0.4 mm)");
  for (const auto& edit : std::vector<std::function<void(Check&)>>{
           [](Check& check) { check.state = CheckState::kFailed; },
           [](Check& check) { check.unit = "m"; },
           [](Check& check) { check.side = LimitSide::kAtLeast; },
           [](Check& check) { *check.limit += 1e-6; }, [](Check& check) { check.figure.reset(); },
           [](Check& check) { check.limit.reset(); }})
    EXPECT_THAT(difference(edit), StartsWith("check 'Sigma' is stated as "));
  EXPECT_EQ(difference([](Check& check) { check.id = "other"; }), "check 'Sigma' is not stated");
}

TEST(ChecksDifference, TinyFigures_AreComparedInTheirUnit) {
  std::vector<Check> measured = {measuredChecks()[1]};
  measured[0].figure = 0.0;
  std::vector<Check> stated = measured;
  stated[0].figure = 0.9e-12;
  EXPECT_EQ(checksDifference(statedChecks(stated), measured, true), "");
  stated[0].figure = 1.1e-12;
  EXPECT_NE(checksDifference(statedChecks(stated), measured, true), "");
}

TEST(ChecksDifference, Number_IsTheSameAndEachDifferenceIsNamed) {
  std::vector<Check> stated = measuredChecks();
  stated[0].state = stated[2].state = CheckState::kFailed;
  EXPECT_THAT(checksDifference(statedChecks(stated), measuredChecks(), true),
              testing::MatchesRegex("check 'Coverage' is stated .*; 'Truth' is stated .*"));
  stated.pop_back();
  EXPECT_EQ(checksDifference(statedChecks(stated), measuredChecks(), true),
            "2 checks are stated, but 3 are measured");
}

TEST(ChecksDifference, ConvergenceTest_IsComparedOnlyWhereItWasRepeated) {
  std::vector<Check> measured = measuredChecks();
  std::vector<Check> convergence;
  addConvergenceChecks({}, CheckLimits(), convergence);
  ASSERT_THAT(convergence, SizeIs(2));
  for (const Check& check : convergence) {
    EXPECT_TRUE(isConvergenceCheck(check.id));
    measured.push_back(check);
    std::vector<Check> stated = measured;
    stated.back().state = CheckState::kPassed;
    EXPECT_EQ(checksDifference(statedChecks(stated), measured, false), "");
    EXPECT_NE(checksDifference(statedChecks(stated), measured, true), "");
    stated.back().sentence = "It was measured.";
    EXPECT_THAT(rewordedChecks(statedChecks(stated), measured, false), IsEmpty());
    EXPECT_THAT(rewordedChecks(statedChecks(stated), measured, true), SizeIs(1));
    stated.front().state = CheckState::kFailed;
    EXPECT_NE(checksDifference(statedChecks(stated), measured, false), "");
  }
}

TEST(RewordedChecks, OtherTitleOrSentence_IsNamed) {
  const std::vector<Check> measured = measuredChecks();
  std::vector<Check> stated = measured;
  EXPECT_THAT(rewordedChecks(statedChecks(stated), measured, true), IsEmpty());
  stated[0].title = "Share";
  stated[1].sentence = "It is known.";
  stated[2].id = "another";
  EXPECT_THAT(rewordedChecks(statedChecks(stated), measured, true),
              ElementsAre("Coverage", "Sigma"));
}

TEST(RequireAsMeasured, Difference_IsRefusedWithItsCase) {
  EXPECT_NO_THROW(requireAsMeasured("a", ""));
  try {
    requireAsMeasured("a", "the pose differs");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("case a"), HasSubstr("the pose differs; run and")));
  }
}

TEST(Checksum, CoversAllButItself) {
  ordered_json json = {{"a", 1}, {"checksum", "any"}, {"b", {1.5, "x"}}};
  const ordered_json checksum = checksumOf(json);
  EXPECT_EQ(checksum["digest"], sha256Text(std::string_view("{\"a\":1,\"b\":[1.5,\"x\"]}")));
  EXPECT_EQ(checksum["algorithm"], "SHA-256");
  json["checksum"] = checksum;
  EXPECT_EQ(checksumOf(json), checksum);
  json["b"][0] = 1.25;
  EXPECT_NE(checksumOf(json)["digest"], checksum["digest"]);
  json["signature"] = "any";
  const ordered_json former = checksumOf(json, kFormerChecksumMember);
  EXPECT_NE(former["over"], checksum["over"]);
  json["signature"] = "other";
  EXPECT_EQ(checksumOf(json, kFormerChecksumMember), former);
}

/// Case "a" with a rig of "b", and "c" apart; each has annotations and rounds, and was run twice.
struct RigSession {
  Random random = randomFor("SessionOfCase");
  JudgedCase judged{random};

  RigSession() {
    Session& session = judged.session;
    SessionCase session_case = *session.findCase("a");
    session_case.rig = Rig{"rig", Pose()};
    session = withCase(session, session_case);
    for (const char* id : {"b", "c"}) {
      session_case.id = id;
      if (session_case.id == "c") session_case.rig.reset();
      session = withCase(session, session_case);
    }
    judged.session.runs.back().inputs_sha256 = inputsDigest(*session.findCase("a"));
    auto loaded = std::make_shared<LoadedCase>();
    loaded->source = *session.findCase("a");
    judged.subject.loaded = loaded;
    for (const char* id : {"b", "c"}) {
      session.runs.push_back(randomRun(random, id));
      session.runs.push_back(randomRun(random, id));
      session = withRounds(session, id, randomRounds(random));
    }
    for (const char* id : {"a", "b", "c"})
      session = withAnnotations(session, id, randomAnnotations(random));
    session.view = {"a", "", 3};
  }
  static std::vector<std::string> runsOf(const Session& session) {
    std::vector<std::string> digests;
    for (const RunRecord& run : session.runs) digests.push_back(run.digest);
    return digests;
  }
};

TEST(SessionOfCase, HasTheCaseItsRigAndTheRunsThatItNeeds) {
  RigSession rig;
  Session session = rig.judged.session;
  const std::string own = session.runs[0].digest;
  const std::string last_of_b = session.runs[2].digest;
  session.decisions = rig.judged.validatedBy("Ada").decisions;
  session.decisions.push_back(session.decisions.back());
  session.decisions.front().by = "Eve";
  const Session alone = sessionOfCase(session, "a", own);
  ASSERT_EQ(alone.cases.size(), 2u);
  EXPECT_TRUE(alone.findCase("a") && alone.findCase("b"));
  EXPECT_THAT(RigSession::runsOf(alone), ElementsAre(own, last_of_b));
  EXPECT_EQ(alone.annotations.size(), 2u);
  EXPECT_EQ(alone.annotations.count("c"), 0u);
  ASSERT_EQ(alone.decisions.size(), 1u);
  EXPECT_EQ(alone.decisions[0], session.decisions.back());
  EXPECT_EQ(alone.rounds.size(), 0u);
  EXPECT_EQ(alone.view, DocumentView());
  session.decisions.back().digest.clear();
  EXPECT_THAT(RigSession::runsOf(sessionOfCase(session, "a", "")), ElementsAre(last_of_b));
  EXPECT_EQ(sessionOfCase(session, "c", session.runs[4].digest).cases.size(), 1u);
  EXPECT_THAT(sessionOfCase(session, "c", "").decisions, IsEmpty());
  // Poses solved together always agree: the run before is the witness.
  session.runs[2].together = TogetherRecord{{{"b", "converged"}, {"a", "converged"}}, ""};
  EXPECT_THAT(RigSession::runsOf(sessionOfCase(session, "a", own)),
              ElementsAre(own, session.runs[1].digest));
}

TEST(SessionOfCase, DecisionOnARun_HasTheSameStatusForAPoseOfAnnotations) {
  RigSession rig;
  rig.judged.noteRun(randomSha256(rig.random), "iteration_limit", rig.random);
  const Session& before = rig.judged.session;
  Session session = rejected(before, "a", lastRunDigest(before, "a"), {}, {"Ann", "nothing found"});
  const auto handed = [&session] {
    return reviewStatusText(reviewStatusOf(sessionOfCase(session, "a", ""), "a"));
  };
  EXPECT_EQ(handed(), "NOT VALIDATED: rejected by Ann");
  rig.judged.session = session;
  rig.judged.noteRun(randomSha256(rig.random), "iteration_limit", rig.random);
  session = rig.judged.session;
  EXPECT_THAT(handed(), HasSubstr("no longer holds: there is a later run"));
}

TEST(SessionOfCase, DecisionThatDoesNotHold_LosesItsChecks) {
  RigSession rig;
  Session session = rig.judged.validatedBy("Ada");
  ASSERT_TRUE(reviewStatusOf(session, "a").holds());
  EXPECT_THAT(sessionOfCase(session, "a", session.runs[0].digest).decisions[0].checks, SizeIs(3));
  session = withAnnotations(session, "a", randomAnnotations(rig.random));
  EXPECT_THAT(sessionOfCase(session, "a", session.runs[0].digest).decisions[0].checks, IsEmpty());
}

TEST(HandedPosesTest, CaseWithoutPose_IsNotedAndEachIsAnnounced) {
  RigSession rig;
  Session session = rig.judged.session;
  session.runs.clear();
  for (const char* id : {"a", "b", "c"}) session = withAnnotations(session, id, Annotations());
  std::vector<int> done;
  const auto progress = [&done](int count, int of) {
    EXPECT_EQ(of, 3);
    done.push_back(count);
  };
  const HandedPoses all = handedPoses(session, {}, progress);
  EXPECT_THAT(done, ElementsAre(0, 1, 2));
  EXPECT_THAT(all.poses, IsEmpty());
  EXPECT_THAT(all.notes, ElementsAre(HasSubstr("'a' has no pose"), HasSubstr("'b' has no pose"),
                                     HasSubstr("'c' has no pose")));
  EXPECT_THAT(handedPoses(session, {"c", "a"}).notes,
              ElementsAre(HasSubstr("'a'"), HasSubstr("'c'")));
  EXPECT_ANY_THROW((void)handedPoses(session, {"none"}));
}

}  // namespace
}  // namespace boresight::test
