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
#include "tests/support/random_pose.h"

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
    if (ViewsLocalizer::requiredBytes(problem, options, 1, Kernels::kPortable, bytes) ==
        Status::kOk)
      memory.resize(bytes);
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

View secondViewOf(const Case& scene, const Picture& picture) {
  return {picture.view(), nullptr, scene.camera, {}, secondFromRig()};
}

/// The station in a camera next to the first one.
const Picture& secondPicture() {
  static const Picture picture =
      takePicture(stationMesh(), pinholeCamera(), secondFromRig() * truthPose());
  return picture;
}

View secondView(const Case& scene) { return secondViewOf(scene, secondPicture()); }

View withImage(View view, const Picture& picture) {
  view.image = picture.view();
  return view;
}

ViewsResult resultOf(const Case& scene, std::vector<View> views, const LocalizerOptions& options) {
  return ViewsRun(scene, std::move(views), options).finish();
}

/// Converges within `limit_m` of the truth; whether each of two views takes part in the pose.
ViewsResult expectTruthOf(const Case& scene, const std::vector<View>& views,
                          const LocalizerOptions& options, std::array<bool, 2> takes_part,
                          double limit_m) {
  const ViewsResult result = resultOf(scene, views, options);
  EXPECT_STREQ(localizationStatusText(result.status), "converged");
  for (std::size_t v = 0; v < 2; ++v) EXPECT_EQ(result.views[v].tookPart(), takes_part[v]) << v;
  EXPECT_LT(poseError(scene.solid, scene.truth, result.rig_from_station).centre_m, limit_m);
  return result;
}

std::vector<LocalizerOptions> profiles() {
  std::vector<LocalizerOptions> all(5, withoutSearch());
  all[1].refinement.enabled = false;
  all[2].loop.match_iterations = 1;
  all[2].loop.enough_inliers = 2.0;
  all[3].support.min_support = 1.0;
  all[4].pnp.min_inliers = 10000;
  all.push_back(paperProfile());
  return all;
}

void expectBitsOfThePlainLocalizer(const Case& scene, const LocalizerOptions& options) {
  const FinishedRun plain(scene, options);
  const Workspace& expected = plain.workspace;
  ViewsRun run(scene, {viewOf(scene)}, options);
  const ViewsResult& result = run.finish();
  EXPECT_EQ(result.status, expected.status);
  EXPECT_EQ(result.iterations, expected.iterations);
  EXPECT_EQ(result.attempts, expected.attempts);
  EXPECT_EQ(result.rig_from_station, expected.camera_from_station);
  EXPECT_EQ(result.covariance, expected.covariance);
  EXPECT_STREQ(hexText(run.localizer->view(0).digest().digest()).data(),
               hexText(plain.localizer.digest()).data());
}

TEST(ViewsLocalizer, SingleView_GivesTheBitsOfTheLocalizer) {
  const std::vector<LocalizerOptions> all = profiles();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      SCOPED_TRACE(testing::Message() << "options " << i << ", seed " << seed);
      expectBitsOfThePlainLocalizer(stationCase(seed, seed == 2), all[i]);
    }
  }
  Case faint = stationCase(1);
  const Picture faint_picture = faintened(*faint.picture);
  faint.picture = &faint_picture;
  expectBitsOfThePlainLocalizer(faint, withoutSearch());  // the refinement finds no edges
}

TEST(ViewsLocalizer, TheSameViewTwiceGivesThePoseWithHalfTheCovariance) {
  const Case scene = stationCase(1);
  const ViewsResult single = resultOf(scene, {viewOf(scene)}, defaultProfile());
  const ViewsResult two = resultOf(scene, {viewOf(scene), viewOf(scene)}, defaultProfile());
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
  const View first = viewOf(scene);
  const ViewsResult single = resultOf(scene, {first}, withoutSearch());
  const ViewsResult two = resultOf(scene, {first, withImage(first, noisy)}, withoutSearch());
  ASSERT_EQ(two.status, LocalizationStatus::kConverged);
  ASSERT_GT(two.views[1].edges_used, 0);
  for (int i = 0; i < 6; ++i) EXPECT_LT(two.covariance(i, i), 1.02 * single.covariance(i, i));
}

TEST(ViewsLocalizer, TwoCamerasConvergeOnTheTruthAndBothTakePart) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const Case scene = stationCase(seed);
    const ViewsResult result = expectTruthOf(scene, {viewOf(scene), secondView(scene)},
                                             withoutSearch(), {true, true}, 0.0002);
    EXPECT_GT(result.views[1].inliers, 20);
    EXPECT_LT(poseError(scene.solid, scene.truth, result.rig_from_station).angle_rad, 0.002);
  }
}

