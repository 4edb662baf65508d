// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "sessions/session/session_maker.h"
#include "tests/support/example_case.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {

/// A copy of the example's stations that a test may spoil.
inline std::filesystem::path copyOfExamples(const TemporaryFolder& folder) {
  std::filesystem::copy(exampleFolder(), folder / "stations",
                        std::filesystem::copy_options::recursive);
  return folder / "stations";
}

/// Unpacks a zip with another program than the one that packed it.
inline void unpack(const std::filesystem::path& archive, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const std::string command =
      "cd '" + folder.string() + "' && '" BORESIGHT_CMAKE "' -E tar xf '" + archive.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
}

/// A transform by a shift along x, stated in a file.
inline sessions::FrameTransform shifted(const sessions::FrameName& target,
                                        const sessions::FrameName& source, double x_m) {
  sessions::FrameTransform transform;
  transform.target = target;
  transform.source = source;
  transform.target_from_source.translation_m = {x_m, 0.0, 0.0};
  transform.comment = "by hand";
  transform.file = "/folder/t.json";
  return transform;
}

/// The files of one station.
inline sessions::CaseFiles filesOf(const std::filesystem::path& station) {
  sessions::CaseFiles files;
  files.id = station.filename().string();
  files.image = station / "image.png";
  files.camera = station / "camera.json";
  files.parts.resize(1);
  files.parts[0].mesh = station / "model.ply";
  files.parts[0].mesh_unit = "m";
  files.seed = station / "seed.json";
  files.truth = station / "truth.json";
  return files;
}

}  // namespace boresight::test
