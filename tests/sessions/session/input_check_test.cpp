// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/input_check.h"

#include <gtest/gtest.h>

#include <fstream>

#include "sessions/session/case_run.h"
#include "sessions/session/session_file.h"
#include "sessions/session/session_pack.h"
#include "tests/sessions/session/example_session.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using namespace sessions;

using testing::Field;

auto finding(FindingKind kind, const std::string& what, const std::string& text) {
  return AllOf(Field(&Finding::kind, kind), Field(&Finding::what, what),
               Field(&Finding::text, HasSubstr(text)));
}

TEST(InputCheck, ReportsWhatIsMissingOrChanged) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  const Session session = makeSession(stations / "dataset.json");
  EXPECT_THAT(checkInputs(session), IsEmpty());
  std::filesystem::remove(stations / "bc/image.png");
  std::ofstream(stations / "bc/model.ply", std::ios::app) << "\n";
  folder.write("stations/os/image.png", "");
  EXPECT_THAT(
      checkInputs(session),
      ElementsAre(finding(FindingKind::kMissing, "image", "image.png: no such file"),
                  finding(FindingKind::kChanged, "parts[0]", "differs from the session's file"),
                  finding(FindingKind::kUnreadable, "image", "the file is empty")));
  std::filesystem::copy(stations / "os/model.ply", stations / "bc/model.ply",
                        std::filesystem::copy_options::overwrite_existing);
  for (const auto& session_case : session.cases)
    EXPECT_NE(folder.message([&] { (void)loadCase(*session_case); }), "(nothing)");
}

/// Closing the window waited until every file was hashed.
TEST(InputCheck, Stop_LeavesOutTheFilesThatAreNotHashed) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  const Session session = makeSession(stations / "dataset.json");
  std::ofstream(stations / "bc/model.ply", std::ios::app) << "\n";
  std::filesystem::rename(stations / "os/image.png", stations / "os/moved.png");
  std::stop_source stopped;
  stopped.request_stop();
  EXPECT_THAT(checkInputs(session, stopped.get_token()), IsEmpty());
  EXPECT_THAT(findMissing(session, stations / "s.json", stopped.get_token()), IsEmpty());
  EXPECT_EQ(findMissing(session, stations / "s.json").size(), 1u);
}

TEST(InputCheck, Acceptance_SetsTheHashesOfTheFilesThatItReadAndNothingElse) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  const Session session = makeSession(stations / "dataset.json");
  const SessionCase before = *session.cases[0];
  std::ofstream(stations / "bc/model.ply", std::ios::app) << "\n";
  const SessionCase accepted = *acceptingInputs(session, before.id).findCase(before.id);
  ASSERT_NE(accepted.parts.front().sha256, before.parts.front().sha256);
  SessionCase edited = before;
  edited.uncertainty.rotation_deg.z() = 90.0;
  SessionCase expected = edited;
  expected.parts = accepted.parts;
  EXPECT_EQ(*withAccepted(withCase(session, edited), before, accepted).findCase(before.id),
            expected);
  SessionCase replaced = before;
  replaced.parts.front().source.mesh = stations / "os/model.ply";
  const Session other = withCase(session, replaced);
  EXPECT_EQ(*withAccepted(other, before, accepted).findCase(before.id), replaced);
}

TEST(InputCheck, ChangedInputs_AreLoadedOnlyAfterAcceptance) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  const Session session = makeSession(stations / "dataset.json");
  const SessionCase& bc = *session.cases[0];
  std::filesystem::copy(stations / "os/image.png", stations / "bc/image.png",
                        std::filesystem::copy_options::overwrite_existing);
  std::filesystem::copy(stations / "os/model.ply", stations / "bc/model.ply",
                        std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(folder.message([&] { (void)loadCase(bc); }),
              HasSubstr("bc/image.png: its bytes differ from those of the session"));
  const Session accepted = acceptingInputs(session, bc.id);
  EXPECT_THAT(checkInputs(accepted), IsEmpty());
  EXPECT_NO_THROW((void)loadCase(*accepted.cases[0]));
  EXPECT_NE(inputsDigest(*accepted.cases[0]), inputsDigest(bc));
  SessionCase half = bc;
  half.image = accepted.cases[0]->image;
  EXPECT_THAT(folder.message([&] { (void)loadCase(half); }),
              HasSubstr("bc/model.ply: its bytes differ from those"));
}

