// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/label_raster.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/gdal_memory.h"
#include "sessions/io/image_decoder.h"
#include "sessions/io/labels/label_layout.h"
#include "sessions/io/labels/label_values.h"

namespace boresight::sessions {
namespace {

const char* driverName(LabelFormat format) {
  return format == LabelFormat::kVicar ? "VICAR" : format == LabelFormat::kPds3 ? "PDS" : "PDS4";
}

/// Of VICAR and PDS3.
nlohmann::json labelTree(const std::filesystem::path& file, LabelFormat format,
                         GDALDataset& dataset) {
  char** lines = dataset.GetMetadata(format == LabelFormat::kVicar ? "json:VICAR" : "json:PDS");
  if (lines == nullptr || *lines == nullptr) throw InputError(file, "the label cannot be read");
  // Labels are of no stated encoding: bytes that are not UTF-8 become question marks.
  nlohmann::json tree = nlohmann::json::parse(*lines, nullptr, false);
  if (tree.is_discarded()) {
    std::string ascii(*lines);
    std::replace_if(
        ascii.begin(), ascii.end(), [](char c) { return (c & 0x80) != 0; }, '?');
    tree = nlohmann::json::parse(ascii, nullptr, false);
  }
  if (!tree.is_object()) throw InputError(file, "the label cannot be read");
  return tree;
}

/// Until it had a type of their own, GDAL noted aside that bytes have a sign.
bool isSignedByte(GDALRasterBand& band) {
  const char* kind = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
  return kind != nullptr && std::string_view(kind) == "SIGNEDBYTE";
}

SampleType sampleTypeOf(const std::filesystem::path& file, GDALRasterBand& band) {
  const GDALDataType type = band.GetRasterDataType();
  switch (type) {
    case GDT_Byte:
      return isSignedByte(band) ? SampleType::kInt8 : SampleType::kUint8;
#if GDAL_VERSION_NUM >= GDAL_COMPUTE_VERSION(3, 7, 0)
    case GDT_Int8:
      return SampleType::kInt8;
#endif
    case GDT_UInt16:
      return SampleType::kUint16;
    case GDT_Int16:
      return SampleType::kInt16;
    case GDT_UInt32:
      return SampleType::kUint32;
    case GDT_Int32:
      return SampleType::kInt32;
    case GDT_Float32:
      return SampleType::kFloat;
    case GDT_Float64:
      return SampleType::kDouble;
    default:
      throw InputError(file, "samples of the type " + std::string(GDALGetDataTypeName(type)) +
                                 " are no picture");
  }
}

}  // namespace

struct LabelRaster::Opened {
  explicit Opened(const LabelFiles& files) : file(files.file), remark(files.remark) {
    label_path = memory.add(files.parts.front().name, files.labelBytes());
    if (files.parts.size() < 2) return;
    std::string name = files.parts.back().name;
    // So GDAL looks for the files of PDS3 labels.
    if (files.format == LabelFormat::kPds3) std::replace(name.begin(), name.end(), ' ', '_');
    pixels_path = memory.add(name, files.parts.back().bytes);
  }

  std::filesystem::path file;
  GdalMemory memory;
  std::string label_path;
  std::string pixels_path;  ///< empty: the pixels are in the label's own file
  std::string remark;
  GdalDataset dataset;
  nlohmann::json label;
  nlohmann::json vicar_label;
  SampleType type = SampleType::kUint8;

  void open(const LabelFiles& files) {
    const GdalQuiet quiet;
    // By this name GDAL opens a PDS4 label whatever it begins with; it has one array.
    dataset = files.format == LabelFormat::kPds4 ? openGdal("PDS4", "PDS4:" + label_path + ":1:1")
                                                 : openGdal(driverName(files.format), label_path);
    if (!dataset)
      throw InputError(file,
                       std::string("the ") + labelFormatName(files.format) +
                           " label describes no image that can be read" +
                           (quiet.failure().empty() ? "" : ": " + memory.plain(quiet.failure())));
    requireImageSize(file, dataset->GetRasterXSize(), dataset->GetRasterYSize());
    if (const int bands = dataset->GetRasterCount(); bands < 1 || bands > kMostLabelBands)
      throw InputError(
          file, "bands",
          std::to_string(bands) + " is outside 1 .. " + std::to_string(kMostLabelBands));
    type = sampleTypeOf(file, *dataset->GetRasterBand(1));
    label = files.elements ? *files.elements : labelTree(file, files.format, *dataset);
    if (files.format == LabelFormat::kPds3) takeImageToTheTop();
    checkLayout(files);
  }

