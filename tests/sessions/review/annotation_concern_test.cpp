// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/annotation_concern.h"

#include <map>

#include <gtest/gtest.h>

#include "tests/sessions/annotation/annotated_scene.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using sessions::annotationConcern;
using sessions::AnnotationConcern;
using sessions::CaseAnnotationsSolution;
using sessions::PoseQuality;

/// A pose known to this, where 0.4 mm are required; nothing: not known.
PoseQuality qualityOf(std::optional<double> found_mm) {
  return {3.0,
          {{{"covariance_lateral", ""},
            "across the view axis",
            "mm",
            0.4,
            found_mm,
            found_mm,
            " at the camera"}}};
}

/// Eight points of a scene. `errors_px`: errors in x, px, by the index of the point.
CaseAnnotationsSolution solutionWith(const std::map<std::size_t, double>& errors_px,
                                     bool robust = false) {
  Random random = randomFor("AnnotationConcern");
  AnnotatedScene scene = randomScene(random, CameraModel::kBrownConrady, 8, 0, 0.1);
  for (const auto& [index, error_px] : errors_px)
    scene.view.annotations.points[index].pixel->x() += error_px;
  sessions::CaseAnnotations annotations;
  annotations.views = {scene.view};
  annotations.views[0].camera_from_rig = Pose();
  annotations.robust = robust;
  return sessions::solveCaseAnnotations(annotations, scene.camera_from_station, {});
}

std::string idOf(const CaseAnnotationsSolution& solution, std::size_t index) {
  return solution.annotations.views[0].annotations.points[index].id;
}

TEST(AnnotationConcern, GoodAnnotations_AreNoneWithinTheRequirement) {
  const AnnotationConcern concern = annotationConcern(solutionWith({}), qualityOf(0.3));
  EXPECT_EQ(concern.text, "");
  EXPECT_THAT(concern.suspects, IsEmpty());
  EXPECT_EQ(annotationConcern(CaseAnnotationsSolution(), qualityOf({})).text, "");
  EXPECT_EQ(annotationConcern(solutionWith({}), qualityOf(0.9)).text,
            "Pose known to 0.90 of 0.40 mm (3 sigma across the view axis at the camera).");
}

TEST(AnnotationConcern, TooFewAnnotations_AreOneWhereTheRequirementLimitsTheirSigmas) {
  CaseAnnotationsSolution few = solutionWith({});
  few.result.solution->degrees_of_freedom = 4;
  EXPECT_THAT(annotationConcern(few, qualityOf(0.3)).text,
              HasSubstr("4 degrees of freedom, which cannot confirm their sigmas"));
  EXPECT_EQ(annotationConcern(few, qualityOf({})).text, "");
}

/// Three of eight mask each other: none stands out alone.
TEST(AnnotationConcern, MaskedErrors_AreNamedByTheRobustSolution) {
  const std::map<std::size_t, double> errors_px = {{1, 8.0}, {4, -7.0}};
  const CaseAnnotationsSolution solution = solutionWith(errors_px);
  const AnnotationConcern concern = annotationConcern(solution, qualityOf(0.3));
  EXPECT_THAT(concern.text, HasSubstr("times the stated sigmas."));
  const auto both = ElementsAre(idOf(solution, 1), idOf(solution, 4));
  EXPECT_THAT(concern.suspects, both);
  EXPECT_FALSE(concern.robust);
  const AnnotationConcern robust = annotationConcern(solutionWith(errors_px, true), qualityOf(0.3));
  EXPECT_TRUE(robust.robust);
  EXPECT_THAT(robust.suspects, both);
  EXPECT_THAT(robust.text, StartsWith("The annotations have 4 degrees of freedom"))
      << "the others fit, but are few";
}

/// Lines mask each other like points do.
TEST(AnnotationConcern, BadLines_AreNamed) {
  Random random = randomFor("AnnotationConcern.Lines");
  AnnotatedScene scene = randomScene(random, CameraModel::kPinhole, 2, 8, 0.1);
  for (const std::size_t bad : {2u, 5u}) {
    sessions::ImageLine& line = *scene.view.annotations.lines[bad].line;
    const Eigen::Vector2d along = (line.end - line.start).normalized();
    const Eigen::Vector2d across_px = 9.0 * Eigen::Vector2d(-along.y(), along.x());
    line.start += across_px;
    line.end += across_px;
  }
  sessions::CaseAnnotations annotations;
  annotations.views = {scene.view};
  const auto solution = sessions::solveCaseAnnotations(annotations, scene.camera_from_station, {});
  EXPECT_THAT(annotationConcern(solution, qualityOf(0.3)).suspects,
              ElementsAre(scene.view.annotations.lines[2].id, scene.view.annotations.lines[5].id));
}

/// The concern is about this case: of the rig's other camera no annotation is named.
TEST(AnnotationConcern, AnnotationsOfTheOtherCamera_AreNotNamed) {
  Random random = randomFor("AnnotationConcern.Rig");
  AnnotatedScene scene = randomScene(random, CameraModel::kPinhole, 8, 0, 0.1);
  sessions::CaseAnnotations annotations;
  annotations.views = {scene.view, scene.view};
  for (sessions::PointPair& point : annotations.views[1].annotations.points)
    point.id = "other " + point.id;
  annotations.views[0].annotations.points[1].pixel->x() += 12.0;
  annotations.views[1].annotations.points[3].pixel->x() -= 12.0;
  const auto solution = sessions::solveCaseAnnotations(annotations, scene.camera_from_station, {});
  EXPECT_THAT(annotationConcern(solution, qualityOf(0.3)).suspects,
              ElementsAre(annotations.views[0].annotations.points[1].id));
}

TEST(AnnotationConcern, TwoReasons_AreTwoSentences) {
  const AnnotationConcern concern =
      annotationConcern(solutionWith({{1, 8.0}, {4, -7.0}}), qualityOf(0.9));
  EXPECT_THAT(concern.text, testing::MatchesRegex("The residuals are [0-9.]+ times the stated "
                                                  "sigmas\\. Pose known to .*\\."));
}

}  // namespace
}  // namespace boresight::test
