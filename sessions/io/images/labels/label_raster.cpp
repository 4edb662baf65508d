// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/labels/label_raster.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/gdal_memory.h"
#include "sessions/io/images/image_decoder.h"
#include "sessions/io/images/labels/label_values.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;
using RawLayout = GDALDataset::RawBinaryLayout;

/// A dataset and the files in memory that it reads.
struct OpenedLabel {
  explicit OpenedLabel(const LabelFiles& files) {
    label_path = memory.add(files.parts.front().name, files.labelBytes());
    if (files.parts.size() < 2) return;
    std::string name = files.parts.back().name;
    // GDAL looks for the files of PDS3 labels by such names.
    if (files.format == LabelFormat::kPds3) std::replace(name.begin(), name.end(), ' ', '_');
    pixels_path = memory.add(name, files.parts.back().bytes);
  }

  GdalMemory memory;
  std::string label_path;
  std::string pixels_path;  ///< empty: the pixels are in the label's own file
  GdalDataset dataset;
};

GdalDataset openDataset(const LabelFiles& files, const OpenedLabel& opened,
                        const GdalQuiet& quiet) {
  constexpr const char* kDrivers[] = {"VICAR", "PDS", "PDS4"};  // by LabelFormat
  // "PDS4:" makes GDAL open a PDS4 label regardless of its first bytes; the label has one array.
  const bool pds4 = files.format == LabelFormat::kPds4;
  GdalDataset dataset = openGdal(kDrivers[static_cast<int>(files.format)],
                                 pds4 ? "PDS4:" + opened.label_path + ":1:1" : opened.label_path);
  if (!dataset)
    throw InputError(
        files.file,
        std::string("the ") + labelFormatName(files.format) +
            " label describes no image that can be read" +
            (quiet.failure().empty() ? "" : ": " + opened.memory.plain(quiet.failure())));
  return dataset;
}

/// Of VICAR and PDS3.
json labelTree(const std::filesystem::path& file, LabelFormat format, GDALDataset& dataset) {
  char** lines = dataset.GetMetadata(format == LabelFormat::kVicar ? "json:VICAR" : "json:PDS");
  std::string text = lines == nullptr || *lines == nullptr ? "" : *lines;
  json tree = json::parse(text, nullptr, false);
  if (tree.is_discarded()) {
    // Labels have no stated encoding: bytes that are not UTF-8 become question marks.
    std::replace_if(
        text.begin(), text.end(), [](char c) { return (c & 0x80) != 0; }, '?');
    tree = json::parse(text, nullptr, false);
  }
  if (!tree.is_object()) throw InputError(file, "the label cannot be read");
  return tree;
}

SampleType sampleTypeOf(const std::filesystem::path& file, GDALRasterBand& band) {
  const GDALDataType type = band.GetRasterDataType();
  const int bits = GDALGetDataTypeSizeBits(type);
  const bool floating = GDALDataTypeIsFloating(type) != 0;
  if (GDALDataTypeIsComplex(type) != 0 || (bits > 32 && !floating))
    throw InputError(file, "samples of the type " + std::string(GDALGetDataTypeName(type)) +
                               " are not an image");
  // GDAL before 3.7 has no type for signed bytes.
  const char* kind = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
  const bool signed_byte = kind != nullptr && std::string_view(kind) == "SIGNEDBYTE";
  return {bits, floating, signed_byte || GDALDataTypeIsSigned(type) != 0};
}

LabelPicture pictureOf(const LabelFiles& files, GDALDataset& dataset) {
  requireImageSize(files.file, dataset.GetRasterXSize(), dataset.GetRasterYSize());
  if (const int bands = dataset.GetRasterCount(); bands < 1 || bands > kMostLabelBands)
    throw InputError(files.file, "bands",
                     std::to_string(bands) + " is outside 1 .. " + std::to_string(kMostLabelBands));
  return {dataset.GetRasterXSize(), dataset.GetRasterYSize(), dataset.GetRasterCount(),
          sampleTypeOf(files.file, *dataset.GetRasterBand(1)), files.remark};
}

