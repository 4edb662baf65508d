// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/labels/label_reading.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/labels/label_camera.h"
#include "sessions/io/images/labels/label_values.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

/// The label's tree, with access to its items.
struct Source {
  LabelFormat format;
  const json& tree;

  bool elements() const { return format == LabelFormat::kPds4; }
  /// The group of the picture itself, not one of a request.
  const json* image(std::string_view key) const {
    return format == LabelFormat::kVicar ? labelItem(format, tree, {"IMAGE_DATA", "IMAGE"}, key)
                                         : labelItem(format, tree, {"IMAGE", "IMAGE_DATA"}, key);
  }
  const json* state(std::string_view key) const {
    return labelItem(format, tree, {"INSTRUMENT_STATE_PARMS", "INSTRUMENT_STATE"}, key);
  }
  const json* identification(std::string_view key) const {
    if (format == LabelFormat::kVicar) return labelItem(format, tree, {"IDENTIFICATION"}, key);
    const json* found = labelMember(&tree, key);
    return found != nullptr ? found : labelItem(format, tree, {"IDENTIFICATION"}, key);
  }
  /// Of PDS4: below Imaging, except commanded parameters.
  const json* imaging(std::string_view group, std::string_view key) const {
    for (const json* imaging : elementsNamed(tree, "Imaging", "Commanded_Parameters"))
      if (const json* found = labelPath(imaging, {group, key})) return found;
    return nullptr;
  }
  /// Of PDS4: the first element of this name that is not below `except`.
  const json* first(std::string_view name, std::string_view except = {}) const {
    const auto found = elementsNamed(tree, name, except);
    return found.empty() ? nullptr : found.front();
  }
};

void addItem(std::vector<LabelItem>& items, std::string name, const json* value) {
  std::string text = joined(labelTexts(value));
  if (!text.empty() && text.find_first_not_of(", ") != std::string::npos)
    items.push_back({std::move(name), std::move(text)});
}

std::vector<LabelItem> elementIdentifiers(const Source& source) {
  std::vector<LabelItem> items;
  const json* area = labelMember(&source.tree, "Observation_Area");
  const auto add = [&](const char* name, const json* value) { addItem(items, name, value); };
  add("Investigation_Area", labelPath(area, {"Investigation_Area", "name"}));
  std::vector<std::string> system;
  for (const json* component :
       labelList(labelPath(area, {"Observing_System", "Observing_System_Component"})))
    if (const auto name = labelText(labelMember(component, "name"))) system.push_back(*name);
  if (!system.empty()) items.push_back({"Observing_System_Component", joined(system)});
  add("logical_identifier", labelPath(&source.tree, {"Identification_Area", "logical_identifier"}));
  add("start_date_time", labelPath(area, {"Time_Coordinates", "start_date_time"}));
  for (const char* name :
       {"spacecraft_clock_start", "start_sol_number", "sequence_id", "geometry_projection_type"})
    add(name, source.first(name, "Commanded_Parameters"));
  add("Target_Identification", labelPath(area, {"Target_Identification", "name"}));
  return items;
}

std::vector<LabelItem> identifiersOf(const Source& source) {
  if (source.elements()) return elementIdentifiers(source);
  std::vector<LabelItem> items;
  for (const char* key : {"MISSION_NAME", "INSTRUMENT_HOST_ID", "INSTRUMENT_ID", "INSTRUMENT_NAME",
                          "PRODUCT_ID", "IMAGE_ID", "START_TIME", "SPACECRAFT_CLOCK_START_COUNT",
                          "PLANET_DAY_NUMBER", "LOCAL_TRUE_SOLAR_TIME", "ROVER_MOTION_COUNTER",
                          "SEQUENCE_ID", "TARGET_NAME", "GEOMETRY_PROJECTION_TYPE"})
    addItem(items, key, source.identification(key));
  return items;
}

