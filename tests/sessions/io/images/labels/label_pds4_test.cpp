// SPDX-License-Identifier: Apache-2.0
// PDS4 labels: which array is read and what is said of it, names as XML may write them, and what
// the image's hash is of.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/image_file.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/images/labels/label_samples.h"
#include "tests/sessions/io/images/labels/label_fixture.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using LabelPds4 = LabelTest;

/// Of bytes 8 x 8: <name>...</name> with its offset and constants.
std::string arrayOf(const std::string& name, const std::string& id, int offset,
                    const std::string& constants = "") {
  return "<" + name + "><local_identifier>" + id + "</local_identifier><offset unit=\"byte\">" +
         std::to_string(offset) +
         "</offset><axes>2</axes><axis_index_order>Last Index Fastest</axis_index_order>"
         "<Element_Array><data_type>UnsignedByte</data_type></Element_Array>" +
         pds4Axis("Line", 8, 1) + pds4Axis("Sample", 8, 2) +
         (constants.empty() ? "" : "<Special_Constants>" + constants + "</Special_Constants>") +
         "</" + name + ">";
}

std::string areaOf(const std::string& file_name, const std::string& arrays) {
  return "<File_Area_Observational><File><file_name>" + file_name + "</file_name></File>" + arrays +
         "</File_Area_Observational>";
}

std::string labelOf(const std::string& areas) {
  return "<?xml version=\"1.0\"?>\n<Product_Observational "
         "xmlns=\"http://pds.nasa.gov/pds4/pds/v1\"><Observation_Area/>" +
         areas + "</Product_Observational>\n";
}

/// Bytes that count from `first` on, 64 of them for every array.
Bytes counting(std::uint8_t first, int arrays) {
  Bytes bytes;
  for (int i = 0; i < 64 * arrays; ++i) bytes.push_back(static_cast<std::uint8_t>(first + i));
  return bytes;
}

TEST_F(LabelPds4, TheFirstImageIsReadByWhatItsOwnElementSays) {
  folder_.write("p.img", counting(0, 2));
  folder_.write("q.img", counting(100, 1));
  const std::string constants =
      "<missing_constant>100</missing_constant><invalid_constant>70</invalid_constant>";
  const auto read = [&](const std::string& areas, int first, const std::string& remark) {
    SCOPED_TRACE(areas);
    const auto file = folder_.write("a.xml", labelOf(areas));
    const LabelSamples samples = readLabelSamples(readLabelFiles(file));
    EXPECT_EQ(samples.values[0], first);
    EXPECT_EQ(samples.values[63], first + 63);
    const auto flags = readImageLabel(file).flags;
    if (remark.empty())
      EXPECT_THAT(flags, Not(Contains(HasSubstr("arrays"))));
    else
      EXPECT_THAT(flags, Contains(remark));
    return samples.invalid_count;
  };
  const std::string image = arrayOf("Array_2D_Image", "img", 0);
  const std::string last = arrayOf("Array_2D_Image", "img", 64);
  const std::string mask = arrayOf("Array_2D", "mask", 0, constants);
  const std::string other = arrayOf("Array_2D_Image", "other", 0, constants);
  const std::string map = arrayOf("Array_2D_Map", "map", 0);
  const std::string first = "the label has 2 arrays; the Array_2D_Image 'img' is read";
  EXPECT_EQ(read(areaOf("p.img", image), 0, ""), 0);
  for (const std::string& areas :
       {areaOf("p.img", image + mask), areaOf("p.img", image) + areaOf("q.img", other),
        areaOf("q.img", map) + areaOf("p.img", image)})
    EXPECT_EQ(read(areas, 0, first), 0);
  for (const std::string& areas :
       {areaOf("p.img", mask + last), areaOf("q.img", mask) + areaOf("p.img", last)})
    EXPECT_EQ(read(areas, 64, first), 0);
  // The array's own constants count.
  const auto own = folder_.write(
      "a.xml", labelOf(areaOf("p.img", arrayOf("Array_2D_Image", "img", 64, constants))));
  EXPECT_EQ(readLabelSamples(readLabelFiles(own)).invalid_count, 2);
  EXPECT_EQ(refusal(folder_.write("a.xml", labelOf(areaOf("p.img", "")))),
            "a.xml: the PDS4 label describes no array of pixels");
}

TEST_F(LabelPds4, SignedBytesAreSigned) {
  const Pds4File pds{"SignedByte", Store::kByte};
  const Raster raster = Raster::filled(32, 8, 1, [](std::size_t i) { return double(i) - 128.0; });
  folder_.write("pixels.img", pds.pixels(raster));
  const ImageSamples samples = readSamples(folder_.write("a.xml", pds.label(raster)));
  EXPECT_EQ(samples.offset, -128.0);
  for (std::size_t i = 0; i < 256; ++i)
    ASSERT_NEAR(samples.offset + samples.scale * samples.values[i], double(i) - 128.0, 1e-9);
  EXPECT_THAT(readImage(folder_ / "a.xml").rule, HasSubstr("8-bit signed integers"));
  const Raster positive = Raster::counting(8, 8);
  folder_.write("pixels.img", pds.pixels(positive));
  const ImageSamples whole = readSamples(folder_.write("a.xml", pds.label(positive)));
  EXPECT_EQ(whole.sample_bits, 8);
  EXPECT_EQ(whole.values[63], 63);
}