/// Frames are inputs like meshes: their files are looked for, hashed, accepted and packed.
TEST(InputCheck, FilesOfFrames_AreInputs) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  const std::filesystem::path arm = folder / "frames/arm.json";
  std::filesystem::create_directories(folder / "frames");
  std::filesystem::copy(exampleFolder() / "../frames/arm.json", arm);
  CaseFiles files = filesOf(stations / "bc");
  files.transforms = {arm};
  const Session session = withCase({}, makeCase(files).made);
  const std::filesystem::path file = folder / "s.boresight.json";
  writeSessionFile(file, session);
  EXPECT_THAT(folder.read("s.boresight.json"), HasSubstr("\"path\": \"frames/arm.json\""));
  const Session read = readSessionFile(file).session;
  EXPECT_TRUE(read == session);
  EXPECT_THAT(checkInputs(read), IsEmpty());

  std::filesystem::rename(arm, folder / "frames/moved.json");
  EXPECT_EQ(checkInputs(read).size(), 1u) << "three transforms of one file";
  EXPECT_THAT(findMissing(read, file), ElementsAre(Relink{arm, folder / "frames/moved.json"}));
  std::filesystem::rename(folder / "frames/moved.json", arm);
  writePack(planPack(read, file), folder / "s.zip");
  unpack(folder / "s.zip", folder / "there");
  const std::filesystem::path there = folder / "there/s.boresight/s.boresight.json";
  const Session unpacked = readSessionFile(there).session;
  EXPECT_THAT(checkInputs(unpacked), IsEmpty());
  EXPECT_TRUE(unpacked.cases[0]->frames[0].file.string().starts_with((folder / "there").string()));

  std::string text = folder.read("frames/arm.json");
  text.replace(text.find("0.39]"), 5, "0.41]");
  folder.write("frames/arm.json", text);
  EXPECT_THAT(checkInputs(read)[0],
              finding(FindingKind::kChanged, "frames[0]", "differs from the session's file"));
  const Session accepted = acceptingInputs(read, "bc");
  EXPECT_THAT(checkInputs(accepted), IsEmpty());
  EXPECT_EQ(accepted.cases[0]->camera_from_end_effector->translation_m.z(), 0.41);
  EXPECT_TRUE(withAccepted(read, *read.cases[0], *accepted.cases[0]) == accepted);
  const auto apart = [](SessionCase& item) {
    item.camera_from_end_effector->translation_m.z() = 0.2;
  };
  const Session own = withChanged(read, "bc", apart);
  EXPECT_EQ(acceptingInputs(own, "bc").cases[0]->camera_from_end_effector->translation_m.z(), 0.2)
      << "stated apart from the frames";
  EXPECT_EQ(*withAccepted(own, *read.cases[0], *accepted.cases[0]).findCase("bc"),
            *acceptingInputs(own, "bc").findCase("bc"));
  text.replace(text.find("END_EFFECTOR"), 12, "WRIST");
  folder.write("frames/arm.json", text);
  EXPECT_THAT(folder.message([&] { (void)acceptingInputs(read, "bc"); }),
              HasSubstr("no longer joins ARM_BASE and END_EFFECTOR"));
}

