// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_sequence.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "core/base/math.h"
#include "sessions/io/files/errors.h"
#include "sessions/run/problem.h"
#include "sessions/session/session_maker.h"
#include "tests/support/approach_files.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

class CaseSequenceTest : public testing::Test {
 protected:
  SequenceOrder order() const {
    SequenceOrder order;
    order.images = test::approachFolder() / "frames";
    order.session_case = makeCase(test::approachFiles()).made;
    order.options = defaultProfile();
    order.settings.threads = 1;
    order.results = folder_ / "r.sqlite";
    return order;
  }
  static CaseSequence open(const SequenceOrder& order, const GrayImage* image = nullptr) {
    return CaseSequence(order, sequenceInputs(order, {}, image), openImages(order.images));
  }
  const test::TemporaryFolder folder_;
};

TEST_F(CaseSequenceTest, StoppedSequence_KeepsItsFramesAndGoesOn) {
  {
    CaseSequence sequence = open(order());
    EXPECT_EQ(sequence.total(), test::kApproachFrames);
    ASSERT_TRUE(sequence.next());
    ASSERT_TRUE(sequence.next());
    std::stop_source stop;
    stop.request_stop();
    EXPECT_FALSE(sequence.next(stop.get_token()));
    EXPECT_GT(sequence.framesPerSecond(), 0.0);
  }
  EXPECT_EQ(readResults(folder_ / "r.sqlite").runs.size(), 2u);
  CaseSequence rest = open(order());
  EXPECT_EQ(rest.earlier(), 2u);
  std::vector<RunResult> results;
  while (auto result = rest.next()) results.push_back(std::move(*result));
  ASSERT_EQ(results.size(), 6u) << "those of the file come first";
  EXPECT_EQ(rest.localized(), 4);
  EXPECT_TRUE(rest.sequence().lost().empty());
  EXPECT_FALSE(rest.next()) << "after the end";
}

/// The window's case has an image of its own, that of the command line has none.
TEST_F(CaseSequenceTest, OwnImageOfTheCase_MakesNoOtherSequence) {
  (void)open(order()).next();
  SequenceOrder without_image = order();
  without_image.session_case.image = {};
  EXPECT_EQ(open(without_image).earlier(), 1u);
  SequenceOrder other_motion = order();
  other_motion.motion.translation_m.setConstant(0.002);
  EXPECT_THROW((void)open(other_motion), OutputError);
  SequenceOrder other_rule = order();
  other_rule.session_case.image.eight_bit.levels = GrayLevels{60, 120};
  EXPECT_THROW((void)open(other_rule), OutputError);
  SequenceOrder other_end_effector = order();
  other_end_effector.session_case.camera_from_end_effector = Pose();
  EXPECT_THROW((void)open(other_end_effector), OutputError);
}

class ChangedSequence : public CaseSequenceTest {
 protected:
  ChangedSequence() {
    for (int i = 0; i < 3; ++i) put(i, std::to_string(2 * i) + ".png");
    order_ = order();
    order_.images = frames_;
    EXPECT_EQ(refusal(), "(nothing)");
  }
  /// Frame `i` of the approach by another name.
  void put(int i, const std::string& name) const {
    std::filesystem::create_directories(frames_);
    std::filesystem::copy_file(test::approachFolder() / ("frames/" + std::to_string(i) + ".png"),
                               frames_ / name, std::filesystem::copy_options::overwrite_existing);
  }
  std::string refusal() const {
    return folder_.message([this] {
      CaseSequence sequence = open(order_);
      while (sequence.next()) {
      }
    });
  }
  const std::filesystem::path frames_ = folder_ / "frames";
  SequenceOrder order_;
};

TEST_F(ChangedSequence, FrameWithOtherPixels_IsRefused) {
  put(5, "2.png");
  EXPECT_THAT(refusal(), HasSubstr("frame 2.png has other pixels than when it was localized"));
}

