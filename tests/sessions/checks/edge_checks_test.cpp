// SPDX-License-Identifier: Apache-2.0
// Edges of a box that OpenCV drew, asked at the pose that it was drawn from and at others.
#include "sessions/checks/checks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "sessions/checks/edge_evidence.h"
#include "sessions/checks/pose_uncertainty.h"
#include "tests/sessions/checks/drawn_box.h"
#include "tests/sessions/checks/find_check.h"
#include "tests/support/coverage.h"
#include "tests/support/example_case.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

using test::copyOf;
using test::DrawnBox;
using test::findCheck;

std::vector<Check> edgeChecksOf(const ReviewSubject& subject, const CheckLimits& limits = {}) {
  const PredictedEdges edges = predictEdges(
      subject.loaded->source.camera, subject.loaded->scene.view(), subject.camera_from_station);
  return test::addedChecks(addEdgeChecks, subject, limits, edges);
}

/// The subject with an image that OpenCV changes.
ReviewSubject withPixels(ReviewSubject subject, const std::function<void(cv::Mat&)>& change) {
  const auto loaded = copyOf(*subject.loaded);
  cv::Mat pixels(loaded->image.height, loaded->image.width, CV_8U, loaded->image.pixels.data());
  change(pixels);
  subject.loaded = loaded;
  return subject;
}

double figureOf(const std::vector<Check>& checks, const std::string& id) {
  return findCheck(checks, id).figure.value_or(-1.0);
}

class EdgeChecks : public testing::Test {
 protected:
  /// At the pose that was drawn.
  ReviewSubject subject() const { return box.subject(box.camera_from_station_); }
  /// The box's pose moved across the view so that the image moves by (x_px, y_px).
  Pose movedBy(double x_px, double y_px) const {
    Pose moved = box.camera_from_station_;
    moved.translation_m += 0.5 / 1000.0 * Eigen::Vector3d(x_px, y_px, 0.0);
    return moved;
  }
  /// Of the drawn image, where a pose predicts these.
  ImageEdges imageEdges(const PredictedEdges& edges) const {
    return {subject().loaded->image.view(), nullptr, regionOf(edges)};
  }
  void hideLeftHalf() {
    box.fill({{0.0, 0.0}, {middle_px, 0.0}, {middle_px, 599.0}, {0.0, 599.0}}, 40);
  }

  DrawnBox box;
  const double middle_px = box.pixelOf({0.0, 0.0, 0.025}).x();
};

TEST_F(EdgeChecks, AtThePoseThatWasDrawnAllIsSeenAndExplained) {
  const auto checks = edgeChecksOf(subject());
  EXPECT_GT(figureOf(checks, "edge_coverage"), 96.0);
  EXPECT_LT(figureOf(checks, "edge_clutter"), 4.0);
  EXPECT_GT(figureOf(checks, "edge_fall_off"), 40.0);
  EXPECT_LT(figureOf(checks, "camera_focal"), 0.6);
  EXPECT_LT(figureOf(checks, "camera_centre"), 5.0);
  for (const Check& check : checks)
    EXPECT_EQ(check.state, CheckState::kPassed) << check.id << ": " << check.sentence;
}

TEST_F(EdgeChecks, BlurredImage_FailsBySharpness) {
  EXPECT_LT(figureOf(edgeChecksOf(subject()), "edge_width"), 5.0);
  const ReviewSubject blurred =
      withPixels(subject(), [](cv::Mat& pixels) { cv::blur(pixels, pixels, cv::Size(16, 1)); });
  const Check width = findCheck(edgeChecksOf(blurred), "edge_width");
  EXPECT_GT(width.figure.value(), 10.0);
  EXPECT_EQ(width.state, CheckState::kFailed);
  const auto of_image = test::addedChecks(addImageChecks, blurred, CheckLimits());
  EXPECT_EQ(findCheck(of_image, "image_sharpness").state, CheckState::kFailed);
}