TEST(ReadKnownScene, ChangedOrMissingFileOfFrames_IsRefused) {
  const TemporaryFolder folder;
  SessionCase session_case = makeCase(filesOf(copyOfExamples(folder) / "bc")).made;
  std::filesystem::copy(exampleFolder() / "../frames/arm.json", folder / "arm.json");
  session_case.frames = readFrameTransforms(folder / "arm.json");
  EXPECT_NO_THROW((void)loadCase(session_case));
  folder.write("arm.json", folder.read("arm.json") + "\n");
  EXPECT_THAT(folder.message([&] { (void)loadCase(session_case); }),
              testing::StartsWith("arm.json: its bytes differ from those of the session"));
  std::filesystem::remove(folder / "arm.json");
  EXPECT_EQ(folder.message([&] { (void)loadCase(session_case); }), "arm.json: no such file");
}

/// Sessions of version 1.0 name the files of frames without their folders.
TEST(InputCheck, FramesWithoutAFolder_AreNotLookedFor) {
  const TemporaryFolder folder;
  Session session = withCase({}, makeCase(filesOf(copyOfExamples(folder) / "bc")).made);
  session = withChanged(session, "bc", [](SessionCase& session_case) {
    session_case.frames = {shifted(kCameraFrame, kEndEffectorFrame, 0.1)};
    session_case.frames[0].file = "t.json";
    session_case.frames[0].file_sha256 = std::string(64, 'a');
  });
  writeSessionFile(folder / "s.json", session);
  const Session read = readSessionFile(folder / "s.json").session;
  EXPECT_TRUE(read == session);
  EXPECT_THAT(checkInputs(read), IsEmpty());
}

TEST(InputCheck, FindsMovedFilesByNameAndHash) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  const Session session = makeSession(stations / "dataset.json");
  // The session lies elsewhere now, its inputs partly in other folders, next to a different file of
  // the same name.
  const std::filesystem::path other = folder / "other";
  std::filesystem::create_directories(other / "deep/er");
  std::filesystem::rename(stations / "bc", other / "deep/er/bc");
  std::filesystem::create_directories(other / "os");
  std::filesystem::rename(stations / "os/image.png", other / "os/image.png");
  std::filesystem::rename(stations / "os/model.ply", folder / "unreachable.ply");
  folder.write("other/bc/image.png", "false friend");
  const auto relinks = findMissing(session, other / "s.json");
  const Session found = relinked(session, relinks);
  EXPECT_EQ(found.cases[0]->image.source.file, other / "deep/er/bc/image.png");
  EXPECT_EQ(found.cases[0]->parts[0].source.mesh, other / "deep/er/bc/model.ply");
  EXPECT_EQ(found.cases[1]->image.source.file, other / "os/image.png");
  EXPECT_THAT(checkInputs(found),
              ElementsAre(finding(FindingKind::kMissing, "parts[0]", "model.ply: no such file")));
}

/// The pixels of the example's picture as they are, and a PDS3 label next to them.
class LabelledImage : public ::testing::Test {
 protected:
  LabelledImage() {
    folder_.write("in/sol12.img", osExample().image.pixels);
    label_ = folder_.write("in/sol12.lbl", labelText("A"));
    CaseFiles files = filesOf(exampleFolder() / "os");
    files.image = label_;
    one_ = makeCase(files).made;
    digest_ = makeCase(filesOf(exampleFolder() / "os")).made.image.pixels_sha256;
  }
  static std::string labelText(const std::string& product) {
    return "PDS_VERSION_ID = PDS3\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = 1024\r\n"
           "FILE_RECORDS = 1024\r\n^IMAGE = (\"sol12.img\", 1)\r\nPRODUCT_ID = \"" +
           product +
           "\"\r\nOBJECT = IMAGE\r\n  LINES = 1024\r\n  LINE_SAMPLES = 1024\r\n  BANDS = 1\r\n"
           "  SAMPLE_TYPE = UNSIGNED_INTEGER\r\n  SAMPLE_BITS = 8\r\nEND_OBJECT = IMAGE\r\n"
           "END\r\n";
  }
  Session session() const { return withCase({}, one_); }
  TemporaryFolder folder_;
  std::filesystem::path label_;
  SessionCase one_;
  std::string digest_;
};

