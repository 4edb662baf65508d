// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/raw_metadata.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <nlohmann/json.hpp>

#include "sessions/text/text_reading.h"

namespace boresight::sessions {
namespace {

constexpr const char* kComponents = "camera_model_component_list";

/// The numbers of "(1,2,3);(4,5,6);2;0.0", whose parentheses and separators carry no meaning.
/// InputError for anything else.
std::vector<double> numbersOf(const JsonReader& json) {
  constexpr const char* kBetween = "(),; ";
  const std::string text = json.text();
  std::vector<double> numbers;
  for (std::string_view rest = text;;) {
    rest.remove_prefix(std::min(rest.find_first_not_of(kBetween), rest.size()));
    if (rest.empty()) return numbers;
    const std::string_view word = rest.substr(0, rest.find_first_of(kBetween));
    const auto number = realIn(word);
    if (!number) json.fail("not a list of numbers: " + noNumberText(word));
    if (!std::isfinite(*number)) json.fail("not a list of numbers: " + shortWord(word));
    numbers.push_back(*number);
    rest.remove_prefix(word.size());
  }
}

CahvModel modelOf(const JsonReader& type, const JsonReader& components) {
  CahvModel cahv;
  cahv.model = *cahvModelOf(type.choice({"CAHV", "CAHVOR", "CAHVORE"}));
  const std::vector<double> numbers = numbersOf(components);
  std::size_t used = 0;
  const int needed = vectorComponents(cahv.model) + (cahv.model == CameraModel::kCahvore ? 2 : 0);
  if (std::ssize(numbers) < needed)
    components.fail(std::to_string(needed) + " numbers are needed, " +
                    std::to_string(numbers.size()) + " given");
  forVectors(cahv, [&](const char*, Eigen::Vector3d& vector) {
    for (int axis = 0; axis < 3; ++axis) vector[axis] = numbers[used++];
  });
  if (cahv.model != CameraModel::kCahvore) return cahv;
  cahv.type = static_cast<int>(numbers[used]);
  if (cahv.type < 1 || cahv.type > 3 || cahv.type != numbers[used])
    components.fail("the type of a CAHVORE model is 1, 2 or 3");
  cahv.parameter = numbers[used + 1];
  return cahv;
}

}  // namespace

bool isRawMetadata(const JsonReader& json) {
  return json.value().is_object() && json.has(kComponents);
}

CameraFile readRawMetadata(const JsonReader& json) {
  const JsonReader components = json.at(kComponents);
  const CahvModel cahv = modelOf(json.at("camera_model_type"), components);
  const JsonReader dimension = json.at("dimension");
  const std::vector<double> size = numbersOf(dimension);
  if (size.size() != 2 || !isImageSide(size[0]) || !isImageSide(size[1]))
    dimension.fail("not the width and height of an image");
  std::optional<CameraFile> file =
      cameraOfVectors(cahv, static_cast<int>(size[0]), static_cast<int>(size[1]));
  if (!file) components.fail("no camera has these vectors");
  file->reference->frame = {"ROVER_NAV_FRAME",
                            {json.at("site").integer(), json.at("drive").integer()}};
  return *file;
}

}  // namespace boresight::sessions