TEST_F(EdgeChecks, GoodImagePassesAndSpoiledImagesFailByTheirOwnCheck) {
  const auto checksWith = [this](double factor, double offset) {
    const auto spoiled = withPixels(
        subject(), [&](cv::Mat& pixels) { pixels.convertTo(pixels, CV_8U, factor, offset); });
    return test::addedChecks(addImageChecks, spoiled, CheckLimits());
  };
  for (const Check& check : checksWith(1.0, 0.0))
    EXPECT_EQ(check.state, CheckState::kPassed) << check.id << ": " << check.sentence;
  EXPECT_EQ(findCheck(checksWith(1.0, 250.0), "image_saturated").state, CheckState::kFailed);
  const auto narrow = checksWith(0.02, 100.0);
  EXPECT_EQ(findCheck(narrow, "image_range").state, CheckState::kFailed);
  EXPECT_EQ(findCheck(narrow, "image_sharpness").state, CheckState::kNotApplicable);
}

TEST_F(EdgeChecks, PlacesAreOnTheDrawnLinesToATenthOfAPixel) {
  const PredictedEdges edges = box.edges();
  double length_px = 0.0;
  for (const EdgePlace& place : edges.places) length_px += place.length_px;
  EXPECT_NEAR(length_px, box.visibleLength_px(), 0.02 * box.visibleLength_px());
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const LookedPlace& looked_place : lookAt(imageEdges(edges), edges.places)) {
    if (!looked_place.found || std::abs(looked_place.found->offset_px) > 1.0) continue;
    sum += looked_place.found->offset_px;
    squares += looked_place.found->offset_px * looked_place.found->offset_px;
    count += 1.0;
  }
  ASSERT_GT(count, 500.0);
  EXPECT_LT(std::abs(sum / count), 0.05);
  EXPECT_LT(std::sqrt(squares / count), 0.2);
}

TEST_F(EdgeChecks, LinesThatTheBoxDoesNotHaveAreClutterByTheirLength) {
  const double added_px = box.addPatch(0.6, 230);
  const auto checks = edgeChecksOf(subject());
  // Of the predicted edges, those on the silhouette count where Canny puts them inside it.
  const double least = 100.0 * added_px / (added_px + box.visibleLength_px());
  EXPECT_GT(figureOf(checks, "edge_clutter"), 0.85 * least);
  EXPECT_LT(figureOf(checks, "edge_clutter"), 2.0 * least);
  EXPECT_GT(figureOf(checks, "edge_coverage"), 96.0);
}

TEST_F(EdgeChecks, AWrongPoseAndAHiddenHalfHaveLessCoverageAndEvidence) {
  const auto right = edgeChecksOf(subject());
  EXPECT_GT(figureOf(right, "edge_evidence"), 120.0);  // more is seen than at many right poses
  EXPECT_EQ(findCheck(right, "edge_evidence").state, CheckState::kPassed);
  EXPECT_GT(figureOf(edgeChecksOf(box.subject(movedBy(0.7, 0.5))), "edge_coverage"), 90.0);
  const auto away = edgeChecksOf(box.subject(movedBy(6.0, 5.0)));
  EXPECT_LT(figureOf(away, "edge_coverage"), 35.0);
  EXPECT_GT(figureOf(away, "edge_clutter"), 60.0);
  EXPECT_LT(figureOf(away, "edge_evidence"), 0.5 * figureOf(right, "edge_evidence"));
  for (const char* id : {"edge_coverage", "edge_evidence"})
    EXPECT_EQ(findCheck(away, id).state, CheckState::kFailed) << id;
  hideLeftHalf();
  const auto half = edgeChecksOf(subject());
  EXPECT_GT(figureOf(half, "edge_coverage"), 35.0);
  EXPECT_LT(figureOf(half, "edge_coverage"), 65.0);
  EXPECT_LT(figureOf(half, "edge_evidence"), figureOf(right, "edge_evidence"));
  EXPECT_GT(figureOf(half, "edge_evidence"), figureOf(away, "edge_evidence"));
}

