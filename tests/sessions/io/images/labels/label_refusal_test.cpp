// SPDX-License-Identifier: Apache-2.0
// Images with labels that are refused: one sentence each, and never a crash.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "sessions/io/images/image_file.h"
#include "sessions/io/images/labels/label_samples.h"
#include "tests/sessions/io/images/labels/label_fixture.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

/// A text of a file in place of another one, and a part of the refusal.
struct Alteration {
  std::string from, to, refusal;
};

class LabelRefusal : public LabelTest {
 protected:
  /// The refusal of a file: one line, and nothing is printed.
  std::string refusal(const std::string& name, const std::string& content) const {
    testing::internal::CaptureStderr();
    const std::string text = LabelTest::refusal(folder_.write(name, content));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_THAT(text, Not(testing::AnyOf(HasSubstr("\n"), HasSubstr("vsimem"))));
    return text;
  }
  std::string refusal(const VicarFile& vicar, const Raster& raster) const {
    return refusal("x.vic", textOf(vicar.bytes(raster)));
  }
  void expectRefused(const std::string& name, const std::string& whole,
                     const std::vector<Alteration>& alterations) const {
    ASSERT_EQ(refusal(name, whole), "(nothing)");
    for (const Alteration& each : alterations)
      EXPECT_THAT(refusal(name, altered(whole, each.from, each.to)),
                  HasSubstr(name + ": " + each.refusal))
          << each.to;
  }

  const Raster gray_ = Raster::counting(8, 8);
};

TEST_F(LabelRefusal, NonImageProducts_AreRefusedInOneSentence) {
  VicarFile vicar;
  EXPECT_THAT(refusal(vicar, Raster::counting(8, 8, 2)),
              HasSubstr("the image has 2 bands; 1 (gray) or 3"));
  vicar.store = Store::kIeee;
  vicar.items = "PROPERTY='DERIVED_IMAGE_PARMS'  DERIVED_IMAGE_TYPE='XYZ_MAP'  ";
  EXPECT_THAT(refusal(vicar, Raster::counting(8, 8, 3)),
              HasSubstr("the label calls this a XYZ_MAP"));
  const Raster nothing =
      Raster::filled(8, 8, 1, [](std::size_t) { return std::numeric_limits<double>::quiet_NaN(); });
  vicar.items = "";
  EXPECT_THAT(refusal(vicar, nothing), HasSubstr("no sample of the image has a value"));
  vicar.store = Store::kByte;
  std::string cut = textOf(vicar.bytes(gray_));
  cut.pop_back();
  EXPECT_THAT(refusal("x.vic", cut), HasSubstr("the pixels are truncated"));
  EXPECT_THAT(refusal("x.vic", cut.substr(0, 100)), HasSubstr("LBLSIZE"));
  vicar.organization = "BIP";
  vicar.prefix_bytes = 4;
  EXPECT_THAT(refusal(vicar, gray_), HasSubstr("NBB: a prefix of every pixel"));
  vicar.organization = "BIL";
  EXPECT_EQ(refusal(vicar, gray_), "(nothing)");
  EXPECT_THAT(refusal(vicar, Raster::counting(8, 8, 3)),
              HasSubstr("NBB: a prefix of every line of every band"));
}

TEST_F(LabelRefusal, VicarSizesThatContradictEachOtherOrTheFileAreRefused) {
  VicarFile vicar;
  const std::string whole = textOf(vicar.bytes(gray_));
  const int label_size = std::stoi(whole.substr(8, 8));
  const std::string wrong_size = std::to_string(label_size - 1);
  expectRefused(
      "x.vic", whole,
      {{"  NL=8 ", "  NL=0 ", "NL: 0 is not a whole number from 1 to 16384"},
       {"  NL=8 ", "  NL=99999999 ", "NL: 99999999 is not a whole number from 1 to"},
       {"  NL=8 ", "  NL=8e0 ", "NL: 8e0 is not a whole number from 1 to"},
       {"  NS=8 ", "  NS=-8 ", "NS: -8 is not a whole number from 1 to"},
       {"  NS=8 ", "  NS=4294967304 ", "NS: 4294967304 is not a whole number from 1 to"},
       {"  NS=8 ", "  NS=9999 ", ""},
       {"  NB=1 ", "  NB=1000000 ", "NB: 1000000 is not a whole number from 1 to"},
       {"FORMAT='BYTE'", "FORMAT='COMP'", ""},
       {"ORG='BSQ'", "ORG='XYZ'", ""},
       {"RECSIZE=8 ", "RECSIZE=0 ", "RECSIZE: 0 is not a whole number from 1 to"},
       {"RECSIZE=8 ", "RECSIZE=2147483648 ", "RECSIZE: 2147483648 is not a whole number from 1 to"},
       {"RECSIZE=8 ", "RECSIZE=9 ",
        "RECSIZE: 9 contradicts the label's other sizes, by which a record has 8 bytes"},
       {"LBLSIZE=" + std::to_string(label_size), "LBLSIZE=" + wrong_size,
        "LBLSIZE: " + wrong_size + " is no multiple of the 8 bytes of a record"}});
  vicar.items_at_end = true;
  vicar.items = "PROPERTY='IMAGE_DATA'  FIRST_LINE=1  ";
  std::string at_end = textOf(vicar.bytes(gray_));
  EXPECT_EQ(refusal("x.vic", at_end), "(nothing)");
  at_end.pop_back();
  EXPECT_EQ(refusal("x.vic", at_end),
            "x.vic: EOL: the part of the label at the file's end is incomplete");
}

