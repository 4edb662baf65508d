// SPDX-License-Identifier: Apache-2.0
#include "core/search/pose_search.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/math.h"
#include "core/base/random.h"
#include "core/geometry/surface_axes.h"
#include "core/search/facing_view.h"
#include "core/search/mirror_search.h"
#include "core/search/pose_evidence_meter.h"
#include "core/search/search_candidates.h"
#include "core/search/wider_search.h"
#include "tests/core/geometry/example_cameras.h"
#include "tests/core/search/search_scene.h"

namespace boresight {
namespace {

/// A search with all its memory.
struct SearchRun {
  using Candidates = std::span<const PoseCandidate>;

  explicit SearchRun(const test::Case& searched)
      : scene(searched), problem(test::searchOf(searched)), block(16 << 20) {
    Arena arena(block);
    EXPECT_EQ(buildAdjacency(problem.mesh, arena, adjacency), Status::kOk);
    EXPECT_EQ(renderer.create(problem.mesh, adjacency, PoseSearch::kLongestView_px,
                              PoseSearch::kLongestView_px, RenderOptions(), arena),
              Status::kOk);
    EXPECT_EQ(search.create(ColorView::kChannels, arena), Status::kOk);
  }
  Candidates run() { return run(problem); }
  Candidates run(const SearchProblem& of) {
    int steps = 0;
    if (search.begin(of, renderer))
      while ((!search.step() || search.resume()) && steps < 1000000) ++steps;
    EXPECT_LT(steps, 1000000);
    return search.candidates();
  }
  /// Before the search is resumed.
  Candidates runFirst() { return finish(search.begin(problem, renderer)); }
  Candidates runAtSeed() { return finish(search.beginAtSeed(problem, renderer)); }
  double error_px(const Pose& pose) const {
    return test::meanDisplacement_px(scene.solid, scene.camera, scene.truth, pose);
  }
  void expectTruthFirst(Candidates candidates) const {
    ASSERT_FALSE(candidates.empty());
    EXPECT_LT(error_px(candidates[0].camera_from_station), 2.0);
  }

  const test::Case& scene;
  SearchProblem problem;
  std::vector<std::byte> block;
  MeshAdjacency adjacency;
  EdgeRenderer renderer;
  PoseSearch search;

 private:
  Candidates finish(bool begun) {
    while (begun && !search.step()) {
    }
    return search.candidates();
  }
};

/// Anywhere in the uncertainty by the whole search; the seed alone within 4 mm along and 0.8 deg
/// about each axis: 16 px.
TEST(PoseSearch, SearchesWithinTheirRange_FindTheTruth) {
  for (const bool distorted : {false, true})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(seed);
      test::Case scene = test::stationCase(seed, distorted);
      SearchRun whole(scene);
      const auto candidates = whole.run();
      ASSERT_NO_FATAL_FAILURE(whole.expectTruthFirst(candidates));
      EXPECT_GT(candidates[0].evidence.strongest_nats(), 0.5);
      EXPECT_LE(candidates.size(), static_cast<std::size_t>(PoseSearch::kMaxCandidates));
      scene.seed = test::displacedSeed(scene.truth, scene.uncertainty, 0.2, seed);
      SearchRun near(scene);
      const auto refined = near.runAtSeed();
      ASSERT_EQ(refined.size(), 1u);
      near.expectTruthFirst(refined);
      EXPECT_GT(refined[0].evidence.strongest_nats(), 0.5);
    }
}

TEST(PoseSearch, SuspendedSearch_HasOneCandidateOfThoseOfTheWholeSearch) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    test::Case scene = test::stationCase(seed);
    scene.uncertainty.rotation_rad.z() = kPi;
    SearchRun run(scene);
    Pose pose;
    // Neither a search at the seed nor a whole search leaves anything to resume.
    for (const bool whole : {false, true}) {
      const auto first = run.runFirst();
      ASSERT_EQ(first.size(), 1u);
      EXPECT_TRUE(run.search.isSuspended());
      pose = first[0].camera_from_station;
      EXPECT_LT(run.error_px(pose), 2.0);
      (void)(whole ? run.run() : run.runAtSeed());
      EXPECT_FALSE(run.search.isSuspended());
      EXPECT_FALSE(run.search.resume());
    }
    const auto all = run.search.candidates();
    EXPECT_GT(all.size(), 1u);
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const PoseCandidate& candidate) {
      return candidate.camera_from_station == pose;
    }));
  }
}

