// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/thumbnail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/sessions/checks/drawn_box.h"

namespace boresight::test {
namespace {

using namespace sessions;

/// Bounding box of some of a picture's pixels.
struct Extent {
  Eigen::AlignedBox2d box;
  double width() const { return box.sizes().x() + 1.0; }
  double height() const { return box.sizes().y() + 1.0; }
};

template <class Shown>
Extent extentOf(const ColorImage& picture, const Shown& shown) {
  Extent extent;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const auto at = static_cast<std::size_t>(3 * (picture.width * y + x));
      if (shown(ColorBgr{picture.bgr[at], picture.bgr[at + 1], picture.bgr[at + 2]}))
        extent.box.extend(Eigen::Vector2d(x, y));
    }
  return extent;
}

/// Pictures of a box drawn by OpenCV, 800 x 600 px: brighter than its background.
class StationPicture : public testing::Test {
 protected:
  ColorImage picture(const std::vector<Pose>& framed, const std::vector<Pose>& layers, int width_px,
                     int height_px) const {
    std::vector<OverlayLayer> overlays;
    for (const Pose& pose : layers) overlays.push_back({"", pose, kResultColor, true});
    const auto loaded = box_.subject(box_.camera_from_station_).loaded;
    return stationPicture(loaded->image.view(), box_.camera_, box_.scene_.view(), framed, overlays,
                          width_px, height_px);
  }
  static Extent edges(const ColorImage& picture) {
    return extentOf(picture, [](const ColorBgr& color) { return color == kResultColor; });
  }
  static Extent bright(const ColorImage& picture) {
    return extentOf(picture, [](const ColorBgr& color) { return color[0] > 65; });
  }
  Pose moved(double x_m, double y_m, double times_as_far = 1.0) const {
    Pose pose = pose_;
    pose.translation_m *= times_as_far;
    pose.translation_m += Eigen::Vector3d(x_m, y_m, 0.0);
    return pose;
  }
  Pose behind() const {
    Pose pose = pose_;
    pose.translation_m.z() = -0.5;
    return pose;
  }

