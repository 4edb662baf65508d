// SPDX-License-Identifier: Apache-2.0
// The only file that knows GDAL.
#include "sessions/io/label_raster.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <mutex>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_minixml.h>
#include <cpl_vsi.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <nlohmann/json.hpp>

#include "sessions/io/camera_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/image_file.h"
#include "sessions/io/label_values.h"

namespace boresight::sessions {
namespace {

constexpr int kMostDepth = 64;  ///< of elements within elements

/// Three formats and no more, at the first image with a label.
void registerDrivers() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALRegister_VICAR();
    GDALRegister_PDS();
    GDALRegister_PDS4();
  });
}

void CPL_STDCALL keepMessage(CPLErr kind, CPLErrorNum, const char* message) {
  auto* kept = static_cast<std::string*>(CPLGetErrorHandlerUserData());
  if (kept != nullptr && kind >= CE_Failure && kept->empty()) *kept = message;
}

/// GDAL's messages in this thread go here and never to stderr; its settings are its own again
/// after.
class Quiet {
 public:
  explicit Quiet(bool vicar_in_pds3 = false) {
    CPLPushErrorHandlerEx(keepMessage, &message_);
    set("GDAL_PAM_ENABLED", "NO");
    set("GDAL_DISABLE_READDIR_ON_OPEN", "EMPTY_DIR");
    set("GDAL_TRY_PDS3_WITH_VICAR", vicar_in_pds3 ? "YES" : "NO");
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  ~Quiet() {
    for (const auto& [key, before] : settings_)
      CPLSetThreadLocalConfigOption(key, before.empty() ? nullptr : before.c_str());
    CPLPopErrorHandler();
    CPLErrorReset();
  }
  const std::string& message() const { return message_; }

 private:
  void set(const char* key, const char* value) {
    const char* before = CPLGetThreadLocalConfigOption(key, nullptr);
    settings_.emplace_back(key, before != nullptr ? before : "");
    CPLSetThreadLocalConfigOption(key, value);
  }
  std::string message_;
  std::vector<std::pair<const char*, std::string>> settings_;
};

/// The parts as files of GDAL's memory, in a folder of their own.
class MemoryFolder {
 public:
  explicit MemoryFolder(const LabelFiles& files) {
    static std::atomic<std::uint64_t> next{0};
    folder_ = "/vsimem/boresight-label-" + std::to_string(++next);
    for (const LabelPart& part : files.parts) {
      const std::string name = path(part.name);
      VSILFILE* file = VSIFileFromMemBuffer(name.c_str(), const_cast<GByte*>(part.bytes.data()),
                                            part.bytes.size(), FALSE);
      if (file == nullptr) continue;
      names_.push_back(name);
      VSIFCloseL(file);
    }
  }
  MemoryFolder(const MemoryFolder&) = delete;
  MemoryFolder& operator=(const MemoryFolder&) = delete;
  ~MemoryFolder() {
    for (const std::string& name : names_) VSIUnlink(name.c_str());
    VSIUnlink(folder_.c_str());
  }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  /// GDAL's words without its names of our files.
  std::string plain(std::string text) const {
    for (auto at = text.find(folder_ + "/"); at != std::string::npos; at = text.find(folder_ + "/"))
      text.erase(at, folder_.size() + 1);
    return oneLine(text);
  }

