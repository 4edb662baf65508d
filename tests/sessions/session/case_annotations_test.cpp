// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_annotations.h"

#include "sessions/io/files/errors.h"
#include "tests/sessions/annotation/annotated_scene.h"
#include "tests/sessions/session/random_session.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using namespace sessions;

/// Two cameras of a rig that see one station, a camera elsewhere, and a session of them.
struct RigSession {
  Session session;
  std::vector<AnnotatedView> views;  ///< left, right
  Pose rig_from_station;

  explicit RigSession(double noise_px = 0.3) {
    Random random = randomFor("RigSession");
    const AnnotatedScene scene = randomScene(random, CameraModel::kBrownConrady, 6, 2, noise_px);
    Pose left_from_rig, right_from_rig;
    left_from_rig.rotation = rotationExp({0.01, -0.02, 0.03});
    left_from_rig.translation_m = {0.05, 0.01, 0.0};
    right_from_rig.rotation = rotationExp({-0.01, 0.04, 0.0});
    right_from_rig.translation_m = {-0.05, 0.0, 0.01};
    rig_from_station = left_from_rig.inverse() * scene.camera_from_station;
    views = {scene.view, scene.view};
    views[0].name = "left";
    views[0].camera_from_rig = left_from_rig;
    views[1].name = "right";
    views[1].camera = annotatedCamera(CameraModel::kKannalaBrandt);
    views[1].camera_from_rig = right_from_rig;
    views[1].annotations = {};
    while (views[1].annotations.points.size() < 5)
      addPoint(views[1], right_from_rig * rig_from_station, randomVector(random, 0.1), noise_px,
               0.3, random);
    for (const char* id : {"right", "other", "left", "unmarked"}) addCase(random, id);
    session = withAnnotations(session, "left", views[0].annotations);
    session = withAnnotations(session, "right", views[1].annotations);
    session = withAnnotations(session, "other", randomAnnotations(random));
  }

  void addCase(Random& random, const std::string& id) {
    SessionCase session_case = randomCase(random, id);
    session_case.rig = Rig{id == "other" ? "another rig" : "rig", Pose()};
    if (id == "left" || id == "right") {
      const AnnotatedView& view = views[id == "left" ? 0 : 1];
      session_case.camera = view.camera;
      session_case.rig->camera_from_rig = view.camera_from_rig;
    }
    session = withCase(session, session_case);
  }
};

TEST(CaseAnnotations, Views_StartWithTheCaseAndOmitUnannotatedAndOtherRigs) {
  const RigSession rig;
  const auto together = caseAnnotations(rig.session, "left");
  ASSERT_EQ(together.views.size(), 2U);
  EXPECT_TRUE(together.rigid);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(together.views[i].name, rig.views[i].name);
    EXPECT_EQ(together.views[i].annotations, rig.views[i].annotations);
    EXPECT_EQ(together.views[i].camera, rig.views[i].camera);
    EXPECT_EQ(together.views[i].camera_from_rig, rig.views[i].camera_from_rig);
  }
  const auto alone = caseAnnotations(rig.session, "left", false);
  ASSERT_EQ(alone.views.size(), 1U);
  EXPECT_EQ(alone.views[0].name, "left");
  EXPECT_FALSE(alone.rigid);
  EXPECT_EQ(alone.views[0].camera_from_rig, Pose());
  std::vector<std::string> names;
  for (const AnnotatedView& view : caseAnnotations(rig.session, "unmarked").views)
    names.push_back(view.name);
  EXPECT_THAT(names, ElementsAre("unmarked", "right", "left"));
  EXPECT_FALSE(caseAnnotations(rig.session, "other").rigid);
  EXPECT_THROW((void)caseAnnotations(rig.session, "unknown"), InputError);
}

TEST(CaseAnnotations, SolveCase_EqualsSolvingItsViews) {
  RigSession rig;
  const Pose guess = rig.views[0].camera_from_rig * rig.rig_from_station;
  for (const bool robust : {false, true}) {
    SolveAnnotationsOptions options;
    options.robust = robust;
    options.rig_from_station_guess = rig.views[0].camera_from_rig.inverse() * guess;
    const auto direct = solveAnnotations(rig.views, options);
    rig.session.robust_annotations = robust;
    const auto result = solveCaseAnnotations(caseAnnotations(rig.session, "left"), guess, {});
    ASSERT_TRUE(direct.solution && result.result.solution) << result.result.reason;
    EXPECT_EQ(result.result.solution->rig_from_station, direct.solution->rig_from_station);
    EXPECT_EQ(result.result.solution->covariance, direct.solution->covariance);
    EXPECT_EQ(result.camera_from_station(), direct.solution->camera_from_station[0]);
    EXPECT_EQ(result.result.solution->rms_px, direct.solution->rms_px);
    const auto left_out = leaveOneOut(rig.views, *direct.solution);
    ASSERT_EQ(result.left_out.size(), left_out.size());
    for (std::size_t i = 0; i < left_out.size(); ++i)
      EXPECT_EQ(result.left_out[i].translation_mm, left_out[i].translation_mm);
    // Together they know the pose to a millimetre.
    EXPECT_LT((result.camera_from_station()->translation_m - guess.translation_m).norm(), 1e-3);
  }
}

