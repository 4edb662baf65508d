// SPDX-License-Identifier: Apache-2.0
// What labels say: the expectations are what the test wrote into them.
#include "sessions/io/images/labels/image_label.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/random.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/io/images/image_file.h"
#include "tests/sessions/io/images/labels/label_fixture.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

class ImageLabelTest : public LabelTest {
 protected:
  /// Why a label with this group of a camera model has no camera; empty where it has one.
  std::string remark(const GroupItems& camera, const std::string& image_items = "",
                     const std::string& items = "", const Raster& raster = Raster::plain()) const {
    Pds3File pds;
    pds.items = items + pds3Group("GEOMETRIC_CAMERA_MODEL", camera);
    pds.image_items = image_items;
    const ImageLabel label = readLabelOf(pds, raster);
    EXPECT_EQ(label.camera.has_value(), label.camera_remark.empty());
    return label.camera_remark;
  }
};

/// The camera of the label projects as the vectors it was written from.
void expectModel(const ImageLabel& label, const CahvModel& cahv) {
  ASSERT_TRUE(label.camera) << label.camera_remark;
  EXPECT_EQ(label.camera_remark, "");
  const Camera& camera = label.camera->camera;
  EXPECT_EQ(camera.model, cahv.model);
  EXPECT_EQ(camera.width, label.width);
  ASSERT_TRUE(label.camera->reference);
  EXPECT_EQ(label.camera->reference->frame, (FrameName{"ROVER_NAV_FRAME", {14, 1262, 6}}));
  const CahvModel back = cahvFromCamera(camera, label.camera->reference->camera_from_reference);
  EXPECT_LT((back.c_m - cahv.c_m).norm(), 1e-8);
  EXPECT_LT((back.h_px - cahv.h_px).norm(), 1e-5);
  EXPECT_LT((back.v_px - cahv.v_px).norm(), 1e-5);
  if (cahv.model == CameraModel::kCahv) return;
  EXPECT_LT((back.o - cahv.o).norm(), 1e-8);
  EXPECT_LT((back.r - cahv.r).norm(), 1e-8);
  if (cahv.model == CameraModel::kCahvor) return;
  EXPECT_LT((back.e_m - cahv.e_m).norm(), 1e-8);
  EXPECT_EQ(back.type, cahv.type);
  EXPECT_NEAR(back.parameter, cahv.parameter, 1e-9);
}

TEST_F(ImageLabelTest, ComponentsAreFoundByLetterOrNameInAnyOrder) {
  Random random(3);
  for (const CameraModel model : {CameraModel::kCahv, CameraModel::kCahvor, CameraModel::kCahvore})
    for (int round = 0; round < 9; ++round) {
      const CahvModel cahv =
          exampleModel(model, 40.0 + random.below(200), 28 + random.below(8), 20 + random.below(8));
      std::string order = "CAHVORETP";
      for (std::size_t i = order.size() - 1; i > 0; --i)
        std::swap(order[i], order[random.below(static_cast<std::uint32_t>(i + 1))]);
      const char* const names[] = {"GEOMETRIC_CAMERA_MODEL", "GEOMETRIC_CAMERA_MODEL_PARMS",
                                   "CAMERA_MODEL"};
      const auto labels =
          labelsOf({{names[round % 3], cameraItems(cahv, order, round % 3 != 1, round % 3 != 2)}});
      for (const ImageLabel& label : labels) expectModel(label, cahv);
      EXPECT_EQ(readCameraFile(folder_ / "last.vic").camera, labels.back().camera->camera);
    }
}

std::string element(const std::string& name, const std::string& content, const char* unit = "") {
  return "<geom:" + name + unit + ">" + content + "</geom:" + name + ">";
}

std::string pds4Vector(const std::string& name, const Eigen::Vector3d& v, const char* suffix) {
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += element(suffix[0] == 'c' ? "c" + std::to_string(i) : "xyz"[i] + std::string(suffix),
                    decimals(v[i]), suffix == std::string("_position") ? " unit=\"m\"" : "");
  return element(name, text);
}

