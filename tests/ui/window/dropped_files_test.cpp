// SPDX-License-Identifier: Apache-2.0
#include "ui/window/session_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/example_case.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/vicar_image.h"

namespace boresight::ui {
namespace {

TEST(DroppedFiles, FourFilesMakeACase_AlsoInTwoDrops) {
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
  const DroppedFiles first = classify({folder / "image.png", folder / "model.ply"});
  EXPECT_FALSE(first.isCase());
  EXPECT_EQ(first.missing(), "a camera (json) and a seed pose (json)");
  EXPECT_TRUE(classify({folder / "camera.json", folder / "seed.json"}, first).isCase());
}

TEST(DroppedFiles, AnImageWithALabelBringsItsCamera) {
  const test::TemporaryFolder folder;
  CahvModel cahv;
  cahv.h_px = {900.0, 0.0, 7.5};
  cahv.v_px = {0.0, 900.0, 5.5};
  const std::vector<std::uint16_t> samples(16 * 12, 100);
  const auto image = folder.write(
      "sol12.img",
      test::vicarImage(16, 12, samples, test::vicarCamera(cahv, {"ROVER_FRAME", {1}})));
  const std::filesystem::path os = test::exampleFolder() / "os";
  const auto transform = folder.write("t.json", R"({"format": "boresight-transform"})");
  const DroppedFiles dropped = classify({image, os / "model.ply", os / "seed.json", transform});
  EXPECT_TRUE(dropped.problems.empty());
  EXPECT_TRUE(dropped.isCase());
  EXPECT_EQ(dropped.one.image, image);
  EXPECT_TRUE(dropped.one.camera.empty());
  ASSERT_EQ(dropped.one.transforms.size(), 1u);
  EXPECT_EQ(dropped.one.transforms[0], transform);

  const auto bare = folder.write("bare.vic", test::vicarImage(16, 12, samples, ""));
  const DroppedFiles without = classify({bare, os / "model.ply", os / "seed.json"});
  EXPECT_FALSE(without.isCase());
  EXPECT_EQ(without.missing().find("a camera (json): "), 0u) << without.missing();
  EXPECT_TRUE(classify({os / "camera.json"}, without).isCase());
  EXPECT_FALSE(classify({os / "image.png"}, dropped).isCase()) << "another image has no label";
}

TEST(DroppedFiles, AnotherImageWithItsFiles_StartsANewCase) {
  const std::filesystem::path bc = test::exampleFolder() / "bc", os = test::exampleFolder() / "os";
  const DroppedFiles failed =
      classify({bc / "image.png", bc / "camera.json", bc / "model.ply", bc / "seed.json"});
  EXPECT_TRUE(classify({os / "image.png", os / "seed.json"}).startsNewCase(failed));
  EXPECT_FALSE(classify({os / "image.png"}).startsNewCase(failed)) << "the image that was wrong";
  EXPECT_FALSE(classify({os / "camera.json", os / "seed.json"}).startsNewCase(failed));
  EXPECT_FALSE(classify({os / "image.png", os / "seed.json"}).startsNewCase({}));
  EXPECT_EQ(classify({os / "camera.json"}).keptNames(failed), "image.png, model.ply, seed.json");
  EXPECT_EQ(classify({os / "camera.json"}).keptNames({}), "");
}

TEST(DroppedFiles, ALabelWithoutItsPixelsIsAProblemAndNoImage) {
  const test::TemporaryFolder folder;
  const auto label = folder.write("det.lbl",
                                  "PDS_VERSION_ID = PDS3\r\n^IMAGE = (\"det.dat\", 1)\r\n"
                                  "OBJECT = IMAGE\r\nEND_OBJECT = IMAGE\r\nEND\r\n");
  const DroppedFiles dropped = classify({label, test::exampleFolder() / "os/model.ply"});
  ASSERT_EQ(dropped.problems.size(), 1u);
  EXPECT_THAT(dropped.problems[0],
              testing::HasSubstr("the file of its pixels, 'det.dat', is not in its folder"));
  EXPECT_EQ(dropped.missing(), "an image, a camera (json) and a seed pose (json)");
}

TEST(DroppedFiles, JsonIsToldByItsFormat_ResultsByTheirExtension) {
  const DroppedFiles dropped = classify({test::exampleFolder() / "dataset.json"});
  EXPECT_TRUE(dropped.dataset.has_value());
  EXPECT_FALSE(dropped.session.has_value());
  EXPECT_EQ(classify({"/data/Results.SQLite"}).results,
            std::filesystem::path("/data/Results.SQLite"));
}

TEST(DroppedFiles, UnknownFile_IsReportedByName) {
  const test::TemporaryFolder folder;
  const struct {
    const char* name;
    const char* text;
    const char* problem;
  } files[] = {{"odd.json", R"({"format": "boresight-points", "version": 1})", "odd.json"},
               {"broken.json", "{", "broken.json"},
               {"notes.txt", "hello", "notes.txt"},
               {"sol12.zip", "", "unpack it"},
               {"copied.json", R"({"fx": 1200.0})", "boresight-camera"}};
  std::vector<std::filesystem::path> paths;
  for (const auto& file : files)
    paths.push_back(folder.write(file.name, std::string_view(file.text)));
  const DroppedFiles dropped = classify(paths);
  ASSERT_EQ(dropped.problems.size(), std::size(files));
  for (std::size_t i = 0; i < std::size(files); ++i)
    EXPECT_THAT(dropped.problems[i], testing::HasSubstr(files[i].problem));
}

}  // namespace
}  // namespace boresight::ui