TEST_F(ChangedSequence, FrameBetweenThoseThatAreDone_IsRefused) {
  put(5, "1.png");
  EXPECT_THAT(refusal(), HasSubstr("frame 1.png was added between frames that are done"));
  std::filesystem::remove(frames_ / "0.png");
  std::filesystem::remove(frames_ / "1.png");
  EXPECT_THAT(refusal(), HasSubstr("frame 2.png was number 2 and is number 1 now"));
}

TEST_F(ChangedSequence, FrameAtTheEnd_IsLocalized) {
  put(3, "6.png");
  EXPECT_EQ(refusal(), "(nothing)");
  EXPECT_EQ(readResults(folder_ / "r.sqlite").runs.size(), 4u);
  EXPECT_EQ(readResultsFacts(folder_ / "r.sqlite").dataset.cases, 4);
}

TEST_F(CaseSequenceTest, StrokesOfTheMask_HideTheStationInEveryFrame) {
  SequenceOrder masked = order();
  MaskStroke stroke;
  stroke.kind = StrokeKind::kPolygon;
  stroke.points = {{-1.0, -1.0}, {512.0, -1.0}, {512.0, 512.0}, {-1.0, 512.0}};
  masked.session_case.ignore_strokes.push_back(stroke);
  const GrayImage image = readImage(masked.images / "0.png");
  EXPECT_FALSE(open(masked, &image).next()->completed);
}

TEST_F(CaseSequenceTest, MaskThatChangedSinceTheSession_IsRefused) {
  SequenceOrder masked = order();
  masked.session_case.ignore = {folder_ / "mask.png", "the hash of another file"};
  const cv::Size size(masked.session_case.camera.width, masked.session_case.camera.height);
  cv::imwrite(masked.session_case.ignore->file.string(), cv::Mat1b::zeros(size));
  EXPECT_THAT(folder_.message([&] { (void)sequenceInputs(masked, {}); }),
              HasSubstr("mask.png: its bytes differ from those of the session"));
}

TEST_F(CaseSequenceTest, SeedThatSeesNothing_IsRefusedByItsName) {
  SequenceOrder away = order();
  away.session_case.camera_from_station_seed.translation_m.x() += 5.0;
  const auto read = [&away] { (void)sequenceInputs(away, {{}, {}, {}, {"case a", "seed"}}); };
  EXPECT_THAT(folder_.message(read),
              HasSubstr("case a: seed: the station is entirely out of view"));
}

/// Against the exact poses of the pictures.
TEST_F(CaseSequenceTest, SequenceRow_HasTheMotionSinceTheLastAcceptedFrame) {
  const test::GeneratedApproach approach(24);
  CaseSequence sequence = open(order());
  const Eigen::Vector3d centre_m(0.01, 0.02, 0.03);
  (void)sequence.next();
  const SequenceRow row = sequenceRow(*sequence.next(), centre_m);
  const Pose from = approach.camera_from_station(0);
  const Pose to = approach.camera_from_station(1);
  EXPECT_EQ(row.number, 2);
  EXPECT_EQ(row.name, "1.png");
  EXPECT_TRUE(row.accepted);
  EXPECT_NEAR(*row.moved_mm, 1e3 * (to * centre_m - from * centre_m).norm(), 0.4);
  EXPECT_NEAR(*row.turned_deg, from.rotation.angularDistance(to.rotation) / kDegree_rad, 0.1);
  EXPECT_GT(row.seconds, 0.0);
}

TEST_F(CaseSequenceTest, SequenceRow_OfALostFrameHasItsReasonAndNoMotion) {
  RunResult lost;
  lost.status = "input_error";
  lost.message = "a.png: is truncated";
  lost.dataset_index = 6;
  const SequenceRow row = sequenceRow(lost, Eigen::Vector3d::Zero());
  EXPECT_EQ(row.number, 7);
  EXPECT_FALSE(row.accepted || row.moved_mm || row.turned_deg);
  EXPECT_EQ(row.reason, "a.png: is truncated");
}

}  // namespace
}  // namespace boresight::sessions