TEST(ViewsLocalizer, PixelThatChangesInAnyView_EndsTheRunAsAFault) {
  const Case scene = stationCase(1);
  Picture second = secondPicture();
  ViewsRun run(scene, {viewOf(scene), secondViewOf(scene, second)}, withoutSearch());
  (void)run.localizer->step();
  second.gray[1000] ^= 1;
  const ViewsResult& result = run.finish();
  EXPECT_EQ(result.status, LocalizationStatus::kFault);
  EXPECT_STREQ(statusText(result.fault), statusText(Status::kMemoryChanged));
}

TEST(ViewsLocalizer, BlackOrWhiteSecondView_GivesTheBitsOfTheFirstView) {
  const Case scene = stationCase(3);
  const ViewsResult expected = resultOf(scene, {viewOf(scene)}, withoutSearch());
  for (const std::uint8_t gray : {std::uint8_t{0}, std::uint8_t{255}}) {
    const Picture blank = flatPicture(512, 512, gray);
    const ViewsResult result =
        resultOf(scene, {viewOf(scene), secondViewOf(scene, blank)}, withoutSearch());
    ASSERT_EQ(result.status, LocalizationStatus::kConverged);
    EXPECT_EQ(result.rig_from_station, expected.rig_from_station);
    EXPECT_EQ(result.covariance, expected.covariance);
    EXPECT_TRUE(result.views[0].tookPart());
    EXPECT_EQ(result.views[1].status, LocalizationStatus::kTooFewMatches);
  }
}

TEST(ViewsLocalizer, BlackFirstView_LeavesThePoseToTheSecondView) {
  const Picture blank = flatPicture(512, 512, 0);
  const Case near = stationCase(2);
  expectTruthOf(near, {withImage(viewOf(near), blank), secondView(near)}, withoutSearch(),
                {false, true}, 0.0006);
  Case turned = stationCase(3);
  turnAboutTheCamera(turned, -100.0 * kDegree_rad);
  expectTruthOf(turned, {withImage(viewOf(turned), blank), secondView(turned)}, defaultProfile(),
                {false, true}, 0.0006);
}

TEST(ViewsLocalizer, ViewOfAnotherScene_IsLeftOut) {
  const Case scene = stationCase(4);
  const Picture noise = noisePicture(512, 512, 5);
  expectTruthOf(scene, {viewOf(scene), secondViewOf(scene, noise)}, withoutSearch(), {true, false},
                0.0006);
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
    const ViewsResult result = resultOf(scene, {viewOf(scene), withImage(whole, half)}, options);
    ASSERT_EQ(result.status, LocalizationStatus::kConverged);
    EXPECT_TRUE(result.views[0].tookPart());
    EXPECT_LT(poseError(scene.solid, scene.truth, result.rig_from_station).centre_m, 0.0006);
    if (result.views[1].status != LocalizationStatus::kNotSupported) continue;  // nearly whole
    ++dropped;
    EXPECT_GT(result.views[1].inliers, 5);
    EXPECT_LT(result.views[1].support.share(), options.support.min_support);
    // By the first view's edges alone at the end: its covariance, not that of both.
    const double of_alone = resultOf(scene, {viewOf(scene)}, options).covariance.trace();
    const double of_both = resultOf(scene, {viewOf(scene), whole}, options).covariance.trace();
    EXPECT_LT(std::abs(result.covariance.trace() - of_alone),
              std::abs(result.covariance.trace() - of_both));
  }
  EXPECT_GT(dropped, 0);
}

TEST(ViewsLocalizer, TurnedSeed_IsFoundByTheSearchOfAllViews) {
  Case scene = stationCase(3);
  turnAboutTheCamera(scene, 130.0 * kDegree_rad);
  const ViewsResult result = expectTruthOf(scene, {viewOf(scene), secondView(scene)},
                                           defaultProfile(), {true, true}, 0.0002);
  EXPECT_GT(result.views[1].probability, 0.9);
}

