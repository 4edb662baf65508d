// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/label_camera.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "sessions/io/label_groups.h"
#include "sessions/io/label_values.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

constexpr int kMostComponents = 9;

/// What a component of the model is called.
struct Component {
  char letter;
  const char* name;
};
constexpr Component kComponents[] = {
    {'C', "CENTER"}, {'A', "AXIS"},     {'H', "HORIZONTAL"}, {'V', "VERTICAL"}, {'O', "OPTICAL"},
    {'R', "RADIAL"}, {'E', "ENTRANCE"}, {'T', "MTYPE"},      {'P', "MPARM"},
};

char letterOf(const std::string& text) {
  const std::string name = upperCase(text);
  for (const Component& one : kComponents)
    if (name == one.name || (name.size() == 1 && name[0] == one.letter)) return one.letter;
  if (name == "CENTRE") return 'C';
  return '\0';
}

/// The values of a group's components by letter.
struct Components {
  std::array<const json*, 128> values{};
  std::array<std::string, 128> units{};
  std::string remark;

  const json* value(char letter) const { return values[static_cast<unsigned char>(letter)]; }
};

Components componentsOf(const json& group) {
  Components components;
  const auto letters = labelTexts(labelMember(&group, "MODEL_COMPONENT_ID"));
  const auto names = labelTexts(labelMember(&group, "MODEL_COMPONENT_NAME"));
  const auto units =
      labelTexts(labelMember(&group, {"MODEL_COMPONENT_UNIT", "MODEL_COMPONENT__UNIT"}));
  for (int i = 0; i < kMostComponents; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::string key = "MODEL_COMPONENT_" + std::to_string(i + 1);
    const json* value = labelMember(&group, key);
    if (value == nullptr) continue;
    const char by_letter = at < letters.size() ? letterOf(letters[at]) : '\0';
    const char by_name = at < names.size() ? letterOf(names[at]) : '\0';
    if (by_letter != '\0' && by_name != '\0' && by_letter != by_name) {
      components.remark = "the label's camera model calls component " + std::to_string(i + 1) +
                          " both " + letters[at] + " and " + names[at];
      return components;
    }
    const char letter = by_letter != '\0' ? by_letter : by_name;
    if (letter == '\0') continue;
    const auto place = static_cast<unsigned char>(letter);
    if (components.values[place] != nullptr) {
      components.remark =
          "the label's camera model has the component " + std::string(1, letter) + " twice";
      return components;
    }
    components.values[place] = value;
    std::string unit = labelUnit(value);
    if (unit.empty()) unit = upperCase(labelText(labelMember(&group, key + "__UNIT")).value_or(""));
    if (unit.empty() && at < units.size()) unit = upperCase(units[at]);
    components.units[place] = unit;
  }
  return components;
}

bool isOneOf(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&text](const char* word) { return text == word; });
}

/// Metres for the centre and the pupil, pixels for H and V, nothing else.
std::string unitRemark(const Components& components) {
  for (const Component& one : kComponents) {
    const std::string& unit = components.units[static_cast<unsigned char>(one.letter)];
    if (unit.empty()) continue;
    const bool length = one.letter == 'C' || one.letter == 'E';
    const bool picture = one.letter == 'H' || one.letter == 'V';
    const bool known = (length && isOneOf(unit, {"M", "METER", "METERS", "METRE", "METRES"})) ||
                       (picture && isOneOf(unit, {"PIXEL", "PIXELS", "PX"})) ||
                       isOneOf(unit, {"N/A", "NONE", "UNITLESS", "DIMENSIONLESS"});
    if (!known && (length || picture))
      return "the unit '" + unit + "' of the label's camera model (component " +
             std::string(1, one.letter) + ") is not known";
  }
  return "";
}

std::optional<CameraModel> modelOf(const std::string& type) {
  const std::string name = upperCase(type);
  if (name == "CAHV") return CameraModel::kCahv;
  if (name == "CAHVOR") return CameraModel::kCahvor;
  if (name == "CAHVORE") return CameraModel::kCahvore;
  return std::nullopt;
}

