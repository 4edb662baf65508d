// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/sequence.h"

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "sessions/run/problem.h"
#include "tests/support/generated_approach.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

constexpr int kFrames = 24;

/// Requirement of the stations: 0.4 mm and 0.25 deg.
void expectTruth(const GeneratedApproach& approach, int frame, const Pose& estimate) {
  SCOPED_TRACE(frame);
  const PoseError error =
      poseError(approach.solid(), approach.camera_from_station(frame), estimate);
  EXPECT_LT(error.centre_m, 0.0004);
  EXPECT_LT(error.angle_rad, 0.25 * kDegree_rad);
}

sessions::SequenceInputs inputsOf(const GeneratedApproach& approach) {
  sessions::SequenceInputs inputs;
  inputs.station = "station";
  inputs.camera = approach.camera();
  inputs.scene.vertices_in_station_m = approach.solid().vertices;
  inputs.scene.faces = approach.solid().faces;
  inputs.scene.part_of_face = approach.solid().part_of_face;
  inputs.scene.parts = approach.solid().parts;
  inputs.uncertainty.translation_m.setConstant(0.02);
  inputs.uncertainty.rotation_deg.setConstant(4.0);
  inputs.uncertainty.pivot = sessions::UncertaintyPivot::kStation;
  inputs.camera_from_station_seed = approach.camera_from_station(0);
  inputs.camera_from_station_seed.translation_m += Eigen::Vector3d(0.012, -0.009, 0.01);
  inputs.options = defaultProfile();
  inputs.settings.level = sessions::RecordLevel::kSummary;
  inputs.settings.threads = 1;
  return inputs;
}

sessions::Frame frameOf(const GeneratedApproach& approach, int frame) {
  return {"frame " + std::to_string(frame), approach.image(frame), ""};
}

class Sequence : public testing::Test {
 protected:
  sessions::RunResult run(int frame, const std::stop_token& stop = {}) {
    return sequence_.run(frameOf(approach_, frame), stop);
  }

  const GeneratedApproach approach_{kFrames};
  const sessions::SequenceInputs inputs_ = inputsOf(approach_);
  sessions::Sequence sequence_{inputs_};
};

/// A frame is covered, the next one is missing; the third is found by a wider box.
TEST_F(Sequence, Approach_IsFollowedAndFoundAgainAfterLostFrames) {
  int searched = 0;
  for (int i = 0; i < 14; ++i) {
    sessions::Frame frame = frameOf(approach_, i);
    if (i == 9) frame.image = approach_.coveredImage();
    if (i == 10) {
      frame.image.reset();
      frame.problem = "000010.png: truncated";
    }
    const sessions::RunResult result = sequence_.run(frame);
    EXPECT_EQ(result.case_id, frame.name);
    EXPECT_EQ(result.dataset_index, i);
    EXPECT_EQ(result.completed, i != 9 && i != 10) << i << " " << result.status;
    if (result.completed) expectTruth(approach_, i, result.camera_from_station);
    EXPECT_EQ(result.status == "input_error", i == 10) << i;
    if (i == 9) {
      EXPECT_NE(result.message, "");
    }
    if (i == 10) {
      EXPECT_EQ(result.message, "000010.png: truncated");
    }
    if (result.completed && result.compared_poses > 0) ++searched;
  }
  EXPECT_THAT(sequence_.lost(), ElementsAre(10, 11));
  EXPECT_LE(searched, 2) << "the first frame, and perhaps the one after those that are lost";
  EXPECT_EQ(sessions::sequenceText(sequence_), "12 of 14 frames accepted, 2 lost: 10, 11");
}

/// The memory of the frame before changes no bit.
TEST_F(Sequence, Frame_HasTheDigestOfARunOfItsOwn) {
  const sessions::RunResult first = run(0);
  ASSERT_TRUE(first.completed);
  const sessions::GrayImage image = approach_.image(1);
  const LocalizationProblem problem =
      sessions::problemOf(image, nullptr, inputs_.camera, inputs_.scene.view(),
                          first.camera_from_station, inputs_.motion, std::nullopt);
  EXPECT_EQ(run(1).digest, sessions::localize(problem, inputs_.options, inputs_.settings).digest);
}

TEST_F(Sequence, ImageOfAnotherSize_IsLostWithBothSizes) {
  sessions::GrayImage image;
  image.width = 64;
  image.height = 48;
  image.pixels.resize(64 * 48);
  const sessions::RunResult result = sequence_.run({"small.png", image, ""});
  EXPECT_EQ(result.status, "input_error");
  EXPECT_THAT(result.message, HasSubstr("is 64 x 48, but the camera is 512 x 512"));
  EXPECT_TRUE(run(0).completed);
}

/// A process that goes on does as the one before would have done.
TEST_F(Sequence, TakenResults_ContinueTheSequence) {
  sessions::Sequence continued(inputs_);
  for (int i = 0; i < 2; ++i) continued.take(run(i));
  EXPECT_EQ(continued.run(frameOf(approach_, 2)).digest, run(2).digest);
  EXPECT_EQ(continued.frames(), 3);
}

TEST_F(Sequence, StoppedFrame_CanBeRunAgain) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(run(0, stop.get_token()).status, "running");
  EXPECT_EQ(sequence_.frames(), 0);
  EXPECT_TRUE(run(0).completed);
}

TEST(SequenceText, LostFrames_AreListedAsRanges) {
  sessions::Sequence sequence(inputsOf(GeneratedApproach(2)));
  for (const bool found : {true, false, false, true, false, false, false, true, false}) {
    sessions::RunResult result;
    result.completed = found;
    sequence.take(result);
  }
  EXPECT_EQ(sessions::sequenceText(sequence), "3 of 9 frames accepted, 6 lost: 2, 3, 5-7, 9");
}

}  // namespace
}  // namespace boresight::test
