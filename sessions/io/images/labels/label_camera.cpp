// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/labels/label_camera.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

#include "sessions/io/images/labels/label_values.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

constexpr std::size_t kMostComponents = 9;
const std::string kNone = "the label's camera model is NONE";

/// What a component of the model is called in groups, and its element in PDS4.
struct Component {
  char letter;
  const char* name;
  const char* element;
};
constexpr Component kComponents[] = {
    {'C', "CENTER", "Vector_Center"},          {'A', "AXIS", "Vector_Axis"},
    {'H', "HORIZONTAL", "Vector_Horizontal"},  {'V', "VERTICAL", "Vector_Vertical"},
    {'O', "OPTICAL", "Vector_Optical"},        {'R', "RADIAL", "Radial_Terms"},
    {'E', "ENTRANCE", "Entrance_Terms"},       {'T', "MTYPE", "cahvore_model_type"},
    {'P', "MPARM", "cahvore_model_parameter"},
};

char letterOf(const std::string& text) {
  const std::string name = upperCase(text);
  for (const Component& component : kComponents)
    if (name == component.name || (name.size() == 1 && name[0] == component.letter))
      return component.letter;
  if (name == "CENTRE") return 'C';
  return '\0';
}

struct Statement {
  std::vector<double> numbers;
  std::string unit;  ///< upper case; "" where none is stated
};

struct Components {
  std::map<char, Statement> entries;  ///< by letter
  std::string remark;                 ///< one sentence where the components contradict each other
};

Components groupComponents(const json& group) {
  Components components;
  const auto letters = labelTexts(labelMember(&group, "MODEL_COMPONENT_ID"));
  const auto names = labelTexts(labelMember(&group, "MODEL_COMPONENT_NAME"));
  const auto units =
      labelTexts(labelMember(&group, {"MODEL_COMPONENT_UNIT", "MODEL_COMPONENT__UNIT"}));
  for (std::size_t at = 0; at < kMostComponents; ++at) {
    const std::string number = std::to_string(at + 1);
    const std::string key = "MODEL_COMPONENT_" + number;
    const json* value = labelMember(&group, key);
    if (value == nullptr) continue;
    const char by_letter = at < letters.size() ? letterOf(letters[at]) : '\0';
    const char by_name = at < names.size() ? letterOf(names[at]) : '\0';
    if (by_letter != '\0' && by_name != '\0' && by_letter != by_name) {
      components.remark = "the label's camera model calls component " + number + " both " +
                          letters[at] + " and " + names[at];
      return components;
    }
    const char letter = by_letter != '\0' ? by_letter : by_name;
    if (letter == '\0') continue;
    std::string unit = labelUnit(value);
    if (unit.empty()) unit = upperCase(labelText(labelMember(&group, key + "__UNIT")).value_or(""));
    if (unit.empty() && at < units.size()) unit = upperCase(units[at]);
    if (!components.entries.emplace(letter, Statement{labelNumbers(value), unit}).second) {
      components.remark =
          "the label's camera model has the component " + std::string(1, letter) + " twice";
      return components;
    }
  }
  return components;
}

/// Of PDS4: an element a component, with a child for each coordinate, or a plain number.
Components elementComponents(const json& model) {
  constexpr const char* kNames[][3] = {{"x_position", "y_position", "z_position"},
                                       {"x_unit", "y_unit", "z_unit"},
                                       {"x_pixel", "y_pixel", "z_pixel"},
                                       {"c0", "c1", "c2"},
                                       {"x", "y", "z"}};
  Components components;
  for (const Component& component : kComponents) {
    const json* element = labelMember(&model, component.element);
    json coordinates = json::array();
    for (const auto& names : kNames)
      for (const char* name : names)
        if (const json* value = labelMember(element, name)) coordinates.push_back(*value);
    const json* values = coordinates.empty() ? element : &coordinates;
    components.entries[component.letter] = {labelNumbers(values), labelUnit(values)};
  }
  return components;
}

/// Metres for the centre and the pupil, pixels for H and V, nothing else.
std::string unitRemark(const Components& components) {
  for (const auto& [letter, statement] : components.entries) {
    const std::string& unit = statement.unit;
    if (unit.empty()) continue;
    const bool length = letter == 'C' || letter == 'E';
    const bool picture = letter == 'H' || letter == 'V';
    const bool known = (length && isOneOf(unit, {"M", "METER", "METERS", "METRE", "METRES"})) ||
                       (picture && isOneOf(unit, {"PIXEL", "PIXELS", "PX"})) ||
                       isOneOf(unit, {"N/A", "NONE", "UNITLESS", "DIMENSIONLESS"});
    if (!known && (length || picture))
      return "the unit '" + unit + "' of the label's camera model (component " +
             std::string(1, letter) + ") is not known";
  }
  return "";
}

