// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/run_text.h"

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "sessions/text/text_table.h"
#include "tests/support/example_run.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using test::editIteration;

void expectContained(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_THAT(text, HasSubstr(part));
}

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

TEST(RunHeadline, SaysInALineWhatWasMeasuredAndNeeded) {
  LocalizationTrace trace = *test::exampleRun();
  const RunHeadline converged = runHeadline(trace);
  EXPECT_EQ(converged.head, "Converged");
  expectContained(converged.sentence, {"iterations", "needed)."});
  trace.status = LocalizationStatus::kNotSupported;
  EXPECT_EQ(runHeadline(trace).head, "Rejected");
  EXPECT_THAT(runHeadline(trace).sentence, HasSubstr("needed. The seed may be turned"));
  trace.status = LocalizationStatus::kLeftUncertainty;
  EXPECT_EQ(runHeadline(trace).head, "No pose found");
  EXPECT_THAT(runHeadline(trace).sentence, HasSubstr("The pose left the seed's uncertainty"));
}

TEST(Explanation, NamesWhatWasMeasuredAndNeeded) {
  EXPECT_EQ(explanation(endedWith(LocalizationStatus::kConverged)), "");
  const struct {
    LocalizationStatus status;
    const char *measured, *needed;
  } cases[] = {{LocalizationStatus::kTooFewEdges, "has 7 edge pixels", "needed 12"},
               {LocalizationStatus::kTooFewTemplates, "5 of 64 px", "needed 6"},
               {LocalizationStatus::kTooFewMatches, "4 of 5", "needed 6"},
               {LocalizationStatus::kPnpFailed, "4 matches", "3 inliers at 8.0 px"},
               {LocalizationStatus::kIterationLimit, "12.300 mm", "2.000 deg"}};
  for (const auto& [status, measured, needed] : cases)
    expectContained(explanation(endedWith(status)), {measured, needed});
  LocalizationTrace trace = endedWith(LocalizationStatus::kPnpFailed);
  trace.edges = edgesOf(0);
  EXPECT_THAT(explanation(trace), HasSubstr("image has no edges"));
  trace = endedWith(LocalizationStatus::kFault);
  trace.fault = Status::kCapacityExceeded;
  EXPECT_THAT(explanation(trace), HasSubstr("render.max_edge_pixels"));
  trace.fault = Status::kTooManyLayers;
  EXPECT_THAT(explanation(trace), HasSubstr("overlap in an image row"));
  LocalizationTrace without_templates = endedWith(LocalizationStatus::kTooFewMatches);
  editIteration(without_templates, 0, [](IterationTrace& last) { last.template_count = 0; });
  expectContained(explanation(without_templates), {"too few matches", "4, needed 6"});
}

TEST(Explanation, NamesTheAxisThatLeftTheUncertainty) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kLeftUncertainty);
  trace.uncertainty.translation_m = {0.03, 0.02, 0.03};
  editIteration(trace, 0, [](IterationTrace& last) {
    last.camera_from_station.translation_m = {0.030, -0.035, 0.0};
  });
  expectContained(explanation(trace), {"35.00 mm along y", "allowed 30.00 mm"});
  editIteration(trace, 0, [](IterationTrace& last) {
    last.camera_from_station.rotation = rotationExp(Eigen::Vector3d(0.0, 0.0, 20.0 * kDegree_rad));
  });
  EXPECT_THAT(explanation(trace), HasSubstr("20.00 deg about z"));
}

TEST(Explanation, GivesTheShareOfSupportedEdgesOrTheFocalLengthThatTheEdgesAskFor) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kNotSupported);
  trace.support.rendered = 200;
  trace.support.covered = 30;
  trace.support.seen = 400;
  trace.support.explained = 80;
  expectContained(explanation(trace),
                  {fixedText(100.0 * trace.support.share(), 1) + " %, needed",
                   "15.0 % of the rendered edges are seen", "20.0 % of the edges seen"});
  trace = endedWith(LocalizationStatus::kCameraMismatch);
  trace.focal = {-0.0187, 0.0012, true};
  expectContained(explanation(trace), {"1.9 % shorter than the camera's", "one sigma 0.12 %"});
}

