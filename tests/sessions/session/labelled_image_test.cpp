// SPDX-License-Identifier: Apache-2.0
// A session of an image whose label is a file of its own: the two belong together.
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/session/input_check.h"
#include "sessions/session/session_file.h"
#include "sessions/session/session_pack.h"
#include "tests/sessions/session/example_session.h"

namespace boresight::test {
namespace {

using sessions::Session;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// The pixels of the example's picture as they are, and a PDS3 label beside them.
class LabelledImage : public ::testing::Test {
 protected:
  LabelledImage() {
    const ExampleCase example("os");
    folder_.write("in/sol12.img", example.image.pixels);
    label_ = folder_.write("in/sol12.lbl", labelText("A"));
    sessions::CaseFiles files = filesOf(exampleFolder() / "os");
    files.image = label_;
    one_ = sessions::makeCase(files).made;
    digest_ = sessions::makeCase(filesOf(exampleFolder() / "os")).made.image.pixels_sha256;
  }
  static std::string labelText(const std::string& product) {
    return "PDS_VERSION_ID = PDS3\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = 1024\r\n"
           "FILE_RECORDS = 1024\r\n^IMAGE = (\"sol12.img\", 1)\r\nPRODUCT_ID = \"" +
           product +
           "\"\r\nOBJECT = IMAGE\r\n  LINES = 1024\r\n  LINE_SAMPLES = 1024\r\n  BANDS = 1\r\n"
           "  SAMPLE_TYPE = UNSIGNED_INTEGER\r\n  SAMPLE_BITS = 8\r\nEND_OBJECT = IMAGE\r\n"
           "END\r\n";
  }
  Session session() const {
    Session made;
    made.cases.push_back(one_);
    return made;
  }
  TemporaryFolder folder_;
  std::filesystem::path label_;
  sessions::SessionCase one_;
  std::string digest_;
};

TEST_F(LabelledImage, IsTheSamePictureWithWhatItsLabelSays) {
  EXPECT_EQ(one_.image.pixels_sha256, digest_);
  EXPECT_THAT(one_.image.label, ::testing::Contains(sessions::LabelItem{"PRODUCT_ID", "A"}));
  EXPECT_THAT(sessions::checkInputs(session()), IsEmpty());
}

TEST_F(LabelledImage, HasChangedWhenEitherFileHas) {
  folder_.write("in/sol12.lbl", labelText("B"));
  EXPECT_THAT(sessions::checkInputs(session()), SizeIs(1));
  folder_.write("in/sol12.lbl", labelText("A"));
  EXPECT_THAT(sessions::checkInputs(session()), IsEmpty());
  std::string pixels = folder_.read("in/sol12.img");
  pixels[12345] ^= 1;
  folder_.write("in/sol12.img", pixels);
  EXPECT_THAT(sessions::checkInputs(session()), SizeIs(1));
  EXPECT_THAT(
      folder_.message([&] { (void)sessions::planPack(session(), folder_ / "s.boresight.json"); }),
      HasSubstr("it is not the file that the session was made with"));
}

/// Whichever of the two files the session names, the other is named too.
TEST_F(LabelledImage, NamesBothFilesWhereOneHasChanged) {
  const auto load = [this] { (void)sessions::loadCase(one_); };
  folder_.write("in/sol12.lbl", labelText("B"));
  EXPECT_THAT(folder_.message(load), HasSubstr("sol12.lbl: its bytes or its pixels sol12.img are"));
  EXPECT_THAT(sessions::checkInputs(session())[0].text,
              HasSubstr("sol12.lbl, or its pixels sol12.img, is not the file"));
  folder_.write("in/sol12.lbl", labelText("A"));
  one_.image.source.file = folder_ / "in/sol12.img";
  EXPECT_EQ(folder_.message(load), "(nothing)");
  folder_.write("in/sol12.lbl", labelText("B"));
  EXPECT_THAT(folder_.message(load), HasSubstr("sol12.img: its bytes or its label sol12.lbl are"));
  EXPECT_THAT(sessions::checkInputs(session())[0].text,
              HasSubstr("sol12.img, or its label sol12.lbl, is not the file"));
}

TEST_F(LabelledImage, SaysThatItIsTheLabelThatIsGone) {
  one_.image.source.file = folder_ / "in/sol12.img";
  std::filesystem::remove(label_);
  const std::string wanted = "no longer there: put sol12.lbl (or sol12.xml) back beside it";
  EXPECT_THAT(folder_.message([this] { (void)sessions::loadCase(one_); }), HasSubstr(wanted));
  const auto findings = sessions::checkInputs(session());
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_EQ(findings[0].kind, sessions::FindingKind::kUnreadable);
  EXPECT_THAT(findings[0].text, HasSubstr(wanted));
}

TEST_F(LabelledImage, IsPackedWithItsPixels) {
  const auto plan = sessions::planPack(session(), folder_ / "s.boresight.json");
  EXPECT_THAT(plan.notes, IsEmpty());
  writePack(plan, folder_ / "s.zip");
  std::filesystem::remove_all(folder_ / "in");
  std::filesystem::create_directories(folder_ / "there");
  const std::string command = "cd '" + (folder_ / "there").string() +
                              "' && '" BORESIGHT_CMAKE "' -E tar xf '" +
                              (folder_ / "s.zip").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const Session again =
      sessions::readSessionFile(folder_ / "there/s.boresight/s.boresight.json").session;
  EXPECT_THAT(sessions::checkInputs(again), IsEmpty());
  EXPECT_EQ(sessions::readImage(again.cases[0]->image.source.file).pixels_sha256, digest_);
}

}  // namespace
}  // namespace boresight::test
