// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/label_raster.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <mutex>

#include <cpl_vsi.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <nlohmann/json.hpp>

#include "sessions/io/camera_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/image_file.h"
#include "sessions/io/labels/gdal_quiet.h"
#include "sessions/io/labels/label_layout.h"
#include "sessions/io/labels/label_xml.h"

namespace boresight::sessions {
namespace {

/// Three formats and no more, at the first image with a label.
void registerDrivers() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALRegister_VICAR();
    GDALRegister_PDS();
    GDALRegister_PDS4();
  });
}

/// The parts as files of GDAL's memory, in a folder of their own.
class MemoryFolder {
 public:
  explicit MemoryFolder(const LabelFiles& files) {
    static std::atomic<std::uint64_t> next{0};
    folder_ = "/vsimem/boresight-label-" + std::to_string(++next);
    label_ = path(files.parts.front().name);
    add(label_, files.labelBytes());
    if (files.parts.size() > 1) {
      pixels_ = path(pixelsName(files));
      add(pixels_, files.parts.back().bytes);
    }
  }
  MemoryFolder(const MemoryFolder&) = delete;
  MemoryFolder& operator=(const MemoryFolder&) = delete;
  ~MemoryFolder() {
    for (const std::string& name : names_) VSIUnlink(name.c_str());
    VSIUnlink(folder_.c_str());
  }
  const std::string& label() const { return label_; }
  /// Whether this is the file of the pixels, where it is not the label's own.
  bool isPixels(const std::string& name) const { return !pixels_.empty() && name == pixels_; }
  /// GDAL's words without its names of our files.
  std::string plain(std::string text) const {
    for (auto at = text.find(folder_ + "/"); at != std::string::npos; at = text.find(folder_ + "/"))
      text.erase(at, folder_.size() + 1);
    return oneLine(text);
  }

 private:
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  /// As GDAL looks for it: of PDS3 names blanks become underscores.
  static std::string pixelsName(const LabelFiles& files) {
    if (files.format == LabelFormat::kPds4) return kXmlPixelsName;
    std::string name = files.parts.back().name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
  }
  void add(const std::string& name, std::span<const std::uint8_t> bytes) {
    VSILFILE* file =
        VSIFileFromMemBuffer(name.c_str(), const_cast<GByte*>(bytes.data()), bytes.size(), FALSE);
    if (file == nullptr) return;
    names_.push_back(name);
    VSIFCloseL(file);
  }

  std::string folder_;
  std::string label_;
  std::string pixels_;
  std::vector<std::string> names_;
};

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

Dataset openWith(const char* driver, const std::string& name) {
  const char* allowed[] = {driver, nullptr};
  const char* siblings[] = {nullptr};
  return Dataset(GDALDataset::Open(name.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, allowed,
                                   nullptr, siblings));
}

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

void requireSide(const std::filesystem::path& file, const char* what, std::int64_t size,
                 std::int64_t most) {
  if (size < 1 || size > most)
    throw InputError(file, "image size",
                     "the label says " + std::to_string(size) + " " + what + ", outside of 1 .. " +
                         std::to_string(most));
}

}  // namespace

struct LabelRaster::Opened {
  explicit Opened(const LabelFiles& files)
      : file(files.file), folder(files), remark(files.remark) {}
  ~Opened() {
    const GdalQuiet quiet;
    dataset.reset();
  }

  std::filesystem::path file;
  MemoryFolder folder;
  std::string remark;
  Dataset dataset;
  nlohmann::json label;
  nlohmann::json vicar_label;
  SampleType type = SampleType::kUint8;
  bool integers_as_floats = false;

  void open(const LabelFiles& files) {
    const GdalQuiet quiet;
    dataset = openWith(driverName(files.format), folder.label());
    if (!dataset)
      throw InputError(file,
                       std::string("the ") + labelFormatName(files.format) +
                           " label describes no image that can be read" +
                           (quiet.message().empty() ? "" : ": " + folder.plain(quiet.message())));
    checkSizes();
    type = sampleTypeOf(file, *dataset->GetRasterBand(1));
    label = files.elements ? *files.elements : labelTree(file, files.format, *dataset);
    checkLayout(files);
  }

  void checkSizes() const {
    requireSide(file, "samples in a line", dataset->GetRasterXSize(), kMaxImageSide_px);
    requireSide(file, "lines", dataset->GetRasterYSize(), kMaxImageSide_px);
    requireSide(file, "bands", dataset->GetRasterCount(), kMostLabelBands);
    const std::int64_t pixels = std::int64_t{dataset->GetRasterXSize()} * dataset->GetRasterYSize();
    if (pixels > kMaxImagePixels)
      throw InputError(file, "image size",
                       std::to_string(pixels) + " pixels are more than the limit of " +
                           std::to_string(kMaxImagePixels));
  }

  void checkLayout(const LabelFiles& files) {
    GDALDataset::RawBinaryLayout raw;
    if (files.format == LabelFormat::kVicar) requireStatedRecords(files, label, layoutOf(raw));
    if (!dataset->GetRawBinaryLayout(raw)) {
      if (files.format == LabelFormat::kVicar) return;  // compressed: reading finds what is wrong
      throw InputError(file, "the label's pixels are not stored plainly");
    }
    if (files.format == LabelFormat::kPds3) {
      if (files.pointer.nested) label["IMAGE"] = label["FILE"]["IMAGE"];
      const RasterLayout layout = layoutOf(raw);
      requireStatedLayout(files, label, layout);
      const SampleType stated = statedSampleType(files, label, layout);
      integers_as_floats = isFloating(type) && !isFloating(stated);
      type = stated;
    }
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
    const bool apart = files.parts.size() > 1;
    if (apart != folder.isPixels(raw.osRawFilename))
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
    const Dataset header = openWith("VICAR", folder.label());
    if (!header) return;
    try {
      vicar_label = labelTree(file, LabelFormat::kVicar, *header);
    } catch (const InputError&) {
      vicar_label = nullptr;
    }
  }
};

LabelRaster::LabelRaster(const LabelFiles& files) {
  registerDrivers();
  if (files.format == LabelFormat::kVicar) requireVicarSizes(files);
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
  const auto read = [&](void* target, GDALDataType type) {
    return opened_->dataset->GetRasterBand(band + 1)->RasterIO(GF_Read, 0, row, width(), 1, target,
                                                               width(), 1, type, 0, 0, nullptr);
  };
  CPLErr error = CE_None;
  if (opened_->integers_as_floats) {
    std::vector<float> bits(samples.size());  // as GDAL has them: nothing is converted
    error = read(bits.data(), GDT_Float32);
    const bool is_signed = opened_->type == SampleType::kInt32;
    std::transform(bits.begin(), bits.end(), samples.begin(), [is_signed](const float& one) {
      const auto whole = std::bit_cast<std::uint32_t>(one);
      return is_signed ? static_cast<double>(static_cast<std::int32_t>(whole))
                       : static_cast<double>(whole);
    });
  } else {
    error = read(samples.data(), GDT_Float64);
  }
  if (opened_->type == SampleType::kInt8)  // of either sign, as GDAL has them
    for (double& one : samples) one = one > 127.0 ? one - 256.0 : one;
  if (error != CE_None)
    throw InputError(opened_->file,
                     "line " + std::to_string(row) +
                         " of the image cannot be read: " + opened_->folder.plain(quiet.message()));
}

}  // namespace boresight::sessions
