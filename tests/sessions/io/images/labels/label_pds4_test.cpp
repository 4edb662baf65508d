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
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::TemporaryFolder;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Of bytes 8 x 8: <name>...</name> with its offset and constants.
std::string arrayOf(const std::string& name, const std::string& id, int offset,
                    const std::string& constants = "") {
  std::string axes;
  for (const char* axis : {"Line", "Sample"})
    axes += "<Axis_Array><axis_name>" + std::string(axis) +
            "</axis_name><elements>8</elements><sequence_number>" +
            std::string(axes.empty() ? "1" : "2") + "</sequence_number></Axis_Array>";
  return "<" + name + "><local_identifier>" + id + "</local_identifier><offset unit=\"byte\">" +
         std::to_string(offset) +
         "</offset><axes>2</axes><axis_index_order>Last Index Fastest</axis_index_order>"
         "<Element_Array><data_type>UnsignedByte</data_type></Element_Array>" +
         axes +
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

TEST(LabelPds4, TheFirstImageIsReadByWhatItsOwnElementSays) {
  const TemporaryFolder folder;
  folder.write("p.img", counting(0, 2));
  folder.write("q.img", counting(100, 1));
  const std::string constants =
      "<missing_constant>100</missing_constant><invalid_constant>70</invalid_constant>";
  const auto read = [&](const std::string& areas, int first, const std::string& remark) {
    const auto file = folder.write("a.xml", labelOf(areas));
    const LabelSamples samples = readLabelSamples(readLabelFiles(file));
    EXPECT_EQ(samples.values[0], first) << areas;
    EXPECT_EQ(samples.values[63], first + 63) << areas;
    const auto flags = readImageLabel(file).flags;
    if (remark.empty())
      EXPECT_THAT(flags, Not(Contains(HasSubstr("arrays")))) << areas;
    else
      EXPECT_THAT(flags, Contains(remark)) << areas;
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
  const auto own = folder.write(
      "a.xml", labelOf(areaOf("p.img", arrayOf("Array_2D_Image", "img", 64, constants))));
  EXPECT_EQ(readLabelSamples(readLabelFiles(own)).invalid_count, 2);
  EXPECT_EQ(folder.message([&] { readImage(folder.write("a.xml", labelOf(areaOf("p.img", "")))); }),
            "a.xml: the PDS4 label describes no array of pixels");
}

TEST(LabelPds4, SignedBytesAreSigned) {
  const TemporaryFolder folder;
  Pds4File pds;
  pds.data_type = "SignedByte";
  pds.store = Store::kByte;
  const Raster raster = Raster::filled(32, 8, 1, [](std::size_t i) { return double(i) - 128.0; });
  folder.write("pixels.img", pds.pixels(raster));
  const ImageSamples samples = readSamples(folder.write("a.xml", pds.label(raster)));
  EXPECT_EQ(samples.offset, -128.0);
  for (std::size_t i = 0; i < 256; ++i)
    ASSERT_NEAR(samples.offset + samples.scale * samples.values[i], double(i) - 128.0, 1e-9);
  EXPECT_THAT(readImage(folder / "a.xml").rule, HasSubstr("8-bit signed integers"));
  const Raster positive = Raster::counting(8, 8);
  folder.write("pixels.img", pds.pixels(positive));
  const ImageSamples whole = readSamples(folder.write("a.xml", pds.label(positive)));
  EXPECT_EQ(whole.sample_bits, 8);
  EXPECT_EQ(whole.values[63], 63);
}

TEST(LabelPds4, LinesAreReadAsStoredWhateverTheirDisplay) {
  const TemporaryFolder folder;
  const Raster raster = Raster::counting(8, 8);
  const auto read = [&](const char* direction) {
    Pds4File pds;
    pds.discipline =
        "<disp:Display_Settings><disp:Display_Direction><disp:horizontal_display_axis>Sample"
        "</disp:horizontal_display_axis><disp:vertical_display_axis>Line"
        "</disp:vertical_display_axis><disp:vertical_display_direction>" +
        std::string(direction) +
        "</disp:vertical_display_direction></disp:Display_Direction></disp:Display_Settings>";
    folder.write("pixels.img", pds.pixels(raster));
    const auto file = folder.write("a.xml", pds.label(raster));
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

TEST(LabelPds4, NamesAreReadAsXmlHasThem) {
  const TemporaryFolder folder;
  folder.write("p.img", counting(7, 1));
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
    const auto file = folder.write("a.xml", label);
    EXPECT_TRUE(hasImageLabel(file)) << label.substr(0, 2000);
    EXPECT_EQ(folder.message([&] { EXPECT_EQ(readSamples(file).values[0], 7); }), "(nothing)")
        << label.substr(0, 2000);
  }
  EXPECT_EQ(
      folder.message([&] { readImage(folder.write("a.xml", "<!--Product_Observational--><a/>")); }),
      "a.xml: the PDS4 label has no Product_Observational");
  EXPECT_THAT(folder.message([&] {
    readImage(folder.write("a.xml", altered(plain, "p.img", "&#47;etc&#47;passwd")));
  }),
              HasSubstr("which is not in its folder"));
}

TEST(LabelPds4, HashIsOfTheLabelAndTheFileOfItsArrayAlone) {
  const TemporaryFolder folder;
  const Bytes pixels = counting(7, 1);
  folder.write("a.img", pixels);
  folder.write("a.jpg", "\xff\xd8\xff junk");
  folder.write("b.img", counting(9, 1));
  const std::string image = arrayOf("Array_2D_Image", "img", 0);
  const std::string text =
      labelOf(areaOf("a.img", image) + areaOf("b.img", arrayOf("Array_2D_Image", "b", 0)) +
              "<File_Area_Observational_Supplemental><File><file_name>a.jpg</file_name></File>"
              "</File_Area_Observational_Supplemental>");
  const auto label = folder.write("a.xml", text);
  Bytes both(text.begin(), text.end());
  both.insert(both.end(), pixels.begin(), pixels.end());
  EXPECT_EQ(readImage(label).file_sha256, sha256Text(both));
  EXPECT_EQ(readSamples(label).file_sha256, sha256Text(both));
  std::filesystem::remove(folder / "a.jpg");
  std::filesystem::remove(folder / "b.img");
  EXPECT_EQ(readImage(label).file_sha256, sha256Text(both));
  EXPECT_EQ(readImage(folder / "a.img").file_sha256, sha256Text(both));
  // A file that the label names for something else is not this image.
  std::filesystem::rename(folder / "a.xml", folder / "b.xml");
  folder.write("b.img", counting(9, 1));
  EXPECT_FALSE(hasImageLabel(folder / "b.img"));
  EXPECT_EQ(readLabelFiles(folder / "b.xml").parts.front().bytes, Bytes(text.begin(), text.end()));
}

}  // namespace
}  // namespace boresight::sessions
