// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_inputs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sessions/io/files/errors.h"
#include "sessions/text/text_table.h"
#include "tests/sessions/session/example_session.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

CaseFiles exampleFiles() { return test::filesOf(test::exampleFolder() / "os"); }

JudgedFile judgedOf(const JudgedFiles& judged, InputKind kind) {
  return judged[static_cast<std::size_t>(kind)];
}

TEST(JudgeFiles, GoodFiles_SayWhatTheyAre) {
  const JudgedFiles judged = judgeFiles(exampleFiles());
  for (const JudgedFile& file : judged) EXPECT_EQ(file.problem, "");
  const JudgedFile image = judgedOf(judged, InputKind::kImage);
  EXPECT_EQ(image.text, "1024 x 1024 px, 8 bit");
  ASSERT_TRUE(image.image);
  EXPECT_EQ(image.image->width, 1024);
  EXPECT_THAT(judgedOf(judged, InputKind::kCamera).text,
              AllOf(HasSubstr("1024 x 1024 px, "), HasSubstr(" deg")));
  const auto loaded = loadCase(makeCase(exampleFiles()).made);
  const Camera& camera = loaded->source.camera;
  const auto deg = [](double size_px, double focal_px) {
    return fixedText(2.0 * std::atan2(size_px / 2.0, focal_px) * 180.0 / std::numbers::pi, 1);
  };
  EXPECT_EQ(judgedOf(judged, InputKind::kCamera).text,
            "1024 x 1024 px, " + deg(1024.0, camera.fx) + " x " + deg(1024.0, camera.fy) + " deg");
  EXPECT_EQ(judgedOf(judged, InputKind::kMesh).text,
            std::to_string(loaded->scene.faces.size()) + " faces");
  EXPECT_EQ(judgedOf(judged, InputKind::kSeed).text,
            "station " +
                fixedText(loaded->source.camera_from_station_seed.translation_m.norm(), 2) +
                " m away");
}

TEST(JudgeFiles, BadFile_HasItsOwnProblemAndSparesTheOthers) {
  const test::TemporaryFolder folder;
  CaseFiles files = exampleFiles();
  files.image = folder.write("a.png", std::string_view("text"));
  files.parts.front().mesh = folder.write("m.ply", std::string_view("ply\nformat ascii 1.0\n"));
  const JudgedFiles judged = judgeFiles(files);
  EXPECT_NE(judgedOf(judged, InputKind::kImage).problem, "");
  EXPECT_NE(judgedOf(judged, InputKind::kMesh).problem, "");
  EXPECT_EQ(judgedOf(judged, InputKind::kCamera).problem, "");
  EXPECT_EQ(judgedOf(judged, InputKind::kSeed).problem, "");
}

TEST(JudgeFiles, FilesThatDoNotFit_AreNamed) {
  const test::TemporaryFolder folder;
  CaseFiles files = exampleFiles();
  writePng(folder / "s.png", std::vector<std::uint8_t>(640 * 480, 9), 640, 480, 1);
  files.image = folder / "s.png";
  EXPECT_EQ(judgedOf(judgeFiles(files), InputKind::kCamera).problem,
            "The camera is for 1024 x 1024 px, the image is 640 x 480 px.");
  files = exampleFiles();
  files.parts.front().mesh_unit = "mm";
  EXPECT_NE(judgedOf(judgeFiles(files), InputKind::kMesh).problem, "");
  files.parts.front().mesh_unit.clear();
  EXPECT_EQ(judgedOf(judgeFiles(files), InputKind::kMesh).problem, "") << "it is still asked for";
}