TEST_F(LabelledImage, IsTheSamePictureWithWhatItsLabelSaysUntilItsPixelsChange) {
  EXPECT_EQ(one_.image.pixels_sha256, digest_);
  EXPECT_THAT(one_.image.label, Contains(LabelItem{"PRODUCT_ID", "A"}));
  EXPECT_THAT(checkInputs(session()), IsEmpty());
  std::string pixels = folder_.read("in/sol12.img");
  pixels[12345] ^= 1;
  folder_.write("in/sol12.img", pixels);
  EXPECT_THAT(checkInputs(session()), SizeIs(1));
  EXPECT_THAT(folder_.message([&] { (void)planPack(session(), folder_ / "s.boresight.json"); }),
              HasSubstr("it differs from the session's file"));
}

/// Whichever of the two files the session names, the other is named too.
TEST_F(LabelledImage, NamesBothFilesWhereOneHasChanged) {
  const auto load = [this] { (void)loadCase(one_); };
  const std::string both[][2] = {{"sol12.lbl", "its pixels sol12.img"},
                                 {"sol12.img", "its label sol12.lbl"}};
  for (const auto& [named, other] : both) {
    folder_.write("in/sol12.lbl", labelText("A"));
    one_.image.source.file = folder_ / ("in/" + named);
    EXPECT_EQ(folder_.message(load), "(nothing)");
    folder_.write("in/sol12.lbl", labelText("B"));
    EXPECT_THAT(folder_.message(load), HasSubstr(named + ": its bytes or " + other + " differ"));
    EXPECT_THAT(checkInputs(session()),
                ElementsAre(Field(&Finding::text, HasSubstr(named + ", or " + other +
                                                            ", differs from the session's file"))));
  }
}

TEST_F(LabelledImage, MissingLabel_IsReported) {
  one_.image.source.file = folder_ / "in/sol12.img";
  std::filesystem::remove(label_);
  const std::string wanted =
      "former label is missing: put sol12.lbl (or sol12.xml) back next to it";
  EXPECT_THAT(folder_.message([this] { (void)loadCase(one_); }), HasSubstr(wanted));
  EXPECT_THAT(checkInputs(session()),
              ElementsAre(finding(FindingKind::kUnreadable, "image", wanted)));
}

TEST_F(LabelledImage, IsPackedWithItsPixels) {
  const auto plan = planPack(session(), folder_ / "s.boresight.json");
  EXPECT_THAT(plan.notes, IsEmpty());
  writePack(plan, folder_ / "s.zip");
  std::filesystem::remove_all(folder_ / "in");
  unpack(folder_ / "s.zip", folder_ / "there");
  const Session again = readSessionFile(folder_ / "there/s.boresight/s.boresight.json").session;
  EXPECT_THAT(checkInputs(again), IsEmpty());
  EXPECT_EQ(readImage(again.cases[0]->image.source.file).pixels_sha256, digest_);
}

TEST(InputCheck, LostTracesOfRuns_AreFoundInTheFolderOfRuns) {
  const TemporaryFolder folder;
  Session session = makeSession(copyOfExamples(folder) / "dataset.json");
  RunRecord run;
  run.case_id = session.cases[0]->id;
  run.digest = std::string(64, 'd');
  run.file = "/elsewhere/s.runs/d.trace";
  session.runs.push_back(run);
  EXPECT_THAT(checkInputs(session),
              ElementsAre(finding(FindingKind::kMissing, "run", "trace of a run is missing")));
  EXPECT_THAT(findMissing(session, folder / "s.json"), IsEmpty());
  const auto moved = folder.write("s.runs/d.trace", "a trace");
  const auto relinks = findMissing(session, folder / "s.json");
  EXPECT_THAT(relinks, ElementsAre(Relink{run.file, moved}));
  const Session found = relinked(session, relinks);
  EXPECT_EQ(found.runs[0].file, moved);
  EXPECT_THAT(checkInputs(found), IsEmpty());
  EXPECT_THAT(findMissing(found, folder / "s.json"), IsEmpty());
}