TEST(Explanation, SaysHowFarTheClosestCompetingPoseOrTheNextBestIs) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kAmbiguous);
  CompetingPose near{trace.iterations.back()->camera_from_station, 0.8, 5.5};
  near.camera_from_station.translation_m.x() += 0.02;
  CompetingPose far = near;
  far.camera_from_station.translation_m.x() += 0.02;
  far.margin_nats = 2.5;
  trace.competing_poses = {near, far};
  trace.camera_from_station_seed = trace.iterations.back()->camera_from_station;
  trace.uncertainty.translation_m.setConstant(0.1);
  EXPECT_THAT(explanation(trace), HasSubstr("a competing pose, 40.0 mm and 0.00 deg away"));
  EXPECT_THAT(explanation(trace), HasSubstr("it is 12 times less likely, needed 20 times"));
  trace.competing_poses[1].margin_nats = -7.5;
  EXPECT_THAT(explanation(trace), HasSubstr("better: it is more than 1000 times more likely"));
  trace.uncertainty.translation_m.setConstant(0.025 / trace.lastOptions().loop.leave_factor);
  trace.probability = 0.9;
  trace.competing_poses[1].margin_nats = -5.0;
  EXPECT_THAT(explanation(trace), HasSubstr("20.0 mm and 0.00 deg away")) << "the other is outside";
  trace.competing_poses[1].margin_nats = -7.5;
  trace.competing_poses[1].mirrored = true;
  EXPECT_THAT(explanation(trace),
              HasSubstr("the mirror image of the mesh is more than 1000 times more likely"));
  // Without competing poses, another one that has about the same score.
  trace.competing_poses.clear();
  trace.hypotheses.resize(2);
  trace.hypotheses[0].camera_from_station = trace.iterations.back()->camera_from_station;
  trace.hypotheses[1] = trace.hypotheses[0];
  trace.hypotheses[1].camera_from_station.translation_m.x() += 0.012;
  trace.best_hypothesis = 0;
  trace.competitor = 1;
  trace.gap = 0.0625;
  expectContained(explanation(trace),
                  {"another pose, 12.0 mm and 0.00 deg away", "lower by 0.06, needed 0.10"});
}

TEST(IterationTable, HasOneLineForEachIteration) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kConverged);
  const std::string matched = iterationTable(trace);
  expectContained(matched, {"match", "12.300", "8.0"});
  EXPECT_THAT(matched, Not(HasSubstr("refine")));
  trace.iterations.push_back(trace.iterations.back());
  editIteration(trace, 1, [](IterationTrace& refined) {
    refined.kind = IterationKind::kRefine;
    refined.refinement.used_count = 4321;
  });
  expectContained(iterationTable(trace), {"refine", "4321"});
}

TEST(PoseText, LabelsTheQuaternionAndSaysWhereItsSigmasAre) {
  Pose pose;
  pose.rotation = Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5);
  EXPECT_THAT(poseText(pose, Matrix6d::Zero()),
              HasSubstr("wxyz 0.500000000 -0.500000000 0.500000000 -0.500000000"))
      << "its scalar is positive";
  EXPECT_THAT(poseText(pose, Matrix6d::Zero()), Not(HasSubstr("sigma")));
  Matrix6d covariance = Matrix6d::Zero();
  covariance(0, 0) = 4e-6;  // rotation about x: 2 mrad
  covariance(5, 5) = 9e-8;  // translation along z: 0.3 mm
  EXPECT_THAT(poseText(Pose(), covariance),
              HasSubstr("1 sigma at the camera, along and about its x y z: 0.0000 0.0000 0.3000 "
                        "mm, 2.0000 0.0000 0.0000 mrad"));
  EXPECT_THAT(poseText(Pose(), covariance, "rig_from_station"),
              HasSubstr("1 sigma at the rig's origin"));
}

TEST(RunStatusText, SaysHowFarARunIsAndHowItEnded) {
  LocalizationTrace trace;
  EXPECT_EQ(runStatusText(trace), "The run has begun.");
  trace = endedWith(LocalizationStatus::kRunning);
  EXPECT_EQ(runStatusText(trace), "Iteration 1 is complete.");
  trace.last_under_way = true;
  expectContained(runStatusText(trace), {"last complete stage", "render"});
  EXPECT_THAT(runStatusText(endedWith(LocalizationStatus::kTooFewEdges)),
              AllOf(HasSubstr("Did not converge. Too few salient edges: the render has 7"),
                    testing::EndsWith(".")));
  trace = endedWith(LocalizationStatus::kConverged);
  trace.covariance(3, 3) = 4e-10;  // 0.02 mm
  trace.support.rendered = trace.support.covered = 10;
  trace.support.seen = trace.support.explained = 10;
  expectContained(runStatusText(trace), {"Converged in 1 iteration,", "0.020, 0.000, 0.000 mm",
                                         "Edge support is 100.0 %"});
  trace.options.support.gate = false;
  EXPECT_THAT(runStatusText(trace), Not(HasSubstr("Edge support")));
}

