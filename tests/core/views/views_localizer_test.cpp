// SPDX-License-Identifier: Apache-2.0
// Several views as one: against the plain localizer, which one view alone must equal to the bit,
// and against known truths.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "core/base/math.h"
#include "core/base/random.h"
#include "core/pnp/correspondence.h"
#include "core/pnp/pnp_options.h"
#include "core/pnp/pnp_ransac.h"
#include "core/pnp/refine_pose.h"
#include "core/views/views_localizer.h"
#include "tests/core/localizer/rail_scene.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

struct ViewsRun {
  std::vector<View> views;
  ViewsProblem problem;
  std::vector<std::byte> memory;
  std::unique_ptr<ViewsLocalizer> localizer;

  ViewsRun(const Case& scene, std::vector<View> given, const LocalizerOptions& options)
      : views(std::move(given)) {
    for (View& view : views)
      if (view.mesh.faces.empty()) view.mesh = scene.solid.view();
    problem.views = views;
    problem.rig_from_station_seed = scene.seed;
    problem.uncertainty = scene.uncertainty;
    std::size_t bytes = 0;
    if (ViewsLocalizer::requiredBytes(problem, options, bytes) == Status::kOk) memory.resize(bytes);
    localizer = std::make_unique<ViewsLocalizer>(problem, options, memory);
  }
  const ViewsResult& finish() {
    for (int i = 0; i < 1000000 && !localizer->step().finished; ++i) {
    }
    return localizer->result();
  }
};

View viewOf(const Case& scene) {
  return {scene.picture->view(), nullptr, scene.camera, {}, Pose()};
}

Pose secondFromRig() { return {rotationExp({0.02, -0.2, 0.03}), {0.09, 0.005, 0.01}}; }

/// The station's pose in a camera next to the first one.
View secondView(const Case& scene) {
  static const Picture picture =
      takePicture(stationMesh(), pinholeCamera(), secondFromRig() * truthPose());
  return {picture.view(), nullptr, scene.camera, {}, secondFromRig()};
}

void expectSamePose(const Pose& first, const Pose& second) {
  EXPECT_EQ(first.rotation.coeffs(), second.rotation.coeffs());
  EXPECT_EQ(first.translation_m, second.translation_m);
}

std::vector<LocalizerOptions> profiles() {
  LocalizerOptions matched = defaultProfile();
  matched.refinement.enabled = false;
  LocalizerOptions one_match = defaultProfile();
  one_match.loop.match_iterations = 1;
  one_match.loop.enough_inliers = 2.0;
  LocalizerOptions refused = defaultProfile();
  refused.support.min_support = 1.0;
  LocalizerOptions few = defaultProfile();
  few.pnp.min_inliers = 10000;
  std::vector<LocalizerOptions> all = {defaultProfile(), paperProfile(), matched,
                                       one_match,        refused,        few};
  for (LocalizerOptions& each : all) each.search.enabled = false;  // views start from their seed
  return all;
}

void expectBitsOfThePlainLocalizer(const Case& scene, const LocalizerOptions& options) {
  OwnedRun plain(scene.problem(), options);
  plain.finish();
  const Workspace& expected = plain.localizer.workspace();
  ViewsRun run(scene, {viewOf(scene)}, options);
  const ViewsResult& result = run.finish();
  EXPECT_EQ(result.status, expected.status);
  EXPECT_EQ(result.iterations, expected.iterations);
  EXPECT_EQ(result.attempts, expected.attempts);
  expectSamePose(result.rig_from_station, expected.camera_from_station);
  EXPECT_EQ(result.covariance, expected.covariance);
  EXPECT_STREQ(hexText(run.localizer->view(0).digest().digest()).data(),
               hexText(plain.localizer.digest()).data());
}

