// SPDX-License-Identifier: Apache-2.0
// Whole checks of the examples that ship: right ones pass, wrong ones do not.
#include <array>
#include <filesystem>
#include <set>

#include "sessions/checks/checks.h"
#include "sessions/checks/pose_uncertainty.h"
#include "sessions/decision/check.h"
#include "sessions/evaluation/batch.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/io/files/errors.h"
#include "sessions/session/session_maker.h"
#include "tests/sessions/checks/find_check.h"
#include "tests/support/annotated_example.h"
#include "tests/support/example_case.h"
#include "tests/support/loaded_example.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::exampleFolder;
using test::findCheck;

struct ExampleReview {
  Session session;
  std::string case_id;
  ReviewSubject subject;
};

/// A station's case, run, stored and read again.
ExampleReview runExample(const std::string& station) {
  static const test::TemporaryFolder folder;
  ExampleReview review;
  review.session = makeSession(exampleFolder() / "dataset.json");
  review.case_id = test::caseOfStation(review.session, station);
  const auto loaded = loadCase(*review.session.findCase(review.case_id));
  const LocalizationTrace trace = runCase(review.session, *loaded);
  review.session = withRun(
      review.session, storeRun(review.session, review.case_id, trace, folder / "a.boresight.json"));
  review.subject = reviewSubject(review.session, loaded, PoseSource::kRun);
  return review;
}

const ExampleReview& example(const std::string& station) {
  static const ExampleReview bc = runExample("bc");
  static const ExampleReview os = runExample("os");
  return station == "bc" ? bc : os;
}

CheckLimits presetLimits() { return checkLimits(kDefaultCheckPreset, {}); }

/// The subject's case without the truth, which would tell at once.
std::shared_ptr<LoadedCase> withoutTruth(const ReviewSubject& subject) {
  auto loaded = test::copyOf(*subject.loaded);
  loaded->source.camera_from_station_truth.reset();
  return loaded;
}

ReviewSubject displaced(const ReviewSubject& subject, const Vector6d& xi) {
  ReviewSubject moved = subject;
  moved.camera_from_station = perturbed(xi, subject.camera_from_station);
  moved.loaded = withoutTruth(subject);
  return moved;
}

TEST(CheckPose, Examples_PassAllChecks) {
  for (const char* station : {"bc", "os"}) {
    const auto checks = checkPose(example(station).subject, presetLimits());
    EXPECT_TRUE(allPassed(checks)) << station << "\n" << checksText(checks, true);
    EXPECT_EQ(findCheck(checks, "agreement_truth").state, CheckState::kPassed);
    EXPECT_EQ(findCheck(checks, "edge_coverage").state, CheckState::kPassed);
  }
}

/// The station's case with another mesh scale or camera, run again from the same seed.
ReviewSubject runWith(const std::string& station, double mesh_scale, void (*change)(SessionCase&)) {
  const ExampleReview& review = example(station);
  const auto loaded = withoutTruth(review.subject);
  change(loaded->source);
  EXPECT_EQ(prepareCamera(loaded->source.camera), Status::kOk);
  for (Eigen::Vector3f& vertex : loaded->scene.vertices_in_station_m)
    vertex *= static_cast<float>(mesh_scale);
  LocalizerOptions options = caseOptions(review.session, loaded->source, "session");
  options.support.gate = false;  // the run itself refuses such a focal length
  const LocalizationTrace trace = runCase(*loaded, options);
  EXPECT_TRUE(trace.converged());
  ReviewSubject subject = review.subject;
  subject.loaded = loaded;
  subject.camera_from_station = trace.camera_from_station;
  subject.covariance = poseCovariance(loaded->source, loaded->scene.view(),
                                      trace.camera_from_station, trace.covariance);
  subject.run = trace;
  return subject;
}

TEST(CheckPose, AMeshHalfAPercentTooLargeIsCoveredByItsStatedScaleAndFails) {
  for (const char* station : {"bc", "os"}) {
    const auto subject = runWith(
        station, 1.005, [](SessionCase& session_case) { session_case.mesh_scale_sigma = 0.005; });
    const SessionCase& truth = example(station).subject.loaded->source;
    // Along the view axis at the end effector.
    const auto sigma = poseSigma(subject.covariance.total(), truth.camera_from_end_effector);
    const PoseError error = poseError(*truth.camera_from_station_truth, subject.camera_from_station,
                                      truth.camera_from_end_effector);
    EXPECT_GT(std::abs(error.normal_mm), 1.5) << station;
    EXPECT_LT(std::abs(error.normal_mm), 1.2 * sigma.value().normal_mm) << station;
    const Check check = findCheck(checkPose(subject, presetLimits()), "covariance_normal");
    EXPECT_EQ(check.state, CheckState::kFailed) << check.sentence;
    EXPECT_THAT(check.sentence, HasSubstr("scale (0.5 %)"));
  }
}