std::optional<LabelSubframe> subframeOf(const Source& source) {
  const auto first = [&](const char* key, const char* element) {
    return labelInteger(source.elements() ? source.imaging("Subframe", element)
                                          : source.image(key));
  };
  const auto averaged = [&](const char* key, const char* element) -> std::optional<double> {
    const json* value =
        source.elements()
            ? labelPath(source.imaging("Downsampling", "Pixel_Averaging_Dimensions"), {element})
            : source.state(key);
    const auto number = labelNumber(value != nullptr ? value : source.image(key));
    if (!number || !(*number >= 1.0 && *number <= 1024.0)) return std::nullopt;
    return number;
  };
  const auto line = first("FIRST_LINE", "first_line");
  const auto sample = first("FIRST_LINE_SAMPLE", "first_sample");
  const auto width = averaged("PIXEL_AVERAGING_WIDTH", "width_pixels");
  const auto height = averaged("PIXEL_AVERAGING_HEIGHT", "height_pixels");
  if (!line && !sample && !width && !height) return std::nullopt;
  // Counted from 1 in labels.
  const auto from0 = [](const std::optional<std::int64_t>& value) {
    return value && *value >= 1 && *value <= 1000000 ? static_cast<int>(*value - 1) : 0;
  };
  return LabelSubframe{from0(sample), from0(line), width.value_or(1.0), height.value_or(1.0)};
}

/// 2#0000111111111111# uses 12 bits.
std::optional<int> bitsOfMask(const std::string& mask) {
  const bool digits_alone = mask.find('#') == std::string::npos;
  // So few digits may also be a number of bits or a decimal mask.
  if (digits_alone && mask.size() < 8) return std::nullopt;
  const auto pattern = bitPattern(digits_alone ? "2#" + mask : mask);
  if (!pattern || pattern->bits == 0) return std::nullopt;
  return static_cast<int>(std::bit_width(pattern->bits));
}

std::optional<int> bitDepthOf(const Source& source, const LabelPicture& picture,
                              std::vector<std::string>& flags) {
  if (picture.type.floating) return std::nullopt;
  const json* mask = source.elements() ? source.imaging("Sampling", "sample_bit_mask")
                                       : source.image("SAMPLE_BIT_MASK");
  std::optional<int> bits;
  if (const auto text = labelText(mask)) bits = bitsOfMask(*text);
  if (!bits && source.elements())
    if (const auto stated = labelInteger(source.imaging("Sampling", "sample_bits")))
      bits = static_cast<int>(std::clamp<std::int64_t>(*stated, 0, 64));
  if (!bits) return std::nullopt;
  if (*bits < 1 || *bits > std::min(picture.type.bits, 16)) {
    if (*bits > picture.type.bits)
      flags.push_back("the label says that " + std::to_string(*bits) +
                      " bits are used, but a sample has " + std::to_string(picture.type.bits));
    return std::nullopt;
  }
  return bits;
}

/// Of PDS4 those of the array that is read: the tree has no other.
std::vector<InvalidValue> invalidValues(const Source& source, const LabelPicture& picture) {
  std::vector<InvalidValue> values;
  const auto add = [&](const json* stated) {
    addInvalidValues(stated, picture.type.floating, picture.type.bits, values);
  };
  if (!source.elements()) {
    for (const char* key : {"MISSING_CONSTANT", "MISSING", "INVALID_CONSTANT", "INVALID",
                            "NULL_CONSTANT", "NULL", "CORE_NULL"})
      add(source.image(key));
    return values;
  }
  const json* area = labelMember(&source.tree, "File_Area_Observational");
  if (area == nullptr || !area->is_object()) return values;
  for (const auto& [name, array] : area->items()) {
    if (!name.starts_with("Array")) continue;
    for (const char* key : {"missing_constant", "invalid_constant", "unknown_constant",
                            "not_applicable_constant", "error_constant"})
      add(labelPath(&array, {"Special_Constants", key}));
  }
  return values;
}

/// How the label has the image displayed, where that is not as it is stored; else empty.
std::string displayOf(const Source& source) {
  std::vector<std::string> otherwise;
  const auto expect = [&](const json* value, const char* stored) {
    const auto text = labelText(value);
    if (text && upperCase(*text) != stored) otherwise.push_back(*text);
  };
  if (source.elements()) {
    for (const json* display : elementsNamed(source.tree, "Display_Direction")) {
      expect(labelMember(display, "vertical_display_axis"), "LINE");
      expect(labelMember(display, "vertical_display_direction"), "TOP TO BOTTOM");
      expect(labelMember(display, "horizontal_display_axis"), "SAMPLE");
      expect(labelMember(display, "horizontal_display_direction"), "LEFT TO RIGHT");
    }
  } else {
    expect(source.image("LINE_DISPLAY_DIRECTION"), "DOWN");
    expect(source.image("SAMPLE_DISPLAY_DIRECTION"), "RIGHT");
  }
  otherwise.resize(std::min<std::size_t>(otherwise.size(), 4));
  return joined(otherwise);
}