TEST_F(EdgeChecks, CoverageOfAPoseIsThatOfTheCheck) {
  for (const double moved_px : {0.0, 1.0, 6.0}) {
    const auto subject = box.subject(movedBy(moved_px, 0.5));
    const Share share = coverageOfPose(*subject.loaded, subject.camera_from_station);
    EXPECT_NEAR(100.0 * share.value(), figureOf(edgeChecksOf(subject), "edge_coverage"), 1e-9);
  }
}

TEST_F(EdgeChecks, IgnoredPixels_DoNotCount) {
  hideLeftHalf();
  ReviewSubject subject = this->subject();
  const auto masked = copyOf(*subject.loaded);
  masked->ignore.emplace();
  masked->ignore->width = 800;
  masked->ignore->height = 600;
  masked->ignore->words.assign(static_cast<std::size_t>(BitImage::wordsPerRow(800)) * 600, 0);
  masked->ignore_bits = masked->ignore->view();
  for (int y = 0; y < 600; ++y)
    for (int x = 0; x < static_cast<int>(middle_px) + 4; ++x) masked->ignore_bits.set(x, y);
  subject.loaded = masked;
  const auto checks = edgeChecksOf(subject);
  EXPECT_GT(figureOf(checks, "edge_coverage"), 96.0);
  EXPECT_LT(figureOf(checks, "edge_clutter"), 4.0);
}

TEST_F(EdgeChecks, UndeterminedDirection_IsReported) {
  // Half of the image hidden so that parallel lines of one edge remain: it slides along itself.
  const PredictedEdges edges = box.edges();
  std::vector<EdgePlace> parallel;
  const Eigen::Vector2d along =
      (box.pixelOf({0.06, 0.04, 0.025}) - box.pixelOf({-0.06, 0.04, 0.025})).normalized();
  for (const EdgePlace& place : edges.places)
    if (std::abs(place.normal.dot(along)) < 0.1) parallel.push_back(place);
  ASSERT_GT(parallel.size(), 200U);
  double most = 0.0;
  for (const FallOff& fall_off :
       fallOffOf(imageEdges(edges), parallel, box.camera_, box.camera_from_station_))
    most = std::max(most, fall_off.coverage);
  EXPECT_GT(most, 0.85);
}

/// The pose that explains the drawn image best with a wrong focal length: farther away.
TEST_F(EdgeChecks, AWrongFocalLengthIsFoundByItsPerspective) {
  Camera wrong = box.camera_;
  wrong.fx *= 1.03;
  wrong.fy *= 1.03;
  ASSERT_EQ(prepareCamera(wrong), Status::kOk);
  const auto follow = poseByCamera(box.edges().places, box.camera_, box.camera_from_station_);
  ASSERT_TRUE(follow);
  const Pose farther = perturbed(Vector6d(30.0 * follow->col(0)), box.camera_from_station_);
  EXPECT_NEAR(farther.translation_m.z(), 1.03 * 0.5, 0.003);
  const PredictedEdges wrong_edges = predictEdges(wrong, box.scene_.view(), farther);
  const auto fit = fitCamera(lookAt(imageEdges(wrong_edges), wrong_edges.places), wrong, farther);
  ASSERT_TRUE(fit);
  // Half a pixel of perspective is all that tells on so small a box.
  EXPECT_LT(fit->focal_px, -10.0);
  EXPECT_GT(fit->focal_px, -36.0);
  EXPECT_LT(fit->focal_sigma_px, 5.0);
}

/// Errors of focal length and principal point (x, y) in sigmas, 1,000 draws: edges are found with
/// Gaussian errors that those of a small tile share in part.
std::array<std::vector<double>, 3> cameraErrors(const PredictedEdges& edges, const Camera& camera,
                                                const Pose& camera_from_station) {
  Random random = test::randomFor("EdgeChecks.Sigmas");
  std::vector<LookedPlace> looked;
  for (const EdgePlace& place : thinned(edges.places, 600)) looked.push_back({place, FoundEdge()});
  std::array<std::vector<double>, 3> errors;
  for (int draw = 0; draw < 1000; ++draw) {
    std::map<std::pair<int, int>, double> shared_px;
    for (LookedPlace& one : looked) {
      const Eigen::Vector2i tile = (one.place.pixel / 8.0).cast<int>();
      const auto [at, added] = shared_px.try_emplace({tile.x(), tile.y()}, 0.0);
      if (added) at->second = 0.1 * random.normal();
      one.found->offset_px = at->second + 0.3 * random.normal();
    }
    const CameraFit fit = fitCamera(looked, camera, camera_from_station).value();
    errors[0].push_back(fit.focal_px / fit.focal_sigma_px);
    for (const Eigen::Index axis : {0, 1})
      errors[static_cast<std::size_t>(axis) + 1].push_back(
          fit.centre_px[axis] / std::sqrt(fit.centre_covariance_px2(axis, axis)));
  }
  return errors;
}

