// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/run_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/math.h"
#include "sessions/text/text_table.h"
#include "sessions/trace/run_headline.h"
#include "tests/support/example_run.h"

namespace boresight::sessions {
namespace {

using test::editIteration;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::shared_ptr<const EdgeMapTrace> edgesOf(std::int32_t count) {
  EdgeMapTrace edges;
  edges.edge_count = count;
  return std::make_shared<const EdgeMapTrace>(std::move(edges));
}

/// A run of one iteration that ended with this status.
LocalizationTrace endedWith(LocalizationStatus status) {
  LocalizationTrace trace;
  trace.status = status;
  trace.finished = status != LocalizationStatus::kRunning;
  trace.edges = edgesOf(1000);
  IterationTrace iteration;
  iteration.status = status;
  iteration.edge_pixel_count = 7;
  iteration.template_count = 5;
  iteration.template_side_px = 64;
  iteration.searched_count = 4;
  iteration.correspondence_count = 4;
  iteration.threshold_px = 8.0;
  iteration.pnp.inlier_count = 3;
  iteration.correction_translation_m = 0.0123;
  iteration.correction_rotation_rad = 2.0 * kDegree_rad;
  trace.iterations.push_back(std::make_shared<const IterationTrace>(iteration));
  return trace;
}

TEST(PoseText, SaysWhereItsSigmasAre) {
  const Matrix6d covariance = 1e-6 * Matrix6d::Identity();
  EXPECT_THAT(
      poseText(Pose(), covariance),
      HasSubstr("1 sigma at the camera, along and about its x y z: 1.0000 1.0000 1.0000 mm"));
  EXPECT_THAT(poseText(Pose(), covariance, "rig_from_station"),
              HasSubstr("1 sigma at the rig's origin"));
}

TEST(RunHeadline, SaysInALineWhatWasMeasuredAndNeeded) {
  LocalizationTrace trace = *test::exampleRun();
  const RunHeadline converged = runHeadline(trace);
  EXPECT_EQ(converged.head, "Converged");
  EXPECT_THAT(converged.sentence, AllOf(HasSubstr("iterations"), HasSubstr("needed).")));
  trace.status = LocalizationStatus::kNotSupported;
  EXPECT_EQ(runHeadline(trace).head, "Rejected");
  EXPECT_THAT(runHeadline(trace).sentence, HasSubstr("needed. The seed may be turned"));
  trace.status = LocalizationStatus::kLeftUncertainty;
  EXPECT_EQ(runHeadline(trace).head, "No pose found");
  EXPECT_THAT(runHeadline(trace).sentence, HasSubstr("The pose left the seed's uncertainty"));
}

TEST(Explanation, IsEmptyForAConvergedRun) {
  EXPECT_THAT(explanation(endedWith(LocalizationStatus::kConverged)), IsEmpty());
}

TEST(Explanation, NamesWhatWasMeasuredAndNeeded) {
  EXPECT_THAT(explanation(endedWith(LocalizationStatus::kTooFewEdges)),
              AllOf(HasSubstr("has 7 edge pixels"), HasSubstr("needed 12")));
  EXPECT_THAT(explanation(endedWith(LocalizationStatus::kTooFewTemplates)),
              AllOf(HasSubstr("5 of 64 px"), HasSubstr("needed 6")));
  EXPECT_THAT(explanation(endedWith(LocalizationStatus::kTooFewMatches)),
              AllOf(HasSubstr("4 of 5"), HasSubstr("needed 6")));
  LocalizationTrace without_templates = endedWith(LocalizationStatus::kTooFewMatches);
  editIteration(without_templates, 0, [](IterationTrace& last) { last.template_count = 0; });
  EXPECT_THAT(explanation(without_templates),
              AllOf(HasSubstr("too few matches"), HasSubstr("4, needed 6")));
  EXPECT_THAT(explanation(endedWith(LocalizationStatus::kPnpFailed)),
              AllOf(HasSubstr("4 matches"), HasSubstr("3 inliers at 8.0 px")));
  EXPECT_THAT(explanation(endedWith(LocalizationStatus::kIterationLimit)),
              AllOf(HasSubstr("12.300 mm"), HasSubstr("2.000 deg")));
}

TEST(Explanation, NamesTheAxisThatLeftTheUncertainty) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kLeftUncertainty);
  trace.uncertainty.translation_m = {0.03, 0.02, 0.03};
  editIteration(trace, 0, [](IterationTrace& last) {
    last.camera_from_station.translation_m = {0.030, -0.035, 0.0};
  });
  EXPECT_THAT(explanation(trace),
              AllOf(HasSubstr("35.00 mm along y"), HasSubstr("allowed 30.00 mm")));
  editIteration(trace, 0, [](IterationTrace& last) {
    last.camera_from_station.rotation = rotationExp(Eigen::Vector3d(0.0, 0.0, 20.0 * kDegree_rad));
  });
  EXPECT_THAT(explanation(trace), HasSubstr("20.00 deg about z"));
}