TEST(ViewsLocalizer, SingleView_GivesTheBitsOfTheLocalizer) {
  for (int i = 0; i < static_cast<int>(profiles().size()); ++i) {
    const LocalizerOptions options = profiles()[static_cast<std::size_t>(i)];
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      SCOPED_TRACE(testing::Message() << "options " << i << ", seed " << seed);
      expectBitsOfThePlainLocalizer(stationCase(seed, seed == 2), options);
    }
  }
  Case faint = stationCase(1);
  const Picture faint_picture = faintened(*faint.picture);
  faint.picture = &faint_picture;
  expectBitsOfThePlainLocalizer(faint, withoutSearch());  // the refinement finds no edges
}

TEST(ViewsLocalizer, TheSameViewTwiceGivesThePoseWithHalfTheCovariance) {
  const Case scene = stationCase(1);
  ViewsRun alone(scene, {viewOf(scene)}, defaultProfile());
  ViewsRun twice(scene, {viewOf(scene), viewOf(scene)}, defaultProfile());
  const ViewsResult& single = alone.finish();
  const ViewsResult& two = twice.finish();
  ASSERT_EQ(two.status, LocalizationStatus::kConverged);
  const Vector6d difference = perturbationBetween(single.rig_from_station, two.rig_from_station);
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(std::abs(difference[i]), 0.3 * std::sqrt(single.covariance(i, i)));
    EXPECT_NEAR(two.covariance(i, i) / single.covariance(i, i), 0.5, 0.02);
  }
}

TEST(ViewsLocalizer, ANoisySecondView_DoesNotMakeTheCovarianceLarger) {
  const Case scene = stationCase(1);
  Picture noisy = *scene.picture;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 25.0);
  for (std::uint8_t& gray : noisy.gray)
    gray = static_cast<std::uint8_t>(std::clamp(gray + noise(random), 0.0, 255.0));
  View second = viewOf(scene);
  second.image = noisy.view();
  ViewsRun alone(scene, {viewOf(scene)}, withoutSearch());
  ViewsRun both(scene, {viewOf(scene), second}, withoutSearch());
  const ViewsResult& single = alone.finish();
  const ViewsResult& two = both.finish();
  ASSERT_EQ(two.status, LocalizationStatus::kConverged);
  ASSERT_GT(two.views[1].edges_used, 0);
  for (int i = 0; i < 6; ++i) EXPECT_LT(two.covariance(i, i), 1.02 * single.covariance(i, i));
}

TEST(ViewsLocalizer, TwoCamerasConvergeOnTheTruthAndBothTakePart) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const Case scene = stationCase(seed);
    ViewsRun run(scene, {viewOf(scene), secondView(scene)}, withoutSearch());
    const ViewsResult& result = run.finish();
    ASSERT_EQ(result.status, LocalizationStatus::kConverged);
    EXPECT_TRUE(result.views[0].tookPart());
    EXPECT_TRUE(result.views[1].tookPart());
    EXPECT_GT(result.views[1].inliers, 20);
    const PoseError error = poseError(scene.solid, scene.truth, result.rig_from_station);
    EXPECT_LT(error.centre_m, 0.0002);
    EXPECT_LT(error.angle_rad, 0.002);
  }
}

TEST(ViewsLocalizer, PixelThatChangesInAnyView_EndsTheRunAsAFault) {
  const Case scene = stationCase(1);
  Picture second;
  const View view = secondView(scene);
  second.width = view.image.width;
  second.height = view.image.height;
  second.gray.assign(view.image.data, view.image.data + second.width * second.height);
  View changing = view;
  changing.image = second.view();
  ViewsRun run(scene, {viewOf(scene), changing}, withoutSearch());
  (void)run.localizer->step();
  second.gray[1000] ^= 1;
  const ViewsResult& result = run.finish();
  EXPECT_EQ(result.status, LocalizationStatus::kFault);
  EXPECT_STREQ(statusText(result.fault), statusText(Status::kMemoryChanged));
}

