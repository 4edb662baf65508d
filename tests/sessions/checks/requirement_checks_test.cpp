// SPDX-License-Identifier: Apache-2.0

#include <memory>

#include "sessions/checks/checks.h"
#include "sessions/checks/pose_uncertainty.h"
#include "tests/sessions/checks/drawn_box.h"
#include "tests/sessions/checks/find_check.h"
#include "tests/support/box_mesh.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using test::DrawnBox;
using test::findCheck;

/// At half a metre, with 0.4 mm asked for along and across the view axis.
ReviewSubject someSubject() {
  ReviewSubject subject;
  subject.camera_from_station.translation_m = {0.0, 0.0, 0.5};
  subject.requirement = {0.4, 0.4, 0.25, {}};
  return subject;
}

class AgreementChecks : public testing::Test {
 protected:
  AgreementChecks() { subject_.loaded = loaded_; }

  Pose movedBy(double x_mm, double z_mm) const {
    Pose moved = subject_.camera_from_station;
    moved.translation_m += 1e-3 * Eigen::Vector3d(x_mm, 0.0, z_mm);
    return moved;
  }
  Check checkOf(const std::string& id) const {
    return findCheck(test::addedChecks(addAgreementChecks, subject_, CheckLimits()), id);
  }

  const std::shared_ptr<LoadedCase> loaded_ = std::make_shared<LoadedCase>();
  SessionCase& one_ = loaded_->source;
  ReviewSubject subject_ = someSubject();
};

TEST_F(AgreementChecks, ExactTruth_IsComparedWithTheRequirement) {
  for (const char* id : {"agreement_annotation", "agreement_truth", "agreement_camera"})
    EXPECT_EQ(checkOf(id).state, CheckState::kNotApplicable) << id << ", no other pose";
  one_.camera_from_station_truth = movedBy(0.1, -0.3);
  EXPECT_NEAR(checkOf("agreement_truth").figure.value(), 75.0, 1e-6);
  EXPECT_EQ(checkOf("agreement_truth").state, CheckState::kPassed);
  one_.camera_from_station_truth = movedBy(0.6, 0.0);
  EXPECT_NEAR(checkOf("agreement_truth").figure.value(), 150.0, 1e-6);
  EXPECT_EQ(checkOf("agreement_truth").state, CheckState::kFailed);
}

TEST_F(AgreementChecks, PosesThatDifferByADeclaredSymmetry_CountAsTheSame) {
  loaded_->scene = test::boxMesh({0.03, 0.02, 0.01});
  const Symmetries half_turns = symmetriesIn("x 180; y 180; z 180");
  const Pose turned = movedBy(0.1, -0.3) * half_turns.discrete[1];
  one_.camera_from_station_truth = turned;
  subject_.annotated = OtherPose{"the annotation", turned};
  for (const char* id : {"agreement_annotation", "agreement_truth"})
    EXPECT_EQ(checkOf(id).state, CheckState::kFailed) << id;
  EXPECT_FALSE(withinRequirement(subject_, turned));
  one_.symmetries = half_turns;
  for (const char* id : {"agreement_annotation", "agreement_truth"}) {
    EXPECT_NEAR(checkOf(id).figure.value(), 75.0, 1e-6) << id;
    EXPECT_THAT(checkOf(id).sentence, HasSubstr("differ by a declared symmetry"));
  }
  EXPECT_TRUE(withinRequirement(subject_, turned));
  EXPECT_FALSE(withinRequirement(subject_, movedBy(0.6, 0.0) * half_turns.discrete[1]));
}

TEST_F(AgreementChecks, TruthThatIsThePoseOfARun_IsNoEvidence) {
  setTruth(one_, subject_.camera_from_station,
           {TruthOrigin::kRun, "pose.json", "", std::string(64, 'a')});
  EXPECT_EQ(checkOf("agreement_truth").state, CheckState::kNotApplicable);
  EXPECT_THAT(checkOf("agreement_truth").sentence,
              HasSubstr("the pose of run aaaaaaaaaaaaaaaa: agreement with it proves nothing"));
}

TEST_F(AgreementChecks, AnnotatedPoseAgainstItself_IsNoEvidence) {
  setTruth(one_, subject_.camera_from_station, {TruthOrigin::kAnnotated, "", "", ""});
  EXPECT_EQ(checkOf("agreement_truth").state, CheckState::kPassed) << "of a run it is";
  subject_.source = PoseSource::kAnnotation;
  EXPECT_EQ(checkOf("agreement_truth").state, CheckState::kNotApplicable);
  setTruth(one_, movedBy(0.1, 0.0), {TruthOrigin::kAnnotated, "", "", ""});
  EXPECT_EQ(checkOf("agreement_truth").state, CheckState::kPassed) << "of other annotations";
}