std::string pds4Camera(const CahvModel& cahv) {
  const std::string kind = modelType(cahv);
  std::string model = pds4Vector("Vector_Vertical", cahv.v_px, "_pixel") +
                      pds4Vector("Vector_Center", cahv.c_m, "_position") +
                      pds4Vector("Vector_Axis", cahv.a, "_unit") +
                      pds4Vector("Vector_Horizontal", cahv.h_px, "_pixel");
  if (kind != "CAHV")
    model +=
        pds4Vector("Vector_Optical", cahv.o, "_unit") + pds4Vector("Radial_Terms", cahv.r, "c");
  if (kind == "CAHVORE")
    model += pds4Vector("Entrance_Terms", cahv.e_m, "c") +
             element("cahvore_model_type", std::to_string(cahv.type)) +
             element("cahvore_model_parameter", decimals(cahv.parameter));
  std::string frame = element("coordinate_space_frame_type", "ROVER_NAV_FRAME");
  for (const auto& [name, value] : {std::pair("SITE", "14"), {"DRIVE", "1262"}, {"POSE", "6"}})
    frame += element("Coordinate_Space_Index",
                     element("index_id", name) + element("index_value_number", value));
  const std::string parameters =
      element("model_type", kind) + element(kind + "_Model", model) +
      element("Coordinate_Space_Reference", element("Coordinate_Space_Indexed", frame));
  return element("Geometry",
                 element("Geometry_Lander", element("Camera_Model_Parameters", parameters)));
}

TEST_F(ImageLabelTest, Pds4GivesTheSameModels) {
  for (const CameraModel model :
       {CameraModel::kCahv, CameraModel::kCahvor, CameraModel::kCahvore}) {
    const CahvModel cahv = exampleModel(model, 77.0, 31.0, 24.0);
    Pds4File pds;
    pds.discipline =
        pds4Camera(cahv) +
        "<img:Imaging><img:Subframe><img:first_line>1</img:first_line><img:first_sample>1"
        "</img:first_sample></img:Subframe><img:Sampling><img:sample_bit_mask>2#0000111111111111#"
        "</img:sample_bit_mask></img:Sampling><img:Commanded_Parameters><img:Subframe>"
        "<img:first_line>500</img:first_line></img:Subframe></img:Commanded_Parameters>"
        "</img:Imaging>";
    folder_.write("pixels.img", pds.pixels(Raster::plain()));
    const ImageLabel label = readImageLabel(folder_.write("image.xml", pds.label(Raster::plain())));
    expectModel(label, cahv);
    EXPECT_EQ(label.format, "PDS4");
    EXPECT_EQ(label.bit_depth, 12);
    EXPECT_TRUE(label.subframe && label.subframe->whole());
  }
}

TEST_F(ImageLabelTest, UnitsBlanksAndWordsForNothingAreUnderstood) {
  const CahvModel cahv = exampleModel(CameraModel::kCahv, 60, 31, 24);
  Pds3File pds;
  GroupItems items = with(cameraItems(cahv), "MODEL_COMPONENT_1",
                          "(" + decimals(cahv.c_m.x()) + " <m>," + decimals(cahv.c_m.y()) +
                              " <m>," + decimals(cahv.c_m.z()) + " <m>)");
  items.emplace_back("FILTER_NAME", "\"N/A\"");
  items.emplace_back("SOLUTION_ID", "\"telemetry   \r\n   and more \"");
  items.emplace_back("CALIBRATION_SOURCE_ID", "UNK");
  pds.items = "PRODUCT_ID = \"IMAGE   \"\r\nMISSION_NAME = \"NULL\"\r\n" +
              pds3Group("GEOMETRIC_CAMERA_MODEL", items);
  const ImageLabel label = readLabelOf(pds);
  expectModel(label, cahv);
  EXPECT_EQ(label.identifiers, (std::vector<LabelItem>{{"PRODUCT_ID", "IMAGE"}}));
  EXPECT_EQ(label.camera_items, (std::vector<LabelItem>{{"SOLUTION_ID", "telemetry and more"}}));
  items[3].second = "(1 <mm>,2 <mm>,3 <mm>)";
  EXPECT_THAT(remark(items), HasSubstr("the unit 'MM'"));
}