TEST(CheckPose, AWrongPrincipalPointOrFocalLengthIsFoundByTheEdges) {
  const std::pair<const char*, void (*)(SessionCase&)> wrongs[] = {
      {"camera_centre", [](SessionCase& session_case) { session_case.camera.cx += 10.0; }},
      {"camera_centre", [](SessionCase& session_case) { session_case.camera.cx -= 10.0; }},
      {"camera_focal", [](SessionCase& session_case) {
         session_case.camera.fx *= 1.015;
         session_case.camera.fy *= 1.015;
       }}};
  for (const char* station : {"bc", "os"})
    for (const auto& [id, change] : wrongs) {
      const Check check = findCheck(checkPose(runWith(station, 1.0, change), presetLimits()), id);
      EXPECT_EQ(check.state, CheckState::kFailed) << station << ": " << check.sentence;
    }
}

TEST(CheckPose, APoseThatIsOffOrOfAnotherMeshFailsAndTheTextStatesTheReason) {
  const ReviewSubject& right = example("bc").subject;
  for (int axis : {3, 4}) {
    const auto checks = checkPose(displaced(right, 0.003 * Vector6d::Unit(axis)), presetLimits());
    EXPECT_FALSE(allPassed(checks)) << axis << "\n" << checksText(checks, true);
  }
  EXPECT_THAT(checksText(checkPose(displaced(right, 0.02 * Vector6d::Unit(3)), presetLimits())),
              AllOf(HasSubstr("FAIL  Predicted edges that are seen"),
                    HasSubstr("Check the overlay"), HasSubstr(" failed, ")));
  ReviewSubject subject = right;
  const auto loaded = withoutTruth(right);
  loaded->scene = example("os").subject.loaded->scene;
  subject.loaded = loaded;
  const auto checks = checkPose(subject, presetLimits());
  EXPECT_EQ(findCheck(checks, "edge_coverage").state, CheckState::kFailed)
      << checksText(checks, true);
}

TEST(CheckPose, FiguresAreTheSameEveryTimeAndIdsAreTheSameForEveryPose) {
  const auto once = checkPose(example("os").subject, presetLimits());
  EXPECT_EQ(once, checkPose(example("os").subject, presetLimits()));
  const auto bare = checkPose(ReviewSubject(), CheckLimits());
  ASSERT_EQ(once.size(), bare.size());
  std::set<std::string> ids;
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].id, bare[i].id);
    EXPECT_FALSE(once[i].sentence.empty()) << once[i].id;
    EXPECT_TRUE(ids.insert(once[i].id).second) << once[i].id;
  }
}

TEST(CheckPose, AnnotationsOfThePoseAgreeAndArePosesOfTheirOwn) {
  ExampleReview review = example("bc");
  review.session.annotations = test::annotatedExample(0.0).annotations;
  const auto loaded = review.subject.loaded;
  const auto run = reviewSubject(review.session, loaded, PoseSource::kRun);
  ASSERT_TRUE(run.annotated);
  EXPECT_EQ(findCheck(checkPose(run, presetLimits()), "agreement_annotation").state,
            CheckState::kPassed);
  const auto annotated = reviewSubject(review.session, loaded, PoseSource::kAnnotation);
  EXPECT_FALSE(annotated.run);
  EXPECT_EQ(annotated.camera_from_station, run.annotated->camera_from_station);
  const auto checks = checkPose(annotated, presetLimits());
  EXPECT_EQ(findCheck(checks, "edge_coverage").state, CheckState::kPassed);
  EXPECT_EQ(findCheck(checks, "converged").state, CheckState::kNotApplicable);
}

TEST(CheckPose, OtherCamera_IsComparedThroughTheRig) {
  ExampleReview review = example("bc");
  // The same image again, declared as taken by a camera shifted by 10 cm and turned by 0.1 rad: the
  // pose that it finds disagrees by as much.
  SessionCase second = *review.session.findCase(review.case_id);
  second.id = "second";
  review.session = withCase(review.session, second);
  RunRecord run = *review.session.lastRunOf(review.case_id);
  run.case_id = "second";
  review.session.runs.push_back(run);
  SessionCase session_case = *review.session.findCase(review.case_id);
  const Pose camera_from_rig{rotationExp({0.1, 0.0, 0.0}), {0.1, 0.0, 0.0}};
  session_case.rig = second.rig = Rig{"rig", camera_from_rig};
  review.session = withCase(withCase(review.session, session_case), second);
  const auto agrees = reviewSubject(review.session, review.subject.loaded, PoseSource::kRun);
  EXPECT_TRUE(agrees.other_cameras.empty()) << "the loaded case is in no rig yet";
  const auto loaded = reloadCase(*review.subject.loaded, session_case);
  const auto same = reviewSubject(review.session, loaded, PoseSource::kRun);
  ASSERT_EQ(same.other_cameras.size(), 1U);
  EXPECT_LT(perturbationBetween(same.other_cameras[0].camera_from_station, same.camera_from_station)
                .norm(),
            1e-9);
  EXPECT_LT((same.other_cameras[0].covariance.total() - same.covariance.total()).norm(),
            1e-6 * same.covariance.total().norm());
  second.rig->camera_from_rig.translation_m.x() += 0.002;
  review.session = withCase(review.session, second);
  const auto apart = reviewSubject(review.session, loaded, PoseSource::kRun);
  EXPECT_EQ(findCheck(checkPose(apart, presetLimits()), "agreement_camera").state,
            CheckState::kFailed);
}

