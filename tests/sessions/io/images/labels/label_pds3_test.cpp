// SPDX-License-Identifier: Apache-2.0
// What PDS3 labels say of their pixels: where they are, how they are stored, and in which order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/image_file.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/images/labels/label_samples.h"
#include "tests/sessions/io/images/labels/label_fixture.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

/// A label and its pixels: 8-bit samples in the order of an organization, with bytes before lines.
class LabelPds3 : public LabelTest {
 protected:
  LabelPds3() { pds_.pixels_file = "p.dat"; }
  std::filesystem::path write(const Raster& raster, const char* organization, int prefix,
                              const std::string& storage_type = "BAND_SEQUENTIAL") const {
    const VicarFile stored{Store::kByte, false, organization, prefix};
    folder_.write("p.dat", stored.records(raster));
    return folder_.write("c.lbl", altered(pds_.label(raster, 0), "BAND_SEQUENTIAL", storage_type));
  }
  Pds3File pds_{"UNSIGNED_INTEGER", Store::kByte};
};

/// The label with IMAGE and its pointer in an object FILE of its own length of records.
std::string nested(const std::string& label, const std::string& pointer) {
  std::string text = label;
  const auto at = text.find("^IMAGE");
  text.erase(at, text.find('\n', at) + 1 - at);
  text = altered(
      text, "OBJECT = IMAGE\r\n",
      "OBJECT = FILE\r\n^IMAGE = " + pointer + "\r\nRECORD_BYTES = 64\r\nOBJECT = IMAGE\r\n");
  return altered(text, "END_OBJECT = IMAGE\r\n", "END_OBJECT = IMAGE\r\nEND_OBJECT = FILE\r\n");
}

TEST_F(LabelPds3, ImageInAnObjectFileIsReadLikeOneAtTheTop) {
  Random random(23);
  Pds3File pds;
  pds.pixels_file = "P.DAT";
  pds.image_items =
      " FIRST_LINE = 301\r\n FIRST_LINE_SAMPLE = 401\r\n SAMPLE_BIT_MASK = "
      "2#0000111111111111#\r\n MISSING_CONSTANT = 26\r\n";
  Raster raster = Raster::filled(16, 9, 1, [&](std::size_t) { return 30.0 + random.below(4000); });
  raster.at(0, 3, 5) = 26;
  folder_.write("p.dat", pds.pixels(raster));
  folder_.write("q.dat", joinedBytes(Bytes(128, 0x77), pds.pixels(raster)));
  const auto flat = folder_.write("flat.lbl", pds.label(raster, 0));
  const std::string table =
      "OBJECT = FILE\r\nRECORD_BYTES = 7\r\n^TABLE = \"T.DAT\"\r\nEND_OBJECT = FILE\r\n";
  const std::string inner = nested(pds.label(raster, 0), "(\"Q.DAT\",3)");
  for (const std::string& label : {nested(pds.label(raster, 0), "\"P.DAT\""), inner,
                                   altered(inner, "\r\nEND\r\n", "\r\n" + table + "END\r\n")}) {
    SCOPED_TRACE(label);
    const auto file = folder_.write("nested.lbl", label);
    EXPECT_EQ(readSamples(file).values, readSamples(flat).values);
    EXPECT_EQ(readLabelSamples(readLabelFiles(file)).invalid_count, 1);
    const ImageLabel read = readImageLabel(file);
    ASSERT_TRUE(read.subframe);
    EXPECT_EQ(std::pair(read.subframe->first_line, read.subframe->first_sample),
              std::pair(300, 400));
    EXPECT_EQ(read.bit_depth, readImageLabel(flat).bit_depth);
  }
}

TEST_F(LabelPds3, BandsAreReadInTheOrderThatTheLabelStates) {
  Random random(29);
  const Raster raster =
      Raster::filled(13, 9, 3, [&](std::size_t) { return double(random.below(256)); });
  const auto wanted = readImage(write(raster, "BSQ", 0)).pixels;
  EXPECT_EQ(wanted[0], raster.luma(0, 0));
  EXPECT_EQ(readImage(write(raster, "BSQ", 0, "\"BAND_SEQUENTIAL\"")).pixels, wanted);
  EXPECT_EQ(readImage(write(raster, "BIL", 0, "LINE_INTERLEAVED")).pixels, wanted);
  for (const char* word : {"SAMPLE_INTERLEAVED", "PIXEL_INTERLEAVED", "\"LINE_INTERLEAVED\""})
    EXPECT_THAT(refusal(write(raster, "BIP", 0, word)), HasSubstr("BAND_STORAGE_TYPE: ")) << word;
  EXPECT_THAT(refusal(write(raster, "BSQ", 0, "TILED")), HasSubstr("3 bands stored as TILED"));
  pds_.image_items = " LINE_PREFIX_BYTES = 12\r\n";
  EXPECT_EQ(readImage(write(raster, "BSQ", 12)).pixels, wanted);
  EXPECT_THAT(refusal(write(raster, "BIL", 12, "LINE_INTERLEAVED")),
              HasSubstr("3 bands stored as LINE_INTERLEAVED, 12 bytes before every line, are not"));
}