TEST(PoseSearch, SeedThatDoesNotSeeTheScene_GivesNoCandidate) {
  test::Case scene = test::stationCase(1);
  scene.seed.translation_m.x() += 10.0;
  EXPECT_TRUE(SearchRun(scene).runAtSeed().empty());
  scene.seed = test::stationCase(1).seed;
  scene.seed.translation_m.z() = -0.5;  // behind the camera
  EXPECT_TRUE(SearchRun(scene).run().empty());
}

TEST(PoseSearch, TruthAtEitherEndOfAWideRangeOfDepths_IsFound) {
  for (const double away_m : {-0.12, 0.12}) {
    test::Case scene = test::stationCase(1);
    scene.uncertainty.translation_m.z() = 0.15;
    scene.seed = scene.truth;
    scene.seed.translation_m.z() += away_m;
    SearchRun run(scene);
    run.expectTruthFirst(run.run());
  }
}

/// Turned by almost half a turn about an axis across the view: rotation vectors near pi.
TEST(PoseSearch, SeedTurnedByAStatedHalfTurn_FindsTheTruth) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double turn_deg : {165.0, 178.0, -172.0}) {
      SCOPED_TRACE(axis);
      test::Case scene = test::stationCase(4);
      Vector6d turned = Vector6d::Zero();
      turned[axis] = turn_deg * kDegree_rad;
      const Eigen::Vector3d middle_m = scene.seed * matchedBounds(scene.problem().mesh).centre();
      scene.seed = displacedAboutPivot(scene.seed, turned, middle_m);
      // A small rotation before a half turn is up to half pi times as much in its rotation vector.
      scene.uncertainty.rotation_rad *= 0.5 * kPi;
      scene.uncertainty.rotation_rad[axis] = kPi;
      SearchRun run(scene);
      run.expectTruthFirst(run.run());
    }
}

TEST(PoseSearch, FlatImage_EndsWithoutEvidence) {
  const test::Picture flat = test::flatPicture(512, 512, 80);
  test::Case scene = test::stationCase(1);
  scene.picture = &flat;
  SearchRun run(scene);
  for (const PoseCandidate& candidate : run.run())
    EXPECT_LT(candidate.evidence.strongest_nats(), 0.0);
}

TEST(PoseEvidenceMeter, RenderOfTheRealCamera_HasTheEvidenceOfTheTruth) {
  const test::Case scene = test::stationCase(1, true);
  const SearchProblem problem = test::searchOf(scene);
  const auto evidenceOf = [&](const Pose& pose) {
    const test::Rendering render = test::renderEdges(scene.solid, scene.camera, pose);
    std::vector<std::byte> block(4 << 20);
    Arena arena(block);
    PoseEvidenceMeter meter;
    EXPECT_EQ(meter.create(ColorView::kChannels, arena), Status::kOk);
    EXPECT_TRUE(meter.begin(problem, render.edges));
    while (!meter.step()) {
    }
    PoseEvidence evidence;
    evidence.contours = meter.contours();
    return evidence;
  };
  const PoseEvidence right = evidenceOf(scene.truth);
  Pose moved = scene.truth;
  moved.translation_m.x() += 0.008;
  const PoseEvidence wrong = evidenceOf(moved);
  for (std::size_t view = 0; view < kEvidenceViews; ++view) {
    SCOPED_TRACE(view);
    EXPECT_GT(right.contours[view].strongest_nats(), 0.6);
    EXPECT_LT(wrong.contours[view].strongest_nats(), 0.2);
  }
  // The same edges are as long as the object is larger in the view.
  const auto spanOf = [&](int view) {
    FacingView facing;
    EXPECT_TRUE(faceScene(problem, scene.truth, evidenceViewSize(view), facing));
    return facing.span_px;
  };
  const auto length_px = [](const ContourEvidence& contours) {
    return contours.places * contours.place_length_px;
  };
  EXPECT_NEAR(length_px(right.contours[1]) / length_px(right.contours[0]), spanOf(1) / spanOf(0),
              0.03);
  EXPECT_GT(right.finest().shareOfExpected(), 0.9);
  EXPECT_LT(wrong.finest().shareOfExpected(), 0.3);
}