TEST_F(ImageLabelTest, ExponentsOfFortranAreExponents) {
  GroupItems items = with(cameraItems(exampleModel(CameraModel::kCahv, 60, 31, 24)),
                          "MODEL_COMPONENT_1", "(1.5D-03,-2.5d1,3.D+2)");
  items.emplace_back("SOLUTION_ID", "\"1.5D-03\"");
  for (const ImageLabel& label : labelsOf({{"GEOMETRIC_CAMERA_MODEL", items}})) {
    ASSERT_TRUE(label.camera) << label.camera_remark;
    const Eigen::Vector3d centre_m =
        label.camera->reference->camera_from_reference.inverse().translation_m;
    EXPECT_LT((centre_m - Eigen::Vector3d(0.0015, -25.0, 300.0)).norm(), 1e-9);
    EXPECT_THAT(label.camera_items, Contains(LabelItem{"SOLUTION_ID", "1.5D-03"}));
  }
  Pds3File pds;
  pds.items = "PRODUCT_ID = 1F483D5\r\n" + pds3Group("GEOMETRIC_CAMERA_MODEL", items);
  EXPECT_THAT(readLabelOf(pds).identifiers, Contains(LabelItem{"PRODUCT_ID", "1F483D5"}));
}

TEST_F(ImageLabelTest, CameraModelsThatAreNoneSayWhy) {
  const CahvModel cahv = exampleModel(CameraModel::kCahvore, 60, 31, 24);
  EXPECT_EQ(readLabelOf(Pds3File()).camera_remark, "the label has no camera model");
  EXPECT_EQ(folder_.message([&] { readCameraFile(folder_ / "image.img"); }),
            "image.img: the label has no camera model");
  for (const auto& [key, value, expected] : std::vector<std::array<const char*, 3>>{
           {"MODEL_TYPE", "\"NONE\"", "the label's camera model is NONE"},
           {"MODEL_TYPE", "\"PSPH\"", "'PSPH', is not one of"},
           {"MODEL_COMPONENT_3", "(1,2)", "no usable component H"},
           {"MODEL_COMPONENT_3", "(1,\"N/A\",2)", "no usable component H"},
           {"MODEL_COMPONENT_8", "7", "does not say its type"},
           {"MODEL_COMPONENT_9", "\"UNK\"", "type 3 has no parameter"},
           {"MODEL_COMPONENT_ID", R"(("C","A","V","H","O","R","E","T","P"))",
            "calls component 3 both V and HORIZONTAL"}})
    EXPECT_THAT(remark(with(cameraItems(cahv), key, value)), HasSubstr(expected)) << value;
  EXPECT_THAT(remark(cameraItems(cahv, "CAHVORETP", false, false)),
              HasSubstr("no usable component C"));
}

TEST_F(ImageLabelTest, CameraModelsThatDoNotFitTheImageAreLeftOut) {
  const std::string uncut = " FIRST_LINE = 1\r\n FIRST_LINE_SAMPLE = 1\r\n";
  const auto model = [](double f, double cx, double cy) {
    return cameraItems(exampleModel(CameraModel::kCahv, f, cx, cy));
  };
  EXPECT_EQ(remark(model(60, 31, 24), uncut), "");
  EXPECT_THAT(remark(model(60, 63, 24), uncut),
              HasSubstr("its principal point would be at (63.0, 24.0) of 64 x 48 px"));
  EXPECT_THAT(remark(model(60, 31, 600)), HasSubstr("no sub-frame is stated"));
  for (const double focal_px : {0.5, 1e7})
    EXPECT_THAT(remark(model(focal_px, 31, 24)), HasSubstr("is invalid: focal lengths"));
  CahvModel longer = exampleModel(CameraModel::kCahv, 60, 31, 24);
  longer.a *= 1.01;
  EXPECT_THAT(remark(cameraItems(longer)), HasSubstr("its axis A has the length 1.0100"));
  CahvModel odd = exampleModel(CameraModel::kCahvor, 60, 31, 24);
  odd.o *= 0.9;
  EXPECT_THAT(remark(cameraItems(odd)), HasSubstr("cannot project"));
  const std::string averaged =
      "GROUP = INSTRUMENT_STATE_PARMS\r\n PIXEL_AVERAGING_WIDTH = 1\r\n "
      "PIXEL_AVERAGING_HEIGHT = 4\r\nEND_GROUP = INSTRUMENT_STATE_PARMS\r\n";
  EXPECT_THAT(remark(model(60, 31, 24), uncut, averaged),
              HasSubstr("does not fit the down-sampling by 1.00 x 4.00"));
}