TEST_F(AgreementChecks, CoarseTruthFromAnnotations_IsComparedWithinItsSigmasAndReportedAsWeak) {
  setTruth(one_, movedBy(0.0, 8.0), {});
  EXPECT_NEAR(checkOf("agreement_truth").figure.value(), 2000.0, 1e-6) << "it is exact";
  // 3 sigma of 10 mm along the view axis, of the truth and of the pose together.
  setTruth(one_, movedBy(0.0, 8.0), {}, Matrix6d(9.9e-5 * Matrix6d::Identity()));
  subject_.covariance.picture = 1e-6 * Matrix6d::Identity();
  const Check check = checkOf("agreement_truth");
  EXPECT_NEAR(check.figure.value(), 100.0 * 8.0 / std::hypot(0.4, 30.0), 1e-6);
  EXPECT_EQ(check.state, CheckState::kPassed);
  EXPECT_THAT(check.sentence, HasSubstr("this check is weak"));
}

TEST_F(AgreementChecks, AnnotationAndRunShareTheErrorsOfMeshAndCamera) {
  subject_.covariance = {1e-12 * Matrix6d::Identity(), Matrix6d::Identity(), Matrix6d::Identity()};
  subject_.annotated.emplace();
  subject_.annotated->camera_from_station = movedBy(0.0, 0.8);
  subject_.annotated->covariance.picture = 1e-12 * Matrix6d::Identity();
  EXPECT_NEAR(checkOf("agreement_annotation").figure.value(), 200.0, 0.1);
}

TEST_F(AgreementChecks, SeveralCameras_AreIndependentAndTheLargestDistanceCounts) {
  OtherPose other{"left", movedBy(0.0, 0.8), {1e-12 * Matrix6d::Identity(), {}, {}}};
  other.covariance.mesh_scale = other.covariance.calibration = Matrix6d::Zero();
  other.covariance.calibration(5, 5) = 1e-8;
  subject_.covariance = other.covariance;
  subject_.other_cameras = {other};
  EXPECT_NEAR(checkOf("agreement_camera").figure.value(),
              100.0 * 0.8 / std::hypot(0.4, 0.3 * std::sqrt(2.0)), 0.1);
  subject_.covariance = {};
  subject_.other_cameras = {
      {"left", movedBy(0.1, 0.0)}, {"top", movedBy(0.0, 0.8)}, {"right", movedBy(0.2, 0.0)}};
  EXPECT_NEAR(checkOf("agreement_camera").figure.value(), 200.0, 1e-6);
  EXPECT_THAT(checkOf("agreement_camera").sentence, HasSubstr("top"));
}

TEST_F(AgreementChecks, Sentence_StatesWhereThePosesDiffer) {
  setTruth(one_, movedBy(0.1, -0.3), {TruthOrigin::kAnnotated, "", "", ""});
  const auto sentence = [&] { return checkOf("agreement_truth").sentence; };
  EXPECT_THAT(sentence(), HasSubstr("across the view axis at the camera"));
  EXPECT_THAT(sentence(), HasSubstr("The pose and the truth (annotated) differ"));
  one_.camera_from_end_effector = Pose();
  EXPECT_THAT(sentence(), HasSubstr("at the end effector"));
}

TEST_F(AgreementChecks, CoarseAnnotation_IsComparedWithinItsSigmasAndReportedAsWeak) {
  subject_.annotated.emplace();
  subject_.annotated->camera_from_station = movedBy(0.6, 0.0);
  EXPECT_EQ(checkOf("agreement_annotation").state, CheckState::kFailed);
  // 3 sigma of 0.4 mm per axis: across the axis 3 sqrt(2) 0.4 mm and the requirement together.
  subject_.annotated->covariance.picture = 1.6e-7 * Matrix6d::Identity();
  const Check check = checkOf("agreement_annotation");
  EXPECT_NEAR(check.figure.value(), 100.0 * 0.6 / std::hypot(0.4, 1.2 * std::sqrt(2.0)), 1e-6);
  EXPECT_EQ(check.state, CheckState::kPassed);
  EXPECT_THAT(check.sentence, HasSubstr("this check is weak"));
}

TEST_F(AgreementChecks, WithinRequirement_NeedsEveryMember) {
  EXPECT_TRUE(withinRequirement(subject_, movedBy(0.3, 0.3)));
  EXPECT_FALSE(withinRequirement(subject_, movedBy(0.3, 0.5)));
  Pose turned = subject_.camera_from_station;
  turned.rotation = rotationExp({0.005, 0.0, 0.0}) * turned.rotation;
  EXPECT_FALSE(withinRequirement(subject_, turned));
}