TEST(CheckPose, CaseWithoutPose_IsReportedInOneSentence) {
  const Session session = makeSession(exampleFolder() / "dataset.json");
  const auto loaded = loadCase(*session.cases.front());
  EXPECT_THROW(reviewSubject(session, loaded, PoseSource::kRun), InputError);
  EXPECT_THROW(reviewSubject(session, loaded, PoseSource::kAnnotation), InputError);
}

TEST(CheckPose, OtherSeeds_ReturnToThePoseAndAStopKeepsPartialCounts) {
  const ReviewSubject& subject = example("os").subject;
  const ConvergenceResult convergence = convergenceTest(subject, 2);
  EXPECT_EQ(convergence.seeds, 2);
  EXPECT_EQ(convergence.returned, 2);
  EXPECT_GT(convergence.coverage, 0.5);
  for (const ConvergedPose& competing : convergence.competing) {
    EXPECT_TRUE(competing.mirrored);
    EXPECT_LT(competing.coverage, convergence.coverage);
  }
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(convergenceTest(subject, 2, stop.get_token()).seeds, 0);
  const auto checks = checkPose(subject, presetLimits(), convergence);
  EXPECT_EQ(findCheck(checks, "convergence_returned").figure, 100.0);
  EXPECT_EQ(findCheck(checks, "convergence_competing").state, CheckState::kPassed);
}

TEST(CheckPose, MirroredStation_FailsAsTheRightOneFitsBetter) {
  // What a mesh mirrored by mistake makes of an image: its own mirror image is the right station.
  const ExampleReview review = example("os");
  ReviewSubject subject = review.subject;
  subject.loaded = mirrorImageOf(*review.subject.loaded, 0);
  subject.run.reset();
  LocalizerOptions options = caseOptions(review.session, subject.loaded->source, "session");
  options.support.gate = false;
  const LocalizationTrace trace = runCase(*subject.loaded, options);
  ASSERT_TRUE(trace.converged()) << "this station is nearly its own mirror image";
  subject.camera_from_station = trace.camera_from_station;
  const auto checks = checkPose(subject, presetLimits(), convergenceTest(subject, 1));
  const Check competing = findCheck(checks, "convergence_competing");
  EXPECT_EQ(competing.state, CheckState::kFailed) << competing.sentence;
  EXPECT_THAT(competing.sentence, HasSubstr("mirror image"));
}

TEST(CheckPresets, ArePickedByWhatTheRequirementNames) {
  EXPECT_EQ(presetFor({{}, {}, {}, 3.0}).name, "photographs");
  EXPECT_EQ(presetFor({1.0, 2.0, 3.0, {}}).name, "sample_transfer");
  EXPECT_EQ(presetFor(Requirement()).name, kDefaultCheckPreset);
}

TEST(ChecksText, NotApplicableChecks_StateTheReason) {
  Check check;
  check.title = "Convergence from other seeds";
  check.state = CheckState::kNotApplicable;
  check.sentence = "No other seeds were run.";
  EXPECT_EQ(checksText(std::vector{check}),
            "  -   Convergence from other seeds\n      No other seeds were run.\n0 passed, 0 "
            "failed, 1 not applicable\n");
  check.state = CheckState::kPassed;
  EXPECT_THAT(checksText(std::vector{check}), Not(HasSubstr("No other seeds were run.")));
}

TEST(MirrorImage, IsAboutTheMiddleOfTheBoxAndKeepsTheOutwardSide) {
  const auto loaded = example("bc").subject.loaded;
  const Eigen::Vector3d middle_m = matchedBounds(loaded->scene.view()).centre();
  for (int axis = 0; axis < 3; ++axis) {
    const auto image = mirrorImageOf(*loaded, axis);
    EXPECT_EQ(image->image.pixels, loaded->image.pixels);
    for (std::size_t i = 0; i < loaded->scene.vertices_in_station_m.size(); ++i) {
      Eigen::Vector3f was = loaded->scene.vertices_in_station_m[i];
      Eigen::Vector3f is = image->scene.vertices_in_station_m[i];
      EXPECT_NEAR(is[axis], 2.0 * middle_m[axis] - was[axis], 1e-6);
      is[axis] = was[axis] = 0.0F;
      EXPECT_EQ(is, was);
    }
    ASSERT_EQ(image->scene.faces.size(), loaded->scene.faces.size());
    for (std::size_t i = 0; i < loaded->scene.faces.size(); ++i) {
      const auto& [a, b, c] = loaded->scene.faces[i].vertex;
      EXPECT_EQ(image->scene.faces[i].vertex, (std::array<std::int32_t, 3>{a, c, b}));
    }
  }
}

}  // namespace
}  // namespace boresight::sessions