 private:
  std::string folder_;
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

const char* metadataDomain(LabelFormat format) {
  return format == LabelFormat::kVicar  ? "json:VICAR"
         : format == LabelFormat::kPds3 ? "json:PDS"
                                        : "xml:PDS4";
}

std::string_view withoutPrefix(const char* name) {
  const std::string_view text(name);
  const auto colon = text.rfind(':');
  return colon == std::string_view::npos ? text : text.substr(colon + 1);
}

void addMember(nlohmann::json& object, const std::string& name, nlohmann::json value) {
  const auto found = object.find(name);
  if (found == object.end())
    object[name] = std::move(value);
  else if (found->is_array())
    found->push_back(std::move(value));
  else
    *found = nlohmann::json::array({std::move(*found), std::move(value)});
}

/// An element's children as an object, or its text. Depth is bounded by the caller's check.
nlohmann::json elementTree(const CPLXMLNode* element) {
  nlohmann::json object = nlohmann::json::object();
  std::string text;
  std::string unit;
  for (const CPLXMLNode* child = element->psChild; child != nullptr; child = child->psNext) {
    if (child->eType == CXT_Text)
      text += child->pszValue;
    else if (child->eType == CXT_Element)
      addMember(object, std::string(withoutPrefix(child->pszValue)), elementTree(child));
    else if (child->eType == CXT_Attribute && std::strcmp(child->pszValue, "unit") == 0 &&
             child->psChild != nullptr)
      unit = child->psChild->pszValue;
  }
  if (!object.empty()) return object;
  if (!unit.empty()) return {{"value", text}, {"unit", unit}};
  return text;
}

/// Elements within elements, counted without a parser: what is nested deeper than any label is
/// kept from parsers that would follow it.
void requireFlat(const std::filesystem::path& file, std::string_view xml) {
  int depth = 0;
  for (auto at = xml.find('<'); at != std::string_view::npos; at = xml.find('<', at + 1)) {
    const auto end = xml.find('>', at);
    if (end == std::string_view::npos) break;
    const char next = at + 1 < xml.size() ? xml[at + 1] : '>';
    if (next == '/') --depth;
    if (next == '/' || next == '!' || next == '?' || xml[end - 1] == '/') continue;
    if (++depth > kMostDepth)
      throw InputError(file,
                       "the label's elements are nested deeper than " + std::to_string(kMostDepth));
  }
}

nlohmann::json xmlTree(const std::filesystem::path& file, const char* xml) {
  requireFlat(file, xml);
  CPLXMLNode* root = CPLParseXMLString(xml);
  if (root == nullptr) throw InputError(file, "the PDS4 label is not well-formed XML");
  const std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)> owner(root, CPLDestroyXMLNode);
  for (const CPLXMLNode* node = root; node != nullptr; node = node->psNext)
    if (node->eType == CXT_Element && withoutPrefix(node->pszValue) == "Product_Observational")
      return elementTree(node);
  throw InputError(file, "the PDS4 label has no Product_Observational");
}

nlohmann::json labelTree(const std::filesystem::path& file, LabelFormat format,
                         GDALDataset& dataset) {
  char** lines = dataset.GetMetadata(metadataDomain(format));
  if (lines == nullptr || *lines == nullptr) throw InputError(file, "the label cannot be read");
  if (format == LabelFormat::kPds4) return xmlTree(file, *lines);
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

SampleType sampleTypeOf(const std::filesystem::path& file, GDALDataType type) {
  switch (type) {
    case GDT_Byte:
      return SampleType::kUint8;
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
  explicit Opened(const LabelFiles& files) : file(files.file), folder(files) {}
  ~Opened() {
    const Quiet quiet;
    dataset.reset();
  }

  std::filesystem::path file;
  MemoryFolder folder;
  Dataset dataset;
  nlohmann::json label;
  nlohmann::json vicar_label;
  SampleType type = SampleType::kUint8;
  bool integers_as_floats = false;

  void open(const LabelFiles& files) {
    const std::string name = folder.path(files.parts.front().name);
    const Quiet quiet;
    dataset = openWith(driverName(files.format), name);
    if (dataset && dataset->GetRasterCount() == 0) openFirstArray();
    if (!dataset)
      throw InputError(file,
                       std::string("the ") + labelFormatName(files.format) +
                           " label describes no image that can be read" +
                           (quiet.message().empty() ? "" : ": " + folder.plain(quiet.message())));
    checkSizes();
    type = sampleTypeOf(file, dataset->GetRasterBand(1)->GetRasterDataType());
    label = labelTree(file, files.format, *dataset);
    if (files.format == LabelFormat::kPds3) correctType();
    requirePixels(files);
  }

  /// GDAL takes every PDS3 sample of 32 bits for a floating-point number of IEEE 754.
  void correctType() {
    const std::string stated =
        upperCase(labelText(labelPath(&label, {"IMAGE", "SAMPLE_TYPE"})).value_or(""));
    if (stated.find("VAX") != std::string::npos || stated.find("COMPLEX") != std::string::npos)
      throw InputError(file, "SAMPLE_TYPE", "samples of the type " + stated + " are not read");
    if (type != SampleType::kFloat || stated.find("INTEGER") == std::string::npos) return;
    integers_as_floats = true;
    type = stated.find("UNSIGNED") != std::string::npos ? SampleType::kUint32 : SampleType::kInt32;
  }

  /// A PDS4 label of several arrays is opened one by one.
  void openFirstArray() {
    const char* first = dataset->GetMetadataItem("SUBDATASET_1_NAME", "SUBDATASETS");
    if (first == nullptr) return;
    const std::string name(first);
    if (name.find(folder.path("")) == std::string::npos) return;
    dataset = openWith("PDS4", name);
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

  /// Readers fill what is missing at the end of a file with zeros and go on: found here.
  void requirePixels(const LabelFiles& files) const {
    GDALDataset::RawBinaryLayout layout;
    if (!dataset->GetRawBinaryLayout(layout)) return;  // compressed: reading finds it
    std::uint64_t size = 0;
    for (const LabelPart& part : files.parts)
      if (folder.path(part.name) == layout.osRawFilename) size = part.bytes.size();
    const auto last = [](std::int64_t count, std::int64_t step) {
      return static_cast<std::uint64_t>((count - 1) * std::max<std::int64_t>(step, 0));
    };
    const std::uint64_t needed =
        layout.nImageOffset + last(dataset->GetRasterXSize(), layout.nPixelOffset) +
        last(dataset->GetRasterYSize(), layout.nLineOffset) +
        last(dataset->GetRasterCount(), layout.nBandOffset) +
        static_cast<std::uint64_t>(GDALGetDataTypeSizeBytes(layout.eDataType));
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
    const Quiet quiet(true);
    const Dataset header = openWith("VICAR", folder.path(files.parts.front().name));
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
  if (files.format == LabelFormat::kPds4) requireFlat(files.file, asText(files.labelBytes()));
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

void LabelRaster::readRow(int band, int row, std::vector<double>& samples) const {
  samples.resize(static_cast<std::size_t>(width()));
  const Quiet quiet;
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
  if (error != CE_None)
    throw InputError(opened_->file,
                     "line " + std::to_string(row) +
                         " of the image cannot be read: " + opened_->folder.plain(quiet.message()));
}

}  // namespace boresight::sessions
