// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/input_sheet.h"

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "core/geometry/cahv_model.h"
#include "sessions/io/cameras/camera_conversion.h"
#include "tests/sessions/io/images/labels/label_fixture.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

const FrameName kRover{"ROVER_FRAME", {3}};
const FrameName kSite{"SITE_FRAME", {3}};

CameraFile cameraOf(const CahvModel& cahv) {
  CameraFile file;
  CameraReference reference;
  reference.frame = kRover;
  EXPECT_EQ(cameraFromCahv(cahv, 640, 480, file.camera, reference.camera_from_reference),
            Status::kOk);
  file.reference = reference;
  return file;
}

class LabelAgreement : public ::testing::Test {
 protected:
  LabelAgreement() {
    label_.camera = cameraOf(model_);
    label_.frames = {{kRover, kSite, rover_in_site_}};
    take(*label_.camera);
    one_.camera_from_station_seed.translation_m = {0.0, 0.0, 1.2};
  }
  void take(const CameraFile& camera) {
    one_.camera = camera.camera;
    one_.camera_reference = camera.reference;
  }
  void give(const FrameName& target, const FrameName& source, const Pose& target_from_source) {
    FrameTransform transform;
    transform.target = target;
    transform.source = source;
    transform.target_from_source = target_from_source;
    transform.comment = "by hand";
    transform.file = "sol3.json";
    one_.frames = {transform};
  }
  std::vector<std::string> flags() const {
    std::vector<RedFlag> found;
    flagLabel(one_, label_, found);
    std::vector<std::string> texts;
    for (const RedFlag& flag : found) texts.push_back(flag.code + ": " + flag.text);
    return texts;
  }

  const CahvModel model_ = exampleModel(CameraModel::kCahvore, 600, 320, 240);
  const Pose rover_in_site_{Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ())),
                            {10, 20, -3}};
  ImageLabel label_;
  SessionCase one_;
};

TEST_F(LabelAgreement, LabelsOwnCameraAndAFitOfItAgree) {
  EXPECT_THAT(flags(), IsEmpty());
  const FittedCamera fit = fitCamera(one_.camera, CameraModel::kBrownConrady, 1.2);
  ASSERT_LT(fit.worst_error_px, 0.5);
  take({fit.camera, std::nullopt});
  EXPECT_THAT(flags(), IsEmpty());
}

TEST_F(LabelAgreement, AnotherCameraIsFlaggedWithItsDifference) {
  CahvModel longer = model_;  // by a tenth: 32 px at the left and right border and 24 at the top
  longer.h_px = 1.1 * model_.h_px - 0.1 * model_.h_px.dot(model_.a) * model_.a;
  longer.v_px = 1.1 * model_.v_px - 0.1 * model_.v_px.dot(model_.a) * model_.a;
  take(cameraOf(longer));
  EXPECT_THAT(flags(), ElementsAre(HasSubstr("camera_label: the camera is not that of the image's "
                                             "label: at the seed's distance the two differ by up "
                                             "to 4")));
  CahvModel moved = model_;
  moved.c_m.y() += 0.02;
  take(cameraOf(moved));
  EXPECT_THAT(flags(),
              ElementsAre(HasSubstr("in ROVER_FRAME (3) it differs by 20.0 mm and 0.00 deg")));
  label_.camera.reset();
  EXPECT_THAT(flags(), IsEmpty());
}

TEST_F(LabelAgreement, PartOfADetectorMayHaveItsPrincipalPointAnywhere) {
  std::vector<RedFlag> found = {{"camera_off_centre", "far"}, {"mesh", "odd"}};
  flagLabel(one_, label_, found);
  EXPECT_EQ(found.size(), 2u);
  label_.subframe = LabelSubframe{1272, 952};
  flagLabel(one_, label_, found);
  EXPECT_EQ(found, (std::vector<RedFlag>{{"mesh", "odd"}}));
}

TEST_F(LabelAgreement, TransformThatTheLabelContradictsIsFlagged) {
  give(kSite, kRover, rover_in_site_);
  EXPECT_THAT(flags(), IsEmpty());
  give(kRover, kSite, rover_in_site_.inverse());
  EXPECT_THAT(flags(), IsEmpty());
  give(kRover, kSite, rover_in_site_);  // the frames swapped
  EXPECT_THAT(flags(), ElementsAre(HasSubstr("transform_label: sol3.json and the image's label "
                                             "differ about where SITE_FRAME (3) is in ROVER_FRAME "
                                             "(3): by ")));
  Pose near = rover_in_site_;
  near.translation_m.x() += 0.02;
  give(kSite, kRover, near);
  one_.truth_frame = one_.station_frame;  // said once
  EXPECT_THAT(flags(), ElementsAre(HasSubstr("by 20.0 mm and 0.00 deg")));
  label_.frames.clear();
  EXPECT_THAT(flags(), IsEmpty());
}

TEST_F(LabelAgreement, TransformsAgreeToAMillimetreAndAMilliradian) {
  const auto flagged = [this](double apart_m, double turned_rad) {
    Pose near = rover_in_site_;
    near.translation_m.y() -= apart_m;
    near.rotation =
        near.rotation * Eigen::Quaterniond(Eigen::AngleAxisd(turned_rad, Eigen::Vector3d::UnitX()));
    give(kSite, kRover, near);
    return !flags().empty();
  };
  EXPECT_FALSE(flagged(0.9e-3, 0.9e-3));
  EXPECT_TRUE(flagged(1.1e-3, 0.0));
  EXPECT_TRUE(flagged(0.0, 1.1e-3));
}

TEST_F(LabelAgreement, OneContradictionIsSaidOnce) {
  give(kRover, kSite, rover_in_site_);
  one_.frames.push_back(one_.frames.front());
  EXPECT_THAT(flags(), SizeIs(1));
  one_.frames.back().file = "other.json";
  EXPECT_THAT(flags(), SizeIs(2));
  give(kRover, FrameName{"ARM", {}}, rover_in_site_);
  EXPECT_THAT(flags(), IsEmpty()) << "the label does not state it";
}

TEST_F(LabelAgreement, CamerasAgreeToAPixelOnAllOfTheImage) {
  const auto flagged = [this](double shift_px) {
    CahvModel shifted = model_;
    shifted.h_px += shift_px * shifted.a;
    take(cameraOf(shifted));
    return !flags().empty();
  };
  EXPECT_FALSE(flagged(0.9));
  EXPECT_TRUE(flagged(1.1));
  one_.camera.width += 1;
  EXPECT_THAT(flags(), IsEmpty()) << "the size has a flag of its own";
}

}  // namespace
}  // namespace boresight::sessions