TEST(InputCheck, AcceptedParts_AreThoseOfTheSameFileAndHash) {
  const TemporaryFolder folder;
  const Session session = makeSession(copyOfExamples(folder) / "dataset.json");
  SessionCase before = *session.cases[0];
  before.parts.push_back(before.parts[0]);
  before.parts.push_back(before.parts[0]);
  SessionCase accepted = before;
  for (MeshInput& part : accepted.parts) part.sha256 = std::string(64, 'e');
  accepted.image.source.sha256 = std::string(64, 'f');
  accepted.ignore = InputFile{"/mask.png", std::string(64, 'e')};
  accepted.onboard_record = InputFile{"/r.whsr", std::string(64, 'e')};
  SessionCase now = before;
  now.parts[0].sha256 = std::string(64, 'a');  // accepted meanwhile
  now.parts[2].source.mesh = "/another.ply";
  now.image.eight_bit.bit_depth = 7;
  SessionCase expected = now;
  expected.parts[1].sha256 = std::string(64, 'e');
  expected.ignore = accepted.ignore;
  expected.onboard_record = accepted.onboard_record;
  EXPECT_EQ(*withAccepted(withCase(session, now), before, accepted).findCase(before.id), expected);
  now.frames = {shifted(kCameraFrame, kEndEffectorFrame, 0.1)};  // stated meanwhile
  expected.frames = now.frames;
  EXPECT_EQ(*withAccepted(withCase(session, now), before, accepted).findCase(before.id), expected);
  now.parts.pop_back();
  now.ignore = InputFile{"/own.png", std::string(64, 'b')};
  now.onboard_record = InputFile{"/own.whsr", std::string(64, 'b')};
  expected = now;
  expected.parts[1].sha256 = std::string(64, 'e');
  EXPECT_EQ(*withAccepted(withCase(session, now), before, accepted).findCase(before.id), expected);
}

TEST(InputCheck, Conversions_AreTakenWhereTheImageIsStillTheSame) {
  const TemporaryFolder folder;
  const Session session = makeSession(copyOfExamples(folder) / "dataset.json");
  const SessionCase& first = *session.cases[0];
  ImageReadOptions levels;
  levels.bit_depth = 8;
  levels.levels = GrayLevels{10, 200};
  const ImageInput image = converted(first.image, levels);
  EXPECT_EQ(image.eight_bit, levels);
  EXPECT_EQ(image.source, first.image.source);
  EXPECT_NE(image.pixels_sha256, first.image.pixels_sha256);
  const Session next = withConversions(session, {{first.id, image}});
  EXPECT_EQ(next.cases[0]->image, image);
  EXPECT_NO_THROW((void)loadCase(*next.cases[0]));
  Session replaced = withChanged(session, first.id, [](SessionCase& item) {
    item.image.source.sha256 = std::string(64, 'a');
  });
  EXPECT_EQ(withConversions(replaced, {{first.id, image}}), replaced);
}

TEST(InputCheck, SameMissingFileOfTwoCases_IsSearchedOnceAndReportedForBoth) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  Session session = makeSession(stations / "dataset.json");
  SessionCase twin = *session.cases[0];
  twin.id = "twin";
  session = withCase(session, twin);
  std::filesystem::rename(stations / "bc/model.ply", stations / "bc/renamed.ply");
  EXPECT_EQ(checkInputs(session).size(), 2u);
  EXPECT_THAT(findMissing(session, folder / "s.json"),
              ElementsAre(Relink{stations / "bc/model.ply", stations / "bc/renamed.ply"}));
}

}  // namespace
}  // namespace boresight::test