/// The station mirrored across the x axis through its middle, faces still turned outwards.
test::Solid mirrored(test::Solid solid) {
  const auto twice_middle_m = static_cast<float>(2.0 * matchedBounds(solid.view()).centre().x());
  for (Eigen::Vector3f& vertex : solid.vertices) vertex.x() = twice_middle_m - vertex.x();
  for (Face& face : solid.faces) std::swap(face.vertex[1], face.vertex[2]);
  return solid;
}

ViewSize sizeOf(double span_px) { return {.span_px = span_px, .margin_px = 10.0, .most_px = 300}; }

/// The image of a view with its memory.
struct ViewImage {
  ViewImage(const SearchProblem& problem, const FacingView& view, int channel = 0)
      : block(1 << 20) {
    Arena arena(block);
    SmallImage all = SmallImage::create(300 * 300, arena, ColorView::kChannels);
    fillViewRows(problem, view, 0, view.camera.height, all);
    image = all.channel(channel);
  }
  std::vector<std::byte> block;
  SmallImage image;
};

/// A flipped view of a mesh shows what the flipped view of a picture shows.
TEST(FacingView, OfAFlippedProblem_IsTheMirrorImageOfTheView) {
  const test::Case scene = test::stationCase(1, true);
  const SearchProblem problem = test::searchOf(scene);
  // A pose whose scene lies across the camera's axis from the seed's.
  SearchProblem flipped = problem;
  flipped.flipped = true;
  Pose across = scene.truth;
  across.rotation = {scene.truth.rotation.w(), scene.truth.rotation.x(), -scene.truth.rotation.y(),
                     -scene.truth.rotation.z()};
  // Its mesh is the station across its own plane x = 0, so that only the middles agree.
  const Eigen::Vector3d middle_m = problem.scene.centre();
  const Eigen::Vector3d seen_m = scene.truth * middle_m;
  across.translation_m =
      Eigen::Vector3d(-seen_m.x(), seen_m.y(), seen_m.z()) - across.matrix() * middle_m;
  const ViewSize size{.span_px = 88.0, .margin_px = 9.0, .least_half = 0.3, .most_px = 200};
  FacingView view;
  FacingView other;
  ASSERT_TRUE(faceScene(problem, scene.truth, size, view));
  ASSERT_TRUE(faceScene(flipped, across, size, other));
  other.camera = view.camera;
  const ViewImage shown(problem, view);
  const ViewImage shown_flipped(flipped, other);
  const SmallImage& image = shown.image;
  const SmallImage& mirror = shown_flipped.image;
  int compared = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto at = static_cast<std::size_t>(y * image.width + x);
      const auto opposite = static_cast<std::size_t>(y * image.width + image.width - 1 - x);
      if (image.seen[at] == 0 || mirror.seen[opposite] == 0) continue;
      ++compared;
      ASSERT_NEAR(image.value[at], mirror.value[opposite], 1) << x << ' ' << y;
    }
  EXPECT_GT(compared, 4000);
}

