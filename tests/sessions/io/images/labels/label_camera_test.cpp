// SPDX-License-Identifier: Apache-2.0
// Which camera model of a label is taken, and which is not.
#include "sessions/io/images/labels/label_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/math.h"
#include "core/base/random.h"
#include "tests/sessions/io/images/labels/label_fixture.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

class LabelCamera : public LabelTest {
 protected:
  const GroupItems items_ = cameraItems(exampleModel(CameraModel::kCahvor, 60, 31, 24));
};

std::string fitOf(const CahvModel& cahv, int width, int height, const LabelSubframe& subframe,
                  const std::vector<LabelItem>& identifiers) {
  return cameraMisfit(cahv, width, height, subframe, detectorOf(identifiers));
}

const std::vector<LabelItem> kNavcam = {{"INSTRUMENT_HOST_ID", "M20"},
                                        {"INSTRUMENT_ID", "NAVCAM_LEFT"}};

/// The model of the whole detector, moved into the part at (first_sample, first_line).
CahvModel partOf(const CahvModel& whole, int first_sample, int first_line) {
  CahvModel part = whole;
  part.h_px -= first_sample * whole.a;
  part.v_px -= first_line * whole.a;
  return part;
}

/// The sixteen tiles in which a Navcam image of 5120 x 3840 comes down, the vectors of one of them
/// as published with the raw image.
TEST_F(LabelCamera, EveryTileOfADetectorIsTakenAsItsOwnModel) {
  CahvModel tile;
  tile.model = CameraModel::kCahvore;
  tile.c_m = {0.950849, 0.349753, -1.89429};
  tile.a = {0.824195, 0.0290508, 0.565575};
  tile.h_px = {2041.2, 3032.24, 1457.62};
  tile.v_px = {-71.0941, 9.0217, 3538};
  tile.o = {0.824089, 0.0304646, 0.565654};
  tile.r = {0.000001736, 0.0501396, -0.0171254};
  tile.e_m = {-0.000000008, 0.00000001, -0.000000029};
  tile.type = 2;
  EXPECT_EQ(fitOf(tile, 1288, 968, {0, 0}, kNavcam), "");
  EXPECT_THAT(fitOf(tile, 1288, 968, {0, 0}, {}), HasSubstr("although the image is said to be"));
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const LabelSubframe subframe{1272 * column, 952 * row};
      const CahvModel part = partOf(tile, subframe.first_sample, subframe.first_line);
      EXPECT_EQ(fitOf(part, 1296, 976, subframe, kNavcam), "") << row << " " << column;
      EXPECT_EQ(fitOf(part, 1296, 976, subframe, {{"MISSION_NAME", "MARS 2020"}}), "");
    }
  // Down-sampled by four the whole detector is an image of 1280 x 960.
  const CahvModel quarter = exampleModel(CameraModel::kCahvor, 750, 640, 480);
  EXPECT_EQ(fitOf(quarter, 1280, 960, {0, 0, 4.0, 4.0}, kNavcam), "");
}

/// Of random parts of a detector the part's model is taken, and none that puts the principal point
/// near the detector's border or outside of it.
TEST_F(LabelCamera, PrincipalPointsNearTheMiddleOfTheDetectorFit) {
  const std::vector<LabelItem> rover = {{"INSTRUMENT_HOST_ID", "MER2"}};
  Random random(31);
  for (int i = 0; i < 300; ++i) {
    const int width = 64 + static_cast<int>(random.uniform(0.0, 900.0));
    const int height = 64 + static_cast<int>(random.uniform(0.0, 900.0));
    const LabelSubframe subframe{static_cast<int>(random.uniform(0.0, 1024.0 - width)),
                                 static_cast<int>(random.uniform(0.0, 1024.0 - height))};
    const double x = random.uniform(0.16, 0.84) * 1024;
    const double y = random.uniform(0.16, 0.84) * 1024;
    const auto model = [&](double cx, double cy) {
      return partOf(exampleModel(CameraModel::kCahv, 1500, cx, cy), subframe.first_sample,
                    subframe.first_line);
    };
    EXPECT_EQ(fitOf(model(x, y), width, height, subframe, rover), "");
    const double beyond = random.uniform(0.9, 3.0) * 1024;
    EXPECT_THAT(fitOf(model(beyond, y), width, height, subframe, rover), HasSubstr("does not fit"));
    EXPECT_THAT(fitOf(model(x, -0.1 * 1024), width, height, subframe, rover),
                HasSubstr("does not fit"));
  }
}

TEST_F(LabelCamera, SeveralModelsMustAgree) {
  const GroupItems other = cameraItems(exampleModel(CameraModel::kCahvor, 61, 31, 24));
  const GroupItems none = {{"MODEL_TYPE", "\"NONE\""}};
  for (const auto& [first, second] : {std::pair(items_, items_), {none, items_}, {items_, other}})
    for (const ImageLabel& label :
         labelsOf({{"GEOMETRIC_CAMERA_MODEL", first}, {"CAMERA_MODEL", second}})) {
      EXPECT_EQ(label.camera.has_value(), second != other) << label.camera_remark;
      EXPECT_EQ(label.camera_remark.find("several camera models that differ") != std::string::npos,
                second == other);
    }
}

