// SPDX-License-Identifier: Apache-2.0
// Images with labels, written byte by byte as their formats' descriptions have it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/cahv_model.h"
#include "sessions/io/images/image_file.h"
#include "sessions/io/images/labels/image_label.h"
#include "tests/sessions/io/folder_test.h"

namespace boresight::sessions {

using Bytes = std::vector<std::uint8_t>;

/// Samples of an image: at(band, line, sample).
struct Raster {
  int width = 0, height = 0, bands = 1;
  std::vector<double> samples;

  std::size_t index(int band, int line, int sample) const {
    return static_cast<std::size_t>((band * height + line) * width + sample);
  }
  double& at(int band, int line, int sample) { return samples[index(band, line, sample)]; }
  double at(int band, int line, int sample) const { return samples[index(band, line, sample)]; }
  /// Of red, green and blue.
  double luma(int line, int x) const {
    return std::floor(
        (9798 * at(0, line, x) + 19235 * at(1, line, x) + 3735 * at(2, line, x) + 16384) / 32768);
  }
  static Raster filled(int width, int height, int bands,
                       const std::function<double(std::size_t)>& value) {
    Raster raster{width, height, bands, {}};
    for (std::size_t i = 0; i < static_cast<std::size_t>(width * height * bands); ++i)
      raster.samples.push_back(value(i));
    return raster;
  }
  /// Of bytes, large enough for most labels.
  static Raster plain(int width = 64, int height = 48) {
    return filled(width, height, 1, [](std::size_t i) { return double(i % 200); });
  }
  /// Samples 0, 1, 2, ...
  static Raster counting(int width, int height, int bands = 1) {
    return filled(width, height, bands, [](std::size_t i) { return double(i); });
  }
};

/// How one sample is stored.
enum class Store { kByte, kHalf, kFull, kIeee, kVax, kDouble };

inline int bytesOf(Store store) {
  return store == Store::kByte ? 1 : store == Store::kHalf ? 2 : store == Store::kDouble ? 8 : 4;
}

inline void append(Bytes& bytes, std::uint64_t bits, int size, bool big_endian) {
  for (int i = 0; i < size; ++i)
    bytes.push_back(static_cast<std::uint8_t>(bits >> 8 * (big_endian ? size - 1 - i : i)));
}

/// VAX F_floating: sign, exponent of excess 128, fraction 0.1f; the word of the sign comes first,
/// each word's low byte first.
inline void appendVax(Bytes& bytes, float value) {
  std::uint32_t bits = 0;
  if (value != 0.0f) {
    int exponent = 0;
    const float fraction = std::frexp(std::abs(value), &exponent);
    const auto mantissa = static_cast<std::uint32_t>(std::ldexp(fraction, 24)) & 0x7fffffu;
    bits = (value < 0 ? 0x80000000u : 0u) | static_cast<std::uint32_t>(exponent + 128) << 23 |
           mantissa;
  }
  append(bytes, bits >> 16, 2, false);
  append(bytes, bits & 0xffffu, 2, false);
}

inline void appendSample(Bytes& bytes, double value, Store store, bool big_endian) {
  if (store == Store::kVax) return appendVax(bytes, static_cast<float>(value));
  if (store == Store::kIeee)
    return append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4, big_endian);
  if (store == Store::kDouble)
    return append(bytes, std::bit_cast<std::uint64_t>(value), 8, big_endian);
  append(bytes, static_cast<std::uint64_t>(static_cast<std::int64_t>(value)), bytesOf(store),
         big_endian);
}