TEST_F(LabelPds4, LinesAreReadAsStoredWhateverTheirDisplay) {
  const Raster raster = Raster::counting(8, 8);
  const auto read = [&](const char* direction) {
    Pds4File pds;
    pds.discipline =
        "<disp:Display_Settings><disp:Display_Direction><disp:horizontal_display_axis>Sample"
        "</disp:horizontal_display_axis><disp:vertical_display_axis>Line"
        "</disp:vertical_display_axis><disp:vertical_display_direction>" +
        std::string(direction) +
        "</disp:vertical_display_direction></disp:Display_Direction></disp:Display_Settings>";
    folder_.write("pixels.img", pds.pixels(raster));
    const auto file = folder_.write("a.xml", pds.label(raster));
    EXPECT_EQ(readSamples(file).values[0], 0);
    EXPECT_EQ(readSamples(file).values[63], 63);
    return readImage(file).notes;
  };
  EXPECT_THAT(read("Top to Bottom"), IsEmpty());
  EXPECT_THAT(
      read("Bottom to Top"),
      ElementsAre("the label's display order differs from its storage order (Bottom to Top); the "
                  "image is read as stored, in the lines and samples of its camera model"));
}

TEST_F(LabelPds4, NamesAreReadAsXmlHasThem) {
  folder_.write("p.img", counting(7, 1));
  const std::string plain = labelOf(areaOf("p.img", arrayOf("Array_2D_Image", "img", 0)));
  std::string prefixed;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    prefixed += plain[i];
    const bool opens = plain[i] == '<' && plain[i + 1] != '?' && plain[i + 1] != '/';
    const bool closes = plain[i] == '/' && plain[i - 1] == '<';
    if (opens || closes) prefixed += "pds:";
  }
  std::string many = "<!-- ";
  for (int i = 0; i < 70; ++i) many += "<x> ";
  const std::string name = "<file_name>p.img</file_name>";
  for (const std::string& label :
       {plain, prefixed, altered(plain, "<file_name>", "<file_name nil=\"no\" note='a > b'>"),
        altered(plain, name, "<file_name>p&#46;img</file_name>"),
        altered(plain, "<Observation_Area/>", "<!-- <file_name>old/old.img</file_name> -->"),
        altered(plain, "<Observation_Area/>", many + "-->"),
        altered(plain, "<Observation_Area/>", "<note><![CDATA[" + many + "]]></note>"),
        altered(plain, "?>\n", "?>\n<!-- " + std::string(100000, 'x') + " -->\n"),
        "\xef\xbb\xbf" + altered(plain, "?>\n", "?><!DOCTYPE a [<!ENTITY b \"c>\">]>\n")}) {
    SCOPED_TRACE(label.substr(0, 2000));
    const auto file = folder_.write("a.xml", label);
    EXPECT_TRUE(hasImageLabel(file));
    EXPECT_EQ(folder_.message([&] { EXPECT_EQ(readSamples(file).values[0], 7); }), "(nothing)");
  }
  EXPECT_EQ(refusal(folder_.write("a.xml", "<!--Product_Observational--><a/>")),
            "a.xml: the PDS4 label has no Product_Observational");
  EXPECT_THAT(refusal(folder_.write("a.xml", altered(plain, "p.img", "&#47;etc&#47;passwd"))),
              HasSubstr("which is not in its folder"));
}

TEST_F(LabelPds4, HashIsOfTheLabelAndTheFileOfItsArrayAlone) {
  folder_.write("a.img", counting(7, 1));
  folder_.write("a.jpg", "\xff\xd8\xff junk");
  folder_.write("b.img", counting(9, 1));
  const std::string image = arrayOf("Array_2D_Image", "img", 0);
  const std::string text =
      labelOf(areaOf("a.img", image) + areaOf("b.img", arrayOf("Array_2D_Image", "b", 0)) +
              "<File_Area_Observational_Supplemental><File><file_name>a.jpg</file_name></File>"
              "</File_Area_Observational_Supplemental>");
  const auto label = folder_.write("a.xml", text);
  const std::string sha256 = sha256Text(joinedBytes({text.begin(), text.end()}, counting(7, 1)));
  EXPECT_EQ(readImage(label).file_sha256, sha256);
  EXPECT_EQ(readSamples(label).file_sha256, sha256);
  std::filesystem::remove(folder_ / "a.jpg");
  std::filesystem::remove(folder_ / "b.img");
  EXPECT_EQ(readImage(label).file_sha256, sha256);
  EXPECT_EQ(readImage(folder_ / "a.img").file_sha256, sha256);
  // A file that the label names for something else is not this image.
  std::filesystem::rename(folder_ / "a.xml", folder_ / "b.xml");
  folder_.write("b.img", counting(9, 1));
  EXPECT_FALSE(hasImageLabel(folder_ / "b.img"));
  EXPECT_EQ(readLabelFiles(folder_ / "b.xml").parts.front().bytes, Bytes(text.begin(), text.end()));
}

}  // namespace
}  // namespace boresight::sessions
