// SPDX-License-Identifier: Apache-2.0
// Whole runs that begin with a search, also on features that repeat: no pose one pitch off is
// accepted.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "core/localizer/acceptance.h"
#include "core/localizer/localizer.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/schedule.h"
#include "tests/core/localizer/rail_scene.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

bool isRight(const Case& scene, const Workspace& end) {
  const PitchError error = pitchError(scene, end.camera_from_station);
  return std::abs(error.pitches) < 0.1 && error.rest_m < 0.0008;
}

bool convergedWrong(const Case& scene, const LocalizerOptions& options) {
  const FinishedRun run(scene, options);
  return run.workspace.status == LocalizationStatus::kConverged && !isRight(scene, run.workspace);
}

TEST(LocalizerSearch, RailWhoseEndsAreSeen_IsFoundAtItsPitch) {
  int wrong_without = 0;
  for (const double off_pitches : {-1.5, -1.0, -0.5, 0.0, 0.75, 1.25}) {
    for (const std::uint64_t seed : {1u, 2u}) {
      SCOPED_TRACE(off_pitches);
      const Case scene = railCase(Ends::kSeen, off_pitches, 1.7, seed);
      wrong_without += convergedWrong(scene, withoutSearch()) ? 1 : 0;
      const FinishedRun run(scene);
      EXPECT_STREQ(localizationStatusText(run.workspace.status), "converged");
      EXPECT_TRUE(isRight(scene, run.workspace));
    }
  }
  EXPECT_GE(wrong_without, 3);  // else these seeds show nothing
}

/// For any pitch that they converge on, the runs are ambiguous and return the seed.
TEST(LocalizerSearch, RailWithoutVisibleEnds_IsAmbiguous) {
  int ambiguous = 0;
  for (const Ends ends : {Ends::kHidden, Ends::kOutside}) {
    for (const double off_pitches : {0.0, 0.5, -0.75}) {
      SCOPED_TRACE(off_pitches);
      const Case scene = railCase(ends, off_pitches, 1.7, 3);
      const FinishedRun run(scene);
      const Workspace& workspace = run.workspace;
      // The visible rest of the hidden ends may suffice.
      if (ends == Ends::kHidden && workspace.status == LocalizationStatus::kConverged &&
          isRight(scene, workspace))
        continue;
      ++ambiguous;
      EXPECT_STREQ(localizationStatusText(workspace.status), "ambiguous");
      const Pose best = workspace.iteration->camera_from_station;
      double nearest_pitches = 1e9;
      for (const CompetingPose& pose : workspace.competing_poses) {
        if (pose.margin_nats >= kLeastMargin_nats) continue;
        const double apart =
            pitchError(scene, pose.camera_from_station).pitches - pitchError(scene, best).pitches;
        nearest_pitches = std::min(nearest_pitches, std::abs(apart));
      }
      EXPECT_NEAR(nearest_pitches, 1.0, 0.1);
    }
  }
  EXPECT_GE(ambiguous, 4);
}

/// No pose inside the stated uncertainty is accepted.
TEST(LocalizerSearch, RailWhoseTruthIsOutsideTheUncertainty_IsRefused) {
  const Case scene = railCase(Ends::kSeen, 1.0, 0.6, 2);
  ASSERT_TRUE(convergedWrong(scene, withoutSearch()));
  EXPECT_STRNE(localizationStatusText(endOf(scene, defaultProfile())), "converged");
}

/// The memory of the candidates is that of the wider search.
TEST(LocalizerSearch, RightPoseBeyondTheStatedUncertainty_IsComparedWithAWiderSearchAndAccepted) {
  for (const double share : {0.5, 1.2}) {
    Case scene = stationCase(1);
    scene.seed = scene.truth;
    scene.seed.translation_m.x() += share * scene.uncertainty.translation_m.x();
    const FinishedRun run(scene);
    EXPECT_STREQ(localizationStatusText(run.workspace.status), "converged");
    EXPECT_GT(run.workspace.probability, kUndoubted);
    EXPECT_EQ(run.workspace.candidates.empty(), share > 1.0);
  }
}

