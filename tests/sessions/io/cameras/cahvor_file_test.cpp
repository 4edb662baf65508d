// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/cahvor_file.h"

#include <algorithm>
#include <array>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/io/images/camera_of_file.h"
#include "tests/core/geometry/planetary_cameras.h"
#include "tests/sessions/io/folder_test.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

/// As calibration programs lay it out.
constexpr const char* kText = R"(# an invented camera

Model = CAHVORE3,0.37 = general

Dimensions = 1024 768

C =      1.030000     -0.170000     -0.710000
A =      0.600000      0.000000      0.800000
H =    307.200000    450.000000    409.600000   # a comment
V =   -129.600000      0.000000    577.200000
O =      0.600000      0.000000      0.800000
R =      0.000008     -0.013400     -0.007300
E =      0.001900      0.001600      0.001700

Hs    =    450.000000
Hc    =    512.000000
Vs    =    450.000000
Vc    =    384.000000
Theta =     -1.570796 (-90.000000 deg)
)";

class CahvorText : public FolderTest {
 protected:
  std::string error(const std::string& text) {
    return folder_.message([&] { (void)readCahvorCamera(folder_.write("a.cahvor", text)); });
  }
  static std::string with(const std::string& from, const std::string& to) {
    std::string text = kText;
    text.replace(text.find(from), from.size(), to);
    return text;
  }
};

TEST_F(CahvorText, Layout_IsReadAndScalesAndCentresAreWritten) {
  const CahvorFile read = readCahvorFile(folder_.write("a.cahvor", kText));
  EXPECT_EQ(std::tie(read.cahv.model, read.cahv.type, read.cahv.parameter),
            std::tuple(CameraModel::kCahvore, 3, 0.37));
  EXPECT_EQ(std::pair(read.width, read.height), std::pair(1024, 768));
  EXPECT_EQ(read.cahv.h_px, Eigen::Vector3d(307.2, 450.0, 409.6));
  EXPECT_EQ(read.cahv.e_m, Eigen::Vector3d(0.0019, 0.0016, 0.0017));
  EXPECT_EQ(read.covariance.size(), 0);
  const CameraFile camera = readCameraFile(folder_ / "a.cahvor");
  EXPECT_EQ(camera.camera.width, 1024);
  EXPECT_NEAR(camera.camera.cx, 512.0, 1e-12);
  EXPECT_NEAR(camera.camera.fx, 450.0, 1e-12);
  EXPECT_EQ(camera.reference->frame.name, "");
  // Scales, centres and the angle between the axes, known of a camera made from them.
  writeCahvorFile(folder_ / "b.cahvor", read);
  for (const char* line : {"Hs    = 450", "Hc    = 512", "Vs    = 450", "Theta = -1.57079632679"})
    EXPECT_THAT(folder_.read("b.cahvor"), HasSubstr(line));
}

TEST_F(CahvorText, EveryModel_RoundTrip_IsEqualToTheBit) {
  for (const test::PlanetaryCamera& camera : test::planetaryCameras()) {
    CahvorFile file{camera.cahv, camera.width, camera.height, {}, {}};
    const Eigen::Index size = vectorComponents(camera.cahv.model);
    const Eigen::MatrixXd root = Eigen::MatrixXd::Random(size, size);
    file.covariance = root.transpose() * root;
    file.covariance = (0.5 * (file.covariance + file.covariance.transpose())).eval();
    file.internal_covariance = file.covariance.topLeftCorner(5, 5);
    writeCahvorFile(folder_ / "b.cahvore", file);
    const CahvorFile again = readCahvorFile(folder_ / "b.cahvore");
    if (camera.cahv.model == CameraModel::kCahvore) {
      EXPECT_EQ(again.cahv, camera.cahv) << camera.name;
    }
    EXPECT_EQ(again.cahv.h_px, camera.cahv.h_px);
    EXPECT_EQ(again.cahv.v_px, camera.cahv.v_px);
    EXPECT_EQ(again.covariance, file.covariance) << camera.name;
    EXPECT_EQ(again.internal_covariance, file.internal_covariance);
    const CameraFile camera_file = readCahvorCamera(folder_ / "b.cahvore");
    for (const test::PlanetaryCamera::Sight& sight : camera.sights) {
      Eigen::Vector2d pixel;
      ASSERT_TRUE(project(camera_file.camera,
                          camera_file.reference->camera_from_reference * sight.point_m, pixel));
      EXPECT_LT((pixel - sight.pixel).norm(), 1e-9) << camera.name;
    }
  }
}

