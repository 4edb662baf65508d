// SPDX-License-Identifier: Apache-2.0

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sessions/review/review_status.h"
#include "tests/sessions/review/judged_case.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using sessions::CheckState;
using sessions::DecisionError;
using sessions::ReviewState;
using sessions::reviewStatusOf;
using sessions::reviewStatusText;
using sessions::Session;

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const DecisionError& error) {
    return error.what();
  }
  return "";
}

sessions::Annotations someAnnotations(Random& random) {
  sessions::Annotations annotations;
  while (annotations == sessions::Annotations()) annotations = randomAnnotations(random);
  return annotations;
}

void expectRefused(const std::string& why, const std::function<void()>& act) {
  EXPECT_THAT(refusal(act), HasSubstr(why));
}

struct Decide : testing::Test {
  Random random = randomFor("Decide.Dropped");
  JudgedCase judged{random};
  const std::string seen = judged.subject.run->digest;  ///< the run on the reviewer's screen
};

TEST_F(Decide, Validation_NeedsNameCommentAndWaivers) {
  const auto refused = [&](const sessions::CheckWaivers& waivers,
                           const sessions::Signature& who = {"Ada", "right"}) {
    return refusal([&] { validated(judged.session, judged.subject, judged.checks, waivers, who); });
  };
  EXPECT_EQ(refused({}), "");
  EXPECT_THAT(refused({}, {" \t", "right"}), HasSubstr("give your name"));
  EXPECT_THAT(refused({}, {"Ada", " \n"}), HasSubstr("give a comment"));
  EXPECT_THAT(refused({{"converged", "so"}}), HasSubstr("has not failed"));
  EXPECT_THAT(refused({{"nothing", "so"}}), HasSubstr("no check 'nothing'"));
  judged.checks[0].state = judged.checks[1].state = CheckState::kFailed;
  EXPECT_THAT(refused({}), HasSubstr("Check of converged, Check of coverage"));
  EXPECT_THAT(refused({{"converged", "seen"}}), HasSubstr("Check of coverage"));
  EXPECT_THAT(refused({{"converged", "seen"}, {"coverage", " "}}), HasSubstr("give a reason"));
  EXPECT_EQ(refused({{"converged", "seen"}, {"coverage", "a shadow"}}), "");
}

TEST_F(Decide, NothingIsValidatedWithoutAnyCheck) {
  for (const auto& checks :
       {std::vector<sessions::Check>(), {JudgedCase::check("truth", CheckState::kNotApplicable)}}) {
    judged.checks = checks;
    expectRefused("has not been checked", [&] { judged.validatedBy("Ada"); });
  }
}