/// In front of the flipped camera, the station mirrored across the plane of its thickness and its
/// length. A plate that faces the camera may be tilted by 15 deg; one that is turned, by twice the
/// turn more, and at most 60 deg.
TEST(MirrorSearch, Seed_ShowsTheMirroredStation) {
  const test::Case scene = test::stationCase(1);
  const SearchProblem problem = test::searchOf(scene);
  const SurfaceAxes surface = surfaceAxesOf(scene.solid.view());
  const Eigen::Vector3d across = surface.axes.col(1);
  for (const auto& [turn_deg, tilt_deg] : {std::pair{0.0, 15.0}, {10.0, 35.0}, {40.0, 60.0}}) {
    Pose pose;
    pose.rotation =
        rotationExp({turn_deg * kDegree_rad, 0.0, 0.0}) *
        Eigen::Quaterniond::FromTwoVectors(surface.axes.col(0), Eigen::Vector3d::UnitZ());
    pose.translation_m = Eigen::Vector3d(0.0, 0.0, 0.5) - pose.matrix() * surface.middle_m;
    const SearchProblem mirror = mirrorSearch(problem, pose);
    EXPECT_TRUE(mirror.flipped);
    for (const Eigen::Vector3f& vertex : scene.solid.vertices) {
      const Eigen::Vector3d point_m = vertex.cast<double>();
      const Eigen::Vector3d mirrored_m =
          point_m - 2.0 * across.dot(point_m - surface.middle_m) * across;
      const Eigen::Vector3d seen_m = pose * mirrored_m;
      EXPECT_LT((mirror.camera_from_station_seed * point_m -
                 Eigen::Vector3d(-seen_m.x(), seen_m.y(), seen_m.z()))
                    .norm(),
                1e-12);
    }
    const Eigen::Vector3d middle_m = mirror.camera_from_station_seed * problem.scene.centre();
    EXPECT_EQ(mirror.uncertainty.pivot_in_camera_m, middle_m);
    EXPECT_NEAR(mirror.uncertainty.translation_m.z(), 0.1 * middle_m.z(), 1e-12);
    EXPECT_NEAR(mirror.uncertainty.rotation_rad.x(), tilt_deg * kDegree_rad, 1e-9);
    EXPECT_EQ(mirror.uncertainty.rotation_rad.z(), kPi);
  }
}

TEST(MirrorSearch, MirroredMesh_HasAMirrorImageThatExplainsFarMore) {
  for (const std::uint64_t seed : {1U, 2U}) {
    test::Case scene = test::stationCase(seed);
    SearchRun right(scene);
    const double right_nats = right.run()[0].evidence.total_nats();
    scene.solid = mirrored(scene.solid);
    SearchRun wrong(scene);
    // Where the wrong mesh covers about the same pixels.
    const auto mirror = wrong.run(mirrorSearch(wrong.problem, scene.truth));
    ASSERT_FALSE(mirror.empty());
    EXPECT_GT(mirror[0].evidence.total_nats(), 0.9 * right_nats);
  }
}

TEST(MirrorSearch, RightMesh_HasNoBetterMirrorImage) {
  const test::Case scene = test::stationCase(3);
  SearchRun run(scene);
  const PoseCandidate found = run.run()[0];
  for (const PoseCandidate& mirror : run.run(mirrorSearch(run.problem, found.camera_from_station)))
    EXPECT_LT(mirror.evidence.total_nats(), 0.8 * found.evidence.total_nats());
}

TEST(WiderSearch, TruthBeyondTheUncertainty_HasFarMoreEvidenceThanPosesWithin) {
  for (const std::uint64_t seed : {1U, 2U, 5U}) {
    test::Case scene = test::stationCase(seed);
    scene.seed = scene.truth;
    scene.uncertainty.translation_m *= 2.0;
    scene.seed.translation_m.head<2>() += 1.8 * scene.uncertainty.translation_m.head<2>();
    SearchRun run(scene);
    double within_nats = 0.0;
    for (const PoseCandidate& candidate : run.run())
      within_nats = std::max(within_nats, candidate.evidence.total_nats());
    const auto wider = run.run(widerSearch(run.problem));
    ASSERT_NO_FATAL_FAILURE(run.expectTruthFirst(wider));
    EXPECT_GT(wider[0].evidence.total_nats(), 2.0 * within_nats);
  }
}

TEST(WiderSearch, DoublesTheRangeUpToAllRotations) {
  const test::Case scene = test::stationCase(1);
  SearchProblem problem = test::searchOf(scene);
  problem.uncertainty.rotation_rad = {0.5, 2.0, kPi};
  const SearchProblem wider = widerSearch(problem);
  EXPECT_EQ(wider.uncertainty.rotation_rad, Eigen::Vector3d(1.0, kPi, kPi));
  EXPECT_EQ(wider.uncertainty.translation_m, 2.0 * problem.uncertainty.translation_m);
}

SearchCandidate at(double x_px, double distance_px) {
  SearchCandidate candidate;
  candidate.slide_x_px = x_px;
  candidate.distance_px = distance_px;
  return candidate;
}