TEST(ViewsLocalizer, BlackOrWhiteSecondView_GivesTheBitsOfTheFirstView) {
  for (const int gray : {0, 255}) {
    const Case scene = stationCase(3);
    const Picture blank = flatPicture(512, 512, static_cast<std::uint8_t>(gray));
    View second = secondView(scene);
    second.image = blank.view();
    ViewsRun alone(scene, {viewOf(scene)}, withoutSearch());
    ViewsRun run(scene, {viewOf(scene), second}, withoutSearch());
    const ViewsResult& expected = alone.finish();
    const ViewsResult& result = run.finish();
    ASSERT_EQ(result.status, LocalizationStatus::kConverged);
    expectSamePose(result.rig_from_station, expected.rig_from_station);
    EXPECT_EQ(result.covariance, expected.covariance);
    EXPECT_TRUE(result.views[0].tookPart());
    EXPECT_EQ(result.views[1].status, LocalizationStatus::kTooFewMatches);
  }
}

/// Two views converge on the truth without this one.
void expectLeftOut(std::size_t left_out, const Case& scene, const std::vector<View>& views) {
  ViewsRun run(scene, views, withoutSearch());
  const ViewsResult& result = run.finish();
  ASSERT_EQ(result.status, LocalizationStatus::kConverged);
  for (std::size_t v = 0; v < 2; ++v) EXPECT_EQ(result.views[v].tookPart(), v != left_out) << v;
  EXPECT_LT(poseError(scene.solid, scene.truth, result.rig_from_station).centre_m, 0.0006);
}

TEST(ViewsLocalizer, BlackFirstView_LeavesThePoseToTheSecondView) {
  const Case scene = stationCase(2);
  const Picture blank = flatPicture(512, 512, 0);
  View first = viewOf(scene);
  first.image = blank.view();
  expectLeftOut(0, scene, {first, secondView(scene)});
}

TEST(ViewsLocalizer, ViewOfAnotherScene_IsLeftOut) {
  const Case scene = stationCase(4);
  const Picture noise = noisePicture(512, 512, 5);
  View second = secondView(scene);
  second.image = noise.view();
  expectLeftOut(1, scene, {viewOf(scene), second});
}

/// What is left of the second view agrees with the first, but supports the pose too little: it is
/// dropped at the end, and the first refines on alone.
TEST(ViewsLocalizer, HalfCoveredView_IsDroppedByTheAcceptanceTestAndTheOtherConverges) {
  const Case scene = stationCase(3);
  const View whole = secondView(scene);
  LocalizerOptions options = withoutSearch();
  options.support.min_support = 0.6;
  int dropped = 0;
  for (int covered = 200; covered <= 320; covered += 40) {
    SCOPED_TRACE(covered);
    Picture half = flatPicture(512, 512, 0);
    for (int y = 0; y < 512; ++y)
      std::copy_n(whole.image.row(y) + covered, 512 - covered,
                  half.gray.begin() + 512 * y + covered);
    View second = whole;
    second.image = half.view();
    ViewsRun run(scene, {viewOf(scene), second}, options);
    const ViewsResult& result = run.finish();
    ASSERT_EQ(result.status, LocalizationStatus::kConverged);
    EXPECT_TRUE(result.views[0].tookPart());
    EXPECT_LT(poseError(scene.solid, scene.truth, result.rig_from_station).centre_m, 0.0006);
    if (result.views[1].status != LocalizationStatus::kNotSupported) continue;  // nearly whole
    ++dropped;
    EXPECT_GT(result.views[1].inliers, 5);
    EXPECT_LT(result.views[1].support.share(), options.support.min_support);
    // By the first view's edges alone at the end: its covariance, not that of both.
    ViewsRun both(scene, {viewOf(scene), whole}, options);
    ViewsRun alone(scene, {viewOf(scene)}, options);
    const double of_alone = alone.finish().covariance.trace();
    const double of_both = both.finish().covariance.trace();
    EXPECT_LT(std::abs(result.covariance.trace() - of_alone),
              std::abs(result.covariance.trace() - of_both));
  }
  EXPECT_GT(dropped, 0);
}