/// As with one view, whatever the probability says.
TEST(ViewsLocalizer, MirroredMesh_IsRefused) {
  for (const std::uint64_t seed : {1U, 3U}) {
    Case scene = stationCase(seed);
    scene.solid = mirroredSolid(scene.solid);  // the pictures show the mesh as it was
    LocalizerOptions options = defaultProfile();
    options.support.min_probability = 0.0;
    EXPECT_NE(resultOf(scene, {viewOf(scene), secondView(scene)}, options).status,
              LocalizationStatus::kConverged);
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

ViewsResult resultOfRail(const Case& rail) {
  const Picture picture = takePicture(rail.solid, rail.camera, secondFromRig() * rail.truth);
  return resultOf(rail, {viewOf(rail), secondViewOf(rail, picture)}, defaultProfile());
}

TEST(ViewsLocalizer, RepeatedFeaturesWithoutEndsInBothViews_EndAsAmbiguous) {
  const Case scene = railCase(Ends::kOutside, 0.0, 1.7, 3);
  const ViewsResult result = resultOfRail(scene);
  ASSERT_EQ(result.status, LocalizationStatus::kAmbiguous);
}

TEST(ViewsLocalizer, RepeatedFeaturesWithEndsHiddenInTheFirstViewOnly_ConvergeOnTheTruth) {
  const Case scene = railCase(Ends::kHidden, 1.0, 1.7, 3);
  const ViewsResult result = resultOfRail(scene);
  ASSERT_EQ(result.status, LocalizationStatus::kConverged);
  EXPECT_NEAR(pitchError(scene, result.rig_from_station).pitches, 0.0, 0.1);
}

TEST(ViewsLocalizer, BlackImages_Fail) {
  const Case scene = stationCase(1);
  const Picture blank = flatPicture(512, 512, 0);
  const ViewsResult result = resultOf(
      scene, {withImage(viewOf(scene), blank), secondViewOf(scene, blank)}, defaultProfile());
  EXPECT_NE(result.status, LocalizationStatus::kConverged);
  EXPECT_EQ(result.rig_from_station, scene.seed);
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

/// The rotation's components within `turn_rad`, those of the translation within `shift_m`.
Vector6d randomPerturbation(Random& random, double turn_rad, double shift_m) {
  Vector6d xi;
  xi << randomVector(random, turn_rad), randomVector(random, shift_m);
  return xi;
}

TEST(AdjointOf, MapsSmallPerturbationsBetweenCameras) {
  Random random(11);
  for (int i = 0; i < 50; ++i) {
    const Pose a_from_b = randomPose(random, 0.5);
    const Pose b_from_station = randomPose(random, 0.5);
    const Vector6d xi = randomPerturbation(random, 1e-5, 1e-5);
    const Pose moved = a_from_b * perturbed(xi, b_from_station);
    const Vector6d carried = perturbationBetween(a_from_b * b_from_station, moved);
    EXPECT_LT((carried - adjointOf(a_from_b) * xi).norm(), 1e-9);
  }
}

struct Seen {
  std::vector<Correspondence> correspondences;
  std::array<PnpView, 2> views;
};

/// Two cameras that see points about the station exactly from the true pose.
Seen seenByTwo(const Camera& camera, Random& random) {
  Seen seen;
  seen.views = {PnpView{&camera, Pose(), 0},
                PnpView{&camera, Pose{rotationExp({0.0, -0.2, 0.1}), {0.1, 0.0, 0.02}}, 0}};
  for (PnpView& view : seen.views) {
    for (int i = 0; i < 20; ++i) {
      Correspondence correspondence;
      correspondence.point_in_station_m = randomVector(random, 0.05);
      EXPECT_TRUE(project(camera,
                          view.camera_from_first * truthPose() * correspondence.point_in_station_m,
                          correspondence.pixel));
      seen.correspondences.push_back(correspondence);
    }
    view.end = static_cast<std::int32_t>(seen.correspondences.size());
  }
  return seen;
}

TEST(RefinePoseOfViews, TwoViews_ConvergeOnTheCommonPose) {
  Random random(12);
  const Camera camera = pinholeCamera();
  for (int i = 0; i < 20; ++i) {
    const Pose truth = truthPose();
    const Seen seen = seenByTwo(camera, random);
    Pose pose = perturbed(randomPerturbation(random, 0.05, 0.01), truth);
    ASSERT_EQ(refinePose(seen.correspondences, {}, seen.views, nullptr, 30, pose), Status::kOk);
    EXPECT_LT(perturbationBetween(truth, pose).norm(), 1e-9);
  }
}

TEST(PnpRansacOfViews, EverySamplerFindsThePoseDespiteWrongMatchesInEither) {
  Random random(13);
  const Camera camera = pinholeCamera();
  const Pose truth = truthPose();
  for (const PnpSampler sampler : {PnpSampler::kGuided, PnpSampler::kEpnp}) {
    Seen seen = seenByTwo(camera, random);
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
    const Pose start = perturbed(randomPerturbation(random, 0.02, 0.005), truth);
    ASSERT_EQ(ransac.begin(seen.correspondences, seen.views, {start, {}}, 2.0, options, solution),
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