/// Copies IMAGE and its pointer out of an object FILE.
void takeImageToTheTop(LabelRaster& raster) {
  json& label = raster.label;
  if (!label.contains("IMAGE"))
    for (const auto& [name, group] : labelGroups(LabelFormat::kPds3, label)) {
      if (name != "FILE" || !group->contains("IMAGE")) continue;
      const json found = *group;
      label.update(found);
      break;
    }
  const auto groups = labelGroups(LabelFormat::kPds3, label);
  const auto images = std::count_if(groups.begin(), groups.end(),
                                    [](const auto& group) { return group.first == "IMAGE"; });
  if (images > 1)
    raster.picture.remark =
        "the label has " + std::to_string(images) + " objects IMAGE; the first is read";
}

// The layout of pixels as stated in labels: GDAL does not read all of it, and uses the first
// statement of a key, the tree the last.

std::int64_t integerOf(const json* group, const char* key) {
  return labelInteger(labelMember(group, key)).value_or(0);
}

std::string wordOf(const json* group, const char* key) {
  return upperCase(labelText(labelMember(group, key)).value_or(""));
}

bool contains(const std::string& text, const char* word) {
  return text.find(word) != std::string::npos;
}

/// Nothing for types that do not state it.
std::optional<bool> isLittleEndian(const std::string& type) {
  for (const char* little : {"LSB", "PC_"})
    if (type.starts_with(little)) return true;
  for (const char* big :
       {"MSB", "MAC_", "SUN_", "IEEE_", "INTEGER", "UNSIGNED_INTEGER", "REAL", "FLOAT"})
    if (type.starts_with(big)) return false;
  return std::nullopt;
}

/// Bytes from one sample, line and band to the next; nothing for an unknown order of bands.
std::optional<std::array<std::int64_t, 3>> statedSteps(const std::string& storage,
                                                       const LabelPicture& picture,
                                                       std::int64_t prefix,
                                                       std::int64_t any_band_step) {
  const std::int64_t item = picture.type.bits / 8;
  const std::int64_t row = item * picture.width;
  if (picture.bands == 1) return {{item, prefix + row, any_band_step}};
  // Labels do not state whether a prefix then is of every band.
  if (storage == "LINE_INTERLEAVED" && prefix == 0) return {{item, row * picture.bands, row}};
  if (storage == "BAND_SEQUENTIAL" || storage.empty())
    return {{item, prefix + row, (prefix + row) * picture.height}};
  return std::nullopt;
}

/// Bytes before the first record or byte that ^IMAGE names.
std::int64_t statedOffset(const LabelFiles& files, const json& label) {
  const json* pointer = labelMember(&label, "^IMAGE");
  const json first = 1;
  const bool names_file = pointer != nullptr && (pointer->is_string() || pointer->is_array());
  if (names_file) pointer = pointer->is_array() && pointer->size() > 1 ? &(*pointer)[1] : &first;
  const std::int64_t number = labelInteger(pointer).value_or(0);
  if (number < 1 || names_file != (files.parts.size() > 1))
    throw InputError(files.file, "^IMAGE",
                     "is neither a record, a byte nor a file's name in quotes");
  if (number == 1 || labelUnit(pointer) == "BYTES") return number - 1;
  const std::int64_t record = integerOf(&label, "RECORD_BYTES");
  if (record < 1 || number > std::int64_t{1} << 30)
    throw InputError(files.file, "^IMAGE",
                     "counts records, but the label does not state RECORD_BYTES");
  return (number - 1) * record;
}

/// GDAL takes all samples of 32 bits for floating-point numbers.
void requireStatedType(const LabelFiles& files, const json* image, const SampleType& type,
                       bool little_endian) {
  const std::string stated = wordOf(image, "SAMPLE_TYPE");
  const auto refuse = [&](const std::string& why) {
    throw InputError(files.file, "SAMPLE_TYPE",
                     "samples of the type " + stated + " and " + std::to_string(type.bits) +
                         " bits are not read" + why);
  };
  if (contains(stated, "VAX") || contains(stated, "COMPLEX")) refuse("");
  const bool integer = contains(stated, "INTEGER") || stated == "MSB" || stated == "LSB";
  if (!stated.empty() && integer == type.floating) refuse("");
  const auto little = isLittleEndian(stated);
  if (type.bits > 8 && little && *little != little_endian)
    refuse(": the order of their bytes is ambiguous");
}