void addPictureFlags(const Source& source, const LabelPicture& picture,
                     std::vector<std::string>& flags) {
  if (!picture.remark.empty()) flags.push_back(picture.remark);
  if (const std::string display = displayOf(source); !display.empty())
    flags.push_back("the label's display order differs from its storage order (" + display +
                    "); the image is read as stored, in the lines and samples of its camera model");
  if (source.format != LabelFormat::kPds3 || picture.type.bits != 8) return;
  const std::string type = labelText(source.image("SAMPLE_TYPE")).value_or("UNSIGNED");
  if (upperCase(type).find("UNSIGNED") == std::string::npos)
    flags.push_back("the label calls samples of 8 bits " + type + "; they are read as unsigned");
}

std::string bayerPattern(const Source& source, const LabelPicture& picture) {
  if (picture.bands != 1) return "";
  if (source.elements()) {
    const auto type = labelText(source.imaging("Color_Filter_Array", "color_filter_array_type"));
    const auto state = labelText(source.imaging("Color_Filter_Array", "color_filter_array_state"));
    if (!type || upperCase(*type).find("BAYER") == std::string::npos) return "";
    return state && upperCase(*state) == "DECODED" ? "" : *type;
  }
  for (const char* key : {"CFA_TYPE", "BAYER_PATTERN", "BAYER_TYPE"}) {
    const auto type = labelText(source.state(key));
    if (!type || upperCase(*type).find("BAYER") == std::string::npos) continue;
    for (const char* done : {"CFA_METHOD", "BAYER_METHOD"}) {
      const std::string method = upperCase(labelText(source.state(done)).value_or("NONE"));
      if (method != "NONE" && method.find("RAW") == std::string::npos) return "";
    }
    return *type;
  }
  return "";
}

std::string derivedType(const Source& source) {
  const json* type =
      source.elements() ? source.first("derived_image_type_name")
                        : labelItem(source.format, source.tree,
                                    {"DERIVED_IMAGE_PARMS", "DERIVED_IMAGE"}, "DERIVED_IMAGE_TYPE");
  const std::string name = upperCase(labelText(type).value_or(""));
  return isOneOf(name, {"NONE", "IMAGE", "IMAGE MAP"}) ? "" : name;
}

/// Of two labels in one file the PDS3 label counts; the other where only it has a model.
StatedCamera chosenCamera(const Source& source, const json& vicar_label,
                          std::vector<std::string>& flags) {
  StatedCamera stated = statedCamera(source.format, source.tree);
  if (!vicar_label.is_object()) return stated;
  StatedCamera other = statedCamera(LabelFormat::kVicar, vicar_label);
  if (!stated.cahv && other.cahv) {
    flags.push_back(
        "the camera model comes from the VICAR header in the file, as the PDS3 label fails: " +
        stated.remark);
    return other;
  }
  if (stated.cahv && other.cahv && !sameModel(stated, other))
    flags.push_back(
        "the VICAR header in the file and the PDS3 label state different camera models; that of "
        "the PDS3 label is used");
  return stated;
}

void readCamera(const Source& source, const json& vicar_label, ImageLabel& label) {
  const StatedCamera stated = chosenCamera(source, vicar_label, label.flags);
  label.camera_items = stated.items;
  label.camera_remark = stated.remark;
  label.flags.insert(label.flags.end(), stated.flags.begin(), stated.flags.end());
  if (!stated.cahv) return;
  label.camera_remark = cameraMisfit(*stated.cahv, label.width, label.height, label.subframe,
                                     detectorOf(label.identifiers));
  if (!label.camera_remark.empty()) return;
  label.camera = cameraOfVectors(*stated.cahv, label.width, label.height);
  if (!label.camera) return;  // reported by cameraMisfit
  label.camera->reference->frame = stated.frame;
  if (stated.frame.name.empty())
    label.flags.push_back("the label does not name the frame of its camera model");
}

/// KEY = VALUE in a label's text; keys within quotes and comments do not count.
class Statements {
 public:
  explicit Statements(std::string_view text) : text_(text) {}

  bool next() {
    while (!text_.empty()) {
      if (text_.starts_with("/*")) {
        skipBehind("*/");
      } else if (text_.front() == '"' || text_.front() == '\'') {
        (void)quoted();
      } else if (key = word(); key.empty()) {
        text_.remove_prefix(1);
      } else if (text_ = skipBlanks(text_); text_.starts_with('=')) {
        text_ = skipBlanks(text_.substr(1));
        value = text_.starts_with('\'') ? quoted() : word();
        return true;
      }
    }
    return false;
  }