TEST_F(ImageLabelTest, SubframesModelIsTakenAndTheWholeDetectorsIsNot) {
  const std::string cut = " FIRST_LINE = 401\r\n FIRST_LINE_SAMPLE = 501\r\n";
  const std::string rover = "INSTRUMENT_HOST_ID = MSL\r\nINSTRUMENT_ID = NAV_LEFT_A\r\n";
  const Raster raster = Raster::plain(256, 128);
  const CahvModel part = exampleModel(CameraModel::kCahv, 454, 11.5, 111.5);
  Pds3File pds;
  pds.items = rover + pds3Group("GEOMETRIC_CAMERA_MODEL", cameraItems(part));
  pds.image_items = cut;
  const ImageLabel label = readLabelOf(pds, raster);
  expectModel(label, part);
  ASSERT_TRUE(label.subframe);
  EXPECT_EQ(label.subframe->first_sample, 500);
  EXPECT_EQ(label.subframe->first_line, 400);
  // A detector of 1024 x 1024 with its principal point in the middle.
  const CahvModel whole = exampleModel(CameraModel::kCahv, 454, 511.5, 511.5);
  EXPECT_THAT(
      remark(cameraItems(whole), cut, rover, raster),
      HasSubstr("does not fit the sub-frame at sample 500, line 400: its principal point "
                "would be at (1011.5, 911.5) of the detector, which has up to 1024 x 1024"));
  // Another mission's label: both readings are possible, so none is taken.
  EXPECT_THAT(remark(cameraItems(part), cut, "", raster), HasSubstr("does not state whether"));
  // Far from the detector's middle the principal point is left of the cut: only one is possible.
  const std::string right = " FIRST_LINE = 401\r\n FIRST_LINE_SAMPLE = 701\r\n";
  const CahvModel left = exampleModel(CameraModel::kCahv, 454, -188.5, 111.5);
  EXPECT_EQ(remark(cameraItems(left), right, "", raster), "");
}

TEST_F(ImageLabelTest, OfTwoLabelsInAFileTheOneWithAModelCounts) {
  const CahvModel cahv = exampleModel(CameraModel::kCahvor, 60, 31, 24);
  const CahvModel other = exampleModel(CameraModel::kCahvor, 61, 31, 24);
  const auto read = [&](const CahvModel* in_pds, const CahvModel* in_vicar) {
    VicarFile vicar{Store::kHalf, true};
    if (in_vicar != nullptr)
      vicar.items = vicarProperty("GEOMETRIC_CAMERA_MODEL", cameraItems(*in_vicar));
    Pds3File pds;
    const Bytes whole = vicar.bytes(Raster::plain());
    pds.between.assign(whole.begin(), whole.end() - 2 * 64 * 48);
    if (in_pds != nullptr) pds.items = pds3Group("GEOMETRIC_CAMERA_MODEL", cameraItems(*in_pds));
    return readLabelOf(pds);
  };
  const ImageLabel same = read(&cahv, &cahv);
  expectModel(same, cahv);
  EXPECT_EQ(same.format, "PDS3");
  EXPECT_TRUE(same.flags.empty()) << same.flags.front();
  const ImageLabel lone = read(nullptr, &cahv);
  expectModel(lone, cahv);
  EXPECT_THAT(lone.flags, Contains(HasSubstr("comes from the VICAR header in the file")));
  const ImageLabel differing = read(&cahv, &other);
  expectModel(differing, cahv);
  EXPECT_THAT(differing.flags, Contains(HasSubstr("state different camera models")));
}

