// SPDX-License-Identifier: Apache-2.0
#include "ui/window/dropped_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/example_case.h"
#include "tests/support/temporary_folder.h"

namespace boresight::ui {
namespace {

TEST(DroppedFiles, FourFilesMakeACase) {
  const std::filesystem::path folder = test::exampleFolder() / "bc";
  const DroppedFiles dropped =
      classify({folder / "model.ply", folder / "seed.json", folder / "image.png",
                folder / "camera.json", folder / "truth.json"});
  EXPECT_TRUE(dropped.problems.empty());
  EXPECT_TRUE(dropped.isCase());
  EXPECT_EQ(dropped.missing(), "");
  EXPECT_EQ(dropped.one.image, folder / "image.png");
  EXPECT_EQ(dropped.one.camera, folder / "camera.json");
  EXPECT_EQ(dropped.one.seed, folder / "seed.json");
  EXPECT_EQ(dropped.one.truth, folder / "truth.json");
  ASSERT_EQ(dropped.one.parts.size(), 1u);
  EXPECT_EQ(dropped.one.parts[0].mesh, folder / "model.ply");
}

TEST(DroppedFiles, ALaterDropCompletesAnEarlierOne) {
  const std::filesystem::path folder = test::exampleFolder() / "bc";
  const DroppedFiles first = classify({folder / "image.png", folder / "model.ply"});
  EXPECT_FALSE(first.isCase());
  EXPECT_EQ(first.missing(), "a camera (json) and a seed pose (json)");
  const DroppedFiles second = classify({folder / "camera.json", folder / "seed.json"}, first);
  EXPECT_TRUE(second.isCase());
}

TEST(DroppedFiles, JsonIsToldByItsFormat) {
  const DroppedFiles dropped = classify({test::exampleFolder() / "dataset.json"});
  EXPECT_TRUE(dropped.dataset.has_value());
  EXPECT_FALSE(dropped.session.has_value());
}

TEST(DroppedFiles, ResultsAreToldByTheirExtension) {
  EXPECT_EQ(classify({"/data/Results.SQLite"}).results,
            std::filesystem::path("/data/Results.SQLite"));
}

TEST(DroppedFiles, WhatIsNothingKnownIsToldByName) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "odd.json") << R"({"format": "boresight-points", "version": 1})";
  std::ofstream(folder.path() / "broken.json") << "{";
  std::ofstream(folder.path() / "notes.txt") << "hello";
  const DroppedFiles dropped = classify(
      {folder.path() / "odd.json", folder.path() / "broken.json", folder.path() / "notes.txt"});
  ASSERT_EQ(dropped.problems.size(), 3u);
  EXPECT_NE(dropped.problems[0].find("odd.json"), std::string::npos);
  EXPECT_NE(dropped.problems[1].find("broken.json"), std::string::npos);
  EXPECT_NE(dropped.problems[2].find("notes.txt"), std::string::npos);
}

}  // namespace
}  // namespace boresight::ui