/// Every vector of the model through `vector(letter)`, type and parameter through `number(letter)`.
/// False with a remark when one is missing.
template <class Vector, class Number>
bool fillModel(const Vector& vector, const Number& number, CahvModel& cahv, std::string& remark) {
  const auto fill = [&](char letter, Eigen::Vector3d& target) {
    const std::optional<Eigen::Vector3d> found = vector(letter);
    if (!found) {
      remark = std::string("the label's camera model has no usable component ") + letter;
      return false;
    }
    target = *found;
    return true;
  };
  if (!fill('C', cahv.c_m) || !fill('A', cahv.a) || !fill('H', cahv.h_px) || !fill('V', cahv.v_px))
    return false;
  if (cahv.model == CameraModel::kCahv) return true;
  if (!fill('O', cahv.o) || !fill('R', cahv.r)) return false;
  if (cahv.model == CameraModel::kCahvor) return true;
  if (!fill('E', cahv.e_m)) return false;
  const std::optional<double> type = number('T');
  if (!type || !(*type == 1.0 || *type == 2.0 || *type == 3.0)) {
    remark = "the label's CAHVORE model does not say its type (1, 2 or 3)";
    return false;
  }
  cahv.type = static_cast<int>(*type);
  if (cahv.type != 3) return true;
  const std::optional<double> parameter = number('P');
  if (!parameter) {
    remark = "the label's CAHVORE model of type 3 has no parameter";
    return false;
  }
  cahv.parameter = *parameter;
  return true;
}

std::vector<LabelItem> itemsOf(const json& group) {
  std::vector<LabelItem> items;
  for (const char* key :
       {"CALIBRATION_SOURCE_ID", "GEOMETRY_SOURCE_ID", "SOLUTION_ID", "CAMERA_SERIAL_NUMBER",
        "FILTER_NAME", "FILTER_NUMBER", "MODEL_DESC", "^MODEL_DESC", "MODEL_DESC__PTR",
        "MODEL_TRANSFORM_VECTOR", "MODEL_TRANSFORM_QUATERNION", "INTERPOLATION_METHOD",
        "INTERPOLATION_VALUE"}) {
    const std::string text = joined(labelTexts(labelMember(&group, key)));
    const std::string name = std::string_view(key).find("MODEL_DESC") == std::string_view::npos
                                 ? std::string(key)
                                 : "MODEL_DESC";
    if (!text.empty()) items.push_back({name, text});
  }
  return items;
}

FrameName frameOf(const json& group, std::string_view name, std::string_view index) {
  FrameName frame;
  frame.name = labelText(labelMember(&group, name)).value_or("");
  for (const double one : labelNumbers(labelMember(&group, index)))
    if (one == std::floor(one) && std::abs(one) < 9e15)
      frame.index.push_back(static_cast<std::int64_t>(one));
  return frame;
}

StatedCamera groupCamera(LabelFormat format, const json& label) {
  StatedCamera stated;
  const json* group = labelGroup(
      format, label, {"GEOMETRIC_CAMERA_MODEL", "GEOMETRIC_CAMERA_MODEL_PARMS", "CAMERA_MODEL"});
  if (group == nullptr) {
    stated.remark = "the label has no camera model";
    return stated;
  }
  stated.items = itemsOf(*group);
  stated.frame = frameOf(*group, "REFERENCE_COORD_SYSTEM_NAME", "REFERENCE_COORD_SYSTEM_INDEX");
  const std::string type = labelText(labelMember(group, "MODEL_TYPE")).value_or("NONE");
  const auto model = modelOf(type);
  if (!model) {
    stated.remark = type == "NONE" ? "the label's camera model is NONE"
                                   : "the label's camera model, '" + type +
                                         "', is not one of CAHV, CAHVOR and CAHVORE";
    return stated;
  }
  const Components components = componentsOf(*group);
  stated.remark = components.remark.empty() ? unitRemark(components) : components.remark;
  if (!stated.remark.empty()) return stated;
  CahvModel cahv;
  cahv.model = *model;
  if (fillModel([&](char letter) { return labelVector(components.value(letter)); },
                [&](char letter) {
                  const auto numbers = labelNumbers(components.value(letter));
                  return numbers.empty() ? std::nullopt : std::optional(numbers.front());
                },
                cahv, stated.remark))
    stated.cahv = cahv;
  return stated;
}

// PDS4: the classes of the geometry dictionary.