/// For an object of 80 px, 3 px apart: slides, turns, tilts by half of them, and depths.
TEST(CandidateList, CandidatesWithinTheDistance_AreNear) {
  const auto turned = [](double x_rad, double z_rad) {
    SearchCandidate candidate = at(0.0, 2.0);
    candidate.camera_from_station.rotation = rotationExp({x_rad, 0.0, z_rad});
    return candidate;
  };
  const auto deeper = [](double ratio) {
    SearchCandidate candidate = at(0.0, 2.0);
    candidate.depth_ratio = ratio;
    return candidate;
  };
  const auto kept = [](const SearchCandidate& first, const SearchCandidate& second) {
    CandidateList list(40.0, 3.0, Eigen::Vector3d::UnitZ());
    list.insert(first);
    list.insert(second);
    return list.candidates().size();
  };
  const SearchCandidate middle = at(0.0, 1.0);
  for (const auto& [near, apart] :
       {std::pair{at(2.9, 2.0), at(3.1, 2.0)}, std::pair{turned(0.0, 0.073), turned(0.0, 0.077)},
        std::pair{turned(0.147, 0.0), turned(0.153, 0.0)},
        std::pair{deeper(1.074), deeper(1.082)}}) {
    EXPECT_EQ(kept(near, middle), 1u);
    EXPECT_EQ(kept(middle, apart), 2u);
  }
  EXPECT_EQ(kept(turned(0.0, kPi), turned(0.0, -kPi)), 1u) << "a full turn";
}

TEST(CandidateList, RandomCandidates_AreKeptInOrderAndApart) {
  Random random(7);
  CandidateList list(40.0, 3.0, Eigen::Vector3d::UnitZ());
  double least = 1e9;
  for (int i = 0; i < 500; ++i) {
    const SearchCandidate candidate = at(random.uniform(-200.0, 200.0), random.uniform(0.0, 5.0));
    least = std::min(least, candidate.distance_px);
    const bool accepted = list.accepts(candidate.distance_px);
    list.insert(candidate);
    const auto kept = list.candidates();
    if (!accepted) {
      EXPECT_TRUE(std::none_of(kept.begin(), kept.end(), [&](const auto& other) {
        return other.slide_x_px == candidate.slide_x_px;
      }));
    }
    for (std::size_t a = 0; a + 1 < kept.size(); ++a)
      EXPECT_LE(kept[a].distance_px, kept[a + 1].distance_px);
    for (std::size_t a = 0; a < kept.size(); ++a)
      for (std::size_t b = a + 1; b < kept.size(); ++b)
        EXPECT_GE(std::abs(kept[a].slide_x_px - kept[b].slide_x_px), 3.0);
  }
  EXPECT_EQ(list.candidates()[0].distance_px, least);
  EXPECT_EQ(list.candidates().size(), static_cast<std::size_t>(CandidateList::kCapacity));
}

TEST(FacingView, TurnedTowardsAPoint_SeesItOnItsAxis) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d point(random.normal(), random.normal(), 0.2 + random.uniform());
    const Eigen::Vector3d on_axis(0.0, 0.0, point.norm());
    EXPECT_LT((viewTowards(point) * point - on_axis).norm(), 1e-12);
  }
}

TEST(FacingView, Scene_IsCentredAtTheRequestedSpan) {
  for (const bool distorted : {false, true}) {
    const test::Case scene = test::stationCase(1, distorted);
    const SearchProblem problem = test::searchOf(scene);
    FacingView view;
    ASSERT_TRUE(faceScene(problem, scene.truth, sizeOf(100.0), view));
    EXPECT_NEAR(view.span_px, 100.0, 1e-9);
    const auto pixelIn = [&](const Eigen::Vector3d& point_m) {
      return test::pixelOf(view.camera, view.view_from_camera * (scene.truth * point_m));
    };
    Eigen::Vector2d least = Eigen::Vector2d::Constant(1e9), most = -least;
    for (const Eigen::Vector3f& vertex : scene.solid.vertices) {
      const Eigen::Vector2d pixel = pixelIn(vertex.cast<double>());
      least = least.cwiseMin(pixel);
      most = most.cwiseMax(pixel);
    }
    EXPECT_NEAR((most - least).maxCoeff(), 100.0, 3.0);
    EXPECT_GE(least.minCoeff(), 5.0);
    const Eigen::Vector2d middle_px(view.camera.cx, view.camera.cy);
    const Eigen::Vector2d half_px = (most - middle_px).cwiseMax(middle_px - least);
    EXPECT_NEAR(0.5 * view.camera.width, half_px.x() + 10.0, 2.5);
    EXPECT_NEAR(0.5 * view.camera.height, half_px.y() + 10.0, 2.5);
    EXPECT_LT((pixelIn(problem.scene.centre()) - middle_px).norm(), 1e-6);
  }
}

