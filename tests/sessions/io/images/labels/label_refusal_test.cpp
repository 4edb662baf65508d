// SPDX-License-Identifier: Apache-2.0
// Images with labels that are refused: one sentence each, and never a crash.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "sessions/io/images/image_file.h"
#include "sessions/io/images/labels/label_samples.h"
#include "tests/sessions/io/images/labels/label_fixture.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

TEST(LabelRefusal, NonImageProducts_AreRefusedInOneSentence) {
  const TemporaryFolder folder;
  VicarFile vicar;
  const auto message = [&](const auto& bytes) {
    const auto file = folder.write("x.vic", bytes);
    testing::internal::CaptureStderr();
    const std::string text = folder.message([&] { readImage(file); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_EQ(text.find("vsimem"), std::string::npos) << text;
    return text;
  };
  const Raster gray = Raster::counting(8, 8);
  const Raster two = Raster::counting(8, 8, 2);
  EXPECT_THAT(message(vicar.bytes(two)), HasSubstr("the image has 2 bands; 1 (gray) or 3"));
  vicar.store = Store::kIeee;
  vicar.items = "PROPERTY='DERIVED_IMAGE_PARMS'  DERIVED_IMAGE_TYPE='XYZ_MAP'  ";
  const Raster three = Raster::counting(8, 8, 3);
  EXPECT_THAT(message(vicar.bytes(three)), HasSubstr("the label calls this a XYZ_MAP"));
  const Raster nothing =
      Raster::filled(8, 8, 1, [](std::size_t) { return std::numeric_limits<double>::quiet_NaN(); });
  vicar.items = "";
  EXPECT_THAT(message(vicar.bytes(nothing)), HasSubstr("no sample of the image has a value"));
  vicar.store = Store::kByte;
  Bytes cut = vicar.bytes(gray);
  cut.pop_back();
  EXPECT_THAT(message(cut), HasSubstr("the pixels are truncated"));
  cut.resize(100);
  EXPECT_THAT(message(cut), HasSubstr("LBLSIZE"));
  const auto refusal = [&](const char* from, const char* to) {
    return message(altered(textOf(vicar.bytes(gray)), from, to));
  };
  EXPECT_THAT(refusal("  NL=8  ", "  NL=0  "),
              HasSubstr("NL: 0 is not a whole number from 1 to 16384"));
  EXPECT_THAT(refusal("  NL=8  ", "  NL=99999999  "), HasSubstr("NL: 99999999 is not a whole"));
  EXPECT_THAT(refusal("  NS=8  ", "  NS=-8  "), HasSubstr("NS: -8 is not a whole"));
  EXPECT_THAT(refusal("  NS=8  ", "  NS=9999  "), HasSubstr("x.vic"));
  EXPECT_THAT(refusal("  NB=1  ", "  NB=1000000  "), HasSubstr("NB: 1000000 is not a whole"));
  EXPECT_THAT(refusal("FORMAT='BYTE'", "FORMAT='COMP'"), HasSubstr("x.vic: "));
  vicar.organization = "BIP";
  vicar.prefix_bytes = 4;
  EXPECT_THAT(message(vicar.bytes(gray)), HasSubstr("NBB: a prefix of every pixel"));
  vicar.store = Store::kByte;
  vicar.organization = "BIL";
  EXPECT_EQ(message(vicar.bytes(gray)), "(nothing)");
  const Raster colour = Raster::counting(8, 8, 3);
  EXPECT_THAT(message(vicar.bytes(colour)), HasSubstr("NBB: a prefix of every line of every band"));
  vicar = VicarFile();
  EXPECT_THAT(refusal("ORG='BSQ'", "ORG='XYZ'"), HasSubstr("x.vic: "));
}

TEST(LabelRefusal, VicarSizesThatContradictEachOtherOrTheFileAreRefused) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& bytes) {
    return folder.message([&] { readImage(folder.write("x.vic", bytes)); });
  };
  const Raster gray = Raster::counting(8, 8);
  VicarFile vicar;
  const std::string whole = textOf(vicar.bytes(gray));
  ASSERT_EQ(message(whole), "(nothing)");
  EXPECT_EQ(message(altered(whole, "RECSIZE=8 ", "RECSIZE=9 ")),
            "x.vic: RECSIZE: 9 contradicts the label's other sizes, by which a record has 8 bytes");
  for (const auto& [from, to] :
       {std::pair{"RECSIZE=8", "RECSIZE=0"}, std::pair{"RECSIZE=8", "RECSIZE=2147483648"},
        std::pair{"NL=8", "NL=8e0"}, std::pair{"NS=8", "NS=4294967304"}}) {
    const std::string item = to;
    const auto equals = item.find('=');
    EXPECT_THAT(message(altered(whole, std::string(from) + " ", item + " ")),
                HasSubstr("x.vic: " + item.substr(0, equals) + ": " + item.substr(equals + 1) +
                          " is not a whole number from 1 to"));
  }
  const auto label_size = std::stoi(whole.substr(8, 8));
  EXPECT_EQ(message(altered(whole, "LBLSIZE=" + std::to_string(label_size),
                            "LBLSIZE=" + std::to_string(label_size - 1))),
            "x.vic: LBLSIZE: " + std::to_string(label_size - 1) +
                " is no multiple of the 8 bytes of a record");
  vicar.items_at_end = true;
  vicar.items = "PROPERTY='IMAGE_DATA'  FIRST_LINE=1  ";
  std::string at_end = textOf(vicar.bytes(gray));
  EXPECT_EQ(message(at_end), "(nothing)");
  at_end.pop_back();
  EXPECT_EQ(message(at_end), "x.vic: EOL: the part of the label at the file's end is incomplete");
}