TEST_F(CahvorText, InternalCovariance_SetsTheCalibrationSigma) {
  const auto sigma = [this](const std::string& text) {
    return readCahvorCamera(folder_.write("a.cahvor", text)).calibration_sigma;
  };
  EXPECT_FALSE(sigma(kText));
  const std::string rest =
      " 0 0 0 0\n 0 0.25 0 0 0\n 0 0 0.0324 0 0\n 0 0 0 0.16 0\n 0 0 0 0 1e-9\n";
  const auto stated = sigma(kText + ("\nS internal =\n 0.0081" + rest));
  ASSERT_TRUE(stated);
  EXPECT_DOUBLE_EQ(stated->focal_relative.value(), 0.18 / 450.0) << "the worse of Hs and Vs";
  EXPECT_DOUBLE_EQ(stated->principal_point_px.value(), 0.5) << "the worse of Hc and Vc";
  std::string mirrored = kText;
  const std::string v = "-129.600000      0.000000    577.200000";
  mirrored.replace(mirrored.find(v), v.size(), "590.4 0 37.2");
  const auto of_mirrored = sigma(mirrored + "\nS internal =\n 0.0081" + rest);
  ASSERT_TRUE(of_mirrored);
  EXPECT_DOUBLE_EQ(of_mirrored->focal_relative.value(), 0.18 / 450.0) << "fy is negative";
  std::string zeros = "\nS internal =\n";
  for (int i = 0; i < 25; ++i) zeros += " 0";
  EXPECT_FALSE(sigma(kText + zeros + "\n")) << "it says nothing";
}

TEST_F(CahvorText, CameraFilesOfOtherPrograms_AreNamed) {
  for (const char* name : {"camera.yaml", "camera.YML", "camera.xml"})
    EXPECT_THAT(folder_.message([&] {
      (void)readCameraFile(folder_.write(name, std::string_view("%YAML:1.0\nfx: 9")));
    }),
                HasSubstr(": a camera is read from a camera.json, a .cahvor file or a labelled"));
}

TEST_F(CahvorText, ByteOrderMark_IsNotPartOfTheFirstKey) {
  const std::string text = kText;
  EXPECT_EQ(error("\xEF\xBB\xBF" + text.substr(text.find("Model"))), "(nothing)");
}

TEST_F(CahvorText, NamesWhatIsWrong) {
  EXPECT_EQ(error("hello"),
            "a.cahvor: not a camera file: it begins with 'hello' instead of Model = ...");
  EXPECT_EQ(error(with("Model =", "Lens =")), "a.cahvor: Model: is missing");
  for (const auto& [from, to, refusal] : std::vector<std::array<const char*, 3>>{
           {"CAHVORE3,0.37", "CAHVORE4", "Model: 'CAHVORE4' is not known"},
           {"CAHVORE3,0.37", "CAHVORE3,x", "is not known"},
           {"CAHVORE3,0.37", "FISH", "is not known"},
           {"E =", "F =", "a.cahvor: E: is missing"},
           {"E =", "C =", "a.cahvor: C: is given twice"},
           {"0.001900 ", "nan ", "a.cahvor: E: 'nan' is not a finite number"},
           {"0.001900 ", "0,0019 ", "E: '0,0019' is not a number: write a decimal point"},
           {"0.001900 ",
            "\xC2\xA0"
            "0.0019 ",
            "not a number: write its digits, sign and the blanks"},
           {"0.001900 ", "1e19 ", "a.cahvor: E: 1e19 is beyond 1e18"},
           {"0.001900 ", "", "a.cahvor: E: 3 numbers are needed, 2 given"},
           {"1024 768", "1024.5 768", "Dimensions: width and height"},
           {"1024 768", "0 768", "Dimensions: width and height"},
           {"A =      0.6", "A =      0.9", "A and O must have length 1"}})
    EXPECT_THAT(error(with(from, to)), HasSubstr(refusal)) << to;
  EXPECT_EQ(error(std::string(kText) + "S = 1 2 3\n"),
            "a.cahvor: S: 441 numbers are needed, 3 given");
  std::string skewed = std::string(kText) + "S internal =\n";
  for (int i = 0; i < 25; ++i) skewed += std::to_string(i) + " ";
  EXPECT_THAT(error(skewed + "\n"), HasSubstr("S internal: is not a covariance"));
}

TEST_F(CahvorText, LinesOfOldMacsAndNumbersOfFortran_AreRead) {
  std::string text = kText;
  std::ranges::replace(text, '\n', '\r');
  EXPECT_EQ(error(text), "(nothing)");
  EXPECT_EQ(error(kText + std::string("\x1a")), "(nothing)");
  const CahvorFile read =
      readCahvorFile(folder_.write("a.cahvor", with("0.001900      0.001600", "+.19D-02\t1.6d-3")));
  EXPECT_EQ(read.cahv.e_m, Eigen::Vector3d(0.0019, 0.0016, 0.0017));
}

/// A number that is cut within its digits shows by the missing end of its line alone.
TEST_F(CahvorText, LastLineWithoutEnd_IsRefused) {
  const std::string text = std::string(kText).substr(0, std::string(kText).find("\n\nHs") + 1);
  ASSERT_EQ(error(text), "(nothing)");
  for (const std::size_t cut : {1u, 2u, 4u})
    EXPECT_EQ(error(text.substr(0, text.size() - cut)),
              "a.cahvor: the last line has no line end: the file may be truncated; add the line "
              "end if it is whole");
}

}  // namespace
}  // namespace boresight::sessions
