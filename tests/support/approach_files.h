// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/session/session_maker.h"
#include "tests/support/generated_approach.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {

inline constexpr int kApproachFrames = 6;

inline std::string plyOf(const Solid& solid) {
  std::ostringstream ply;
  ply.precision(9);
  ply << "ply\nformat ascii 1.0\nelement vertex " << solid.vertices.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
      << solid.faces.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Eigen::Vector3f& vertex : solid.vertices)
    ply << vertex.x() << " " << vertex.y() << " " << vertex.z() << "\n";
  for (const Face& face : solid.faces)
    ply << "3 " << face.vertex[0] << " " << face.vertex[1] << " " << face.vertex[2] << "\n";
  return ply.str();
}

/// Six frames of an approach in files, made once.
inline const TemporaryFolder& approachFolder() {
  static const TemporaryFolder folder;
  static const bool made = [] {
    const GeneratedApproach approach(24);
    folder.write("model.ply", plyOf(approach.solid()));
    nlohmann::ordered_json camera = {{"format", "boresight-camera"}, {"version", 1}};
    camera.update(sessions::toJson(approach.camera()));
    folder.write("camera.json", camera.dump());
    Pose seed = approach.camera_from_station(0);
    seed.translation_m += Eigen::Vector3d(0.01, -0.008, 0.006);
    sessions::DeclaredUncertainty uncertainty;
    uncertainty.translation_m.setConstant(0.02);
    uncertainty.rotation_deg.setConstant(4.0);
    uncertainty.pivot = sessions::UncertaintyPivot::kStation;
    sessions::writePose(folder / "seed.json", seed, uncertainty);
    std::filesystem::create_directory(folder / "frames");
    for (int i = 0; i < kApproachFrames; ++i) {
      const sessions::GrayImage image = approach.image(i);
      sessions::writePng(folder / ("frames/" + std::to_string(i) + ".png"), image.pixels,
                         image.width, image.height, 1);
    }
    return true;
  }();
  (void)made;
  return folder;
}

/// The approach's case; its own image is the first frame.
inline sessions::CaseFiles approachFiles() {
  const TemporaryFolder& folder = approachFolder();
  sessions::CaseFiles files;
  files.image = folder / "frames/0.png";
  files.camera = folder / "camera.json";
  files.parts.emplace_back().mesh = folder / "model.ply";
  files.parts.front().mesh_unit = "m";
  files.seed = folder / "seed.json";
  return files;
}

}  // namespace boresight::test