/// Poses that the seed excludes are not ambiguous.
TEST(LocalizerSearch, RailWhoseSeedExcludesOtherPitches_IsNotAmbiguous) {
  const Case scene = railCase(Ends::kOutside, 0.0, 0.6, 2);
  const FinishedRun run(scene);
  EXPECT_STREQ(localizationStatusText(run.workspace.status), "converged");
  EXPECT_TRUE(isRight(scene, run.workspace));
}

/// The seed turned about the view through the station's middle, within its stated uncertainty.
Case turnedCase(std::uint64_t seed, double turn_rad) {
  Case turned = stationCase(seed);
  const Eigen::Vector3d middle_m = turned.seed * matchedBounds(turned.solid.view()).centre();
  const Eigen::Quaterniond turn = rotationExp(middle_m.normalized() * turn_rad);
  turned.seed.rotation = (turn * turned.seed.rotation).normalized();
  turned.seed.translation_m = turn * (turned.seed.translation_m - middle_m) + middle_m;
  turned.uncertainty.pivot_in_camera_m = middle_m;
  turned.uncertainty.rotation_rad.z() = kPi;
  return turned;
}

TEST(LocalizerSearch, SeedFarOff_IsFoundWithinAStatedUncertainty) {
  for (const double turn_deg : {75.0, 180.0}) {
    SCOPED_TRACE(turn_deg);
    const Case scene = turnedCase(3, turn_deg * kDegree_rad);
    EXPECT_NE(endOf(scene, withoutSearch()), LocalizationStatus::kConverged);
    expectTruth(scene, FinishedRun(scene).workspace);
  }
  for (const Eigen::Vector3d& off_m :
       {Eigen::Vector3d(0.0, 0.0, 0.075), Eigen::Vector3d(0.0, 0.0, -0.075),
        Eigen::Vector3d(0.06, -0.03, 0.03)}) {
    SCOPED_TRACE(off_m.transpose());
    Case scene = stationCase(7);
    scene.seed.translation_m = scene.truth.translation_m + off_m;
    scene.uncertainty.translation_m.setConstant(0.08);
    expectTruth(scene, FinishedRun(scene).workspace);
  }
}

TEST(LocalizerSearch, SeedTurnedAboutTheCamera_IsFoundOffTheOpticalAxis) {
  Case scene = stationCase(3);
  scene.truth.translation_m += Eigen::Vector3d(0.06, 0.01, 0.2);
  const Picture picture = takePicture(scene.solid, scene.camera, scene.truth);
  scene.picture = &picture;
  turnAboutTheCamera(scene, 175.0 * kDegree_rad);
  expectTruth(scene, FinishedRun(scene).workspace);
}

/// A row of `length_px` pixels is averaged, as a camera that moves to the side does.
Picture movedPicture(const Picture& sharp, int length_px) {
  Picture moved = sharp;
  for (int y = 0; y < sharp.height; ++y) {
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(sharp.width);
    for (int x = 0; x < sharp.width; ++x) {
      int sum = 0;
      for (int k = 0; k < length_px; ++k)
        sum += sharp.gray[row + static_cast<std::size_t>(
                                    std::clamp(x + k - length_px / 2, 0, sharp.width - 1))];
      moved.gray[row + static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(sum / length_px);
    }
  }
  return moved;
}

TEST(LocalizerSearch, PoseFromAMovedImage_IsRefusedAsBlurred) {
  Case scene = stationCase(3);
  const Picture moved = movedPicture(*scene.picture, 14);
  scene.picture = &moved;
  EXPECT_STREQ(localizationStatusText(endOf(scene, defaultProfile())), "blurred");
}

TEST(LocalizerSearch, FocalLengthStated5PercentTooLong_IsRefusedAsACameraMismatch) {
  Case scene = stationCase(3);
  scene.camera.fx *= 1.05;
  scene.camera.fy *= 1.05;
  ASSERT_EQ(prepareCamera(scene.camera), Status::kOk);
  const FinishedRun run(scene);
  EXPECT_STREQ(localizationStatusText(run.workspace.status), "camera_mismatch");
  EXPECT_LT(run.workspace.focal.change, -0.02);
}

TEST(LocalizerSearch, WrongMeshWithASharpImage_IsNotReportedAsBlurred) {
  Case scene = stationCase(3);
  scene.solid = Solid();
  scene.solid.addBox(0.0, 0.0, 0.05, 0.03, 0.4, 0.0, 0.09, 0.5);
  scene.solid.addCylinder(0.02, 0.01, 0.02, 0.09, 0.13, 0.5);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    scene.uncertainty = uncertaintyAbout(scene.solid, scene.truth);
    scene.seed = displacedSeed(scene.truth, scene.uncertainty, 0.5, seed);
    const LocalizationStatus end = endOf(scene, defaultProfile());
    EXPECT_STRNE(localizationStatusText(end), "converged");
    EXPECT_STRNE(localizationStatusText(end), "blurred");
  }
}