/// As the run's own checks say, and only then.
TEST(InputConcern, IsThatOfTheRun) {
  const auto refused = [](const SessionCase& session_case) {
    const auto loaded = loadCase(session_case);
    const auto concern = inputConcern(*loaded);
    if (!concern) {
      EXPECT_NO_THROW(requireRunnable(*loaded));
      return std::optional<InputKind>();
    }
    EXPECT_THROW(requireRunnable(*loaded), InputError);
    return std::optional(concern->kind);
  };
  const SessionCase good = makeCase(exampleFiles()).made;
  EXPECT_EQ(refused(good), std::nullopt);
  SessionCase bad = good;
  bad.camera.width = 1000;
  EXPECT_EQ(refused(bad), InputKind::kCamera);
  const std::filesystem::path& mesh = good.parts.front().source.mesh;
  EXPECT_EQ(refused(withInputFile(good, InputKind::kMesh, mesh, "mm")), InputKind::kMesh);
  bad = good;
  bad.camera_from_station_seed.translation_m.x() += 9.0;
  EXPECT_EQ(refused(bad), InputKind::kSeed);
}

TEST(WithInputFile, TakesTheFileInPlaceOfTheFormerOne) {
  const test::TemporaryFolder folder;
  const SessionCase os = makeCase(exampleFiles()).made;
  const std::filesystem::path bc = test::exampleFolder() / "bc";
  const SessionCase other_image = withInputFile(os, InputKind::kImage, bc / "image.png");
  EXPECT_EQ(other_image.image.source.file, bc / "image.png");
  EXPECT_NE(other_image.image.pixels_sha256, os.image.pixels_sha256);
  SessionCase with_levels = os;
  with_levels.image.eight_bit.levels = GrayLevels{10, 200};
  EXPECT_EQ(withInputFile(with_levels, InputKind::kImage, bc / "image.png").image.eight_bit,
            with_levels.image.eight_bit);
  EXPECT_EQ(withInputFile(os, InputKind::kMesh, bc / "model.ply", "m").parts.front().source.mesh,
            bc / "model.ply");
  SessionCase nudged = os;
  nudged.camera_from_station_working = Pose();
  nudged.has_seed = false;
  EXPECT_EQ(withInputFile(nudged, InputKind::kSeed, test::exampleFolder() / "os/seed.json"), os);
  EXPECT_EQ(withInputFile(os, InputKind::kCamera, test::exampleFolder() / "os/camera.json"), os);
  const std::filesystem::path mesh = os.parts.front().source.mesh;
  const SessionCase in_mm = withInputFile(os, InputKind::kMesh, mesh, "mm");
  EXPECT_EQ(withInputFile(in_mm, InputKind::kMesh, mesh, "m"), os);
  EXPECT_THROW(
      (void)withInputFile(os, InputKind::kCamera, folder.write("c.json", std::string_view("{"))),
      InputError);
}

/// A file takes seconds to read: what was edited meanwhile stays.
TEST(WithInput, ChangesThatInputAlone_UnlessItHasChangedMeanwhile) {
  const SessionCase os = makeCase(exampleFiles()).made;
  const std::filesystem::path bc = test::exampleFolder() / "bc";
  const SessionCase changed = withInputFile(os, InputKind::kMesh, bc / "model.ply", "m");
  SessionCase edited = os;
  edited.uncertainty.rotation_deg.z() = 90.0;
  edited.ignore_strokes.resize(1);
  const Session session = withCase({}, edited);
  const auto after = withInput(session, InputKind::kMesh, os, changed);
  ASSERT_TRUE(after);
  SessionCase expected = edited;
  expected.parts = changed.parts;
  EXPECT_EQ(*after->findCase(os.id), expected);
  const SessionCase in_mm = withInputFile(os, InputKind::kMesh, os.parts.front().source.mesh, "mm");
  EXPECT_FALSE(withInput(*after, InputKind::kMesh, os, in_mm)) << "another mesh is there by now";
  EXPECT_FALSE(withInput({}, InputKind::kMesh, os, changed)) << "and no case is added";
  SessionCase moved = os;
  moved.camera_from_station_working = Pose();
  const SessionCase reseeded =
      withInputFile(os, InputKind::kSeed, test::exampleFolder() / "os/seed.json");
  EXPECT_EQ(*withInput(withCase({}, moved), InputKind::kSeed, os, reseeded)->findCase(os.id), os);
}

}  // namespace
}  // namespace boresight::sessions