TEST(RunStatusText, PosesWhoseRendersExceedACapacity_AreSaidToBeLeftOut) {
  for (const LocalizationStatus status :
       {LocalizationStatus::kConverged, LocalizationStatus::kLeftUncertainty}) {
    LocalizationTrace trace = endedWith(status);
    trace.finished = true;
    EXPECT_THAT(runStatusText(trace), Not(HasSubstr("left out")));
    trace.fault = Status::kCapacityExceeded;
    expectContained(runStatusText(trace), {"Poses were left out", "raise render.max_edge_pixels"});
  }
}

TEST(RunStatusText, NamesTheOtherViews) {
  LocalizationTrace trace = endedWith(LocalizationStatus::kConverged);
  trace.views = {{"a", "converged"}, {"b", "too_few_matches"}, {"c", "converged"}};
  EXPECT_THAT(runStatusText(trace),
              StartsWith("Together with b (left out: too few of its templates match edges "
                         "of the image) and c. Converged in"));
  trace = endedWith(LocalizationStatus::kTooFewMatches);
  trace.views = {{"a", "converged"}, {"b", "too_few_matches"}};
  trace.own_view = 1;
  EXPECT_THAT(runStatusText(trace),
              StartsWith("Together with a. This view was left out: too few of"));
  trace.views[0].status = "pnp_failed";
  EXPECT_THAT(runStatusText(trace), StartsWith("Together with a. Did not converge. "));
  trace.views = {{"a", "running"}, {"b", "running"}};
  trace.finished = false;
  EXPECT_EQ(runStatusText(trace), "Together with a. Iteration 1 is complete.");
}

TEST(AcceptanceText, SearchedRun_StatesTheProbabilityWithItsParts) {
  LocalizationTrace run = test::exampleTrace();
  run.competing_poses.resize(2);
  run.competing_poses[0].margin_nats = 7.5;
  run.competing_poses[1].margin_nats = 4.0;
  expectContained(
      acceptanceText(run),
      {"right is " + fixedText(100.0 * run.probability, 1) + " %, needed 30.0 %",
       "edges show 100 % of the evidence",
       "differ along " + fixedText(100.0 * run.evidence.region.separatedShare(), 0) + " % of the",
       "support is " + fixedText(100.0 * run.support.share(), 1) + " %",
       "comes from " + originText(run.hypotheses[static_cast<std::size_t>(run.best_hypothesis)]),
       "2 competing poses are similar; the closest is 55 times less likely"});
  run.competing_poses.resize(1);
  run.competing_poses[0].margin_nats = -2.5;
  EXPECT_THAT(acceptanceText(run), HasSubstr("it is 12 times more likely"));
}

TEST(HasProbability, RunWithoutSearchOrEvidenceOfAnEarlierAttempt_DoesNotCount) {
  const auto of_seed = test::exampleRunOfSeed();
  EXPECT_FALSE(hasProbability(*of_seed));
  EXPECT_THAT(acceptanceText(*of_seed),
              AllOf(HasSubstr("Edge support is"), Not(HasSubstr("probab"))));
  LocalizationTrace run = test::exampleTrace();
  EXPECT_TRUE(hasProbability(run));
  run.status = LocalizationStatus::kBlurred;
  EXPECT_TRUE(hasProbability(run));
  run.status = LocalizationStatus::kPnpFailed;
  EXPECT_FALSE(hasProbability(run));
  EXPECT_EQ(acceptanceText(run), "");
}

TEST(AcceptanceText, ComparedPoses_AreCountedWithTheGapToTheNextBest) {
  LocalizationTrace run = test::exampleTrace();
  run.hypotheses.assign(2, PoseHypothesis());
  run.hypotheses[1].origin = HypothesisOrigin::kRestart;
  run.hypotheses[1].number = 2;
  run.best_hypothesis = 1;
  run.competitor = -1;
  expectContained(acceptanceText(run),
                  {"most evidence of 2 compared poses", "restart 3 of the best pose"});
  EXPECT_THAT(acceptanceText(run), Not(HasSubstr("next best")));
  run.competitor = 0;
  run.gap = 0.875;
  EXPECT_THAT(acceptanceText(run), HasSubstr("lower by a score of 0.88"));
  run.hypotheses.resize(1);
  run.hypotheses[0].origin = HypothesisOrigin::kSeed;
  run.best_hypothesis = 0;
  run.competitor = -1;
  EXPECT_THAT(acceptanceText(run), HasSubstr("the only pose found and comes from templates around "
                                             "the seed"));
}

}  // namespace
}  // namespace boresight::sessions
