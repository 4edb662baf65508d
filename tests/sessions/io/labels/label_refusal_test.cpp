// SPDX-License-Identifier: Apache-2.0
// Images with labels that are refused: one sentence each, and never a crash.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "sessions/io/image_file.h"
#include "sessions/io/labels/label_samples.h"
#include "tests/sessions/io/labels/label_fixture.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::Bytes;
using test::Pds3File;
using test::Pds4File;
using test::Raster;
using test::Store;
using test::TemporaryFolder;
using test::VicarFile;
using ::testing::HasSubstr;

TEST(LabelRefusal, WhatIsNoPictureIsRefusedInOneSentence) {
  const TemporaryFolder folder;
  VicarFile vicar;
  const auto message = [&](const Bytes& bytes) {
    const auto file = folder.write("x.vic", bytes);
    testing::internal::CaptureStderr();
    const std::string text = folder.message([&] { readImage(file); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_EQ(text.find("vsimem"), std::string::npos) << text;
    return text;
  };
  const Raster gray = Raster::filled(8, 8, 1, [](std::size_t i) { return double(i); });
  const Raster two = Raster::filled(8, 8, 2, [](std::size_t i) { return double(i); });
  EXPECT_THAT(message(vicar.bytes(two)), HasSubstr("the image has 2 bands; 1 (gray) or 3"));
  vicar.store = Store::kIeee;
  vicar.items = "PROPERTY='DERIVED_IMAGE_PARMS'  DERIVED_IMAGE_TYPE='XYZ_MAP'  ";
  const Raster three = Raster::filled(8, 8, 3, [](std::size_t i) { return double(i); });
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
  const auto altered = [&](const std::string& from, const std::string& to) {
    const Bytes whole = vicar.bytes(gray);
    std::string text(whole.begin(), whole.end());
    text.replace(text.find(from), from.size(), to);
    return message(Bytes(text.begin(), text.end()));
  };
  EXPECT_THAT(altered("  NL=8  ", "  NL=0  "),
              HasSubstr("NL: 0 is no whole number from 1 to 16384"));
  EXPECT_THAT(altered("  NL=8  ", "  NL=99999999  "), HasSubstr("NL: 99999999 is no whole"));
  EXPECT_THAT(altered("  NS=8  ", "  NS=-8  "), HasSubstr("NS: -8 is no whole"));
  EXPECT_THAT(altered("  NS=8  ", "  NS=9999  "), HasSubstr("x.vic"));
  EXPECT_THAT(altered("  NB=1  ", "  NB=1000000  "), HasSubstr("NB: 1000000 is no whole"));
  EXPECT_THAT(altered("FORMAT='BYTE'", "FORMAT='COMP'"), HasSubstr("x.vic: "));
  vicar.organization = "BIP";
  vicar.prefix_bytes = 4;
  EXPECT_THAT(message(vicar.bytes(gray)), HasSubstr("NBB: a prefix of every pixel"));
  vicar.store = Store::kByte;
  vicar.organization = "BIL";
  EXPECT_EQ(message(vicar.bytes(gray)), "(nothing)");
  const Raster colour = Raster::filled(8, 8, 3, [](std::size_t i) { return double(i); });
  EXPECT_THAT(message(vicar.bytes(colour)), HasSubstr("NBB: a prefix of every line of every band"));
  vicar = VicarFile();
  EXPECT_THAT(altered("ORG='BSQ'", "ORG='XYZ'"), HasSubstr("x.vic: "));
}

std::string altered(const Bytes& bytes, const std::string& from, const std::string& to) {
  std::string text(bytes.begin(), bytes.end());
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(LabelRefusal, VicarSizesThatContradictEachOtherOrTheFileAreRefused) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& bytes) {
    return folder.message([&] { readImage(folder.write("x.vic", bytes)); });
  };
  const Raster gray = Raster::filled(8, 8, 1, [](std::size_t i) { return double(i); });
  VicarFile vicar;
  const Bytes whole = vicar.bytes(gray);
  ASSERT_EQ(message(altered(whole, "RECSIZE=8 ", "RECSIZE=8 ")), "(nothing)");
  EXPECT_EQ(message(altered(whole, "RECSIZE=8 ", "RECSIZE=9 ")),
            "x.vic: RECSIZE: 9 contradicts the label's other sizes, by which a record has 8 bytes");
  EXPECT_THAT(message(altered(whole, "RECSIZE=8 ", "RECSIZE=0 ")),
              HasSubstr("x.vic: RECSIZE: 0 is no whole number from 1 to"));
  EXPECT_THAT(message(altered(whole, "RECSIZE=8 ", "RECSIZE=2147483648 ")),
              HasSubstr("x.vic: RECSIZE: 2147483648 is no whole number from 1 to"));
  EXPECT_THAT(message(altered(whole, "  NL=8  ", "  NL=8e0  ")),
              HasSubstr("x.vic: NL: 8e0 is no whole number from 1 to"));
  EXPECT_THAT(message(altered(whole, "  NS=8  ", "  NS=4294967304  ")),
              HasSubstr("x.vic: NS: 4294967304 is no whole number from 1 to"));
  const auto label_size = std::stoi(std::string(whole.begin() + 8, whole.begin() + 16));
  EXPECT_EQ(message(altered(whole, "LBLSIZE=" + std::to_string(label_size),
                            "LBLSIZE=" + std::to_string(label_size - 1))),
            "x.vic: LBLSIZE: " + std::to_string(label_size - 1) +
                " is no multiple of the 8 bytes of a record");
  vicar.items_at_end = true;
  vicar.items = "PROPERTY='IMAGE_DATA'  FIRST_LINE=1  ";
  Bytes at_end = vicar.bytes(gray);
  EXPECT_EQ(message(altered(at_end, "EOL=1", "EOL=1")), "(nothing)");
  at_end.pop_back();
  EXPECT_EQ(message(altered(at_end, "EOL=1", "EOL=1")),
            "x.vic: EOL: the part of the label at the file's end is not there in full");
}

/// The default of ORG is BSQ.
TEST(LabelRefusal, VicarWithABlankOrganizationIsReadAsBandSequential) {
  const TemporaryFolder folder;
  const Raster gray = Raster::filled(8, 8, 1, [](std::size_t i) { return double(i); });
  const Bytes whole = VicarFile().bytes(gray);
  const auto pixels = readImage(folder.write("x.vic", whole)).pixels;
  for (const char* blank : {"ORG='    ' ", "ORG='   '  ", "ORG=''     "})
    EXPECT_EQ(readImage(folder.write("x.vic", altered(whole, "ORG='BSQ'  ", blank))).pixels, pixels)
        << blank;
}

TEST(LabelRefusal, Pds3SizesThatAreNoPlainNumbersAreRefused) {
  const TemporaryFolder folder;
  Pds3File pds;
  const Raster raster = Raster::filled(8, 8, 1, [](std::size_t i) { return double(i); });
  const Bytes whole = pds.bytes(raster);
  const auto message = [&](const std::string& from, const std::string& to) {
    const auto file = folder.write("x.img", altered(whole, from, to));
    return folder.message([&] { readImage(file); });
  };
  const std::string reason = " is no whole number of at most nine digits";
  EXPECT_EQ(message(" LINE_SAMPLES = 8", " LINE_SAMPLES = 4294967304"),
            "x.img: LINE_SAMPLES: 4294967304" + reason);
  EXPECT_EQ(message(" LINES = 8", " LINES = 8e0"), "x.img: LINES: 8e0" + reason);
  EXPECT_EQ(message(" SAMPLE_BITS = 16", " SAMPLE_BITS = 16.0"),
            "x.img: SAMPLE_BITS: 16.0" + reason);
  EXPECT_EQ(message("RECORD_BYTES = 128", "RECORD_BYTES = 4294967424"),
            "x.img: RECORD_BYTES: 4294967424" + reason);
}

TEST(LabelRefusal, LabelsThatLieOfTheirPixelsAreRefused) {
  const TemporaryFolder folder;
  Pds3File pds;
  const Raster raster = Raster::filled(8, 8, 1, [](std::size_t i) { return double(i); });
  const auto read = [&](const std::string& name) {
    return folder.message([&] { readImage(folder.path() / name); });
  };
  for (const char* place : {"(\"../secret.img\",1)", "(\"/etc/passwd\",1)",
                            "(\"/vsicurl/http://127.0.0.1/x.img\",1)", "\"..\"", "\"a\\b\""}) {
    pds.pointer = place;
    folder.write("d.lbl", pds.label(raster, 0));
    EXPECT_THAT(read("d.lbl"), HasSubstr("which is not one beside it")) << place;
  }
  pds.pointer = "(\"gone.img\",1)";
  folder.write("d.lbl", pds.label(raster, 0));
  EXPECT_EQ(read("d.lbl"), "d.lbl: the file of its pixels, 'gone.img', is not beside it");
  pds.pointer = "";
  Bytes bytes = pds.bytes(raster);
  bytes.resize(bytes.size() - 3);
  folder.write("t.img", bytes);
  EXPECT_THAT(read("t.img"), HasSubstr("the pixels are truncated: the label needs"));
  const auto altered = [&](const std::string& from, const std::string& to) {
    const Bytes whole = pds.bytes(raster);
    std::string text(whole.begin(), whole.end());
    text.replace(text.find(from), from.size(), to);
    folder.write("a.img", Bytes(text.begin(), text.end()));
    return read("a.img");
  };
  EXPECT_THAT(altered(" LINES = 8", " LINES = 0"), HasSubstr("a.img: "));
  EXPECT_THAT(altered(" LINES = 8", " LINES = 90000"), HasSubstr("a.img: "));
  EXPECT_THAT(altered(" SAMPLE_BITS = 16", " SAMPLE_BITS = 12"), HasSubstr("a.img: "));
  EXPECT_THAT(altered(" SAMPLE_TYPE = MSB_INTEGER", " SAMPLE_TYPE = VAX_REAL"),
              HasSubstr("SAMPLE_TYPE: samples of the type VAX_REAL are not read"));
  EXPECT_THAT(altered("^IMAGE = 2", "^IMAGE = 9"), HasSubstr("a.img: "));

  Pds4File xml;
  folder.write("pixels.img", xml.pixels(raster));
  const auto label = [&](const std::string& text) {
    folder.write("p.xml", text);
    return read("p.xml");
  };
  xml.pixels_file = "../pixels.img";
  EXPECT_THAT(label(xml.label(raster)), HasSubstr("which is not one beside it"));
  xml.pixels_file = "pixels.img";
  xml.offset = 10;
  EXPECT_THAT(label(xml.label(raster)), HasSubstr("the pixels are truncated"));
  xml.offset = 0;
  EXPECT_EQ(label(xml.label(raster)), "(nothing)");
  std::string deep = xml.label(raster);
  std::string nest;
  for (int i = 0; i < 100000; ++i) nest += "<a>";
  deep.insert(deep.find("<Identification_Area>"), nest);
  EXPECT_THAT(label(deep), HasSubstr("nested deeper than 64"));
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
