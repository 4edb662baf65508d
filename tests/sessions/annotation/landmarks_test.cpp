// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/landmarks.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "sessions/io/files/errors.h"
#include "tests/sessions/annotation/box_scene.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

TEST(Landmarks, ReadBackAsTheSameBits) {
  const test::TemporaryFolder folder;
  Random random = test::randomFor("Landmarks.RoundTrip");
  std::vector<Landmark> landmarks;
  for (int i = 0; i < 50; ++i)
    landmarks.push_back({"screw \"" + std::to_string(i) + "\" \xC3\xBC",
                         test::randomVector(random, 1.0), i % 2 == 0 ? "left\nof it" : ""});
  writeLandmarks(folder / "landmarks.json", landmarks);
  EXPECT_EQ(readLandmarks(folder / "landmarks.json"), landmarks);
  writeLandmarks(folder / "landmarks.json", {});
  EXPECT_TRUE(readLandmarks(folder / "landmarks.json").empty());
}

TEST(Landmarks, SaysWhatIsWrongAndWhere) {
  const test::TemporaryFolder folder;
  const std::string good = R"({"name": "a", "point_in_station_m": [0, 0, 1]})";
  for (const auto& [landmarks, error] :
       {std::pair<std::string, std::string>("[" + good + "]", "(nothing)"),
        {"[" + good + "," + good + "]", "[1].name: 'a' is given twice"},
        {"3", "l.json: landmarks: "},
        {R"([{"name": ""}])", "landmarks[0].name: is empty"},
        {R"([{"name": "a"}])", "point_in_station_m: missing"},
        {R"([{"name": "a", "point_in_station_m": [0, 0, 1e9]}])", "point_in_station_m[2]"},
        {R"([{"names": "a"}])", "landmarks[0].name: missing"}}) {
    const auto file =
        folder.write("l.json", R"({"format": "boresight-landmarks", "version": 1, "landmarks": )" +
                                   landmarks + "}");
    EXPECT_THAT(folder.message([&] { (void)readLandmarks(file); }), HasSubstr(error));
  }
}

TEST(Landmarks, TakeTheStationsSideOfPairs) {
  Annotations annotations;
  annotations.points.push_back({"a", Eigen::Vector3d(1, 2, 3), {}, 1.0, false, false, "new"});
  annotations.points.push_back({"b", {}, Eigen::Vector2d(5, 6), 1.0, true, false, ""});
  annotations.points.push_back(
      {"c", Eigen::Vector3d(4, 5, 6), Eigen::Vector2d(7, 8), 1.0, true, false, ""});
  const std::vector<Landmark> before = {{"z", {0, 0, 0}, "kept"}, {"a", {9, 9, 9}, "old"}};
  const std::vector<Landmark> expected = {
      {"z", {0, 0, 0}, "kept"}, {"a", {1, 2, 3}, "new"}, {"c", {4, 5, 6}, ""}};
  EXPECT_EQ(withAnnotations(before, annotations), expected);
  EXPECT_EQ(leftOutOfLandmarks(annotations), "");
  annotations.lines.resize(2);
  EXPECT_EQ(leftOutOfLandmarks(annotations), "2 lines are left out: landmarks are points.");
}

class Proposals : public testing::Test, protected test::BoxScene {
 protected:
  std::vector<Landmark> landmarks_ = {
      {"under", {0.0, 0.0, -0.04}, ""},  {"corner", {-0.1, 0.1, 0.0}, "its comment"},
      {"above", {0.03, 0.02, 0.02}, ""}, {"away", {5.0, 0.0, 0.0}, ""},
      {"behind", {0.0, 0.0, 3.0}, ""},   {"marked", {0.1, 0.1, 0.0}, ""}};
};

