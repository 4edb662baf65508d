// SPDX-License-Identifier: Apache-2.0

#include <functional>
#include <map>

#include <gmock/gmock.h>

#include "sessions/review/review_status.h"
#include "tests/sessions/review/judged_case.h"

namespace boresight::test {
namespace {

using sessions::CheckState;
using sessions::DecisionError;
using sessions::ReviewState;
using sessions::reviewStatusOf;
using sessions::reviewStatusText;
using sessions::Session;
using testing::HasSubstr;

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const DecisionError& error) {
    return error.what();
  }
  return "";
}

TEST(Decide, Validation_NeedsNameCommentAndWaivers) {
  Random random = randomFor("Decide.Validation");
  JudgedCase judged(random);
  const auto refused = [&judged](const sessions::CheckWaivers& waivers,
                                 const sessions::Signature& who) {
    return refusal([&] { validated(judged.session, judged.subject, judged.checks, waivers, who); });
  };
  EXPECT_EQ(refused({}, {"Ada", "right"}), "");
  EXPECT_THAT(refused({}, {" \t", "right"}), HasSubstr("give your name"));
  EXPECT_THAT(refused({}, {"Ada", " \n"}), HasSubstr("give a comment"));
  EXPECT_THAT(refused({{"converged", "so"}}, {"Ada", "right"}), HasSubstr("has not failed"));
  EXPECT_THAT(refused({{"nothing", "so"}}, {"Ada", "right"}), HasSubstr("no check 'nothing'"));

  judged.checks[0].state = CheckState::kFailed;
  judged.checks[1].state = CheckState::kFailed;
  EXPECT_THAT(refused({}, {"Ada", "right"}), HasSubstr("Check of converged, Check of coverage"));
  EXPECT_THAT(refused({{"converged", "seen"}}, {"Ada", "right"}), HasSubstr("Check of coverage"));
  EXPECT_THAT(refused({{"converged", "seen"}, {"coverage", " "}}, {"Ada", "right"}),
              HasSubstr("give a reason"));
  EXPECT_EQ(refused({{"converged", "seen"}, {"coverage", "a shadow"}}, {"Ada", "right"}), "");
}

TEST(Decide, NothingIsValidatedWithoutAnyCheck) {
  Random random = randomFor("Decide.NoChecks");
  JudgedCase judged(random);
  judged.checks.clear();
  EXPECT_THAT(refusal([&] { judged.validatedBy("Ada"); }), HasSubstr("has not been checked"));
  judged.checks = {JudgedCase::check("truth", CheckState::kNotApplicable)};
  EXPECT_THAT(refusal([&] { judged.validatedBy("Ada"); }), HasSubstr("has not been checked"));
}

TEST(Decide, Validation_StoresPoseChecksAndWaivers) {
  Random random = randomFor("Decide.Holds");
  JudgedCase judged(random);
  judged.checks[1].state = CheckState::kFailed;
  const Session next = validated(judged.session, judged.subject, judged.checks,
                                 {{"coverage", "  half of it is dark "}}, {" Ada ", "right"});
  ASSERT_EQ(next.decisions.size(), 1u);
  const sessions::Decision& decision = next.decisions.front();
  EXPECT_EQ(decision.by, "Ada");
  EXPECT_EQ(decision.digest, judged.subject.run->digest);
  EXPECT_EQ(decision.pose->camera_from_station, judged.subject.camera_from_station);
  EXPECT_EQ(decision.pose->covariance, judged.subject.covariance);
  ASSERT_EQ(decision.checks.size(), 3u);
  EXPECT_EQ(decision.checks[0].waiver_reason, "");
  EXPECT_EQ(decision.checks[1].waiver_reason, "half of it is dark");
  EXPECT_EQ(reviewStatusOf(next, "a").state, ReviewState::kValidated);
  EXPECT_EQ(reviewStatusText(reviewStatusOf(next, "a")), "validated by Ada");
}

TEST(Decide, OnlyTheLastConvergedRunOfTheseInputsCanBeValidated) {
  Random random = randomFor("Decide.Concern");
  JudgedCase judged(random);
  const auto refused = [&judged] { return refusal([&judged] { judged.validatedBy("Ada"); }); };

  JudgedCase other = judged;
  other.subject.run->status = LocalizationStatus::kNotSupported;
  EXPECT_THAT(refusal([&] { other.validatedBy("Ada"); }), HasSubstr("did not converge"));

  sessions::SessionCase moved = *judged.session.findCase("a");
  moved.camera_from_station_seed.translation_m.x() += 1e-9;
  other = judged;
  other.session = withCase(judged.session, moved);
  EXPECT_THAT(refusal([&] { other.validatedBy("Ada"); }), HasSubstr("inputs have changed"));

  judged.noteRun(randomSha256(random), "converged", random);
  EXPECT_THAT(refused(), HasSubstr("not the last run"));
  judged.session = withoutCase(judged.session, "a");
  EXPECT_THAT(refused(), HasSubstr("no case 'a'"));
}