TEST_F(LabelCamera, KeyStatedTwice_LeavesTheCameraOut) {
  GroupItems items = items_;
  items.insert(items.begin(), {"MODEL_DESC", "\"PROPERTY in 2 (two) = lines,\r\n GROUP = X\""});
  // Other groups may repeat a key.
  for (const ImageLabel& label :
       labelsOf({{"GEOMETRIC_CAMERA_MODEL", items}, {"OTHER", {{"A", "1"}, {"A", "2"}}}}))
    EXPECT_TRUE(label.camera) << label.camera_remark;
  items.emplace_back("MODEL_COMPONENT_1", "(9,9,9)");
  for (const ImageLabel& label : labelsOf({{"GEOMETRIC_CAMERA_MODEL", items}})) {
    EXPECT_FALSE(label.camera) << label.format;
    EXPECT_THAT(label.camera_remark, HasSubstr("states MODEL_COMPONENT_1 of its camera model "));
  }
}

TEST_F(LabelCamera, MirroredAndSkewedModelsAreNoCameras) {
  const auto misfit = [](const CahvModel& cahv) {
    return cameraMisfit(cahv, 64, 48, std::nullopt, {});
  };
  const CahvModel good = exampleModel(CameraModel::kCahv, 60, 31, 24);
  EXPECT_EQ(misfit(good), "");
  CahvModel swapped = good;
  std::swap(swapped.h_px, swapped.v_px);
  EXPECT_THAT(misfit(swapped), HasSubstr("mirrors the image"));
  CahvModel reversed = good;
  reversed.v_px -= 2 * (good.v_px - 24 * good.a);
  EXPECT_THAT(misfit(reversed), HasSubstr("mirrors the image"));
  CahvModel skewed = good;
  skewed.v_px += std::tan(10 * kDegree_rad) * (good.h_px - 31 * good.a);
  EXPECT_THAT(misfit(skewed), HasSubstr("H and V are 10.0 deg off square"));
  CahvModel turned = good;  // by 180 deg about its axis: a camera that hangs upside down
  turned.h_px = 2 * 31 * good.a - good.h_px;
  turned.v_px = 2 * 24 * good.a - good.v_px;
  EXPECT_EQ(misfit(turned), "");
  CahvModel far = good;
  far.c_m.x() = 2e9;
  EXPECT_THAT(misfit(far), HasSubstr("its centre is over 1000000 m"));
}

TEST_F(LabelCamera, UnitsOfAllValuesCount) {
  Pds3File pds;
  pds.items = pds3Group("GEOMETRIC_CAMERA_MODEL",
                        with(items_, "MODEL_COMPONENT_1", "(1 <m>, -200 <mm>, -700 <mm>)"));
  EXPECT_THAT(readLabelOf(pds).camera_remark, HasSubstr("the unit 'M, MM'"));
  const auto frames = [&](const std::string& offset) {
    pds.items =
        pds3Group("ROVER_COORDINATE_SYSTEM", {{"COORDINATE_SYSTEM_NAME", "\"ROVER_FRAME\""},
                                              {"ORIGIN_OFFSET_VECTOR", offset},
                                              {"ORIGIN_ROTATION_QUATERNION", "(1.0,0.0,0.0,0.0)"},
                                              {"REFERENCE_COORD_SYSTEM_NAME", "\"SITE_FRAME\""}});
    return readLabelOf(pds).frames;
  };
  EXPECT_EQ(frames("(1.0 <m>,2.0 <m>,3.0 <m>)").size(), 1u);
  EXPECT_EQ(frames("(1.0,2.0,3.0)").size(), 1u);
  EXPECT_THAT(frames("(1000.0 <mm>,0.0 <mm>,0.0 <mm>)"), IsEmpty());
}

TEST_F(LabelCamera, FramesWithAnOddIndexHaveNoName) {
  for (const char* index : {"(1,2,\"N/A\")", "(1,2.5,3)", "(1,\"A7\")", "\"A7\"", "\"N/A\""})
    for (const ImageLabel& label : labelsOf(
             {{"GEOMETRIC_CAMERA_MODEL", with(items_, "REFERENCE_COORD_SYSTEM_INDEX", index)}})) {
      ASSERT_TRUE(label.camera) << label.camera_remark;
      const bool odd = index != std::string("\"N/A\"");
      EXPECT_EQ(label.camera->reference->frame,
                (odd ? FrameName() : FrameName{"ROVER_NAV_FRAME", {}}))
          << index;
      EXPECT_EQ(testing::Matches(Contains(HasSubstr("is not of whole numbers")))(label.flags), odd)
          << index;
    }
}

}  // namespace
}  // namespace boresight::sessions