/// The checks "returned" and "competing".
std::pair<Check, Check> convergencePair(const ConvergenceResult& convergence) {
  const auto checks = test::addedChecks(addConvergenceChecks, convergence, CheckLimits());
  EXPECT_EQ(checks.size(), 2u);
  return {findCheck(checks, "convergence_returned"), findCheck(checks, "convergence_competing")};
}

TEST(ConvergenceChecks, TooFewReturningSeeds_Fail) {
  const auto none = convergencePair({});
  EXPECT_EQ(none.first.state, CheckState::kNotApplicable);
  EXPECT_EQ(none.second.state, CheckState::kNotApplicable);
  const double limit = CheckLimits().convergence_percent;
  ConvergenceResult convergence{100, 100, static_cast<int>(limit), 0.5, {}};
  EXPECT_EQ(convergencePair(convergence).first.figure, limit);
  EXPECT_EQ(convergencePair(convergence).first.state, CheckState::kPassed);
  --convergence.returned;
  EXPECT_EQ(convergencePair(convergence).first.state, CheckState::kFailed);
  EXPECT_EQ(convergencePair(convergence).second.state, CheckState::kPassed);
  const auto no_seed = convergencePair(ConvergenceResult{10, 10, 0, 0.5, {}});
  EXPECT_EQ(no_seed.first.state, CheckState::kFailed);
  EXPECT_EQ(no_seed.second.state, CheckState::kNotApplicable);
}

TEST(ConvergenceChecks, CompetingPose_FailsOnlyIfItFitsBetter) {
  ConvergenceResult convergence{10, 10, 9, 0.5, {{Pose(), false, 0.3}}};
  const auto competing = [&convergence] { return convergencePair(convergence).second; };
  EXPECT_EQ(competing().state, CheckState::kPassed);
  EXPECT_NEAR(competing().figure.value(), 60.0, 1e-9);
  convergence.competing.push_back({Pose(), false, 0.7});
  EXPECT_EQ(competing().state, CheckState::kFailed);
  EXPECT_THAT(competing().sentence, HasSubstr("another pose 70 %"));
  convergence.competing.push_back({Pose(), true, 0.8});
  EXPECT_THAT(competing().sentence, HasSubstr("mirror image of the station 80 %"));
  convergence.coverage = 0.0;
  EXPECT_EQ(competing().state, CheckState::kFailed);
}

Check onboardCheck(const ReviewSubject& subject) {
  return findCheck(test::addedChecks(addOnboardCheck, subject), "agreement_onboard");
}

TEST(OnboardCheck, States_FollowTheComparison) {
  ReviewSubject subject = someSubject();
  EXPECT_EQ(onboardCheck(subject).state, CheckState::kNotApplicable);
  subject.onboard.emplace().verdict = RunVerdict::kEqual;
  EXPECT_EQ(onboardCheck(subject).state, CheckState::kPassed);
  subject.onboard->first.emplace().text = "The pixels differ.";
  subject.onboard->verdict = RunVerdict::kWithinLimits;
  subject.onboard->missing = {"first: the end is cut off"};
  for (bool RecordComparison::*part :
       {&RecordComparison::inputs_compared, &RecordComparison::ends_compared}) {
    EXPECT_EQ(onboardCheck(subject).state, CheckState::kNotApplicable) << "it shows nothing";
    EXPECT_THAT(onboardCheck(subject).sentence, HasSubstr("First: the end is cut off."));
    subject.onboard.value().*part = true;
  }
  EXPECT_EQ(onboardCheck(subject).state, CheckState::kPassed);
  EXPECT_THAT(onboardCheck(subject).sentence, HasSubstr("The pixels differ."));
  subject.onboard->verdict = RunVerdict::kDifferent;
  subject.onboard->beyond = {"the final poses are 7 sigmas apart", "the images are of two sizes"};
  EXPECT_EQ(onboardCheck(subject).state, CheckState::kFailed);
  EXPECT_THAT(onboardCheck(subject).sentence,
              HasSubstr("run. The pixels differ. The final poses are 7 sigmas apart. The images"));
  subject.onboard->verdict = RunVerdict::kUndecided;
  EXPECT_EQ(onboardCheck(subject).state, CheckState::kNotApplicable);
}

/// Independent sigmas: 1 mrad about every axis, 0.1, 0.1 and 0.2 mm along them.
Matrix6d someCovariance() {
  Vector6d sigma;
  sigma << 1e-3, 1e-3, 1e-3, 1e-4, 1e-4, 2e-4;
  return sigma.cwiseAbs2().asDiagonal();
}

class PrecisionChecks : public testing::Test {
 protected:
  Check checkOf(const std::string& id) const {
    return findCheck(test::addedChecks(addPrecisionChecks, subject_, CheckLimits()), id);
  }
  const DrawnBox box_;
  ReviewSubject subject_ = box_.subject(box_.camera_from_station_);
};