TEST(Decide, ChangedInput_InvalidatesADecisionAndIsNamed) {
  Random random = randomFor("Decide.Dropped");
  const JudgedCase judged(random);
  const Session before = judged.validatedBy("Ada");
  using Edit = std::function<void(Session&, sessions::SessionCase&)>;
  const std::map<std::string, Edit> edits = {
      {"the image, camera, mesh, seed or mask has",
       [](Session&, auto& item) { item.camera_from_station_seed.translation_m.x() += 1e-12; }},
      {"the truth has", [&](Session&, auto& item) { item.camera_from_station_truth = Pose(); }},
      {"the stated sigmas of mesh and camera have",
       [](Session&, auto& item) { item.mesh_scale_sigma = 1e-3; }},
      {"the stated sigmas of mesh and camera",
       [](Session&, auto& item) {
         item.camera_covariance = sessions::CameraCovariance{Eigen::MatrixXd::Identity(12, 12)};
       }},
      {"the requirement has",
       [](Session&, auto& item) {
         item.requirement = {1.0, {}, {}, {}};
       }},
      {"the end effector has",
       [](Session&, auto& item) { item.camera_from_end_effector = Pose(); }},
      {"the rig has",
       [](Session&, auto& item) {
         item.rig = sessions::Rig{"r", Pose()};
       }},
      {"the onboard record has",
       [&](Session&, auto& item) { item.onboard_record = randomInput(random, ".whsr"); }},
      {"the limits of the checks have",
       [](Session& session, auto&) { session.review.preset = "photographs"; }},
      {"there is a later run",
       [&](Session& session, auto&) {
         sessions::RunRecord run = session.runs.back();
         run.digest = randomSha256(random);
         session.runs.push_back(run);
       }},
      {"its run is missing", [](Session& session, auto&) { session.runs.clear(); }},
      {"the annotations have", [&](Session& session, auto& item) {
         sessions::Annotations annotations;
         while (annotations == sessions::Annotations()) annotations = randomAnnotation(random);
         session = withAnnotations(session, item.id, annotations);
       }}};
  for (const auto& [text, edit] : edits) {
    Session after = before;
    sessions::SessionCase session_case = *before.findCase("a");
    edit(after, session_case);
    after = withCase(after, session_case);
    const sessions::ReviewStatus status = reviewStatusOf(after, "a");
    EXPECT_NE(status.state, ReviewState::kValidated) << text;
    EXPECT_FALSE(status.holds()) << text;
    EXPECT_THAT(status.dropped, HasSubstr(text));
    EXPECT_THAT(reviewStatusText(status), testing::StartsWith("NOT VALIDATED: "));
  }
}

TEST(Decide, RobustAnnotations_InvalidateAValidationOfAnAnnotatedCase) {
  Random random = randomFor("Decide.Robust");
  JudgedCase judged(random);
  sessions::Annotations annotations;
  while (annotations == sessions::Annotations()) annotations = randomAnnotation(random);
  for (const bool annotated : {false, true}) {
    if (annotated) judged.session = withAnnotations(judged.session, "a", annotations);
    Session after = judged.validatedBy("Ada");
    after.robust_annotations = !after.robust_annotations;
    EXPECT_EQ(reviewStatusOf(after, "a").holds(), !annotated);
  }
}

TEST(Decide, NewRunOfTheRigsOtherCamera_InvalidatesAValidation) {
  Random random = randomFor("Decide.OtherCamera");
  JudgedCase judged(random);
  sessions::SessionCase session_case = *judged.session.findCase("a");
  session_case.rig = sessions::Rig{"rig", Pose()};
  sessions::SessionCase other = session_case;
  other.id = "b";
  judged.session = withCase(withCase(judged.session, session_case), other);
  Session after = judged.validatedBy("Ada");
  EXPECT_TRUE(reviewStatusOf(after, "a").holds());
  sessions::RunRecord run = after.runs.back();
  run.case_id = "b";
  after.runs.push_back(run);
  EXPECT_EQ(reviewStatusOf(after, "a").dropped, "the runs of the rig's other cameras have changed");
  after.runs.back().together =
      sessions::TogetherRecord{{{"b", "converged"}, {"a", "converged"}}, ""};
  EXPECT_TRUE(reviewStatusOf(after, "a").holds()) << "a run in which it had a part is no witness";
}