TEST(LocalizerSearch, Candidates_AreOrderedByEvidenceAndTheFirstIsTheResult) {
  const Case scene = stationCase(3);
  const FinishedRun run(scene);
  const std::span<const PoseCandidate> candidates = run.workspace.candidates;
  ASSERT_FALSE(candidates.empty());
  EXPECT_LE(candidates.size(), static_cast<std::size_t>(PoseSearch::kMaxCandidates));
  EXPECT_TRUE(std::ranges::is_sorted(candidates, std::greater(), &PoseCandidate::rank_nats));
  EXPECT_LT(displacementBetween_px(candidates[0].camera_from_station, scene.truth,
                                   matchedBounds(scene.solid.view()), scene.camera),
            3.0);
  EXPECT_GT(run.workspace.probability, 0.9);
}

/// One whose roll is not known has several candidates, one on a rail without ends another of the
/// same evidence. Restarts move a convincing pose to both sides: its render shows the scene for all
/// of them.
TEST(LocalizerSearch, FirstCandidate_IsRestartedAndTheOthersWaitUnlessItDoesNotConvince) {
  Case scene = stationCase(3);
  scene.uncertainty.rotation_rad.z() = kPi;
  OwnedRun run(scene.problem(), defaultProfile());
  const RunLevels levels = levelsOf(sizeOf(scene.problem()), defaultProfile());
  std::vector<Pose> found, restarted;
  std::set<std::int32_t> edges;
  int searches = 0;
  const auto count = [&searches](const StepReport& report) {
    searches += report.stage == Stage::kSearch && report.stage_complete ? 1 : 0;
  };
  run.finish([&](const StepReport& report) {
    count(report);
    if (!report.iteration_complete) return;
    const Iteration& iteration = *run.workspace.iteration;
    const Pose& rendered = iteration.render.camera_from_station;
    const bool is_restart = iteration.level == levels.coarse &&
                            std::ranges::count(found, rendered) > 0 &&
                            rendered != iteration.camera_from_station_before;
    if (is_restart) {
      EXPECT_EQ(std::ranges::count(restarted, iteration.camera_from_station_before), 0);
      restarted.push_back(iteration.camera_from_station_before);
      edges.insert(iteration.render.pixel_count);
      // Each ends where it has reached the best pose again.
      EXPECT_LT(displacementBetween_px(rendered, iteration.camera_from_station,
                                       matchedBounds(scene.problem().mesh), scene.problem().camera),
                0.6 * static_cast<double>(1 << levels.coarse));
    }
    found.push_back(iteration.camera_from_station);
  });
  EXPECT_EQ(restarted.size(), 4u);
  EXPECT_EQ(edges.size(), 1u);
  EXPECT_EQ(run.workspace.status, LocalizationStatus::kConverged);
  EXPECT_EQ(searches, 1);

  const Case rail = railCase(Ends::kOutside, 0.5, 1.7, 3);
  OwnedRun run_of_rail(rail.problem(), defaultProfile());
  searches = 0;
  run_of_rail.finish(count);
  EXPECT_EQ(run_of_rail.workspace.status, LocalizationStatus::kAmbiguous);
  EXPECT_EQ(searches, 2);
}