TEST_F(PrecisionChecks, SigmasAreSetAgainstWhatTheRequirementNames) {
  subject_.covariance.picture = someCovariance();
  subject_.requirement = {0.5, 0.5, {}, {}};
  EXPECT_NEAR(checkOf("covariance_normal").figure.value(), 0.6, 1e-9);
  EXPECT_EQ(checkOf("covariance_normal").state, CheckState::kFailed);
  EXPECT_NEAR(checkOf("covariance_lateral").figure.value(), 0.3 * std::sqrt(2.0), 1e-9);
  EXPECT_EQ(checkOf("covariance_lateral").state, CheckState::kPassed);
  EXPECT_EQ(checkOf("covariance_rotation").state, CheckState::kNotApplicable);
}

TEST_F(PrecisionChecks, FewAnnotations_FailWhereTheRequirementLimitsTheirSigmas) {
  subject_.covariance.picture = someCovariance();
  subject_.requirement = {0.5, 0.5, {}, {}};
  subject_.degrees_of_freedom = 5;
  EXPECT_EQ(checkOf("covariance_normal").state, CheckState::kFailed);
  EXPECT_THAT(checkOf("covariance_normal").sentence, HasSubstr("are 0.600 mm"))
      << "it is too large";
  EXPECT_EQ(checkOf("covariance_lateral").state, CheckState::kFailed);
  EXPECT_EQ(checkOf("covariance_lateral").sentence,
            "The annotations have 5 degrees of freedom, which cannot confirm their sigmas: "
            "annotate more points.");
  EXPECT_EQ(checkOf("covariance_rotation").state, CheckState::kNotApplicable);
  subject_.degrees_of_freedom = 6;
  EXPECT_EQ(checkOf("covariance_lateral").state, CheckState::kPassed);
}

TEST_F(PrecisionChecks, PoseWithoutCovariance_FailsWhatTheRequirementLimits) {
  subject_.requirement = {0.5, {}, {}, 3.5};
  for (const char* id : {"covariance_normal", "covariance_projection"}) {
    EXPECT_EQ(checkOf(id).state, CheckState::kFailed) << id;
    EXPECT_THAT(checkOf(id).sentence, HasSubstr("has no covariance")) << id;
  }
  for (const char* id : {"covariance_lateral", "covariance_rotation"})
    EXPECT_EQ(checkOf(id).state, CheckState::kNotApplicable) << id;
}

TEST_F(PrecisionChecks, InTheImageTheyAreTheSpreadOfTheEdges) {
  // 0.5 mm along x at half a metre with f = 1000 px: a pixel, whatever the place's depth makes of
  // it.
  subject_.covariance.picture(3, 3) = 0.5e-3 * 0.5e-3;
  subject_.requirement = {{}, {}, {}, 3.5};
  EXPECT_NEAR(checkOf("covariance_projection").figure.value(), 3.0, 0.25);
  EXPECT_EQ(checkOf("covariance_projection").state, CheckState::kPassed);
}

TEST_F(PrecisionChecks, UnstatedScaleAndCalibration_UseDefaults) {
  subject_.covariance = poseCovariance(subject_.loaded->source, subject_.loaded->scene.view(),
                                       subject_.camera_from_station, 1e-12 * Matrix6d::Identity());
  // 0.02 % of half a metre twice over, less what the box's own depth tells of the focal length.
  const Check check = checkOf("covariance_normal");
  EXPECT_NEAR(check.figure.value(), 3.0 * 0.1 * std::sqrt(2.0), 0.02);
  EXPECT_EQ(check.state, CheckState::kFailed) << "0.4 mm are required";
  EXPECT_THAT(check.sentence, HasSubstr("limited by the mesh's scale (0.02 %, assumed) and the "
                                        "camera's calibration (0.02 % and "));
  EXPECT_THAT(check.sentence, HasSubstr(" px, assumed): 0.4"));
  EXPECT_THAT(check.sentence, HasSubstr("state mesh_scale_sigma"));
}

TEST_F(PrecisionChecks, Sentence_StatesTheReferencePoint) {
  subject_.covariance.picture = someCovariance();
  EXPECT_THAT(checkOf("covariance_normal").sentence, StartsWith("3 sigma at the camera are "));
  auto loaded = std::make_shared<LoadedCase>();
  loaded->source.camera_from_end_effector = Pose();
  subject_.loaded = loaded;
  EXPECT_THAT(checkOf("covariance_normal").sentence,
              StartsWith("3 sigma at the end effector are "));
}

}  // namespace
}  // namespace boresight::sessions
