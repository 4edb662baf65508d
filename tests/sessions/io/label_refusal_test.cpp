// SPDX-License-Identifier: Apache-2.0
// Images with labels that are refused: one sentence each, and never a crash.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "sessions/io/image_file.h"
#include "sessions/io/label_samples.h"
#include "tests/sessions/io/label_fixture.h"
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
  EXPECT_THAT(altered("  NL=8  ", "  NL=0  "), HasSubstr("NL: 0 is outside of 1 .. 16384"));
  EXPECT_THAT(altered("  NL=8  ", "  NL=99999999  "), HasSubstr("NL: 99999999 is outside"));
  EXPECT_THAT(altered("  NS=8  ", "  NS=-8  "), HasSubstr("NS: -8 is outside"));
  EXPECT_THAT(altered("  NS=8  ", "  NS=9999  "), HasSubstr("x.vic"));
  EXPECT_THAT(altered("  NB=1  ", "  NB=1000000  "), HasSubstr("NB: 1000000 is outside"));
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