TEST_F(LabelRefusal, Pds3LabelsThatContradictTheirPixels_AreRefused) {
  Pds3File pds;
  const std::string whole = textOf(pds.bytes(gray_));
  expectRefused(
      "x.img", whole,
      {{" LINE_SAMPLES = 8", " LINE_SAMPLES = 4294967304",
        "LINE_SAMPLES: 4294967304 is not a whole number from 0 to 999999999"},
       {" LINES = 8", " LINES = 8e0", "LINES: 8e0 is not a whole number from 0 to 999999999"},
       {" LINES = 8", " LINES = 0", ""},
       {" LINES = 8", " LINES = 90000", ""},
       {" SAMPLE_BITS = 16", " SAMPLE_BITS = 16.0",
        "SAMPLE_BITS: 16.0 is not a whole number from 0 to 999999999"},
       {" SAMPLE_BITS = 16", " SAMPLE_BITS = 12", ""},
       {"RECORD_BYTES = 128", "RECORD_BYTES = 4294967424",
        "RECORD_BYTES: 4294967424 is not a whole number from 0 to 999999999"},
       {" SAMPLE_TYPE = MSB_INTEGER", " SAMPLE_TYPE = VAX_REAL",
        "SAMPLE_TYPE: samples of the type VAX_REAL and 16 bits are not read"},
       {"^IMAGE = 2", "^IMAGE = 9", ""}});
  EXPECT_THAT(refusal("x.img", whole.substr(0, whole.size() - 3)),
              HasSubstr("the pixels are truncated: the label needs"));
  for (const char* place : {"(\"../secret.img\",1)", "(\"/etc/passwd\",1)",
                            "(\"/vsicurl/http://127.0.0.1/x.img\",1)", "\"..\"", "\"a\\b\""}) {
    pds.pointer = place;
    EXPECT_THAT(refusal("d.lbl", pds.label(gray_, 0)), HasSubstr("which is not in its folder"))
        << place;
  }
  pds.pointer = "(\"gone.img\",1)";
  EXPECT_EQ(refusal("d.lbl", pds.label(gray_, 0)),
            "d.lbl: the file of its pixels, 'gone.img', is not in its folder");
}

TEST_F(LabelRefusal, Pds4LabelsThatContradictTheirPixels_AreRefused) {
  Pds4File xml;
  folder_.write("pixels.img", xml.pixels(gray_));
  const std::string whole = xml.label(gray_);
  const auto deep = [](int depth) {
    std::string nest;
    for (const char* tag : {"<a>", "</a>"})
      for (int i = 0; i < depth; ++i) nest += tag;
    return nest + "<Identification_Area>";
  };
  expectRefused(
      "p.xml", whole,
      {{"<Identification_Area>", deep(100), "the label's elements are nested deeper than 64"},
       {"<Identification_Area>", deep(100000), "the PDS4 label is not well-formed XML"}});
  EXPECT_THAT(refusal("p.xml", whole.substr(0, 900)), HasSubstr("p.xml: "));
  xml.offset = 10;
  EXPECT_THAT(refusal("p.xml", xml.label(gray_)), HasSubstr("the pixels are truncated"));
  xml.pixels_file = "../pixels.img";
  EXPECT_THAT(refusal("p.xml", xml.label(gray_)), HasSubstr("which is not in its folder"));
}

TEST_F(LabelRefusal, MaskWithALabelIsRefused) {
  const auto file = folder_.write("mask.png", VicarFile().bytes(gray_));
  EXPECT_THAT(folder_.message([&] { readIgnoreMask(file, 8, 8); }),
              HasSubstr("a mask must be PNG or TIFF, not VICAR"));
}

}  // namespace
}  // namespace boresight::sessions