/// Sets the model of the components, or the remark why there is none.
void setModel(CameraModel model, const Components& components, StatedCamera& stated) {
  stated.remark = components.remark.empty() ? unitRemark(components) : components.remark;
  const auto numbers = [&components](char letter) {
    const auto found = components.entries.find(letter);
    return found == components.entries.end() ? std::vector<double>() : found->second.numbers;
  };
  CahvModel cahv;
  cahv.model = model;
  forVectors(cahv, [&](const char* key, Eigen::Vector3d& target) {
    const std::vector<double> found = numbers(key[0]);
    if (found.size() == 3)
      target = {found[0], found[1], found[2]};
    else if (stated.remark.empty())
      stated.remark = std::string("the label's camera model has no usable component ") + key;
  });
  if (stated.remark.empty() && model == CameraModel::kCahvore) {
    const std::vector<double> type = numbers('T'), parameter = numbers('P');
    if (type.empty() || !(type[0] == 1.0 || type[0] == 2.0 || type[0] == 3.0))
      stated.remark = "the label's CAHVORE model does not say its type (1, 2 or 3)";
    else if (type[0] == 3.0 && parameter.empty())
      stated.remark = "the label's CAHVORE model of type 3 has no parameter";
    else
      cahv.type = static_cast<int>(type[0]);
    if (cahv.type == 3 && !parameter.empty()) cahv.parameter = parameter[0];
  }
  if (stated.remark.empty()) stated.cahv = cahv;
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

StatedCamera groupCamera(const json& group) {
  StatedCamera stated;
  stated.items = itemsOf(group);
  stated.frame = groupFrame(group, "REFERENCE_COORD_SYSTEM_NAME", "REFERENCE_COORD_SYSTEM_INDEX",
                            stated.flags);
  const std::string type = labelText(labelMember(&group, "MODEL_TYPE")).value_or("NONE");
  if (const auto model = cahvModelOf(type))
    setModel(*model, groupComponents(group), stated);
  else
    stated.remark = type == "NONE" ? kNone
                                   : "the label's camera model, '" + type +
                                         "', is not one of CAHV, CAHVOR and CAHVORE";
  return stated;
}

/// Of PDS4: the classes of the geometry dictionary.
StatedCamera elementCamera(const json& parameters) {
  StatedCamera stated;
  for (const char* key : {"calibration_source_id", "model_desc", "solution_id"})
    if (const auto text = labelText(labelMember(&parameters, key)))
      stated.items.push_back({key, *text});
  if (const json* space =
          labelPath(&parameters, {"Coordinate_Space_Reference", "Coordinate_Space_Indexed"}))
    stated.frame = indexedFrame(*space, stated.flags);
  constexpr std::pair<const char*, CameraModel> kModels[] = {
      {"CAHVORE_Model", CameraModel::kCahvore},
      {"CAHVOR_Model", CameraModel::kCahvor},
      {"CAHV_Model", CameraModel::kCahv}};
  const auto type = labelText(labelMember(&parameters, "model_type"));
  const auto stated_model = cahvModelOf(type.value_or(""));
  for (const auto& [name, model] : kModels) {
    const json* element = labelMember(&parameters, name);
    if (element == nullptr || element->is_array() || stated_model.value_or(model) != model)
      continue;
    setModel(model, elementComponents(*element), stated);
    return stated;
  }
  stated.remark = type == "NONE" ? kNone
                                 : "the label's camera model" + (type ? ", '" + *type + "'," : "") +
                                       " is not one of CAHV, CAHVOR and CAHVORE";
  return stated;
}

/// Of several models that agree the first; models that differ are none.
StatedCamera onlyCamera(const std::vector<StatedCamera>& cameras) {
  const StatedCamera* chosen = nullptr;
  StatedCamera none;
  for (const StatedCamera& camera : cameras) {
    if (!camera.cahv) continue;
    if (chosen == nullptr) chosen = &camera;
    if (chosen == &camera || sameModel(*chosen, camera)) continue;
    none.remark =
        "the label states several camera models that differ; give a camera file with that of the "
        "image";
    return none;
  }
  if (chosen != nullptr) return *chosen;
  for (const StatedCamera& camera : cameras)
    if (camera.remark != kNone) return camera;
  if (!cameras.empty()) return cameras.front();
  none.remark = "the label has no camera model";
  return none;
}

}  // namespace

bool isCameraGroup(std::string_view name) {
  return isOneOf(name, {"GEOMETRIC_CAMERA_MODEL", "GEOMETRIC_CAMERA_MODEL_PARMS", "CAMERA_MODEL"});
}

bool sameModel(const StatedCamera& a, const StatedCamera& b) {
  if (!a.cahv || !b.cahv || a.cahv->model != b.cahv->model || !(a.frame == b.frame)) return false;
  const auto near = [](const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    return (u - v).norm() <= 2e-6 * std::max(1.0, u.norm());
  };
  return near(a.cahv->c_m, b.cahv->c_m) && near(a.cahv->a, b.cahv->a) &&
         near(a.cahv->h_px, b.cahv->h_px) && near(a.cahv->v_px, b.cahv->v_px) &&
         near(a.cahv->o, b.cahv->o) && near(a.cahv->r, b.cahv->r) &&
         near(a.cahv->e_m, b.cahv->e_m) && a.cahv->type == b.cahv->type &&
         std::abs(a.cahv->parameter - b.cahv->parameter) <= 2e-6;
}

StatedCamera statedCamera(LabelFormat format, const json& label) {
  std::vector<StatedCamera> cameras;
  for (const auto& [name, group] : labelGroups(format, label))
    if (isCameraGroup(name)) cameras.push_back(groupCamera(*group));
  if (format == LabelFormat::kPds4)
    for (const json* parameters : elementsNamed(label, "Camera_Model_Parameters"))
      cameras.push_back(elementCamera(*parameters));
  return onlyCamera(cameras);
}

}  // namespace boresight::sessions