  const DrawnBox box_;
  const Pose pose_ = box_.camera_from_station_;
};

TEST_F(StationPicture, Edges_LieOnThoseOfTheImageAtEveryScale) {
  for (const int width_px : {80, 160, 400, 1600}) {
    const int height_px = width_px * 3 / 4;
    const Extent shown = bright(picture({pose_}, {}, width_px, height_px));
    const Extent drawn = edges(picture({pose_}, {pose_}, width_px, height_px));
    const double limit_px = width_px > 800 ? 2.0 : 0.75;  // an edge of the image is 6 px wide there
    EXPECT_LT((shown.box.center() - drawn.box.center()).cwiseAbs().maxCoeff(), limit_px)
        << width_px;
    EXPECT_NEAR(shown.width(), drawn.width(), 3.0);
    EXPECT_NEAR(shown.height(), drawn.height(), 3.0);
  }
}

/// A margin of 15 % about the station in the direction that fills the picture.
TEST_F(StationPicture, Station_FillsThePictureButForAMargin) {
  for (const auto& [width_px, height_px] : {std::pair(400, 300), {400, 200}, {300, 300}}) {
    const ColorImage whole = picture({pose_}, {}, width_px, height_px);
    EXPECT_NEAR(whole.width, width_px, 2);
    EXPECT_NEAR(whole.height, height_px, 2);
    const Extent shown = bright(whole);
    const double share = std::max(shown.width() / whole.width, shown.height() / whole.height);
    EXPECT_NEAR(share, 1.0 / 1.15, 0.02) << width_px << " x " << height_px;
    EXPECT_NEAR(shown.box.center().x() / whole.width, 0.5, 0.03);
    EXPECT_NEAR(shown.box.center().y() / whole.height, 0.5, 0.03);
  }
}

TEST_F(StationPicture, SeveralPoses_AreAllInThePicture) {
  const std::vector<Pose> poses = {pose_, moved(0.06, 0.02), behind(), moved(-0.05, -0.03)};
  const ColorImage whole = picture(poses, poses, 400, 300);
  const Extent shown = edges(whole);
  EXPECT_GT(shown.box.min().x(), 2);
  EXPECT_GT(shown.box.min().y(), 2);
  EXPECT_LT(shown.box.max().x(), whole.width - 3);
  EXPECT_LT(shown.box.max().y(), whole.height - 3);
  EXPECT_GT(std::max(shown.width() / whole.width, shown.height() / whole.height), 0.8);
}

TEST_F(StationPicture, StationAtTheBorder_IsShownInAPictureOfFullSize) {
  for (const auto& [x_m, y_m] : {std::pair(-0.12, 0.0), {0.12, 0.0}, {0.0, -0.09}, {0.0, 0.09}}) {
    const Pose pose = moved(x_m, y_m);
    const ColorImage whole = picture({pose}, {pose}, 400, 300);
    EXPECT_NEAR(whole.width, 400, 2) << x_m << " " << y_m;
    EXPECT_NEAR(whole.height, 300, 2);
    EXPECT_GT(std::max(edges(whole).width(), edges(whole).height()), 200.0);
  }
}

/// An eighth of the image's width is shown at least.
TEST_F(StationPicture, DistantStation_IsEnlargedToALimit) {
  const double box_px = bright(picture({behind()}, {}, 800, 600)).width();
  for (const double times : {10.0, 20.0, 40.0}) {
    const Pose far = moved(0.0, 0.0, times);
    const ColorImage whole = picture({far}, {far}, 800, 600);
    EXPECT_EQ(whole.width, 800);
    EXPECT_NEAR(edges(whole).width(), 8.0 * box_px / times, 0.25 * 8.0 * box_px / times + 4.0);
  }
}

TEST_F(StationPicture, StationThatIsNotVisible_LeavesTheWholeImage) {
  const Extent in_image = bright(picture({pose_, behind()}, {}, 800, 600));
  ASSERT_GT(in_image.width(), 500.0) << "enlarged";
  for (const std::vector<Pose>& framed :
       {std::vector<Pose>{behind()}, std::vector<Pose>{moved(5.0, 0.0)}, std::vector<Pose>()}) {
    const ColorImage whole = picture(framed, {behind()}, 400, 300);
    EXPECT_EQ(whole.width, 400);
    EXPECT_EQ(whole.height, 300);
    const Extent shown = bright(whole);
    for (int i = 0; i < 8; ++i) {
      const auto& quad = boxCorner({0.06, 0.04, 0.025}, i);
      const Eigen::Vector2d pixel = (box_.pixelOf(quad) + Eigen::Vector2d(0.5, 0.5)) / 2.0;
      EXPECT_TRUE(pixel.x() > shown.box.min().x() - 2.0 && pixel.x() < shown.box.max().x() + 2.0);
      EXPECT_TRUE(pixel.y() > shown.box.min().y() - 2.0 && pixel.y() < shown.box.max().y() + 2.0);
    }
    EXPECT_LT(shown.width(), 200.0);
  }
}

TEST_F(StationPicture, OtherShape_KeepsTheImagesOwn) {
  const ColorImage wide = picture({behind()}, {}, 800, 60);
  EXPECT_EQ(wide.height, 60);
  EXPECT_EQ(wide.width, 80);
  const ColorImage high = picture({behind()}, {}, 8, 600);
  EXPECT_EQ(high.width, 8);
  EXPECT_EQ(high.height, 6);
}

/// A camera that cannot be prepared still has its image.
TEST_F(StationPicture, UnusableCamera_LeavesTheImageWithoutEdges) {
  Camera broken = box_.camera_;
  broken.fx = 0.0;
  const OverlayLayer layer{"", pose_, kResultColor, true};
  const auto loaded = box_.subject(pose_).loaded;
  const ColorImage whole = stationPicture(loaded->image.view(), broken, box_.scene_.view(),
                                          {&pose_, 1}, {&layer, 1}, 400, 300);
  EXPECT_TRUE(edges(whole).box.isEmpty());
  EXPECT_FALSE(bright(whole).box.isEmpty());
}

}  // namespace
}  // namespace boresight::test