TEST_F(LabelPds3, BytesBehindLinesAreRefused) {
  const Raster raster = Raster::counting(16, 4);
  pds_.image_items = " LINE_PREFIX_BYTES = 8\r\n LINE_SUFFIX_BYTES = 0\r\n";
  EXPECT_EQ(readSamples(write(raster, "BSQ", 8)).values[16], 16);
  for (const char* items :
       {" LINE_PREFIX_BYTES = 4\r\n LINE_SUFFIX_BYTES = 4\r\n", " LINE_SUFFIX_BYTES = 4\r\n"}) {
    pds_.image_items = items;
    EXPECT_EQ(refusal(write(raster, "BSQ", 8)),
              "c.lbl: LINE_SUFFIX_BYTES: bytes behind every line of the image are not read");
  }
}

TEST_F(LabelPds3, SampleTypesThatWouldBeReadOtherwiseAreRefused) {
  const Raster raster = Raster::counting(16, 4);
  const auto read = [&](const char* type, Store store, bool big_endian = true) {
    const Pds3File pds{type, store, big_endian};
    const auto file = folder_.write("t.img", pds.bytes(raster));
    return folder_.message([&] { EXPECT_EQ(readSamples(file).values[0], 0); });
  };
  EXPECT_THAT(read("IEEE_REAL", Store::kHalf), HasSubstr("IEEE_REAL and 16 bits are not read"));
  EXPECT_THAT(read("MSB_INTEGER", Store::kDouble), HasSubstr("MSB_INTEGER and 64 bits are not"));
  EXPECT_THAT(read("MSB_INTEGER", Store::kFull), HasSubstr("MSB_INTEGER and 32 bits are not"));
  EXPECT_THAT(read("UNSIGNED_INTEGER", Store::kHalf), HasSubstr("the order of their bytes"));
  EXPECT_THAT(read("PC_UNSIGNED_INTEGER", Store::kHalf, false), HasSubstr("order of their bytes"));
  EXPECT_EQ(read("SUN_INTEGER", Store::kHalf), "(nothing)");
  EXPECT_EQ(read("\"LSB_INTEGER\"", Store::kHalf, false), "(nothing)");
}

TEST_F(LabelPds3, PointersAreUnderstoodOrRefused) {
  const Raster raster = Raster::counting(8, 8);
  Pds3File pds;
  folder_.write("p.dat", pds.pixels(raster));
  folder_.write("q q.dat", joinedBytes(Bytes(100, 0x55), pds.pixels(raster)));
  const auto read = [&](const std::string& place, const std::string& from = "RECORD_TYPE",
                        const std::string& to = "RECORD_TYPE") {
    pds.pointer = place;
    const auto file = folder_.write("d.lbl", altered(pds.label(raster, 0), from, to));
    return folder_.message([&] { EXPECT_EQ(readSamples(file).values[63], 63) << place; });
  };
  for (const char* place : {"\"P.DAT\"", "(\"P.DAT\")", "( \"p.dat\" , 1 )",
                            "(\"Q Q.DAT\", 101 <BYTES>)", "(\"Q Q.DAT\",101<BYTES>)"})
    EXPECT_EQ(read(place), "(nothing)") << place;
  for (const char* place : {"P.DAT", "'P.DAT'", "(\"Q Q.DAT\",101 <bytes>)", "(P.DAT,1)",
                            "(12 <BYTES>)", "0", "-3", "\"\"", "1.5"})
    EXPECT_THAT(read(place), StartsWith("d.lbl: ")) << place;
  EXPECT_THAT(read("(\"P.DAT\",2)", "RECORD_BYTES = 128", "NO_BYTES = 1"),
              HasSubstr("^IMAGE: counts records, but the label does not state RECORD_BYTES"));
  EXPECT_THAT(read("\"P.DAT\"", "^IMAGE", "^QUBE"), HasSubstr("has no pointer ^IMAGE"));
  EXPECT_THAT(read("\"P.DAT\"", "OBJECT = IMAGE", "OBJECT = COMPRESSED_FILE"),
              StartsWith("d.lbl: "));
  EXPECT_THAT(read("\"P.DAT\"", " BANDS = 1", " BANDS = 1\r\n LINES = 4"),
              HasSubstr("LINES: the label's object IMAGE states 4, but it would be read as 8"));
}