/// The seed turned about the first camera's axis, as its uncertainty says.
Case turnedCase(double turn_deg) {
  Case scene = stationCase(3);
  const Eigen::Quaterniond turn = rotationExp({0.0, 0.0, turn_deg * kDegree_rad});
  scene.seed.rotation = (turn * scene.truth.rotation).normalized();
  scene.seed.translation_m = turn * scene.truth.translation_m;
  scene.uncertainty.pivot_in_camera_m.setZero();
  scene.uncertainty.rotation_rad.z() = kPi;
  return scene;
}

TEST(ViewsLocalizer, TurnedSeed_IsFoundByTheSearchOfAllViews) {
  const Case scene = turnedCase(130.0);
  ViewsRun run(scene, {viewOf(scene), secondView(scene)}, defaultProfile());
  const ViewsResult& result = run.finish();
  ASSERT_EQ(result.status, LocalizationStatus::kConverged);
  EXPECT_TRUE(result.views[0].tookPart());
  EXPECT_TRUE(result.views[1].tookPart());
  EXPECT_GT(result.views[1].probability, 0.9);
  EXPECT_LT(poseError(scene.solid, scene.truth, result.rig_from_station).centre_m, 0.0002);
}

TEST(ViewsLocalizer, TurnedSeedBeforeABlackFirstView_IsFoundInTheSecond) {
  const Case scene = turnedCase(-100.0);
  const Picture blank = flatPicture(512, 512, 0);
  View first = viewOf(scene);
  first.image = blank.view();
  ViewsRun run(scene, {first, secondView(scene)}, defaultProfile());
  const ViewsResult& result = run.finish();
  ASSERT_EQ(result.status, LocalizationStatus::kConverged);
  EXPECT_FALSE(result.views[0].tookPart());
  EXPECT_LT(poseError(scene.solid, scene.truth, result.rig_from_station).centre_m, 0.0006);
}

/// As with one view, whatever the probability says.
TEST(ViewsLocalizer, MirroredMesh_IsRefused) {
  for (const std::uint64_t seed : {1U, 3U}) {
    Case scene = stationCase(seed);
    const View first = viewOf(scene);
    const View second = secondView(scene);  // of the mesh as it is
    const auto twice_middle_m =
        static_cast<float>(2.0 * matchedBounds(scene.solid.view()).centre().x());
    for (Eigen::Vector3f& vertex : scene.solid.vertices) vertex.x() = twice_middle_m - vertex.x();
    for (Face& face : scene.solid.faces) std::swap(face.vertex[1], face.vertex[2]);
    LocalizerOptions options = defaultProfile();
    options.support.min_probability = 0.0;
    ViewsRun run(scene, {first, second}, options);
    EXPECT_NE(run.finish().status, LocalizationStatus::kConverged);
  }
}

/// The memory of the candidates is that of the wider search.
TEST(ViewsLocalizer, PoseBeyondTheStatedUncertainty_IsComparedWithAWiderSearchInAllViews) {
  for (const double share : {0.5, 1.2}) {
    Case scene = stationCase(1);
    scene.seed = scene.truth;
    scene.seed.translation_m.x() += share * scene.uncertainty.translation_m.x();
    ViewsRun run(scene, {viewOf(scene), secondView(scene)}, defaultProfile());
    EXPECT_STREQ(localizationStatusText(run.finish().status), "converged");
    for (int v = 0; v < 2; ++v)
      EXPECT_EQ(run.localizer->view(v).workspace().candidates.empty(), share > 1.0);
  }
}

/// A second picture of a rail.
View secondRailView(const Case& scene, const Picture& picture) {
  return {picture.view(), nullptr, scene.camera, {}, secondFromRig()};
}