TEST(Explanation, GivesTheShareOfSupportedEdges) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kNotSupported);
  trace.support.rendered = 200;
  trace.support.covered = 30;
  trace.support.seen = 400;
  trace.support.explained = 80;
  EXPECT_THAT(explanation(trace),
              AllOf(HasSubstr(fixedText(100.0 * trace.support.share(), 1) + " %, needed"),
                    HasSubstr("15.0 % of the rendered edges are seen"),
                    HasSubstr("20.0 % of the edges seen")));
}

TEST(Explanation, SaysHowFarTheClosestCompetingPoseIs) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kAmbiguous);
  CompetingPose near{trace.iterations.back()->camera_from_station, 0.8, 5.5};
  near.camera_from_station.translation_m.x() += 0.02;
  CompetingPose far = near;
  far.camera_from_station.translation_m.x() += 0.02;
  far.margin_nats = 2.5;
  trace.competing_poses = {near, far};
  EXPECT_THAT(explanation(trace), HasSubstr("a competing pose, 40.0 mm and 0.00 deg away"));
  EXPECT_THAT(explanation(trace), HasSubstr("it is 12 times less likely, needed 20 times"));
  trace.competing_poses[1].margin_nats = -7.5;
  EXPECT_THAT(explanation(trace), HasSubstr("better: it is more than 1000 times more likely"));
  trace.competing_poses[1].mirrored = true;
  EXPECT_THAT(explanation(trace), HasSubstr("the mirror image of the mesh is more than 1000 times more likely"));
}

TEST(Explanation, SaysThatAnotherPoseHasAboutTheSameScore) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kAmbiguous);
  PoseHypothesis best;
  best.camera_from_station = trace.iterations.back()->camera_from_station;
  PoseHypothesis other = best;
  other.camera_from_station.translation_m.x() += 0.012;
  trace.hypotheses = {best, other};
  trace.best_hypothesis = 0;
  trace.competitor = 1;
  trace.gap = 0.0625;
  trace.competing_poses.clear();
  EXPECT_THAT(explanation(trace), AllOf(HasSubstr("another pose, 12.0 mm and 0.00 deg away"),
                                        HasSubstr("lower by 0.06, needed 0.15")));
}

TEST(Explanation, SaysWhichFocalLengthTheEdgesAskFor) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kCameraMismatch);
  trace.focal = {-0.0187, 0.0012, true};
  EXPECT_THAT(explanation(trace),
              AllOf(HasSubstr("1.9 % shorter than the camera's"), HasSubstr("one sigma 0.12 %")));
}

TEST(Explanation, BlamesAnImageWithoutEdges) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kPnpFailed);
  trace.edges = edgesOf(0);
  EXPECT_THAT(explanation(trace), HasSubstr("image has no edges"));
}

TEST(Explanation, NamesTheOptionThatACapacityNeeds) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kFault);
  trace.fault = Status::kCapacityExceeded;
  EXPECT_THAT(explanation(trace), HasSubstr("render.max_edge_pixels"));
}

