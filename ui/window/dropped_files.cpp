// SPDX-License-Identifier: Apache-2.0
#include "ui/window/dropped_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <exception>

#include "sessions/io/cahvor_file.h"
#include "sessions/io/json_reader.h"
#include "sessions/io/labels/image_label.h"

namespace boresight::ui {
namespace {

enum class Kind {
  kImage,
  kMesh,
  kCamera,
  kPose,
  kTransform,
  kDataset,
  kSession,
  kResults,
  kRecord,
  kUnknown
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

template <std::size_t N>
bool isOneOf(const std::string& text, const std::array<const char*, N>& known) {
  return std::find(known.begin(), known.end(), text) != known.end();
}

Kind kindOfJson(const std::filesystem::path& file, std::string& problem) {
  std::string format;
  try {
    const auto bytes =
        sessions::readFileBytes(file, sessions::kMaxJsonBytes, sessions::FileUse::kFree);
    const sessions::JsonDocument document(file, sessions::asText(bytes));
    format = document.root().at("format").nonEmptyText();
  } catch (const std::exception& error) {
    problem = error.what();
    return Kind::kUnknown;
  }
  if (format == "boresight-camera") return Kind::kCamera;
  if (format == "boresight-pose") return Kind::kPose;
  if (format == "boresight-transform") return Kind::kTransform;
  if (format == "boresight-dataset") return Kind::kDataset;
  if (format == "boresight-session") return Kind::kSession;
  problem = file.string() + ": the format '" + format +
            "' is none that can be opened here (camera, pose, transform, dataset, session)";
  return Kind::kUnknown;
}

Kind kindOf(const std::filesystem::path& file, std::string& problem) {
  const std::string extension = lower(file.extension().string());
  if (isOneOf(extension, std::array{".png", ".jpg", ".jpeg", ".tif", ".tiff"})) return Kind::kImage;
  if (isOneOf(extension, std::array{".ply", ".obj", ".stl", ".gltf", ".glb"})) return Kind::kMesh;
  if (extension == ".whsr") return Kind::kRecord;
  if (extension == ".sqlite") return Kind::kResults;
  if (extension == ".json") return kindOfJson(file, problem);
  if (extension == ".zip") {
    problem = file.string() + ": an archive: unpack it, and open the session in it";
    return Kind::kUnknown;
  }
  if (sessions::isCahvorFile(file)) return Kind::kCamera;
  if (sessions::hasImageLabel(file)) return Kind::kImage;
  problem =
      file.string() +
      ": not an image (png, jpg, tif, or with a VICAR, PDS3 or PDS4 label), a mesh (ply, obj, "
      "stl, gltf, glb), a camera (json, cahvor), an onboard record (whsr), results (sqlite) "
      "or a json file";
  return Kind::kUnknown;
}

/// Takes the image; one whose label cannot be read, or lacks its pixels, is a problem and no image.
void takeImage(const std::filesystem::path& image, DroppedFiles& made) {
  std::optional<std::string> remark;
  if (sessions::hasImageLabel(image)) {
    try {
      const sessions::ImageLabel label = sessions::readImageLabel(image);
      remark = label.camera ? std::string() : label.camera_remark;
    } catch (const std::exception& error) {
      made.problems.emplace_back(error.what());
      return;
    }
  }
  made.one.image = image;
  made.label_camera_remark = remark;
}

bool isNamedTruth(const std::filesystem::path& file) {
  return lower(file.stem().string()).find("truth") != std::string::npos;
}

}  // namespace

bool DroppedFiles::isCase() const {
  return !one.image.empty() && hasCamera() && !one.seed.empty() && !one.parts.empty();
}

bool DroppedFiles::hasCamera() const {
  return !one.camera.empty() || (label_camera_remark && label_camera_remark->empty());
}

bool DroppedFiles::isRecordAlone() const {
  return record && !dataset && one.image.empty() && one.camera.empty() && one.seed.empty() &&
         one.parts.empty() && !one.truth;
}

std::string DroppedFiles::missing() const {
  std::vector<std::string> names;
  if (one.image.empty()) names.emplace_back("an image");
  if (!hasCamera())
    names.emplace_back("a camera (json)" +
                       (label_camera_remark ? ": " + *label_camera_remark : ""));
  if (one.parts.empty()) names.emplace_back("a mesh");
  if (one.seed.empty()) names.emplace_back("a seed pose (json)");
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i];
  }
  return text;
}

bool DroppedFiles::beginsAnew(const DroppedFiles& earlier) const {
  const bool more =
      !one.camera.empty() || !one.seed.empty() || !one.parts.empty() || one.truth.has_value();
  return isCase() || (!one.image.empty() && !earlier.one.image.empty() && more);
}

std::string DroppedFiles::keptNames(const DroppedFiles& earlier) const {
  std::string names;
  const auto add = [&names](const std::filesystem::path& file, bool replaced) {
    if (!file.empty() && !replaced) names += (names.empty() ? "" : ", ") + file.filename().string();
  };
  add(earlier.one.image, !one.image.empty());
  add(earlier.one.camera, !one.camera.empty());
  for (const sessions::PartSource& part : earlier.one.parts) add(part.mesh, !one.parts.empty());
  add(earlier.one.seed, !one.seed.empty());
  add(earlier.one.truth.value_or(""), one.truth.has_value());
  for (const std::filesystem::path& file : earlier.one.transforms) add(file, false);
  add(earlier.record.value_or(""), record.has_value());
  return names;
}

DroppedFiles classify(const std::vector<std::filesystem::path>& files,
                      const DroppedFiles& earlier) {
  DroppedFiles made;
  made.one = earlier.one;
  made.record = earlier.record;
  made.label_camera_remark = earlier.label_camera_remark;
  bool new_mesh = true;
  for (const std::filesystem::path& file : files) {
    std::string problem;
    switch (kindOf(file, problem)) {
      case Kind::kImage:
        takeImage(file, made);
        break;
      case Kind::kMesh: {
        if (new_mesh) made.one.parts.clear();
        new_mesh = false;
        sessions::PartSource part;
        part.mesh = file;
        made.one.parts.push_back(part);
        break;
      }
      case Kind::kCamera:
        made.one.camera = file;
        break;
      case Kind::kPose:
        if (isNamedTruth(file)) {
          made.one.truth = file;
        } else {
          made.one.seed = file;
        }
        break;
      case Kind::kTransform:
        made.one.transforms.push_back(file);
        break;
      case Kind::kDataset:
        made.dataset = file;
        break;
      case Kind::kSession:
        made.session = file;
        break;
      case Kind::kResults:
        made.results = file;
        break;
      case Kind::kRecord:
        made.record = file;
        break;
      case Kind::kUnknown:
        made.problems.push_back(problem);
        break;
    }
  }
  return made;
}

}  // namespace boresight::ui