/// Of a PDS3 image: type, byte order, size, order of bands and offset.
void requireStatedLayout(const LabelFiles& files, const json& label, const LabelPicture& picture,
                         const RawLayout& raw) {
  const json* image = labelMember(&label, "IMAGE");
  requireStatedType(files, image, picture.type, raw.bLittleEndianOrder);
  for (const auto& [key, used] : {std::pair{"LINES", picture.height},
                                  {"LINE_SAMPLES", picture.width},
                                  {"SAMPLE_BITS", picture.type.bits}})
    if (integerOf(image, key) != used)
      throw InputError(files.file, key,
                       "the label's object IMAGE states " + std::to_string(integerOf(image, key)) +
                           ", but it would be read as " + std::to_string(used));
  if (integerOf(image, "LINE_SUFFIX_BYTES") != 0)
    throw InputError(files.file, "LINE_SUFFIX_BYTES",
                     "bytes behind every line of the image are not read");
  const std::int64_t prefix = integerOf(image, "LINE_PREFIX_BYTES");
  const std::int64_t offset = statedOffset(files, label) + prefix;
  const std::string storage = wordOf(image, "BAND_STORAGE_TYPE");
  const std::array<std::int64_t, 3> used = {raw.nPixelOffset, raw.nLineOffset, raw.nBandOffset};
  if (statedSteps(storage, picture, prefix, raw.nBandOffset) != used)
    throw InputError(files.file, "BAND_STORAGE_TYPE",
                     std::to_string(picture.bands) + " bands stored as " +
                         (storage.empty() ? "BAND_SEQUENTIAL" : storage) + ", " +
                         std::to_string(prefix) + " bytes before every line, are not read");
  if (offset != static_cast<std::int64_t>(raw.nImageOffset))
    throw InputError(files.file, "^IMAGE",
                     "names byte " + std::to_string(offset) + ", but it would be read as byte " +
                         std::to_string(raw.nImageOffset));
}

/// The sizes of a VICAR label agree: a record is NBB bytes and N1 samples, the label a number of
/// records, and the items at the file's end are complete.
void requireStatedRecords(const LabelFiles& files, const json& label, const LabelPicture& picture) {
  const std::string_view text = asText(files.labelBytes());
  const std::int64_t label_size = statedInteger(text, "LBLSIZE").value_or(0);
  const std::string_view own = text.substr(0, static_cast<std::size_t>(label_size));
  const auto stated = [own](const char* key) { return statedInteger(own, key).value_or(0); };
  const std::string order = wordOf(&label, "ORG");
  const bool by_pixel = order == "BIP";
  // A record is then one pixel, and GDAL misreads the prefix of each.
  if (stated("NBB") > 0 && by_pixel)
    throw InputError(files.file, "NBB", "a prefix of every pixel (ORG='BIP') is not read");
  if (stated("NBB") > 0 && order == "BIL" && picture.bands > 1)
    throw InputError(files.file, "NBB",
                     "a prefix of every line of every band (ORG='BIL') is not read");
  const std::int64_t record =
      stated("NBB") + (by_pixel ? picture.bands : picture.width) * (picture.type.bits / 8);
  if (stated("RECSIZE") != record)
    throw InputError(files.file, "RECSIZE",
                     std::to_string(stated("RECSIZE")) +
                         " contradicts the label's other sizes, by which a record has " +
                         std::to_string(record) + " bytes");
  if (label_size % record != 0)
    throw InputError(files.file, "LBLSIZE",
                     std::to_string(label_size) + " is no multiple of the " +
                         std::to_string(record) + " bytes of a record");
  const auto end_at = vicarEndLabel(own);
  if (!end_at) return;
  const std::string_view end =
      text.substr(std::min(static_cast<std::size_t>(*end_at), text.size()));
  const std::int64_t end_size = statedInteger(end.substr(0, 64), "LBLSIZE").value_or(0);
  if (end_size < 1 || static_cast<std::uint64_t>(end_size) > end.size())
    throw InputError(files.file, "EOL", "the part of the label at the file's end is incomplete");
}