TEST(Decide, ChangeOfNonInputs_KeepsADecision) {
  Random random = randomFor("Decide.Stands");
  const JudgedCase judged(random);
  Session after = judged.validatedBy("Ada");
  sessions::SessionCase session_case = *after.findCase("a");
  session_case.tags.push_back("looked at");
  session_case.camera_from_station_working = randomPose(random);
  after = withCase(after, session_case);
  after.review.second_person = false;
  after.options = {{"pnp.seed", std::int64_t{7}}};  // the run's own are part of its digest
  after.runs.push_back(after.runs.back());          // the same run once more
  EXPECT_EQ(reviewStatusOf(after, "a").state, ReviewState::kValidated);
}

TEST(Decide, Approval_ByTheSamePerson_IsRefused) {
  Random random = randomFor("Decide.Approval");
  JudgedCase judged(random);
  judged.session.review.second_person = true;
  EXPECT_THAT(refusal([&] {
                approved(judged.session, "a", {"Bob", "yes"});
              }),
              HasSubstr("no validation"));
  const Session first = judged.validatedBy("Ada L");
  EXPECT_EQ(reviewStatusOf(first, "a").state, ReviewState::kConverged);
  EXPECT_TRUE(reviewStatusOf(first, "a").awaits_approval);
  EXPECT_THAT(reviewStatusText(reviewStatusOf(first, "a")), HasSubstr("second person"));
  EXPECT_THAT(refusal([&] {
                approved(first, "a", {"ada  l ", "yes"});
              }),
              HasSubstr("another person"));
  EXPECT_THAT(refusal([&] { approved(first, "a", {"Bob", ""}); }), HasSubstr("comment"));

  const Session second = approved(first, "a", {"Bob", "yes"});
  EXPECT_EQ(reviewStatusOf(second, "a").state, ReviewState::kValidated);
  EXPECT_EQ(reviewStatusText(reviewStatusOf(second, "a")), "validated by Ada L, approved by Bob");
  EXPECT_THAT(refusal([&] { approved(second, "a", {"Eve", "yes"}); }), HasSubstr("already"));
  Session other = first;
  other.runs.clear();
  EXPECT_THAT(refusal([&] { approved(other, "a", {"Bob", "yes"}); }), HasSubstr("no longer holds"));
}

TEST(Decide, ValidationOfARunWithOtherOptions_IsOutdatedAndHolds) {
  Random random = randomFor("Decide.Outdated");
  const JudgedCase judged(random);
  Session after = judged.validatedBy("Ada");
  EXPECT_EQ(reviewStatusOf(after, "a").outdated, "");
  after.options = {{"pnp.min_inliers", std::int64_t{20}}};
  const sessions::ReviewStatus status = reviewStatusOf(after, "a");
  EXPECT_TRUE(status.holds());
  EXPECT_EQ(status.state, ReviewState::kValidated);
  EXPECT_EQ(reviewStatusText(status),
            "validated by Ada; outdated: the run was made with other options");
  after.options.clear();
  EXPECT_EQ(reviewStatusOf(after, "a").outdated, "") << "as it was";
}

TEST(Decide, Rejection_NeedsNoPoseAndCanBeWithdrawn) {
  Random random = randomFor("Decide.Rejection");
  JudgedCase judged(random);
  judged.session.runs.clear();
  const Session rejected = sessions::rejected(judged.session, "a", {}, {"Ada", "blurred"});
  EXPECT_EQ(reviewStatusOf(rejected, "a").state, ReviewState::kRejected);
  EXPECT_EQ(reviewStatusText(reviewStatusOf(rejected, "a")), "NOT VALIDATED: rejected by Ada");
  EXPECT_THAT(refusal([&] {
                sessions::rejected(judged.session, "a", {}, {"Ada", ""});
              }),
              HasSubstr("comment"));
  const Session again = reopened(rejected, "a", {"Bob", "another image came down"});
  EXPECT_EQ(reviewStatusOf(again, "a").state, ReviewState::kNew);
  EXPECT_EQ(again.decisions.size(), 2u);
  EXPECT_THAT(refusal([&] {
                reopened(again, "a", {"Bob", "once more"});
              }),
              HasSubstr("no decision"));
}

}  // namespace
}  // namespace boresight::test