TEST_F(EdgeChecks, SigmasOfTheCamera_HoldTheErrors) {
  for (const char* station : {"bc", "os"}) {
    SCOPED_TRACE(station);
    const test::ExampleCase example(station);
    const Pose& pose = example.truth.camera_from_station;
    const PredictedEdges edges = predictEdges(example.camera, example.scene.view(), pose);
    for (const auto& errors : cameraErrors(edges, example.camera, pose))
      test::expectGaussianCoverage(errors);
  }
  // A jackknife over few tiles is rather too large.
  SCOPED_TRACE("box");
  for (const auto& errors : cameraErrors(box.edges(), box.camera_, box.camera_from_station_)) {
    test::expectGaussianCoverage(errors, true);
    EXPECT_LT(test::shareWithinSigmas(errors)[0], 0.8);
  }
}

TEST_F(EdgeChecks, UnconfirmedCamera_Fails) {
  ReviewSubject subject = this->subject();
  CheckLimits limits;
  limits.focal_percent = 0.001;
  const auto focalState = [&] {
    return findCheck(edgeChecksOf(subject, limits), "camera_focal").state;
  };
  EXPECT_EQ(focalState(), CheckState::kFailed);
  const auto stated = copyOf(*subject.loaded);
  // Known, to five percent: what the edges ask for is within that.
  stated->source.calibration_sigma = StatedCalibration{0.05, 0.3};
  subject.loaded = stated;
  EXPECT_EQ(focalState(), CheckState::kPassed);
  subject.requirement = {{}, {}, {}, 3.0};
  EXPECT_EQ(focalState(), CheckState::kNotApplicable);
}

/// A fit and a calibration whose sigmas are 0.3 and 0.4 (% or px): 0.5 together. Changes below 0.75
/// may be chance, and the limits of 1 come on top; 1.25 is the largest sigma that confirms.
class CameraChecks : public testing::Test {
 protected:
  CameraChecks() {
    session_case_.camera.fx = session_case_.camera.fy = 1000.0;
    limits_.focal_percent = limits_.centre_px = 1.0;
  }
  /// States of both checks for a change and a sigma of each parameter, % and px.
  std::vector<CheckState> states(double change, double sigma) const {
    CameraFit fit;
    fit.focal_px = 10.0 * change;
    fit.focal_sigma_px = 10.0 * sigma;
    fit.centre_px = {0.6 * change, -0.8 * change};
    fit.centre_covariance_px2 = sigma * sigma * Eigen::Matrix2d::Identity();
    const auto checks =
        test::addedChecks(addCameraChecks, std::optional(fit), session_case_, limits_);
    return {findCheck(checks, "camera_focal").state, findCheck(checks, "camera_centre").state};
  }

  SessionCase session_case_;
  CheckLimits limits_;
  const std::vector<CheckState> passed_ = {CheckState::kPassed, CheckState::kPassed};
  const std::vector<CheckState> failed_ = {CheckState::kFailed, CheckState::kFailed};
};

TEST_F(CameraChecks, ChangeMayExceedTheLimitByOneAndAHalfSigmas) {
  session_case_.calibration_sigma = StatedCalibration{0.004, 0.4};
  EXPECT_EQ(states(1.74, 0.3), passed_);
  EXPECT_EQ(states(-1.74, 0.3), passed_);
  EXPECT_EQ(states(1.76, 0.3), failed_);
  EXPECT_EQ(states(-1.76, 0.3), failed_);
}