TEST_F(Decide, Validation_StoresPoseChecksAndWaivers) {
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

TEST_F(Decide, OnlyTheLastConvergedRunOfTheseInputsCanBeValidated) {
  JudgedCase other = judged;
  const auto validate = [&other] { other.validatedBy("Ada"); };
  other.subject.run->status = LocalizationStatus::kNotSupported;
  expectRefused("did not converge", validate);
  sessions::SessionCase moved = *judged.session.findCase("a");
  moved.camera_from_station_seed.translation_m.x() += 1e-9;
  other = judged;
  other.session = withCase(judged.session, moved);
  expectRefused("inputs have changed", validate);
  other = judged;
  other.noteRun(randomSha256(random), "converged", random);
  expectRefused("not the last run", validate);
  other.session = withoutCase(other.session, "a");
  expectRefused("no case 'a'", validate);
}

TEST_F(Decide, ChangedInput_InvalidatesADecisionAndIsNamed) {
  const Session before = judged.validatedBy("Ada");
  const std::vector<std::pair<std::string, std::function<void(Session&, sessions::SessionCase&)>>>
      edits = {
          {"the image, camera, mesh, seed or mask has",
           [](Session&, auto& item) { item.camera_from_station_seed.translation_m.x() += 1e-12; }},
          {"the truth has", [](Session&, auto& item) { item.camera_from_station_truth = Pose(); }},
          {"the stated sigmas of mesh and camera have",
           [](Session&, auto& item) { item.mesh_scale_sigma = 1e-3; }},
          {"the stated sigmas of mesh and camera",
           [](Session&, auto& item) {
             item.camera_covariance.emplace().of_vectors.setIdentity(12, 12);
           }},
          {"the requirement or the symmetries has",
           [](Session&, auto& item) { item.requirement.emplace().normal_mm = 1.0; }},
          {"the requirement or the symmetries has",
           [](Session&, auto& item) { item.symmetries = sessions::symmetriesIn("z"); }},
          {"the end effector has",
           [](Session&, auto& item) { item.camera_from_end_effector = Pose(); }},
          {"the rig has", [](Session&, auto& item) { item.rig.emplace().id = "r"; }},
          {"the onboard record has",
           [&](Session&, auto& item) { item.onboard_record = randomInput(random, ".whsr"); }},
          {"the limits of the checks have",
           [](Session& session, auto&) { session.review.preset = "photographs"; }},
          {"the image's file has",
           [&](Session&, auto& item) { item.image.source.sha256 = randomSha256(random); }},
          {"the image, camera, mesh, seed or mask",
           [&](Session&, auto& item) { item.image.color_sha256 = randomSha256(random); }},
          {"the image's label has",
           [](Session&, auto& item) {
             item.image.label.push_back({"PRODUCT_ID", "typed in"});
           }},
          {"the name of case or station has", [](Session&, auto& item) { item.station += "7"; }},
          {"the frames have",
           [&](Session&, auto& item) {
             item.station_frame = sessions::FrameName{"SITE", {1, 2, 3, 4}};
           }},
          {"the frames have",
           [&](Session&, auto& item) {
             item.camera_reference.emplace().camera_from_reference = randomPose(random);
           }},
          {"the frames have",
           [&](Session&, auto& item) {
             item.frames.push_back({sessions::kCameraFrame, sessions::kEndEffectorFrame,
                                    randomPose(random), Matrix6d(Matrix6d::Identity()),
                                    sessions::TransformSource::kTelemetry, "sol 12", "/arm.json",
                                    randomSha256(random)});
           }},
          {"the truth has",
           [](Session&, auto& item) { item.truth_source.emplace().file = "another"; }},
          {"there is a later run",
           [&](Session& session, auto&) {
             session.runs.push_back(session.runs.back());
             session.runs.back().digest = randomSha256(random);
           }},
          {"its run is missing", [](Session& session, auto&) { session.runs.clear(); }},
          {"the annotations have", [&](Session& session, auto& item) {
             session = withAnnotations(session, item.id, someAnnotations(random));
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
    EXPECT_THAT(reviewStatusText(status), StartsWith("NOT VALIDATED: "));
  }
}

/// Of frames each number counts, and their file's bytes, but not its folder.
TEST_F(Decide, FramesOfADecision_AreCoveredByNumbersCovarianceAndHash) {
  sessions::FrameTransform arm{sessions::FrameName{"ARM_BASE", {}},
                               sessions::kEndEffectorFrame,
                               randomPose(random),
                               Matrix6d(Matrix6d::Identity()),
                               sessions::TransformSource::kTelemetry,
                               "sol 12",
                               "/arm.json",
                               randomSha256(random)};
  judged.session = withChanged(judged.session, "a", [&](auto& item) { item.frames = {arm}; });
  const Session before = judged.validatedBy("Ada");
  const auto dropped = [&](const std::function<void(sessions::FrameTransform&)>& edit) {
    return reviewStatusOf(withChanged(before, "a", [&](auto& item) { edit(item.frames.front()); }),
                          "a")
        .dropped;
  };
  const std::string changed = "the frames have changed";
  EXPECT_EQ(dropped([](auto& frame) { frame.file = "/moved/arm.json"; }), "");
  EXPECT_EQ(dropped([](auto& frame) { frame.target_from_source.translation_m.x() += 1e-9; }),
            changed);
  EXPECT_EQ(dropped([](auto& frame) { (*frame.covariance)(3, 3) *= 0.5; }), changed);
  EXPECT_EQ(dropped([](auto& frame) { frame.origin = sessions::TransformSource::kCommanded; }),
            changed);
  EXPECT_EQ(dropped([&](auto& frame) { frame.file_sha256 = randomSha256(random); }), changed);
}

TEST_F(Decide, DecisionOfAnEarlierVersion_EndsAndNamesWhatItDoesNotCover) {
  Session before = judged.validatedBy("Ada");
  for (const char* name : {"frames", "names", "image_label"})
    ASSERT_EQ(before.decisions.back().input_fingerprint.erase(name), 1u) << name;
  const sessions::ReviewStatus status = reviewStatusOf(before, "a");
  EXPECT_FALSE(status.holds());
  EXPECT_EQ(status.dropped,
            "an earlier version made it and did not record the frames, the image's label and the "
            "name of case or station: decide again");
}

TEST_F(Decide, InvisibleText_IsNoNameNoCommentAndNoReason) {
  const auto validate = [&](const char* by, const char* comment, const char* reason) {
    return refusal([&] {
      validated(judged.session, judged.subject, judged.checks, {{"coverage", reason}},
                {by, comment});
    });
  };
  judged.checks[1].state = CheckState::kFailed;
  EXPECT_THAT(validate("\xE2\x80\x8B", "right", "so"), HasSubstr("give your name"));
  EXPECT_THAT(validate("Ada", "\xC2\xA0\xE2\x81\xA0", "so"), HasSubstr("give a comment"));
  EXPECT_THAT(validate("Ada", "right", "\xEF\xBB\xBF "), HasSubstr("not waived"));
  EXPECT_EQ(validate("\xD0\x90\xD0\xB4\xD0\xB0", "right", "so"), "") << "a name in Cyrillic";
  for (const char* other : {"a. op", "A\xE2\x80\xA4 Op", "A.\xE2\x80\x8BOp", "A Op."})
    EXPECT_TRUE(sessions::samePerson("A. Op", other)) << other;
  EXPECT_FALSE(sessions::samePerson("A. Op", "B. Op"));
  EXPECT_FALSE(sessions::samePerson("-", "+"));
}

TEST_F(Decide, RobustAnnotations_InvalidateAValidationOfAnAnnotatedCase) {
  const sessions::Annotations annotations = someAnnotations(random);
  for (const bool annotated : {false, true}) {
    if (annotated) judged.session = withAnnotations(judged.session, "a", annotations);
    Session after = judged.validatedBy("Ada");
    after.robust_annotations = !after.robust_annotations;
    EXPECT_EQ(reviewStatusOf(after, "a").holds(), !annotated);
  }
}

TEST_F(Decide, NewRunOfTheRigsOtherCamera_InvalidatesAValidation) {
  sessions::SessionCase session_case = *judged.session.findCase("a");
  session_case.rig = sessions::Rig{"rig", Pose()};
  sessions::SessionCase other = session_case;
  other.id = "b";
  judged.session = withCase(withCase(judged.session, session_case), other);
  Session after = judged.validatedBy("Ada");
  EXPECT_TRUE(reviewStatusOf(after, "a").holds());
  after.runs.push_back(after.runs.back());
  after.runs.back().case_id = "b";
  EXPECT_EQ(reviewStatusOf(after, "a").dropped, "the runs of the rig's other cameras have changed");
  after.runs.back().together =
      sessions::TogetherRecord{{{"b", "converged"}, {"a", "converged"}}, ""};
  EXPECT_TRUE(reviewStatusOf(after, "a").holds()) << "a run in which it had a part is no witness";
}

TEST_F(Decide, ChangeOfNonInputs_KeepsADecisionWhichOtherOptionsMakeOutdated) {
  Session after = judged.validatedBy("Ada");
  sessions::SessionCase session_case = *after.findCase("a");
  session_case.tags.push_back("looked at");
  session_case.camera_from_station_working = randomPose(random);
  after = withCase(after, session_case);
  after.review.second_person = false;
  after.runs.push_back(after.runs.back());  // the same run once more
  EXPECT_EQ(reviewStatusOf(after, "a").outdated, "");
  after.options = {{"pnp.min_inliers", std::int64_t{20}}};  // the run's own are part of its digest
  const sessions::ReviewStatus status = reviewStatusOf(after, "a");
  EXPECT_TRUE(status.holds());
  EXPECT_EQ(status.state, ReviewState::kValidated);
  EXPECT_EQ(reviewStatusText(status),
            "validated by Ada; outdated: the run was made with other options");
  after.options.clear();
  EXPECT_EQ(reviewStatusOf(after, "a").outdated, "") << "as it was";
}

TEST_F(Decide, Approval_ByTheSamePerson_IsRefused) {
  judged.session.review.second_person = true;
  expectRefused("no validation", [&] { approved(judged.session, "a", seen, {"Bob", "yes"}); });
  const Session first = judged.validatedBy("Ada L");
  EXPECT_EQ(reviewStatusOf(first, "a").state, ReviewState::kConverged);
  EXPECT_TRUE(reviewStatusOf(first, "a").awaits_approval);
  EXPECT_THAT(reviewStatusText(reviewStatusOf(first, "a")), HasSubstr("second person"));
  expectRefused("another person", [&] { approved(first, "a", seen, {"ada  l ", "yes"}); });
  expectRefused("comment", [&] { approved(first, "a", seen, {"Bob", ""}); });
  const Session second = approved(first, "a", seen, {"Bob", "yes"});
  EXPECT_EQ(reviewStatusOf(second, "a").state, ReviewState::kValidated);
  EXPECT_EQ(reviewStatusText(reviewStatusOf(second, "a")), "validated by Ada L, approved by Bob");
  expectRefused("already", [&] { approved(second, "a", seen, {"Eve", "yes"}); });
  Session other = first;
  other.runs.clear();
  expectRefused("no longer holds", [&] { approved(other, "a", seen, {"Bob", "yes"}); });
}

TEST_F(Decide, Rejection_NeedsNoPoseAndCanBeWithdrawn) {
  judged.session.runs.clear();
  const Session rejected = sessions::rejected(judged.session, "a", "", {}, {"Ada", "blurred"});
  EXPECT_EQ(reviewStatusOf(rejected, "a").state, ReviewState::kRejected);
  EXPECT_EQ(reviewStatusText(reviewStatusOf(rejected, "a")), "NOT VALIDATED: rejected by Ada");
  expectRefused("comment", [&] { sessions::rejected(judged.session, "a", "", {}, {"Ada", ""}); });
  const Session again = reopened(rejected, "a", {"Bob", "another image came down"});
  EXPECT_EQ(reviewStatusOf(again, "a").state, ReviewState::kNew);
  EXPECT_EQ(again.decisions.size(), 2u);
  expectRefused("no decision", [&] { reopened(again, "a", {"Bob", "once more"}); });
}

TEST_F(Decide, DecisionOnARunThatIsNotShown_IsRefused) {
  const std::string other = randomSha256(random);
  for (const std::string& unseen : {other, std::string()})
    expectRefused("is not the last run of 'a'", [&] {
      sessions::rejected(judged.session, "a", unseen, {}, {"Ada", "no"});
    });
  judged.session.review.second_person = true;
  const Session first = judged.validatedBy("Ada");
  for (const std::string& unseen : {other, std::string()})
    expectRefused("of another run", [&] { approved(first, "a", unseen, {"Bob", "yes"}); });
}

TEST_F(Decide, RejectionWithoutARun_DoesNotHoldForARunThatFollows) {
  const std::vector<sessions::RunRecord> runs(judged.session.runs.begin(),
                                              judged.session.runs.end());
  judged.session.runs.clear();
  Session after = sessions::rejected(judged.session, "a", "", {}, {"Ada", "blurred"});
  after.runs.push_back(runs.front());
  EXPECT_EQ(reviewStatusOf(after, "a").dropped, "there is a later run");
  EXPECT_EQ(reviewStatusOf(after, "a").state, ReviewState::kConverged);
}

TEST_F(Decide, UndecidedCase_IsInTheStateOfItsRunOrAnnotations) {
  const auto state = [this] { return reviewStatusOf(judged.session, "a").state; };
  EXPECT_EQ(state(), ReviewState::kConverged);
  judged.session.runs.back().status = "pnp_failed";
  EXPECT_EQ(state(), ReviewState::kFailed);
  judged.session = withAnnotations(judged.session, "a", someAnnotations(random));
  EXPECT_EQ(state(), ReviewState::kFailed);
  judged.session.runs.clear();
  EXPECT_EQ(state(), ReviewState::kAnnotated);
  judged.session = withAnnotations(judged.session, "a", {});
  EXPECT_EQ(state(), ReviewState::kNew);
  EXPECT_EQ(reviewStatusText(reviewStatusOf(judged.session, "a")), "NOT VALIDATED: new");
}

TEST_F(Decide, StatusText_NamesADecisionThatNoLongerHolds) {
  Session after = withAnnotations(judged.validatedBy("Ada"), "a", someAnnotations(random));
  EXPECT_EQ(reviewStatusText(reviewStatusOf(after, "a")),
            "NOT VALIDATED: converged; the validation by Ada no longer holds: the annotations have "
            "changed");
  after = sessions::rejected(judged.session, "a", seen, judged.checks, {"Bob", "blurred"});
  EXPECT_EQ(after.decisions.back().digest, judged.subject.run->digest);
  EXPECT_EQ(after.decisions.back().checks.size(), 3u);
  after = withAnnotations(after, "a", someAnnotations(random));
  EXPECT_EQ(reviewStatusText(reviewStatusOf(after, "a")),
            "NOT VALIDATED: converged; the rejection by Bob no longer holds: the annotations have "
            "changed");
}

TEST_F(Decide, AwaitingOutdatedValidation_SaysBoth) {
  judged.session.review.second_person = true;
  Session after = judged.validatedBy("Ada");
  after.options = {{"pnp.min_inliers", std::int64_t{20}}};
  EXPECT_EQ(reviewStatusText(reviewStatusOf(after, "a")),
            "NOT VALIDATED: converged; validated by Ada, a second person must approve; outdated: "
            "the run was made with other options");
}

TEST_F(Decide, DecisionWithoutItsInputsOrPose_DoesNotHold) {
  Session after = judged.validatedBy("Ada");
  after.decisions.back().input_fingerprint.clear();
  EXPECT_EQ(reviewStatusOf(after, "a").dropped, "it does not state its inputs");
  after = judged.validatedBy("Ada");
  after.decisions.back().pose.reset();
  EXPECT_EQ(reviewStatusOf(after, "a").dropped, "it does not state its inputs");
  after.decisions.back().verdict = sessions::Verdict::kRejected;
  EXPECT_EQ(reviewStatusOf(after, "a").dropped, "") << "a rejection needs no pose";
  EXPECT_EQ(reviewStatusOf(after, "a").judgedPose(), nullptr);
}

TEST_F(Decide, PoseOfAnnotations_NeedsNoRun) {
  judged.subject.source = sessions::PoseSource::kAnnotation;
  judged.subject.run.reset();
  judged.session.runs.clear();
  judged.session = withAnnotations(judged.session, "a", someAnnotations(random));
  Session after = judged.validatedBy("Ada");
  EXPECT_EQ(after.decisions.back().digest, "");
  EXPECT_EQ(after.decisions.back().input_fingerprint.count("run"), 0u);
  EXPECT_EQ(reviewStatusOf(after, "a").state, ReviewState::kValidated);
  after.runs.push_back(randomRun(random, "a"));
  EXPECT_TRUE(reviewStatusOf(after, "a").holds()) << "a run changes nothing about annotations";
}

TEST_F(Decide, Concern_NamesWhyAPoseCannotBeValidated) {
  const auto concern = [](const JudgedCase& of) {
    return validationConcern(of.session, of.subject);
  };
  EXPECT_EQ(concern(judged), "");
  JudgedCase other = judged;
  other.subject.run.reset();
  EXPECT_EQ(concern(other), "there is no finished run");
  other = judged;
  other.subject.run->digest = "";
  EXPECT_EQ(concern(other), "there is no finished run");
  other = judged;
  other.session.runs.clear();
  EXPECT_THAT(concern(other), HasSubstr("not the last run"));
  other = judged;
  other.session.runs.back().inputs_sha256 = randomSha256(random);
  EXPECT_EQ(concern(other), "the inputs have changed since the run: run again");
  other.subject.source = sessions::PoseSource::kAnnotation;
  EXPECT_EQ(concern(other), "");
}

TEST_F(Decide, ChangedInputs_AreListedOnceWithTheirVerb) {
  using sessions::changedInputsText;
  const std::map<std::string, std::string> before = {
      {"truth", "1"}, {"limits", "1"}, {"rig", "1"}, {"later", "1"}};
  const auto text = [&before](std::map<std::string, std::string> edits) {
    std::map<std::string, std::string> after = before;
    for (const auto& [name, value] : edits) {
      after[name] = value;
      if (value.empty()) after.erase(name);
    }
    return changedInputsText(before, after);
  };
  EXPECT_EQ(text({}), "");
  EXPECT_EQ(text({{"truth", "2"}}), "the truth has changed");
  EXPECT_EQ(text({{"limits", "2"}}), "the limits of the checks have changed");
  EXPECT_EQ(text({{"truth", "2"}, {"rig", ""}}), "the truth and the rig have changed");
  EXPECT_EQ(text({{"later", "2"}}), "later has changed") << "a name of another version";
  EXPECT_EQ(text({{"names", "1"}, {"truth", "2"}}),
            "an earlier version made it and did not record the name of case or station: decide "
            "again");
  for (const char* plural : {"annotations", "frames", "limits", "other_runs", "input_sigmas"})
    EXPECT_THAT(changedInputsText({{plural, "1"}}, {{plural, "2"}}),
                testing::EndsWith(" have changed"))
        << plural;
  for (const char* singular : {"inputs", "image", "image_label", "names", "run", "truth", "rig",
                               "requirement", "end_effector", "onboard_record"})
    EXPECT_THAT(changedInputsText({{singular, "1"}}, {{singular, "2"}}),
                testing::EndsWith(" has changed"))
        << singular;
}

/// Of the rig's other camera, everything that the comparison of both poses depends on.
TEST_F(Decide, OtherCameraOfTheRig_IsAnInput) {
  sessions::SessionCase session_case = *judged.session.findCase("a");
  session_case.rig = sessions::Rig{"rig", randomPose(random)};
  judged.session = withCase(judged.session, session_case);
  session_case.id = "b";
  judged.session = withCase(judged.session, session_case);
  const Session before = judged.validatedBy("Ada");
  const auto dropped = [&before](const char* id,
                                 const std::function<void(sessions::SessionCase&)>& edit) {
    return reviewStatusOf(withChanged(before, id, edit), "a").dropped;
  };
  const std::string changed = "the rig has changed";
  for (const char* id : {"a", "b"})
    EXPECT_EQ(dropped(id, [](auto& item) { item.rig->camera_from_rig.translation_m.x() += 1e-9; }),
              changed);
  EXPECT_EQ(dropped("b", [](auto& item) { item.camera.fx += 1e-9; }), changed);
  EXPECT_EQ(dropped("b", [](auto& item) { item.image.source.sha256[0] ^= 1; }), changed);
  EXPECT_EQ(dropped("b", [](auto& item) { item.mesh_scale_sigma = 0.05; }), changed);
  EXPECT_EQ(dropped("b", [](auto& item) { item.rig->id = "another"; }), changed);
  EXPECT_EQ(dropped("b", [](auto& item) { item.tags = {"dusty"}; }), "");
  EXPECT_EQ(reviewStatusOf(withAnnotations(before, "b", someAnnotations(random)), "a").dropped,
            "the annotations have changed");
  EXPECT_THAT(inputFingerprint(before, "none", ""), IsEmpty());
}

TEST_F(Decide, CaseThatDoesNotExist_CannotBeDecided) {
  expectRefused("no case 'x'", [&] { approved(judged.session, "x", seen, {"Bob", "yes"}); });
  expectRefused("no case 'x'", [&] {
    sessions::rejected(judged.session, "x", seen, {}, {"Bob", "no"});
  });
  expectRefused("no case 'x'", [&] { reopened(judged.session, "x", {"Bob", "no"}); });
  expectRefused("to take back", [&] { reopened(judged.session, "a", {"Bob", "no"}); });
  const Session rejection = sessions::rejected(judged.session, "a", seen, {}, {"Ada", "no"});
  expectRefused("no validation", [&] { approved(rejection, "a", seen, {"Bob", "yes"}); });
}

TEST(ReviewStateText, EachState_HasItsText) {
  const char* const expected[] = {"new",       "converged", "failed",
                                  "annotated", "validated", "rejected"};
  for (int i = 0; i < 6; ++i)
    EXPECT_STREQ(reviewStateText(static_cast<ReviewState>(i)), expected[i]);
}

}  // namespace
}  // namespace boresight::test