TEST_F(ImageLabelTest, FramesAreReadScalarFirst) {
  // 90 deg about z: x of the rover is y of the site.
  const GroupItems rover{{"COORDINATE_SYSTEM_NAME", "\"ROVER_NAV_FRAME\""},
                         {"COORDINATE_SYSTEM_INDEX", "(14,1262)"},
                         {"ORIGIN_OFFSET_VECTOR", "(-176.5,-129.5,-0.25)"},
                         {"ORIGIN_ROTATION_QUATERNION", "(0.707106781,0.0,0.0,0.707106781)"},
                         {"REFERENCE_COORD_SYSTEM_NAME", "\"SITE_FRAME\""},
                         {"REFERENCE_COORD_SYSTEM_INDEX", "14"}};
  GroupItems bad = rover;
  bad[0].second = "\"ARM_FRAME\"";
  bad[3].second = "(1.0,1.0,0.0,0.0)";
  for (const ImageLabel& label :
       labelsOf({{"ROVER_COORDINATE_SYSTEM", rover}, {"ARM_COORDINATE_SYSTEM", bad}})) {
    ASSERT_THAT(label.frames, SizeIs(1));
    EXPECT_EQ(label.frames[0].frame, (FrameName{"ROVER_NAV_FRAME", {14, 1262}}));
    EXPECT_EQ(label.frames[0].reference, (FrameName{"SITE_FRAME", {14}}));
    const Eigen::Vector3d seen = label.frames[0].reference_from_frame * Eigen::Vector3d(1, 0, 0);
    EXPECT_LT((seen - Eigen::Vector3d(-176.5, -128.5, -0.25)).norm(), 1e-9);
    EXPECT_THAT(label.flags, Contains(HasSubstr("the label's place of ARM_FRAME")));
  }
}

TEST_F(ImageLabelTest, MosaicsAndMapsAreFlagged) {
  Pds3File pds;
  pds.items =
      "GROUP = INSTRUMENT_STATE_PARMS\r\n CFA_TYPE = \"BAYER_RGGB\"\r\nEND_GROUP = "
      "INSTRUMENT_STATE_PARMS\r\nGROUP = DERIVED_IMAGE_PARMS\r\n DERIVED_IMAGE_TYPE = "
      "\"RANGE_MAP\"\r\nEND_GROUP = DERIVED_IMAGE_PARMS\r\n";
  const ImageLabel label = readLabelOf(pds);
  EXPECT_EQ(label.bayer_pattern, "BAYER_RGGB");
  EXPECT_THAT(label.flags, Contains(HasSubstr("the label calls this a RANGE_MAP")));
  const GrayImage image = readImage(folder_ / "image.img");
  EXPECT_THAT(image.notes, Contains(HasSubstr("a mosaic of colours (BAYER_RGGB)")));
  const ImageReadOptions interpolated{{}, {}, {}, BayerPattern::kRggb};
  EXPECT_EQ(readImage(folder_ / "image.img", interpolated).notes, label.flags);
  ASSERT_TRUE(image.label);
  EXPECT_EQ(image.label->bayer_pattern, "BAYER_RGGB");
}

TEST_F(ImageLabelTest, FilesWithoutALabelHaveNone) {
  for (const auto& file :
       {folder_ / "gone.img", folder_.path(),
        folder_.write("a.json", "{\"format\": \"boresight-camera\"}"),
        folder_.write("a.xml", "<?xml version=\"1.0\"?><svg/>"), folder_.write("a.txt", "LBLSIZ")})
    EXPECT_FALSE(hasImageLabel(file)) << file;
  EXPECT_TRUE(hasImageLabel(folder_.write("a", "LBLSIZE=  100")));
  EXPECT_TRUE(hasImageLabel(folder_.write("b", "PDS_VERSION_ID = PDS3\r\n")));
}

}  // namespace
}  // namespace boresight::sessions
