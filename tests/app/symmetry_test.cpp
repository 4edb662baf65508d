// SPDX-License-Identifier: Apache-2.0
// A can and a box from new to verify, with and without their declared symmetries.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/images/image_file.h"
#include "sessions/session/session_file.h"
#include "tests/app/run_whs.h"
#include "tests/core/localizer/scene.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

/// A symmetric object before a small camera.
struct Object {
  Solid solid;
  Pose camera_from_station;
  Pose equivalent;             ///< station_from_station: the truth is given as another such pose
  Eigen::Vector3d turned_deg;  ///< uncertainty of the seed
  std::vector<std::string> symmetries;
};

Pose turned(const Eigen::Vector3d& turn_rad) {
  return {rotationExp(turn_rad), Eigen::Vector3d::Zero()};
}

Object can() {
  Object object;
  constexpr int kSides = 60;  // between which no edge is salient
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < kSides; ++i)
    outline.push_back(0.033 * Eigen::Vector2d(std::cos(2.0 * kPi * i / kSides),
                                              std::sin(2.0 * kPi * i / kSides)));
  object.solid.addPrism(outline, -0.05, 0.05, 0.6);
  object.camera_from_station = tiltedPose({0.9, 0.25, 0.1}, {0.004, -0.003, 0.32});
  object.equivalent = turned(1.9 * Eigen::Vector3d::UnitZ());
  object.turned_deg = {10.0, 10.0, 10.0};
  object.symmetries = {"z", "x 180"};
  return object;
}

Object box() {
  Object object;
  object.solid.addBox(0.0, 0.0, 0.045, 0.028, 0.0, -0.018, 0.018, 0.6);
  object.camera_from_station = tiltedPose({0.55, -0.35, 0.2}, {0.004, -0.003, 0.3});
  object.equivalent = turned(kPi * Eigen::Vector3d::UnitZ());
  object.turned_deg = {15.0, 15.0, 180.0};
  object.symmetries = {"x 180; y 180; z 180"};
  return object;
}

Camera smallCamera() {
  Camera camera;
  camera.width = 160;
  camera.height = 120;
  camera.fx = camera.fy = 220.0;
  camera.cx = 79.5;
  camera.cy = 59.5;
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

std::string plyText(const Solid& solid) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex " + std::to_string(solid.vertices.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
      std::to_string(solid.faces.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Eigen::Vector3f& vertex : solid.vertices)
    text += std::to_string(vertex.x()) + " " + std::to_string(vertex.y()) + " " +
            std::to_string(vertex.z()) + "\n";
  for (const Face& face : solid.faces)
    text += "3 " + std::to_string(face.vertex[0]) + " " + std::to_string(face.vertex[1]) + " " +
            std::to_string(face.vertex[2]) + "\n";
  return text;
}

class SymmetricObject : public ::testing::TestWithParam<Object (*)()> {
 protected:
  SymmetricObject() {
    const Camera camera = smallCamera();
    const Picture picture = takePicture(object_.solid, camera, object_.camera_from_station);
    sessions::writePng(folder_ / "image.png", picture.gray, picture.width, picture.height, 1);
    sessions::CameraFile file;
    file.camera = camera;
    file.calibration_sigma = sessions::StatedCalibration{1e-3, 0.2};
    sessions::writeCamera(folder_ / "camera.json", file);
    folder_.write("model.ply", plyText(object_.solid));
    sessions::DeclaredUncertainty uncertainty;
    uncertainty.translation_m.setConstant(0.02);
    uncertainty.rotation_deg = object_.turned_deg;
    uncertainty.pivot = sessions::UncertaintyPivot::kStation;
    Pose seed = object_.camera_from_station;
    seed.translation_m += Eigen::Vector3d(0.004, -0.003, 0.006);
    sessions::writePose(folder_ / "seed.json", seed, uncertainty);
    sessions::writePose(folder_ / "truth.json", object_.camera_from_station * object_.equivalent);
    Arguments arguments = {"new",
                           "--image",
                           folder_ / "image.png",
                           "--camera",
                           folder_ / "camera.json",
                           "--mesh",
                           folder_ / "model.ply",
                           "--mesh-unit",
                           "m",
                           "--seed",
                           folder_ / "seed.json",
                           "--truth",
                           folder_ / "truth.json",
                           "--requirement",
                           "6",
                           "4",
                           "2",
                           "--out",
                           session_};
    for (const std::string& text : object_.symmetries)
      arguments.insert(arguments.end(), {"--symmetry", text});
    runWhs(arguments, 0);
    runWhs({"run", session_}, 0);
  }

  const TemporaryFolder folder_;
  const Object object_ = GetParam()();
  const std::string session_ = folder_ / "s.boresight.json";
};

TEST_P(SymmetricObject, WithItsSymmetries_PassesAllChecksAndIsHandedOver) {
  const ProgramRun checked = runWhs({"check", session_}, 0);
  EXPECT_THAT(checked.out,
              AllOf(HasSubstr("pass  Convergence from other seeds"),
                    HasSubstr("pass  Agreement with the truth"), Not(HasSubstr("FAIL"))));
  runWhs({"decide", session_, "--case", "image", "--validate", "--by", "Ada", "--comment", "right"},
         0);
  const std::string pose = folder_ / "pose.json";
  runWhs({"export", session_, "--case", "image", "--pose", pose}, 0);
  runWhs({"verify", pose}, 0);
  EXPECT_THAT(runWhs({"info", session_}, 0).out, HasSubstr("symmetries"));
}

TEST_P(SymmetricObject, WithoutADeclaration_FailsTheNamedChecks) {
  sessions::Session session = sessions::readSessionFile(session_).session;
  session = withChanged(session, "image", [](auto& changed) { changed.symmetries = {}; });
  sessions::writeSessionFile(session_, session);
  const ProgramRun checked = runWhs({"check", session_}, 4);
  const auto fails = [&checked](const std::string& title) {
    return checked.out.find("FAIL  " + title) != std::string::npos;
  };
  const bool is_can = object_.symmetries.front() == "z";
  EXPECT_TRUE(fails("Agreement with the truth")) << checked.out;
  EXPECT_EQ(fails("Convergence from other seeds"), is_can) << checked.out;
  EXPECT_EQ(fails("Edge-coverage sensitivity"), is_can) << checked.out;
}

TEST_P(SymmetricObject, TurnThatMovesTheStation_IsRefusedAndNotStated) {
  const std::string before = runWhs({"info", session_}, 0).out;
  const ProgramRun refused = runWhs({"run", session_, "--symmetry", "z at 0 100 0"}, 3);
  EXPECT_THAT(refused.err, HasSubstr("state a point on the axis, in m"));
  EXPECT_EQ(runWhs({"info", session_}, 0).out, before);
}

INSTANTIATE_TEST_SUITE_P(Objects, SymmetricObject, ::testing::Values(&can, &box),
                         [](const auto& info) { return info.index == 0 ? "Can" : "Box"; });

}  // namespace
}  // namespace boresight::test