  /// IMAGE and what belongs to it may be in an object FILE.
  void takeImageToTheTop() {
    if (!label.contains("IMAGE"))
      for (const auto& [name, group] : labelGroups(LabelFormat::kPds3, label)) {
        if (name != "FILE" || !group->contains("IMAGE")) continue;
        const nlohmann::json found = *group;
        label.update(found);
        break;
      }
    int images = 0;
    for (const auto& [name, group] : labelGroups(LabelFormat::kPds3, label))
      if (name == "IMAGE") ++images;
    if (images > 1)
      remark = "the label has " + std::to_string(images) + " objects IMAGE; the first is read";
  }

  void checkLayout(const LabelFiles& files) {
    GDALDataset::RawBinaryLayout raw;
    if (files.format == LabelFormat::kVicar) requireStatedRecords(files, label, layoutOf(raw));
    if (!dataset->GetRawBinaryLayout(raw)) {
      if (files.format == LabelFormat::kVicar) return;  // compressed: reading finds what is wrong
      throw InputError(file, "the label's pixels are not stored plainly");
    }
    if (files.format == LabelFormat::kPds3) requireStatedLayout(files, label, layoutOf(raw));
    requirePixels(files, raw);
  }

  RasterLayout layoutOf(const GDALDataset::RawBinaryLayout& raw) const {
    RasterLayout layout;
    layout.width = dataset->GetRasterXSize();
    layout.height = dataset->GetRasterYSize();
    layout.bands = dataset->GetRasterCount();
    layout.little_endian = raw.bLittleEndianOrder;
    layout.offset = raw.nImageOffset;
    layout.pixel_step = raw.nPixelOffset;
    layout.line_step = raw.nLineOffset;
    layout.band_step = raw.nBandOffset;
    layout.type = type;
    return layout;
  }

  /// Readers fill what is missing at the end of a file with zeros and go on: found here.
  void requirePixels(const LabelFiles& files, const GDALDataset::RawBinaryLayout& raw) const {
    if ((pixels_path.empty() ? label_path : pixels_path) != raw.osRawFilename)
      throw InputError(file, "the label's pixels cannot be found where it says that they are");
    const std::uint64_t size = files.parts.back().bytes.size();
    const auto last = [](std::int64_t count, std::int64_t step) {
      return static_cast<std::uint64_t>((count - 1) * std::max<std::int64_t>(step, 0));
    };
    const std::uint64_t needed =
        raw.nImageOffset + last(dataset->GetRasterXSize(), raw.nPixelOffset) +
        last(dataset->GetRasterYSize(), raw.nLineOffset) +
        last(dataset->GetRasterCount(), raw.nBandOffset) +
        static_cast<std::uint64_t>(GDALGetDataTypeSizeBytes(raw.eDataType));
    if (needed > size)
      throw InputError(file, "the pixels are truncated: the label needs " + std::to_string(needed) +
                                 " bytes, there are " + std::to_string(size));
  }

  /// The header is read when it can be; a damaged one is as none.
  void readVicarHeader(const LabelFiles& files) {
    const auto bytes = files.labelBytes();
    if (files.format != LabelFormat::kPds3 ||
        asText(bytes).find("LBLSIZE=") == std::string_view::npos)
      return;
    const GdalQuiet quiet(true);
    const GdalDataset header = openGdal("VICAR", label_path);
    if (!header) return;
    try {
      vicar_label = labelTree(file, LabelFormat::kVicar, *header);
    } catch (const InputError&) {
      vicar_label = nullptr;
    }
  }
};

LabelRaster::LabelRaster(const LabelFiles& files) {
  opened_ = std::make_unique<Opened>(files);
  opened_->open(files);
  opened_->readVicarHeader(files);
}

LabelRaster::~LabelRaster() = default;

int LabelRaster::width() const { return opened_->dataset->GetRasterXSize(); }
int LabelRaster::height() const { return opened_->dataset->GetRasterYSize(); }
int LabelRaster::bands() const { return opened_->dataset->GetRasterCount(); }
SampleType LabelRaster::type() const { return opened_->type; }
const nlohmann::json& LabelRaster::label() const { return opened_->label; }
const nlohmann::json& LabelRaster::vicarLabel() const { return opened_->vicar_label; }
const std::string& LabelRaster::remark() const { return opened_->remark; }

void LabelRaster::readRow(int band, int row, std::vector<double>& samples) const {
  samples.resize(static_cast<std::size_t>(width()));
  const GdalQuiet quiet;
  const CPLErr error = opened_->dataset->GetRasterBand(band + 1)->RasterIO(
      GF_Read, 0, row, width(), 1, samples.data(), width(), 1, GDT_Float64, 0, 0, nullptr);
  if (opened_->type == SampleType::kInt8)  // of either sign, as GDAL has them
    for (double& one : samples) one = one > 127.0 ? one - 256.0 : one;
  if (error != CE_None)
    throw InputError(opened_->file,
                     "line " + std::to_string(row) +
                         " of the image cannot be read: " + opened_->memory.plain(quiet.failure()));
}

}  // namespace boresight::sessions
