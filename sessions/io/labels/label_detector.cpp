// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/label_detector.h"

#include <string>
#include <string_view>

#include "sessions/io/labels/label_values.h"

namespace boresight::sessions {
namespace {

/// What a mission is called in labels; the host is an INSTRUMENT_HOST_ID and nothing more.
struct MissionName {
  char mission;
  std::string_view name;
  bool host;
};
constexpr MissionName kMissions[] = {
    {'E', "MARS EXPLORATION ROVER", false},
    {'S', "MARS SCIENCE LABORATORY", false},
    {'S', "CURIOSITY", false},
    {'M', "MARS 2020", false},
    {'M', "MARS2020", false},
    {'M', "PERSEVERANCE", false},
    {'E', "MER1", true},
    {'E', "MER2", true},
    {'S', "MSL", true},
    {'M', "M20", true},
    {'M', "M2020", true},
    {'P', "PHX", true},
};

/// Detectors by words of the instrument's identifier or name; the last of a mission is its largest.
struct Instrument {
  char mission;
  std::string_view word;
  int width;
  int height;
};
constexpr Instrument kInstruments[] = {
    {'E', "", 1024, 1024},         {'S', "NAV", 1024, 1024},        {'S', "HAZ", 1024, 1024},
    {'S', "MAST", 1648, 1200},     {'S', "MAHLI", 1648, 1200},      {'S', "MARDI", 1648, 1200},
    {'M', "NAVCAM", 5120, 3840},   {'M', "NAVIGATION", 5120, 3840}, {'M', "HAZ", 5120, 3840},
    {'M', "CACHECAM", 5120, 3840}, {'M', "MCZ", 1648, 1200},        {'M', "MASTCAM", 1648, 1200},
    {'M', "WATSON", 1648, 1200},   {'M', "SHERLOC", 1648, 1200},    {'S', "", 1648, 1200},
    {'M', "", 5120, 3840},
};

char missionOf(const std::vector<LabelItem>& identifiers) {
  for (const LabelItem& item : identifiers) {
    const std::string text = upperCase(item.value);
    for (const MissionName& one : kMissions)
      if (one.host ? item.name == "INSTRUMENT_HOST_ID" && text == one.name
                   : text.find(one.name) != std::string::npos)
        return one.mission;
  }
  return '\0';
}

bool namesInstrument(const LabelItem& item) {
  return item.name == "INSTRUMENT_ID" || item.name == "INSTRUMENT_NAME" ||
         item.name == "Observing_System_Component";
}

}  // namespace

LabelDetector detectorOf(const std::vector<LabelItem>& identifiers) {
  LabelDetector detector;
  const char mission = missionOf(identifiers);
  detector.model_of_subframe = mission != '\0';
  std::string words;
  for (const LabelItem& item : identifiers)
    if (namesInstrument(item)) words += upperCase(item.value) + "\n";
  for (const Instrument& one : kInstruments) {
    if (one.mission != mission || words.find(one.word) == std::string::npos) continue;
    detector.width = one.width;
    detector.height = one.height;
    return detector;
  }
  return detector;
}

}  // namespace boresight::sessions