/// GDAL fills what is missing at the end of a file with zeros.
void requirePixels(const LabelFiles& files, const OpenedLabel& opened, const LabelPicture& picture,
                   const RawLayout& raw) {
  if ((opened.pixels_path.empty() ? opened.label_path : opened.pixels_path) != raw.osRawFilename)
    throw InputError(files.file, "the label's pixels are not at the stated position");
  const auto last = [](std::int64_t count, std::int64_t step) {
    return static_cast<std::uint64_t>((count - 1) * std::max<std::int64_t>(step, 0));
  };
  const std::uint64_t needed = raw.nImageOffset + last(picture.width, raw.nPixelOffset) +
                               last(picture.height, raw.nLineOffset) +
                               last(picture.bands, raw.nBandOffset) +
                               static_cast<std::uint64_t>(GDALGetDataTypeSizeBytes(raw.eDataType));
  if (const std::uint64_t size = files.parts.back().bytes.size(); needed > size)
    throw InputError(files.file, "the pixels are truncated: the label needs " +
                                     std::to_string(needed) + " bytes, there are " +
                                     std::to_string(size));
}

void checkLayout(const LabelFiles& files, const OpenedLabel& opened, const LabelRaster& raster) {
  RawLayout raw;
  if (files.format == LabelFormat::kVicar)
    requireStatedRecords(files, raster.label, raster.picture);
  if (!opened.dataset->GetRawBinaryLayout(raw)) {
    if (files.format == LabelFormat::kVicar) return;  // compressed: reading finds what is wrong
    throw InputError(files.file, "the label's pixels are compressed or encoded");
  }
  if (files.format == LabelFormat::kPds3)
    requireStatedLayout(files, raster.label, raster.picture, raw);
  requirePixels(files, opened, raster.picture, raw);
}

/// The VICAR header inside a PDS3 file; null where there is none that can be read.
json vicarHeader(const LabelFiles& files, const OpenedLabel& opened) {
  if (files.format != LabelFormat::kPds3 ||
      asText(files.labelBytes()).find("LBLSIZE=") == std::string_view::npos)
    return nullptr;
  const GdalQuiet quiet(true);
  const GdalDataset header = openGdal("VICAR", opened.label_path);
  try {
    return header ? labelTree(files.file, LabelFormat::kVicar, *header) : json();
  } catch (const InputError&) {
    return nullptr;
  }
}

}  // namespace

LabelRaster openLabelRaster(const LabelFiles& files) {
  const auto opened = std::make_shared<OpenedLabel>(files);
  LabelRaster raster;
  {
    const GdalQuiet quiet;
    opened->dataset = openDataset(files, *opened, quiet);
    raster.picture = pictureOf(files, *opened->dataset);
    raster.label =
        files.elements ? *files.elements : labelTree(files.file, files.format, *opened->dataset);
    if (files.format == LabelFormat::kPds3) takeImageToTheTop(raster);
    checkLayout(files, *opened, raster);
  }
  raster.vicar_label = vicarHeader(files, *opened);
  raster.readRow = [opened, file = files.file, picture = raster.picture](
                       int band, int row, std::vector<double>& samples) {
    samples.resize(static_cast<std::size_t>(picture.width));
    const GdalQuiet quiet;
    const CPLErr error = opened->dataset->GetRasterBand(band + 1)->RasterIO(
        GF_Read, 0, row, picture.width, 1, samples.data(), picture.width, 1, GDT_Float64, 0, 0,
        nullptr);
    if (picture.type.bits == 8 && picture.type.is_signed)  // unsigned in GDAL before 3.7
      for (double& sample : samples) sample = sample > 127.0 ? sample - 256.0 : sample;
    if (error != CE_None)
      throw InputError(file, "line " + std::to_string(row) + " of the image cannot be read: " +
                                 opened->memory.plain(quiet.failure()));
  };
  return raster;
}

}  // namespace boresight::sessions