TEST_F(Proposals, LieWhereTheCameraSeesThem) {
  Annotations annotations;
  annotations.points.push_back({"marked", {}, {}, 1.0, true, false, ""});
  const auto proposals = proposeAnnotations(landmarks_, annotations, scene_.view(), camera_,
                                            camera_from_station_, nullptr);
  ASSERT_EQ(proposals.size(), 3u);
  const std::vector<std::string> names = {"above", "corner", "under"};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(proposals[i].landmark.name, names[i]);
    EXPECT_EQ(proposals[i].pixel, pixelOf(proposals[i].landmark.point_in_station_m));
    EXPECT_EQ(proposals[i].sigma_px, 0.0);
    EXPECT_EQ(proposals[i].seen, names[i] != "under");
  }
  EXPECT_EQ(proposals[1].landmark.comment, "its comment");
}

TEST_F(Proposals, SigmaIsThatOfDrawnPoses) {
  Random random = test::randomFor("Proposals.Sigma");
  Vector6d sigma;
  sigma << 0.002, 0.001, 0.003, 5e-4, 2e-4, 1e-3;
  const Matrix6d covariance = sigma.cwiseAbs2().asDiagonal();
  const auto proposals =
      proposeAnnotations(landmarks_, {}, scene_.view(), camera_, camera_from_station_, &covariance);
  ASSERT_FALSE(proposals.empty());
  for (const Proposal& proposal : proposals) {
    constexpr int kDraws = 20000;
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (int i = 0; i < kDraws; ++i) {
      const Vector6d xi = sigma.cwiseProduct(test::normalVector6(random));
      Eigen::Vector2d pixel;
      ASSERT_TRUE(project(
          camera_, perturbed(xi, camera_from_station_) * proposal.landmark.point_in_station_m,
          pixel));
      spread += (pixel - proposal.pixel) * (pixel - proposal.pixel).transpose() / kDraws;
    }
    const double trace = spread.trace();
    const double largest = 0.5 * (trace + std::sqrt(trace * trace - 4.0 * spread.determinant()));
    // The deviation of a deviation over 20000 draws is 0.5 %.
    EXPECT_NEAR(proposal.sigma_px / std::sqrt(largest), 1.0, 0.02) << proposal.landmark.name;
  }
}

constexpr int kSide = 100;

/// A picture of what is bright.
std::vector<std::uint8_t> picture(const std::function<bool(int, int)>& bright) {
  std::vector<std::uint8_t> pixels(kSide * kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      pixels[static_cast<std::size_t>(y * kSide + x)] = bright(x, y) ? 200 : 40;
  return pixels;
}

std::optional<Eigen::Vector2d> featureIn(const std::vector<std::uint8_t>& pixels,
                                         const Eigen::Vector2d& predicted, double sigma_px) {
  Proposal proposal;
  proposal.pixel = predicted;
  proposal.sigma_px = sigma_px;
  return featureOf(proposal, {pixels.data(), kSide, kSide, kSide});
}

TEST(ProposalFeature, IsTheCornerOrEllipseNearThePrediction) {
  const auto corner = picture([](int x, int y) { return x >= 50 && y >= 40; });
  const auto disc =
      picture([](int x, int y) { return (x - 50) * (x - 50) + (y - 48) * (y - 48) < 64; });
  const auto at_corner = featureIn(corner, {51.0, 41.0}, 1.0);
  const auto at_centre = featureIn(disc, {51.0, 47.5}, 1.5);
  ASSERT_TRUE(at_corner && at_centre);
  EXPECT_LT((*at_corner - Eigen::Vector2d(49.5, 39.5)).norm(), 0.3);
  EXPECT_LT((*at_centre - Eigen::Vector2d(50.0, 48.0)).norm(), 0.3);
  EXPECT_FALSE(featureIn(corner, {70.0, 70.0}, 1.0)) << "too far from any corner";
  EXPECT_FALSE(featureIn(corner, {60.0, 50.0}, 100.0)) << "the search has an end";
  EXPECT_FALSE(featureIn(picture([](int, int) { return true; }), {50.0, 50.0}, 2.0));
  EXPECT_FALSE(featureIn(picture([](int x, int) { return x >= 50; }), {50.0, 50.0}, 2.0))
      << "along an edge it may be anywhere";
}

}  // namespace
}  // namespace boresight::sessions
