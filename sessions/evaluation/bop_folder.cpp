// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/bop_folder.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <vector>

#include "sessions/io/errors.h"
#include "sessions/io/json_reader.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

std::optional<int> numberOf(const std::string& text) {
  int number = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 0) return std::nullopt;
  return number;
}

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    found.push_back(at->path());
  if (error) throw InputError(folder, "", "cannot be listed: " + error.message());
  std::sort(found.begin(), found.end());
  return found;
}

bool isImage(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg" ||
         extension == ".tif" || extension == ".tiff";
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Sensors whose files lie in a scene, for messages.
std::string sensorsOf(const fs::path& scene) {
  const std::string start = "scene_camera_";
  std::vector<std::string> names;
  for (const fs::path& file : entries(scene)) {
    const std::string stem = file.stem().string();
    if (stem.rfind(start, 0) == 0) names.push_back(stem.substr(start.size()));
  }
  return listed(names);
}

}  // namespace

std::string bopNumber(int number) {
  const std::string digits = std::to_string(number);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

fs::path bopSceneFile(const fs::path& scene, const std::string& what, const std::string& sensor) {
  return scene / (what + (sensor.empty() ? "" : "_" + sensor) + ".json");
}

std::map<int, fs::path> bopScenes(const fs::path& split, const std::string& sensor) {
  std::map<int, fs::path> scenes;
  for (const fs::path& entry : entries(split)) {
    const auto number = numberOf(entry.filename().string());
    if (!number || !fs::is_directory(entry)) continue;
    if (fs::exists(bopSceneFile(entry, "scene_camera", sensor))) {
      scenes.emplace(*number, entry);
    } else if (const std::string sensors = sensorsOf(entry); !sensors.empty()) {
      throw InputError(entry, "",
                       sensor.empty()
                           ? "has several sensors (" + sensors + "): choose one with --sensor"
                           : "has no sensor " + sensor + "; there are " + sensors);
    }
  }
  return scenes;
}

fs::path bopSplitFolder(const fs::path& root, const std::string& split, const std::string& sensor) {
  if (!split.empty()) {
    if (fs::is_directory(root / split)) return root / split;
    throw InputError(root, "", "has no split " + split);
  }
  std::vector<std::string> names;
  for (const fs::path& entry : entries(root))
    if (fs::is_directory(entry) && !bopScenes(entry, sensor).empty())
      names.push_back(entry.filename().string());
  if (std::find(names.begin(), names.end(), "test") != names.end()) return root / "test";
  if (names.size() == 1) return root / names.front();
  if (names.empty())
    throw InputError(root, "",
                     "is not a BOP dataset: no folder in it has scenes with scene_camera.json");
  throw InputError(root, "", "has several splits, choose one with --split: " + listed(names));
}

std::map<int, fs::path> bopImages(const fs::path& scene, const std::string& sensor) {
  const std::string end = sensor.empty() ? "" : "_" + sensor;
  std::vector<std::string> names = {"rgb" + end, "gray" + end};
  if (!sensor.empty()) names.insert(names.begin(), sensor);
  for (const std::string& name : names) {
    if (!fs::is_directory(scene / name)) continue;
    std::map<int, fs::path> images;
    for (const fs::path& file : entries(scene / name))
      if (const auto number = numberOf(file.stem().string()); number && isImage(file))
        images.emplace(*number, file);
    return images;
  }
  throw InputError(scene, "", "has no folder of images (" + listed(names) + ")");
}

fs::path bopModels(const fs::path& root) {
  for (const char* name : {"models", "models_cad", "models_eval"})
    if (fs::exists(root / name / "models_info.json")) return root / name;
  for (const fs::path& entry : entries(root))
    if (entry.filename().string().rfind("models", 0) == 0 && fs::exists(entry / "models_info.json"))
      return entry;
  throw InputError(root, "", "has no folder models with a models_info.json");
}

std::optional<BopTargets> bopTargets(const fs::path& root) {
  const fs::path file = root / "test_targets_bop19.json";
  if (!fs::exists(file)) return std::nullopt;
  constexpr int kMaxId = 1 << 30;
  BopTargets targets;
  const JsonDocument document(file);
  for (const JsonReader& entry : document.root().elements()) {
    const auto id = [&entry](const char* key) {
      return static_cast<int>(entry.at(key).integer(0, kMaxId));
    };
    targets[{id("scene_id"), id("im_id"), id("obj_id")}] = id("inst_count");
  }
  return targets;
}

}  // namespace boresight::sessions