inline void appendText(Bytes& bytes, const std::string& text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

inline Bytes joinedBytes(Bytes first, const Bytes& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

inline std::string decimals(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof(buffer), "%.9g", value);
  return buffer;
}

inline std::string vectorText(const Eigen::Vector3d& v) {
  return "(" + decimals(v.x()) + "," + decimals(v.y()) + "," + decimals(v.z()) + ")";
}

struct VicarFile {
  Store store = Store::kByte;
  bool big_endian = false;
  std::string organization = "BSQ";
  int prefix_bytes = 0;    ///< NBB
  int header_records = 0;  ///< NLB
  std::string items = {};  ///< property and task items of the label
  bool items_at_end = false;

  std::string formatName() const {
    constexpr const char* kNames[] = {"BYTE", "HALF", "FULL", "REAL", "REAL", "DOUB"};
    return kNames[static_cast<int>(store)];
  }

  /// The samples in the order of the organization, a prefix before each record.
  Bytes records(const Raster& r) const {
    Bytes bytes;
    const std::array<int, 3> count = {r.bands, r.height, r.width};
    const std::array<std::size_t, 3> order = slowestFirst();
    std::array<int, 3> at = {0, 0, 0};
    for (at[order[0]] = 0; at[order[0]] < count[order[0]]; ++at[order[0]])
      for (at[order[1]] = 0; at[order[1]] < count[order[1]]; ++at[order[1]]) {
        bytes.insert(bytes.end(), static_cast<std::size_t>(prefix_bytes), 0x5a);
        for (at[order[2]] = 0; at[order[2]] < count[order[2]]; ++at[order[2]])
          appendSample(bytes, r.at(at[0], at[1], at[2]), store, big_endian);
      }
    return bytes;
  }

  Bytes bytes(const Raster& r) const {
    const std::array<int, 3> count = {r.bands, r.height, r.width};
    const auto [slow, middle, fast] = slowestFirst();
    const int record = prefix_bytes + count[fast] * bytesOf(store);
    const int label_size = ((2000 + static_cast<int>(items.size())) / record + 1) * record;
    const bool vax = store == Store::kVax;
    const std::string host = vax ? "VAX-VMS" : big_endian ? "SUN-SOLR" : "X86-LINUX";
    const std::string real = vax ? "VAX" : big_endian ? "IEEE" : "RIEEE";
    const auto number = [](const char* key, int value) {
      return std::string(key) + "=" + std::to_string(value) + "  ";
    };
    std::string begin = "LBLSIZE=" + std::to_string(label_size);
    begin.resize(24, ' ');
    const std::string system =
        "FORMAT='" + formatName() + "'  TYPE='IMAGE'  " + number("BUFSIZ", record) +
        number("DIM", 3) + number("EOL", items_at_end ? 1 : 0) + number("RECSIZE", record) +
        "ORG='" + organization + "'  " + number("NL", r.height) + number("NS", r.width) +
        number("NB", r.bands) + number("N1", count[fast]) + number("N2", count[middle]) +
        number("N3", count[slow]) + number("N4", 0) + number("NBB", prefix_bytes) +
        number("NLB", header_records) + "HOST='" + host + "'  INTFMT='" +
        (big_endian ? "HIGH" : "LOW") + "'  REALFMT='" + real +
        "'  COMPRESS='NONE'  EOCI1=0  EOCI2=0  ";
    Bytes bytes;
    appendText(bytes, begin + system + (items_at_end ? "" : items));
    bytes.resize(static_cast<std::size_t>(label_size), 0);
    bytes.insert(bytes.end(), static_cast<std::size_t>(header_records * record), 0xa5);
    bytes = joinedBytes(bytes, records(r));
    if (!items_at_end) return bytes;
    const std::size_t end = bytes.size() + static_cast<std::size_t>(label_size);
    appendText(bytes, begin + items);
    bytes.resize(end, 0);
    return bytes;
  }

 private:
  /// Of a place (band, line, sample): what grows slowest, then faster.
  std::array<std::size_t, 3> slowestFirst() const {
    if (organization == "BSQ") return {0, 1, 2};
    if (organization == "BIL") return {1, 0, 2};
    return {1, 2, 0};
  }
};

struct Pds3File {
  std::string sample_type = "MSB_INTEGER";
  Store store = Store::kHalf;
  bool big_endian = true;
  std::string items = {};        ///< of the label before the image object
  std::string image_items = {};  ///< of the image object
  std::string pixels_file = {};  ///< detached: their name
  Bytes between = {};            ///< between label and pixels, e.g. a VICAR header
  std::string pointer = {};      ///< instead of the right ^IMAGE

  static constexpr int kRecord = 128;

  Bytes pixels(const Raster& raster) const {
    Bytes bytes;
    for (const double value : raster.samples) appendSample(bytes, value, store, big_endian);
    return bytes;
  }
  std::string label(const Raster& raster, int records) const {
    const int skipped = records + (static_cast<int>(between.size()) + kRecord - 1) / kRecord;
    const std::string place = !pointer.empty()      ? pointer
                              : pixels_file.empty() ? std::to_string(skipped + 1)
                                                    : "(\"" + pixels_file + "\",1)";
    return "PDS_VERSION_ID = PDS3\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = " +
           std::to_string(kRecord) + "\r\nLABEL_RECORDS = " + std::to_string(records) + "\r\n" +
           (between.empty() ? "" : "^IMAGE_HEADER = " + std::to_string(records + 1) + "\r\n") +
           "^IMAGE = " + place + "\r\n" + items +
           "OBJECT = IMAGE\r\n LINES = " + std::to_string(raster.height) +
           "\r\n LINE_SAMPLES = " + std::to_string(raster.width) +
           "\r\n SAMPLE_TYPE = " + sample_type +
           "\r\n SAMPLE_BITS = " + std::to_string(8 * bytesOf(store)) +
           "\r\n BANDS = " + std::to_string(raster.bands) +
           "\r\n BAND_STORAGE_TYPE = BAND_SEQUENTIAL\r\n" + image_items +
           "END_OBJECT = IMAGE\r\nEND\r\n";
  }
  Bytes bytes(const Raster& raster) const {
    const int records = 20 + static_cast<int>(items.size() + image_items.size()) / kRecord;
    Bytes bytes;
    appendText(bytes, label(raster, records));
    bytes.resize(static_cast<std::size_t>(records * kRecord), ' ');
    bytes = joinedBytes(bytes, between);
    while (bytes.size() % kRecord != 0) bytes.push_back(' ');
    return joinedBytes(bytes, pixels(raster));
  }
};

inline std::string pds4Axis(const std::string& name, int count, int number) {
  return "<Axis_Array><axis_name>" + name + "</axis_name><elements>" + std::to_string(count) +
         "</elements><sequence_number>" + std::to_string(number) +
         "</sequence_number></Axis_Array>\n";
}

struct Pds4File {
  std::string data_type = "UnsignedMSB2";
  Store store = Store::kHalf;
  bool big_endian = true;
  std::string discipline = {};  ///< inside Discipline_Area
  std::string constants = {};   ///< inside Special_Constants
  std::string pixels_file = "pixels.img";
  int offset = 0;

  std::string label(const Raster& r) const {
    const std::string array = r.bands == 1 ? "Array_2D_Image" : "Array_3D_Image";
    const int number = r.bands == 1 ? 1 : 2;
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
           "<Product_Observational xmlns=\"http://pds.nasa.gov/pds4/pds/v1\" "
           "xmlns:geom=\"http://pds.nasa.gov/pds4/geom/v1\" "
           "xmlns:img=\"http://pds.nasa.gov/pds4/img/v1\">\n"
           "<Identification_Area><logical_identifier>urn:test:image</logical_identifier>"
           "<title>t</title></Identification_Area>\n<Observation_Area><Investigation_Area>"
           "<name>Mars 2020</name></Investigation_Area><Discipline_Area>" +
           discipline +
           "</Discipline_Area></Observation_Area>\n<File_Area_Observational><File><file_name>" +
           pixels_file + "</file_name></File>\n<" + array + "><offset unit=\"byte\">" +
           std::to_string(offset) + "</offset><axes>" + std::to_string(r.bands == 1 ? 2 : 3) +
           "</axes><axis_index_order>Last Index Fastest</axis_index_order>\n<Element_Array>"
           "<data_type>" +
           data_type + "</data_type></Element_Array>\n" +
           (r.bands == 1 ? "" : pds4Axis("Band", r.bands, 1)) + pds4Axis("Line", r.height, number) +
           pds4Axis("Sample", r.width, number + 1) +
           (constants.empty() ? "" : "<Special_Constants>" + constants + "</Special_Constants>\n") +
           "</" + array + "></File_Area_Observational></Product_Observational>\n";
  }
  Bytes pixels(const Raster& raster) const {
    Bytes bytes(static_cast<std::size_t>(offset), 0x77);
    for (const double value : raster.samples) appendSample(bytes, value, store, big_endian);
    return bytes;
  }
};

/// A camera that looks somewhat down in a vehicle's frame, its principal point near (cx, cy).
inline CahvModel exampleModel(CameraModel model, double focal_px, double cx, double cy) {
  CahvModel cahv;
  cahv.model = model;
  cahv.c_m = {0.61, -0.04, -0.23};
  cahv.a = Eigen::Vector3d(0.7, -0.005, 0.71).normalized();
  const Eigen::Vector3d down = Eigen::Vector3d(0, 0, 1) - cahv.a.z() * cahv.a;
  const Eigen::Vector3d y = down.normalized();
  const Eigen::Vector3d x = y.cross(cahv.a);
  cahv.h_px = focal_px * x + cx * cahv.a;
  cahv.v_px = focal_px * y + cy * cahv.a;
  if (model == CameraModel::kCahv) return cahv;
  cahv.o = (cahv.a + Eigen::Vector3d(0.001, -0.0009, -0.001)).normalized();
  cahv.r = {3e-06, -0.012015, -0.007525};
  if (model == CameraModel::kCahvor) return cahv;
  cahv.e_m = {0.001442, 0.001522, 0.000483};
  cahv.type = 3;
  cahv.parameter = 0.37;
  return cahv;
}

/// KEY = VALUE lines of a group, for PDS3 with line ends, for VICAR as items.
using GroupItems = std::vector<std::pair<std::string, std::string>>;

inline std::string pds3Group(const std::string& name, const GroupItems& items) {
  std::string text = "GROUP = " + name + "\r\n";
  for (const auto& [key, value] : items) text += " " + key + " = " + value + "\r\n";
  return text + "END_GROUP = " + name + "\r\n";
}

inline std::string vicarProperty(const std::string& name, const GroupItems& items) {
  std::string text = "PROPERTY='" + name + "'  ";
  for (const auto& [key, value] : items) text += key + "=" + value + "  ";
  std::replace(text.begin(), text.end(), '"', '\'');
  return text;
}

/// A test that writes images with labels into its folder.
class LabelTest : public FolderTest {
 protected:
  ImageLabel readLabelOf(const Pds3File& pds, const Raster& raster = Raster::plain()) const {
    return readImageLabel(folder_.write("image.img", pds.bytes(raster)));
  }
  /// What the same groups say in a PDS3 label and in VICAR labels at the beginning and at the end.
  std::vector<ImageLabel> labelsOf(
      const std::vector<std::pair<std::string, GroupItems>>& groups) const {
    Pds3File pds;
    VicarFile vicar;
    for (const auto& [name, items] : groups) {
      pds.items += pds3Group(name, items);
      vicar.items += vicarProperty(name, items);
    }
    const auto first = folder_.write("first.vic", vicar.bytes(Raster::plain()));
    vicar.items_at_end = true;
    const auto last = folder_.write("last.vic", vicar.bytes(Raster::plain()));
    return {readLabelOf(pds), readImageLabel(first), readImageLabel(last)};
  }
  /// The refusal of an image; "(nothing)" when it is read.
  std::string refusal(const std::filesystem::path& file,
                      const ImageReadOptions& options = {}) const {
    return folder_.message([&] { (void)readImage(file, options); });
  }
};

inline std::string modelType(const CahvModel& cahv) {
  return cahv.model == CameraModel::kCahv     ? "CAHV"
         : cahv.model == CameraModel::kCahvor ? "CAHVOR"
                                              : "CAHVORE";
}

/// The group of a camera model; `order` says which component stands where.
inline GroupItems cameraItems(const CahvModel& cahv, const std::string& order = "CAHVORETP",
                              bool letters = true, bool names = true) {
  const std::string type = modelType(cahv);
  const std::string all = "CAHVORETP";
  const std::size_t count = type == "CAHVORE" ? all.size() : type.size();
  const char* const words[] = {"CENTER", "AXIS",     "HORIZONTAL", "VERTICAL", "OPTICAL",
                               "RADIAL", "ENTRANCE", "MTYPE",      "MPARM"};
  const std::string values[] = {
      vectorText(cahv.c_m),  vectorText(cahv.a),  vectorText(cahv.h_px),
      vectorText(cahv.v_px), vectorText(cahv.o),  vectorText(cahv.r),
      vectorText(cahv.e_m),  decimals(cahv.type), decimals(cahv.parameter)};
  GroupItems items{{"MODEL_TYPE", '"' + type + '"'}};
  std::string ids, titles;
  GroupItems components;
  for (const char letter : order) {
    const std::size_t at = all.find(letter);
    if (at >= count) continue;
    ids += (ids.empty() ? "(\"" : ",\"") + std::string(1, letter) + "\"";
    titles += (titles.empty() ? "(\"" : ",\"") + std::string(words[at]) + "\"";
    components.emplace_back("MODEL_COMPONENT_" + std::to_string(components.size() + 1), values[at]);
  }
  if (letters) items.emplace_back("MODEL_COMPONENT_ID", ids + ")");
  if (names) items.emplace_back("MODEL_COMPONENT_NAME", titles + ")");
  items.insert(items.end(), components.begin(), components.end());
  items.emplace_back("REFERENCE_COORD_SYSTEM_NAME", "\"ROVER_NAV_FRAME\"");
  items.emplace_back("REFERENCE_COORD_SYSTEM_INDEX", "(14,1262,6)");
  return items;
}

/// The items with this value of a key.
inline GroupItems with(GroupItems items, const std::string& key, const std::string& value) {
  for (auto& item : items)
    if (item.first == key) item.second = value;
  return items;
}

/// The text with `to` in place of the first `from`.
inline std::string altered(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}
inline std::string textOf(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace boresight::sessions