TEST(LabelRefusal, Pds3SizesThatAreNoPlainNumbersAreRefused) {
  const TemporaryFolder folder;
  Pds3File pds;
  const Raster raster = Raster::counting(8, 8);
  const std::string whole = textOf(pds.bytes(raster));
  const auto message = [&](const std::string& from, const std::string& to) {
    const auto file = folder.write("x.img", altered(whole, from, to));
    return folder.message([&] { readImage(file); });
  };
  const std::string reason = " is not a whole number from 0 to 999999999";
  EXPECT_EQ(message(" LINE_SAMPLES = 8", " LINE_SAMPLES = 4294967304"),
            "x.img: LINE_SAMPLES: 4294967304" + reason);
  EXPECT_EQ(message(" LINES = 8", " LINES = 8e0"), "x.img: LINES: 8e0" + reason);
  EXPECT_EQ(message(" SAMPLE_BITS = 16", " SAMPLE_BITS = 16.0"),
            "x.img: SAMPLE_BITS: 16.0" + reason);
  EXPECT_EQ(message("RECORD_BYTES = 128", "RECORD_BYTES = 4294967424"),
            "x.img: RECORD_BYTES: 4294967424" + reason);
}

TEST(LabelRefusal, LabelsThatContradictTheirPixels_AreRefused) {
  const TemporaryFolder folder;
  Pds3File pds;
  const Raster raster = Raster::counting(8, 8);
  const auto read = [&](const std::string& name) {
    return folder.message([&] { readImage(folder.path() / name); });
  };
  for (const char* place : {"(\"../secret.img\",1)", "(\"/etc/passwd\",1)",
                            "(\"/vsicurl/http://127.0.0.1/x.img\",1)", "\"..\"", "\"a\\b\""}) {
    pds.pointer = place;
    folder.write("d.lbl", pds.label(raster, 0));
    EXPECT_THAT(read("d.lbl"), HasSubstr("which is not in its folder")) << place;
  }
  pds.pointer = "(\"gone.img\",1)";
  folder.write("d.lbl", pds.label(raster, 0));
  EXPECT_EQ(read("d.lbl"), "d.lbl: the file of its pixels, 'gone.img', is not in its folder");
  pds.pointer = "";
  Bytes bytes = pds.bytes(raster);
  bytes.resize(bytes.size() - 3);
  folder.write("t.img", bytes);
  EXPECT_THAT(read("t.img"), HasSubstr("the pixels are truncated: the label needs"));
  const auto refusal = [&](const char* from, const char* to) {
    folder.write("a.img", altered(textOf(pds.bytes(raster)), from, to));
    return read("a.img");
  };
  EXPECT_THAT(refusal(" LINES = 8", " LINES = 0"), HasSubstr("a.img: "));
  EXPECT_THAT(refusal(" LINES = 8", " LINES = 90000"), HasSubstr("a.img: "));
  EXPECT_THAT(refusal(" SAMPLE_BITS = 16", " SAMPLE_BITS = 12"), HasSubstr("a.img: "));
  EXPECT_THAT(refusal(" SAMPLE_TYPE = MSB_INTEGER", " SAMPLE_TYPE = VAX_REAL"),
              HasSubstr("SAMPLE_TYPE: samples of the type VAX_REAL and 16 bits are not read"));
  EXPECT_THAT(refusal("^IMAGE = 2", "^IMAGE = 9"), HasSubstr("a.img: "));

  Pds4File xml;
  folder.write("pixels.img", xml.pixels(raster));
  const auto label = [&](const std::string& text) {
    folder.write("p.xml", text);
    return read("p.xml");
  };
  xml.pixels_file = "../pixels.img";
  EXPECT_THAT(label(xml.label(raster)), HasSubstr("which is not in its folder"));
  xml.pixels_file = "pixels.img";
  xml.offset = 10;
  EXPECT_THAT(label(xml.label(raster)), HasSubstr("the pixels are truncated"));
  xml.offset = 0;
  EXPECT_EQ(label(xml.label(raster)), "(nothing)");
  const auto deep = [&](int depth) {
    std::string nest;
    for (const char* tag : {"<a>", "</a>"})
      for (int i = 0; i < depth; ++i) nest += tag;
    return label(
        altered(xml.label(raster), "<Identification_Area>", nest + "<Identification_Area>"));
  };
  EXPECT_THAT(deep(100), HasSubstr("nested deeper than 64"));
  EXPECT_THAT(deep(100000), HasSubstr("not well-formed XML"));  // deeper than the parser goes
  EXPECT_THAT(label(xml.label(raster).substr(0, 900)), HasSubstr("p.xml: "));
}

TEST(LabelRefusal, MaskWithALabelIsRefused) {
  const TemporaryFolder folder;
  const Raster raster = Raster::filled(8, 8, 1, [](std::size_t) { return 1.0; });
  const auto file = folder.write("mask.png", VicarFile().bytes(raster));
  EXPECT_THAT(folder.message([&] { readIgnoreMask(file, 8, 8); }),
              HasSubstr("a mask must be PNG or TIFF, not VICAR"));
}

}  // namespace
}  // namespace boresight::sessions