TEST(ViewsLocalizer, RepeatedFeaturesWithoutEndsInBothViews_EndAsAmbiguous) {
  const Case scene = railCase(Ends::kOutside, 0.0, 1.7, 3);
  const Picture picture = takePicture(scene.solid, scene.camera, secondFromRig() * scene.truth);
  ViewsRun run(scene, {viewOf(scene), secondRailView(scene, picture)}, defaultProfile());
  const ViewsResult& result = run.finish();
  ASSERT_EQ(result.status, LocalizationStatus::kAmbiguous);
  ASSERT_GT(result.competing_poses.size(), 0);
  double nearest_pitches = 1e9;
  for (const CompetingPose& pose : result.competing_poses.items()) {
    const double pitches = std::abs(pitchError(scene, pose.camera_from_station).pitches);
    nearest_pitches = std::min(nearest_pitches, std::abs(pitches - std::round(pitches)));
  }
  EXPECT_LT(nearest_pitches, 0.1);
}

TEST(ViewsLocalizer, RepeatedFeaturesWithEndsHiddenInTheFirstViewOnly_ConvergeOnTheTruth) {
  const Case scene = railCase(Ends::kHidden, 1.0, 1.7, 3);
  const Picture picture = takePicture(scene.solid, scene.camera, secondFromRig() * scene.truth);
  ViewsRun run(scene, {viewOf(scene), secondRailView(scene, picture)}, defaultProfile());
  const ViewsResult& result = run.finish();
  ASSERT_EQ(result.status, LocalizationStatus::kConverged);
  EXPECT_NEAR(pitchError(scene, result.rig_from_station).pitches, 0.0, 0.1);
}

TEST(ViewsLocalizer, BlackImages_Fail) {
  const Case scene = stationCase(1);
  const Picture blank = flatPicture(512, 512, 0);
  View first = viewOf(scene);
  View second = secondView(scene);
  first.image = second.image = blank.view();
  ViewsRun run(scene, {first, second}, defaultProfile());
  EXPECT_NE(run.finish().status, LocalizationStatus::kConverged);
  expectSamePose(run.localizer->result().rig_from_station, scene.seed);
}

TEST(ViewsLocalizer, InvalidOptionsViewsAndCameras_AreRefused) {
  const Case scene = stationCase(1);
  LocalizerOptions invalid = defaultProfile();
  invalid.templates.count = -1;
  ViewsRun two(scene, {viewOf(scene), secondView(scene)}, invalid);
  EXPECT_EQ(two.localizer->status(), Status::kInvalidOption);
  EXPECT_EQ(two.finish().status, LocalizationStatus::kFault);
  EXPECT_EQ(ViewsRun(scene, {}, defaultProfile()).localizer->status(), Status::kCapacityExceeded);
  View blind = viewOf(scene);
  blind.camera = Camera();
  EXPECT_NE(ViewsRun(scene, {viewOf(scene), blind}, defaultProfile()).localizer->status(),
            Status::kOk);
}

// Equations of one camera in the frame of another, against perturbations carried out and against
// one list of equations.

double signedUniform(Random& random) { return 2.0 * random.uniform() - 1.0; }

Eigen::Vector3d randomVector(Random& random, double size) {
  return {size * signedUniform(random), size * signedUniform(random), size * signedUniform(random)};
}

Pose randomPose(Random& random, double turn_rad, double shift_m) {
  return {rotationExp(randomVector(random, turn_rad)), randomVector(random, shift_m)};
}

TEST(AdjointOf, MapsSmallPerturbationsBetweenCameras) {
  Random random(11);
  for (int i = 0; i < 50; ++i) {
    const Pose a_from_b = randomPose(random, 2.0, 0.5);
    const Pose b_from_station = randomPose(random, 2.0, 0.5);
    Vector6d xi;
    xi << randomVector(random, 1e-5), randomVector(random, 1e-5);
    const Pose moved = a_from_b * perturbed(xi, b_from_station);
    const Vector6d carried = perturbationBetween(a_from_b * b_from_station, moved);
    EXPECT_LT((carried - adjointOf(a_from_b) * xi).norm(), 1e-9);
  }
}