TEST(FacingView, SmallScene_IsMagnifiedTo130PixelsOrTwice) {
  const test::Case scene = test::stationCase(1);
  const SearchProblem problem = test::searchOf(scene);
  for (const double distance : {1.5, 2.5, 3.5, 5.0, 8.0}) {
    Pose far = scene.truth;
    far.translation_m *= distance;
    FacingView view;
    ASSERT_TRUE(faceScene(problem, far, sizeOf(250.0), view));
    const double real_span_px = view.span_px / view.pixels_per_px;
    EXPECT_NEAR(view.span_px,
                std::min(250.0, std::max(real_span_px, std::min(130.0, 2.0 * real_span_px))), 1e-6)
        << distance;
  }
}

TEST(FacingView, SceneBehindTheCameraOrOutsideTheImage_HasNoView) {
  const test::Case scene = test::stationCase(1);
  FacingView view;
  Pose behind = scene.truth;
  behind.translation_m.z() = -0.5;
  EXPECT_FALSE(faceScene(test::searchOf(scene), behind, sizeOf(100.0), view));
  Pose aside = scene.truth;
  aside.translation_m.x() += 3.0;
  EXPECT_FALSE(faceScene(test::searchOf(scene), aside, sizeOf(100.0), view));
}

/// The second channel is the gray image, the others are something else. Blocks of a few to many
/// pixels, in the middle and at the right border of the image.
TEST(FacingView, ChannelOfAColorImage_IsShownAsThatChannelAlone) {
  const test::Case scene = test::stationCase(1, true);
  SearchProblem problem = test::searchOf(scene);
  const SearchProblem gray = problem;
  const auto width = static_cast<std::size_t>(problem.image.width);
  std::vector<std::uint8_t> color(3 * width * static_cast<std::size_t>(problem.image.height));
  for (std::size_t i = 0; i < color.size() / 3; ++i) {
    color[3 * i] = static_cast<std::uint8_t>(i % 251);
    color[3 * i + 1] = problem.image.at(static_cast<int>(i % width), static_cast<int>(i / width));
  }
  problem.color = {color.data(), problem.image.width, problem.image.height,
                   3 * problem.image.width};
  EXPECT_EQ(channelsOf(problem), 3);
  for (const double span_px : {90.0, 30.0, 14.0, 8.0})
    for (const double aside_m : {0.0, 0.09}) {
      Pose pose = scene.truth;
      pose.translation_m.x() += aside_m;
      FacingView view;
      ASSERT_TRUE(faceScene(problem, pose, sizeOf(span_px), view));
      const auto pixels = static_cast<std::ptrdiff_t>(view.camera.width * view.camera.height);
      const auto valuesOf = [&](const SearchProblem& shown, int channel) {
        const ViewImage image(shown, view, channel);
        return std::vector<std::uint8_t>(image.image.value.begin(),
                                         image.image.value.begin() + pixels);
      };
      EXPECT_EQ(valuesOf(problem, 1), valuesOf(gray, 0)) << span_px;
      EXPECT_NE(valuesOf(problem, 0), valuesOf(gray, 0));
    }
}

TEST(FacingView, IgnoredPixels_AreNotKnown) {
  test::Case scene = test::stationCase(1);
  test::Mask mask(512, 512);
  mask.fill(0, 0, 512, 512);
  scene.ignore = &mask.bits;
  const SearchProblem problem = test::searchOf(scene);
  FacingView view;
  ASSERT_TRUE(faceScene(problem, scene.truth, sizeOf(90.0), view));
  const ViewImage shown(problem, view);
  const auto pixels = static_cast<std::size_t>(shown.image.width * shown.image.height);
  EXPECT_THAT(shown.image.seen.first(pixels), testing::Each(0));
}

}  // namespace
}  // namespace boresight