TEST(CaseAnnotations, Outliers_OfTheCase_AreNamed) {
  CaseAnnotationsSolution case_annotations_solution;
  EXPECT_TRUE(case_annotations_solution.outlierAnnotations().empty()) << "without a solution";
  case_annotations_solution.annotations.views = RigSession().views;
  case_annotations_solution.result.solution.emplace();
  const auto add = [&](const AnnotationAddress& address, bool projected, double normalized) {
    SolvedAnnotation& annotation =
        case_annotations_solution.result.solution->annotations.emplace_back();
    annotation.address = address;
    annotation.projected = projected;
    annotation.normalized = normalized;
  };
  add({0, AnnotationKind::kPoint, 0}, true, 2.9);
  add({0, AnnotationKind::kPoint, 1}, true, 4.2);
  add({0, AnnotationKind::kPoint, 2}, false, 9.0);
  add({0, AnnotationKind::kLine, 1}, true, 3.1);
  add({1, AnnotationKind::kPoint, 3}, true, 8.0);
  const Annotations& own = case_annotations_solution.annotations.views[0].annotations;
  const std::map<std::string, double> expected = {{own.points[1].id, 4.2}, {own.lines[1].id, 3.1}};
  EXPECT_EQ(case_annotations_solution.outlierAnnotations(), expected);
}

TEST(CaseAnnotations, AnUnannotatedCaseGetsItsPoseFromTheRig) {
  const RigSession rig(0.0);
  const Session session = withAnnotations(rig.session, "left", {});
  const auto result = solveCaseAnnotations(caseAnnotations(session, "left"), Pose(), {});
  ASSERT_TRUE(result.camera_from_station()) << result.result.reason;
  const Pose truth = rig.views[0].camera_from_rig * rig.rig_from_station;
  EXPECT_LT(perturbationBetween(truth, *result.camera_from_station()).norm(), 1e-6);
}

TEST(CaseAnnotations, SaysWhyThereIsNoPose) {
  const RigSession rig;
  const auto none = solveCaseAnnotations(
      caseAnnotations(withAnnotations(rig.session, "other", {}), "other"), Pose(), {});
  EXPECT_FALSE(none.camera_from_station());
  EXPECT_THAT(none.left_out, IsEmpty());
  ASSERT_FALSE(none.warnings.empty());
  EXPECT_TRUE(none.warnings[0].prevents);
  EXPECT_EQ(none.result.reason, none.warnings[0].text);
}

TEST(CaseAnnotations, SigmaBeyondRequirement_IsReportedAsWeakWithItsExcess) {
  const RigSession rig(3.0);
  Session session = rig.session;
  const auto warningsFor = [&](double required_mm) {
    SessionCase session_case = *session.findCase("left");
    session_case.requirement = {required_mm, {}, {}, {}};
    session_case.camera_from_end_effector = Pose();
    session = withCase(session, session_case);
    const Pose guess = rig.views[0].camera_from_rig * rig.rig_from_station;
    return solveCaseAnnotations(caseAnnotations(session, "left", false), guess, {});
  };
  const auto result = warningsFor(0.001);
  ASSERT_TRUE(result.result.solution);
  const double sigma_mm = 1e3 * std::sqrt((*result.covariance())(5, 5));
  const auto& weak = result.warnings;
  ASSERT_FALSE(weak.empty());
  EXPECT_EQ(weak.back().weakness, GeometryWeakness::kImprecise);
  EXPECT_FALSE(weak.back().prevents);
  char begin[80];
  std::snprintf(begin, sizeof begin, "3 sigma: %.3g mm along the view axis at the end effector",
                3.0 * sigma_mm);
  EXPECT_THAT(weak.back().text, AllOf(StartsWith(begin), HasSubstr("times the 0.001 mm required")));
  EXPECT_EQ(warningsFor(1e6).warnings.size(), weak.size() - 1);
  session.review.limits = {{"check.sigmas", 1.5}};
  EXPECT_THAT(warningsFor(0.001).warnings.back().text, testing::StartsWith("1.5 sigma: "));
}

TEST(CaseAnnotations, NamesTheCornersOfABox) {
  const auto corners = boxCorners({{-1, -2, -3}, {1, 2, 3}});
  ASSERT_EQ(corners.size(), 8u);
  EXPECT_EQ(corners.front(), Eigen::Vector3d(-1, -2, -3));
  EXPECT_EQ(corners[1], Eigen::Vector3d(1, -2, -3));
  EXPECT_EQ(corners.back(), Eigen::Vector3d(1, 2, 3));
}

}  // namespace
}  // namespace boresight::test