TEST_F(CameraChecks, ParameterThatIsNotStated_IsConfirmedBySigmasWithinTheLimit) {
  const CheckState good = CheckState::kPassed;
  const CheckState bad = CheckState::kFailed;
  EXPECT_EQ(states(0.0, 1.24), passed_);
  EXPECT_EQ(states(0.0, 1.26), failed_);
  session_case_.calibration_sigma = StatedCalibration{0.004, std::nullopt};
  EXPECT_EQ(states(0.0, 1.24), passed_);
  EXPECT_EQ(states(0.0, 1.26), (std::vector{good, bad}));
  session_case_.calibration_sigma = StatedCalibration{std::nullopt, 0.4};
  EXPECT_EQ(states(0.0, 1.24), passed_);
  EXPECT_EQ(states(0.0, 1.26), (std::vector{bad, good}));
  session_case_.calibration_sigma = StatedCalibration{0.004, 0.4};
  EXPECT_EQ(states(0.0, 1.26), passed_);
}

TEST_F(CameraChecks, CameraThatIsNotDetermined_FailsWhereItIsNotStated) {
  const auto state = [this](const char* id) {
    return findCheck(test::addedChecks(addCameraChecks, std::optional<CameraFit>(), session_case_,
                                       limits_),
                     id)
        .state;
  };
  session_case_.calibration_sigma = StatedCalibration{0.004, std::nullopt};
  EXPECT_EQ(state("camera_focal"), CheckState::kNotApplicable);
  EXPECT_EQ(state("camera_centre"), CheckState::kFailed);
  session_case_.calibration_sigma = StatedCalibration{std::nullopt, 0.4};
  EXPECT_EQ(state("camera_focal"), CheckState::kFailed);
  EXPECT_EQ(state("camera_centre"), CheckState::kNotApplicable);
}

TEST_F(EdgeChecks, CameraThatTheEdgesDoNotDetermine_FailsUnlessItsCalibrationIsStated) {
  ReviewSubject subject = this->subject();
  const auto black = copyOf(*subject.loaded);
  std::ranges::fill(black->image.pixels, std::uint8_t{0});
  subject.loaded = black;
  const auto stateOf = [&](const char* id) { return findCheck(edgeChecksOf(subject), id).state; };
  EXPECT_EQ(stateOf("camera_focal"), CheckState::kFailed);
  EXPECT_EQ(stateOf("camera_centre"), CheckState::kFailed);
  const auto stated = copyOf(*black);
  stated->source.calibration_sigma = StatedCalibration{0.05, 0.3};
  subject.loaded = stated;
  EXPECT_EQ(stateOf("camera_focal"), CheckState::kNotApplicable);
}

TEST_F(EdgeChecks, ImageThatDeterminesTheCameraTooWeakly_IsUndecidedAndDoesNotPass) {
  hideLeftHalf();
  for (const char* id : {"camera_focal", "camera_centre"}) {
    const Check check = findCheck(edgeChecksOf(subject()), id);
    EXPECT_EQ(check.state, CheckState::kFailed) << check.sentence;
    EXPECT_THAT(check.sentence, testing::HasSubstr("cannot confirm the camera"));
  }
}

TEST_F(EdgeChecks, PoseThatShowsNothingAndImageOfAnotherSize_Fail) {
  Pose behind = box.camera_from_station_;
  behind.translation_m.z() = -1.0;
  EXPECT_EQ(findCheck(edgeChecksOf(box.subject(behind)), "edge_coverage").state,
            CheckState::kFailed);
  ReviewSubject subject = this->subject();
  const auto other = copyOf(*subject.loaded);
  other->image = {};
  subject.loaded = other;
  for (const Check& check : edgeChecksOf(subject))
    EXPECT_EQ(check.state,
              check.id == "edge_coverage" ? CheckState::kFailed : CheckState::kNotApplicable)
        << check.id;
}

}  // namespace
}  // namespace boresight::sessions