TEST(LocalizerSearch, Result_IsTheHypothesisWithTheBestScoreAndHasItsContours) {
  for (const std::uint64_t seed : {3U, 5U}) {
    const Case scene = stationCase(seed);
    const FinishedRun run(scene);
    const Workspace& workspace = run.workspace;
    ASSERT_EQ(workspace.status, LocalizationStatus::kConverged);
    ASSERT_GE(workspace.best_hypothesis, 0);
    const auto at = static_cast<std::size_t>(workspace.best_hypothesis);
    const PoseHypothesis& best = workspace.hypotheses[at];
    for (const PoseHypothesis& other : workspace.hypotheses) EXPECT_LE(other.score, best.score);
    // Its last iteration is repeated with a new render and more edge places.
    EXPECT_NE(workspace.camera_from_station, best.camera_from_station);
    const PoseError moved =
        poseError(scene.solid, best.camera_from_station, workspace.camera_from_station);
    EXPECT_LT(moved.centre_m, 4e-5);
    EXPECT_LT(moved.angle_rad, 4e-4);
    EXPECT_NEAR(workspace.probability, best.probability, 0.01);
    EXPECT_EQ(workspace.probability, workspace.evidence.probability());
    EXPECT_EQ(workspace.evidence.edge_support, workspace.support.share());
    for (std::size_t view = 0; view < workspace.evidence.contours.size(); ++view)
      EXPECT_EQ(workspace.evidence.contours[view].total_nats(),
                best.evidence.contours[view].total_nats());
  }
}

TEST(LocalizerSearch, MirroredMesh_IsRefused) {
  for (const std::uint64_t seed : {1U, 3U, 4U}) {
    Case scene = stationCase(seed);
    scene.solid = mirroredSolid(scene.solid);
    LocalizerOptions options = defaultProfile();
    options.support.min_probability = 0.0;  // only the comparison refuses it
    EXPECT_NE(endOf(scene, options), LocalizationStatus::kConverged);
  }
}

TEST(LocalizerSearch, UnsupportedPose_IsFollowedByFurtherAttempts) {
  const Case scene = stationCase(3);
  LocalizerOptions options = defaultProfile();
  options.support.min_probability = 1.0;
  const FinishedRun run(scene, options);
  EXPECT_EQ(run.workspace.status, LocalizationStatus::kNotSupported);
  EXPECT_GT(run.workspace.attempts, 1);
  EXPECT_LE(run.workspace.attempts, PoseComparison::kMostHypotheses + 1);
}

TEST(LocalizerSearch, AnyKernelsAndWorkers_GiveTheSameBits) {
  const Case scene = turnedCase(4, -130.0 * kDegree_rad);
  const Digest plain = digestOf(scene.problem(), defaultProfile());
  for (const int workers : {1, 3})
    EXPECT_EQ(sharedDigest(scene.problem(), defaultProfile(), workers), plain) << workers;
}

/// The seed from which an offset within the free axes (rotation, translation; bits) leads to the
/// truth; the other axes are known exactly.
void knowExactlyBut(unsigned free_axes, std::uint64_t seed, Case& scene) {
  SeedUncertainty& uncertainty = scene.uncertainty;
  Vector6d offset = offsetWithin(uncertainty, 0.6, seed);
  for (int axis = 0; axis < 6; ++axis) {
    if ((free_axes >> axis & 1U) != 0) continue;
    offset[axis] = 0.0;
    (axis < 3 ? uncertainty.rotation_rad[axis] : uncertainty.translation_m[axis - 3]) = 0.0;
  }
  Pose moved = scene.truth;
  moved.translation_m -= offset.tail<3>();
  Vector6d turn = Vector6d::Zero();
  turn.head<3>() = -offset.head<3>();
  scene.seed = displacedAboutPivot(moved, turn, uncertainty.pivot_in_camera_m);
}

/// A turntable, a rail, an object that gravity levels.
TEST(LocalizerSearch, AxesThatAreKnownExactly_DoNotEndTheRun) {
  for (const unsigned free_axes : {0U, 0b000100U, 0b100000U, 0b111000U, 0b000111U, 0b011111U})
    for (const std::uint64_t seed : {1U, 2U}) {
      SCOPED_TRACE(testing::Message() << "free axes " << free_axes << ", seed " << seed);
      Case scene = stationCase(seed);
      knowExactlyBut(free_axes, seed, scene);
      const FinishedRun run(scene);
      expectTruth(scene, run.workspace, 0.0002, 0.1 * kDegree_rad);
    }
}

}  // namespace
}  // namespace boresight::test