TEST(IterationTable, HasOneLineForEachIteration) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kConverged);
  const std::string matched = iterationTable(trace);
  EXPECT_THAT(matched, AllOf(HasSubstr("match"), HasSubstr("12.300"), HasSubstr("8.0")));
  EXPECT_THAT(matched, Not(HasSubstr("refine")));
  trace.iterations.push_back(trace.iterations.back());
  editIteration(trace, 1, [](IterationTrace& refined) {
    refined.kind = IterationKind::kRefine;
    refined.refinement.used_count = 4321;
  });
  EXPECT_THAT(iterationTable(trace), AllOf(HasSubstr("refine"), HasSubstr("4321")));
}

TEST(PoseText, LabelsTheQuaternionAndKeepsItsScalarPositive) {
  Pose pose;
  pose.rotation = Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5);
  EXPECT_THAT(poseText(pose, Matrix6d::Zero()),
              AllOf(HasSubstr("wxyz 0.500000000 -0.500000000 0.500000000 -0.500000000"),
                    Not(HasSubstr("sigma"))));
}

TEST(PoseText, GivesSigmasInMillimetresAndMilliradians) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance(0, 0) = 4e-6;  // rotation about x: 2 mrad
  covariance(5, 5) = 9e-8;  // translation along z: 0.3 mm
  EXPECT_THAT(poseText(Pose(), covariance),
              HasSubstr("0.0000 0.0000 0.3000 mm, 2.0000 0.0000 0.0000 mrad"));
}

TEST(RunStatusText, ExplainsARunThatFailed) {
  EXPECT_THAT(runStatusText(endedWith(LocalizationStatus::kTooFewEdges)),
              AllOf(HasSubstr("Did not converge. Too few salient edges: the render has 7"),
                    testing::EndsWith(".")));
}

TEST(RunStatusText, ConvergedRun_StatesItsEvidence) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kConverged);
  trace.covariance(3, 3) = 4e-10;  // 0.02 mm
  trace.support.rendered = trace.support.covered = 10;
  trace.support.seen = trace.support.explained = 10;
  EXPECT_THAT(runStatusText(trace),
              AllOf(HasSubstr("Converged in 1 iteration,"), HasSubstr("0.020, 0.000, 0.000 mm"),
                    HasSubstr("Edge support is 100.0 %")));
  trace.options.support.gate = false;
  EXPECT_THAT(runStatusText(trace), Not(HasSubstr("Edge support")));
}

TEST(RunStatusText, SaysHowFarARunIs) {
  LocalizationTrace trace;
  EXPECT_EQ(runStatusText(trace), "The run has begun.");
  trace = endedWith(LocalizationStatus::kRunning);
  EXPECT_EQ(runStatusText(trace), "Iteration 1 is complete.");
  trace.last_under_way = true;
  EXPECT_THAT(runStatusText(trace), AllOf(HasSubstr("last complete stage"), HasSubstr("render")));
}

TEST(RunStatusText, NamesTheOtherViews) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kConverged);
  trace.views = {{"a", "converged"}, {"b", "too_few_matches"}, {"c", "converged"}};
  EXPECT_THAT(runStatusText(trace),
              testing::StartsWith("Together with b (left out: too few of its templates match edges "
                                  "of the image) and c. Converged in"));
  trace = endedWith(LocalizationStatus::kTooFewMatches);
  trace.views = {{"a", "converged"}, {"b", "too_few_matches"}};
  trace.own_view = 1;
  EXPECT_THAT(runStatusText(trace),
              testing::StartsWith("Together with a. This view was left out: too few of"));
  trace.views[0].status = "pnp_failed";
  EXPECT_THAT(runStatusText(trace), testing::StartsWith("Together with a. Did not converge. "));
  trace.views = {{"a", "running"}, {"b", "running"}};
  trace.finished = false;
  EXPECT_EQ(runStatusText(trace), "Together with a. Iteration 1 is complete.");
}

}  // namespace
}  // namespace boresight::sessions