  std::string_view key;
  std::string_view value;  ///< a word, or the text between ' and '; else empty

 private:
  void skipBehind(std::string_view end) {
    const std::size_t at = text_.find(end, 1);
    text_.remove_prefix(at == std::string_view::npos ? text_.size() : at + end.size());
  }
  std::string_view quoted() {
    const std::string_view before = text_;
    skipBehind(text_.substr(0, 1));
    return before.substr(1, before.size() - text_.size() - (before.size() > 1 ? 2 : 1));
  }
  std::string_view word() {
    const auto isPart = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    };
    const auto end = std::find_if_not(text_.begin(), text_.end(), isPart);
    const std::string_view taken = text_.substr(0, static_cast<std::size_t>(end - text_.begin()));
    text_.remove_prefix(taken.size());
    return taken;
  }

  std::string_view text_;
};

/// The first key that a camera model of the text states twice, or its VICAR property that is there
/// twice. GDAL hands on the last one alone.
std::string statedTwice(std::string_view text, std::set<std::string>& properties) {
  Statements statements(text);
  std::set<std::string> keys;
  bool in_model = false;
  while (statements.next()) {
    const std::string key = upperCase(statements.key);
    const bool begins = isOneOf(key, {"GROUP", "OBJECT", "PROPERTY"});
    if (begins) keys.clear();
    if (begins || isOneOf(key, {"END_GROUP", "END_OBJECT", "TASK"})) {
      in_model = begins && isCameraGroup(statements.value);
      if (in_model && key == "PROPERTY" && !properties.emplace(statements.value).second)
        return std::string(statements.value);
    } else if (in_model && !keys.insert(key).second) {
      return key;
    }
  }
  return "";
}

std::string statedTwice(const LabelFiles& files) {
  const std::string_view text = asText(files.labelBytes());
  std::set<std::string> properties;
  if (files.format == LabelFormat::kPds3)
    return statedTwice(text.substr(0, text.find('\0')), properties);
  if (files.format != LabelFormat::kVicar) return "";
  // Properties are in the label at the file's beginning and in that at its end; pixels between
  // them.
  std::string twice;
  std::size_t at = text.find("PROPERTY='");
  while (at != std::string_view::npos && twice.empty()) {
    const std::size_t end = std::min(text.find('\0', at), text.size());
    twice = statedTwice(text.substr(at, end - at), properties);
    at = text.find("PROPERTY='", end);
  }
  return twice;
}

}  // namespace

LabelReading readLabelTree(LabelFormat format, const json& tree, const json& vicar_label,
                           const LabelPicture& picture) {
  const Source source{format, tree};
  LabelReading reading;
  ImageLabel& label = reading.label;
  label.format = labelFormatName(format);
  label.width = picture.width;
  label.height = picture.height;
  label.identifiers = identifiersOf(source);
  label.subframe = subframeOf(source);
  label.bit_depth = bitDepthOf(source, picture, label.flags);
  label.bayer_pattern = bayerPattern(source, picture);
  reading.invalid = invalidValues(source, picture);
  reading.derived_type = derivedType(source);
  readCamera(source, vicar_label, label);
  label.frames = labelFrames(format, tree, label.flags);
  addPictureFlags(source, picture, label.flags);
  if (!reading.derived_type.empty())
    label.flags.push_back("the label calls this a " + reading.derived_type +
                          ", not an image of the scene");
  return reading;
}

LabelReading readLabel(const LabelFiles& files, const LabelRaster& raster) {
  LabelReading reading =
      readLabelTree(files.format, raster.label, raster.vicar_label, raster.picture);
  const std::string twice = statedTwice(files);
  if (twice.empty()) return reading;
  reading.label.camera.reset();
  reading.label.camera_remark =
      "the label states " + twice + " of its camera model twice; give a camera file";
  return reading;
}

bool hasImageLabel(const std::filesystem::path& file) { return labelFileOf(file).has_value(); }

ImageLabel readImageLabel(const std::filesystem::path& file) {
  const LabelFiles files = readLabelFiles(labelFileOf(file).value_or(file));
  return readLabel(files, openLabelRaster(files)).label;
}

}  // namespace boresight::sessions