struct Seen {
  std::vector<Correspondence> correspondences;
  std::array<PnpView, 2> views;
};

/// Two cameras that see points about the station exactly from a pose.
Seen seenFrom(const Camera& camera, const Pose& second_from_first, const Pose& first_from_station,
              Random& random) {
  Seen seen;
  seen.views[0] = {&camera, Pose(), 0};
  seen.views[1] = {&camera, second_from_first, 0};
  for (std::size_t v = 0; v < 2; ++v) {
    const Pose camera_from_station =
        v == 0 ? first_from_station : second_from_first * first_from_station;
    for (int i = 0; i < 20; ++i) {
      Correspondence correspondence;
      correspondence.point_in_station_m = randomVector(random, 0.05);
      EXPECT_TRUE(project(camera, camera_from_station * correspondence.point_in_station_m,
                          correspondence.pixel));
      seen.correspondences.push_back(correspondence);
    }
    seen.views[v].end = static_cast<std::int32_t>(seen.correspondences.size());
  }
  return seen;
}

TEST(RefinePoseOfViews, TwoViews_ConvergeOnTheCommonPose) {
  Random random(12);
  const Camera camera = pinholeCamera();
  for (int i = 0; i < 20; ++i) {
    const Pose truth = truthPose();
    const Pose second_from_first{rotationExp({0.0, -0.2, 0.1}), {0.1, 0.0, 0.02}};
    const Seen seen = seenFrom(camera, second_from_first, truth, random);
    Vector6d xi;
    xi << randomVector(random, 0.05), randomVector(random, 0.01);
    Pose pose = perturbed(xi, truth);
    ASSERT_EQ(refinePose(seen.correspondences, {}, seen.views, nullptr, 30, pose), Status::kOk);
    EXPECT_LT(perturbationBetween(truth, pose).norm(), 1e-9);
  }
}

TEST(PnpRansacOfViews, EverySamplerFindsThePoseDespiteWrongMatchesInEither) {
  Random random(13);
  const Camera camera = pinholeCamera();
  const Pose truth = truthPose();
  const Pose second_from_first{rotationExp({0.0, -0.2, 0.1}), {0.1, 0.0, 0.02}};
  for (const PnpSampler sampler : {PnpSampler::kGuided, PnpSampler::kEpnp}) {
    Seen seen = seenFrom(camera, second_from_first, truth, random);
    for (std::size_t i = 0; i < seen.correspondences.size(); i += 4)
      seen.correspondences[i].pixel += Eigen::Vector2d(40.0, -25.0 - static_cast<double>(i));
    std::vector<std::byte> memory(100000);
    Arena arena(memory);
    PnpRansac ransac;
    ASSERT_EQ(ransac.create(40, arena), Status::kOk);
    std::vector<std::uint8_t> inlier(40);
    std::vector<double> residual_px(40);
    PnpSolution solution;
    solution.inlier = inlier;
    solution.residual_px = residual_px;
    PnpOptions options;
    options.sampler = sampler;
    Vector6d xi;
    xi << randomVector(random, 0.02), randomVector(random, 0.005);
    ASSERT_EQ(ransac.begin(seen.correspondences, seen.views, {perturbed(xi, truth), {}}, 2.0,
                           options, solution),
              Status::kOk);
    bool done = false;
    Status status = Status::kOk;
    while (!done) status = ransac.step(done);
    ASSERT_EQ(status, Status::kOk);
    EXPECT_EQ(solution.inlier_count, 30);
    EXPECT_LT(perturbationBetween(truth, solution.camera_from_station).norm(), 1e-8);
  }
}

}  // namespace
}  // namespace boresight::test