TEST_F(LabelPds3, OfSeveralImagesTheFirstIsReadAndNothingOfTheOthers) {
  const Raster raster = Raster::counting(8, 8);
  Pds3File pds;
  pds.pixels_file = "p.dat";
  folder_.write("p.dat", pds.pixels(raster));
  const std::string second =
      "END_OBJECT = IMAGE\r\nOBJECT = IMAGE\r\n LINES = 2\r\n LINE_SAMPLES = 3\r\n SAMPLE_BITS = 8"
      "\r\n MISSING_CONSTANT = 5\r\nEND_OBJECT = IMAGE\r\n";
  const auto file =
      folder_.write("d.lbl", altered(pds.label(raster, 0), "END_OBJECT = IMAGE\r\n", second));
  const GrayImage image = readImage(file);
  EXPECT_THAT(image.notes, Contains("the label has 2 objects IMAGE; the first is read"));
  EXPECT_THAT(image.rule, Not(HasSubstr("without a value")));
  EXPECT_EQ(readSamples(file).values[5], 5);
}

/// As on discs that such labels were written for. Of two files whose names differ in case alone, the
/// label is that of one.
TEST_F(LabelPds3, LabelWhoseNameDiffersInCase_BelongsToThePixelsThatItNames) {
  const Raster raster = Raster::plain();
  pds_.pixels_file = "b.dat";
  folder_.write("B.DAT", pds_.pixels(raster));
  folder_.write("b.Lbl", pds_.label(raster, 0));
  EXPECT_TRUE(readImage(folder_ / "B.DAT").label);
  folder_.write("b.dat", pds_.pixels(raster));
  EXPECT_TRUE(readImage(folder_ / "b.dat").label);
  EXPECT_EQ(folder_.message([&] { (void)readImage(folder_ / "B.DAT"); }).find("B.DAT: not a"), 0u);
}

TEST_F(LabelPds3, HashIsOfTheLabelAndThePixelsAsTheyAre) {
  const Raster raster = Raster::counting(8, 8);
  Pds3File pds;
  pds.pointer = "\"P.DAT\"";
  pds.items = "^BROWSE_IMAGE = \"B.DAT\"\r\nEXPOSURE = 1.5D-03\r\n";
  const std::string label = pds.label(raster, 0);
  folder_.write("p.dat", pds.pixels(raster));
  folder_.write("b.dat", "a picture to look at");
  const auto file = folder_.write("d.lbl", label);
  const Bytes both = joinedBytes({label.begin(), label.end()}, pds.pixels(raster));
  EXPECT_EQ(readImage(file).file_sha256, sha256Text(both));
  std::filesystem::remove(folder_ / "b.dat");
  EXPECT_EQ(readImage(file).file_sha256, sha256Text(both));
  const LabelFiles files = readLabelFiles(file);
  ASSERT_EQ(files.parts.size(), 2u);
  EXPECT_EQ(textOf(files.parts[0].bytes), label);  // what is packed is what was hashed
  EXPECT_NE(std::string(asText(files.labelBytes())), label);
  EXPECT_EQ(files.parts[1].name, "P.DAT");
}

TEST_F(LabelPds3, LabelThatDoesNotEndIsRefusedSoon) {
  std::string keys = "PDS_VERSION_ID = PDS3\r\n";
  for (int i = 0; keys.size() < (5u << 20); ++i) keys += "K" + std::to_string(i) + " = 1\r\n";
  const auto read = [&](const std::string& text) { return refusal(folder_.write("k.img", text)); };
  EXPECT_EQ(read(keys + "END\r\n"),
            "k.img: the PDS3 label has no line END within the file's first 4 MB");
  EXPECT_THAT(read("PDS_VERSION_ID = PDS3\r\n^IMAGE = 1\r\n\r\nthis is none\r\nEND\r\n"),
              HasSubstr("k.img: the PDS3 label describes no image that can be read"));
  std::string deep = "PDS_VERSION_ID = PDS3\r\n^IMAGE = 1\r\n";
  for (int i = 0; i < 100000; ++i) deep += "GROUP = A\r\n";
  EXPECT_THAT(read(deep + "END\r\n"), HasSubstr("describes no image that can be read"));
}

TEST_F(LabelPds3, LinesAreReadAsStoredWhateverTheirDisplay) {
  const Raster raster = Raster::counting(8, 8);
  Pds3File pds;
  pds.image_items = " LINE_DISPLAY_DIRECTION = DOWN\r\n SAMPLE_DISPLAY_DIRECTION = RIGHT\r\n";
  EXPECT_THAT(readImage(folder_.write("a.img", pds.bytes(raster))).notes, IsEmpty());
  pds.image_items = " LINE_DISPLAY_DIRECTION = UP\r\n SAMPLE_DISPLAY_DIRECTION = LEFT\r\n";
  const auto file = folder_.write("a.img", pds.bytes(raster));
  EXPECT_EQ(readSamples(file).values[1], 1);
  EXPECT_THAT(readImage(file).notes,
              Contains(HasSubstr("display order differs from its storage order (UP, LEFT)")));
}

}  // namespace
}  // namespace boresight::sessions