const char* elementOf(char letter) {
  switch (letter) {
    case 'C':
      return "Vector_Center";
    case 'A':
      return "Vector_Axis";
    case 'H':
      return "Vector_Horizontal";
    case 'V':
      return "Vector_Vertical";
    case 'O':
      return "Vector_Optical";
    case 'R':
      return "Radial_Terms";
    case 'E':
      return "Entrance_Terms";
    case 'T':
      return "cahvore_model_type";
    default:
      return "cahvore_model_parameter";
  }
}

/// Three members called PREFIXx.., by the first set of names that is whole.
std::optional<Eigen::Vector3d> elementVector(const json* element) {
  constexpr const char* kNames[][3] = {{"x_position", "y_position", "z_position"},
                                       {"x_unit", "y_unit", "z_unit"},
                                       {"x_pixel", "y_pixel", "z_pixel"},
                                       {"c0", "c1", "c2"},
                                       {"x", "y", "z"}};
  for (const auto& names : kNames) {
    Eigen::Vector3d vector;
    bool whole = true;
    for (int i = 0; i < 3 && whole; ++i) {
      const auto number = labelNumber(labelMember(element, names[i]));
      whole = number.has_value();
      if (whole) vector[i] = *number;
    }
    if (whole) return vector;
  }
  return std::nullopt;
}

bool hasOtherUnit(const json& model) {
  for (const char* name : {"x_position", "y_position", "z_position"}) {
    const std::string unit = labelUnit(labelPath(&model, {"Vector_Center", name}));
    if (!unit.empty() && unit != "M") return true;
  }
  return false;
}

StatedCamera elementCamera(const json& label) {
  StatedCamera stated;
  const auto parameters = elementsNamed(label, "Camera_Model_Parameters");
  if (parameters.empty()) {
    stated.remark = "the label has no camera model";
    return stated;
  }
  const json& found = *parameters.front();
  for (const char* key : {"calibration_source_id", "model_desc", "solution_id"})
    if (const auto text = labelText(labelMember(&found, key))) stated.items.push_back({key, *text});
  if (const json* space =
          labelPath(&found, {"Coordinate_Space_Reference", "Coordinate_Space_Indexed"}))
    stated.frame = indexedFrame(*space);
  constexpr std::pair<const char*, CameraModel> kModels[] = {
      {"CAHVORE_Model", CameraModel::kCahvore},
      {"CAHVOR_Model", CameraModel::kCahvor},
      {"CAHV_Model", CameraModel::kCahv}};
  const auto stated_type = labelText(labelMember(&found, "model_type"));
  for (const auto& [name, model] : kModels) {
    const json* element = labelMember(&found, name);
    if (element == nullptr || element->is_array()) continue;
    if (stated_type && modelOf(*stated_type) && *modelOf(*stated_type) != model) continue;
    if (hasOtherUnit(*element)) {
      stated.remark = "the centre of the label's camera model is not in metres";
      return stated;
    }
    CahvModel cahv;
    cahv.model = model;
    if (fillModel([&](char c) { return elementVector(labelMember(element, elementOf(c))); },
                  [&](char c) { return labelNumber(labelMember(element, elementOf(c))); }, cahv,
                  stated.remark))
      stated.cahv = cahv;
    return stated;
  }
  stated.remark = "the label's camera model" + (stated_type ? ", '" + *stated_type + "'," : "") +
                  " is not one of CAHV, CAHVOR and CAHVORE";
  return stated;
}

}  // namespace

FrameName indexedFrame(const json& space) {
  FrameName frame;
  frame.name = labelText(labelMember(&space, "coordinate_space_frame_type")).value_or("");
  const json* indices = labelMember(&space, "Coordinate_Space_Index");
  const auto add = [&frame](const json& index) {
    const auto number = labelInteger(
        labelMember(&index, {"index_value_number", "index_value_string", "index_value"}));
    if (number) frame.index.push_back(*number);
  };
  if (indices != nullptr && indices->is_array())
    for (const json& index : *indices) add(index);
  else if (indices != nullptr)
    add(*indices);
  return frame;
}

StatedCamera statedCamera(LabelFormat format, const json& label) {
  return format == LabelFormat::kPds4 ? elementCamera(label) : groupCamera(format, label);
}

}  // namespace boresight::sessions
