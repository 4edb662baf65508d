// SPDX-License-Identifier: Apache-2.0
#include "ui/window/dropped_files.h"

#include <algorithm>
#include <stdexcept>

#include "sessions/io/cameras/cahvor_file.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/text/plain_text.h"

namespace boresight::ui {

namespace {

/// In the order of `InputKind`.
constexpr const char* kMissingNames[] = {"an image", "a camera (json)", "a mesh",
                                         "a seed pose (json)"};
static_assert(std::size(kMissingNames) == sessions::kInputKinds);

/// Adds a file of one kind to the files taken so far.
using Take = void (*)(const std::filesystem::path& file, DroppedFiles& taken);

/// Throws when the label of an image cannot be read or lacks its pixels.
void takeImage(const std::filesystem::path& file, DroppedFiles& taken) {
  std::optional<std::string> remark;
  if (sessions::hasImageLabel(file)) {
    const sessions::ImageLabel label = sessions::readImageLabel(file);
    remark = label.camera ? std::string() : label.camera_remark;
  }
  taken.one.image = file;
  taken.label_camera_remark = remark;
}

void takeMesh(const std::filesystem::path& file, DroppedFiles& taken) {
  taken.one.parts.emplace_back().mesh = file;
}

void takeCamera(const std::filesystem::path& file, DroppedFiles& taken) { taken.one.camera = file; }

void takePose(const std::filesystem::path& file, DroppedFiles& taken) {
  if (sessions::lowerCase(file.stem().string()).find("truth") != std::string::npos)
    taken.one.truth = file;
  else
    taken.one.seed = file;
}

void takeTransform(const std::filesystem::path& file, DroppedFiles& taken) {
  taken.one.transforms.push_back(file);
}

template <std::optional<std::filesystem::path> DroppedFiles::*Member>
void takeAs(const std::filesystem::path& file, DroppedFiles& taken) {
  taken.*Member = file;
}

struct FileKind {
  std::vector<std::string> names;  ///< extensions, or values of `format`
  Take take;
};

Take findTake(const std::vector<FileKind>& kinds, const std::string& name) {
  for (const FileKind& kind : kinds)
    if (std::ranges::find(kind.names, name) != kind.names.end()) return kind.take;
  return nullptr;
}

Take takeOfJson(const std::filesystem::path& file) {
  static const std::vector<FileKind> kFormats = {
      {{"boresight-camera"}, takeCamera},
      {{"boresight-pose"}, takePose},
      {{"boresight-transform", "boresight-frames"}, takeTransform},
      {{"boresight-dataset"}, takeAs<&DroppedFiles::dataset>},
      {{"boresight-session"}, takeAs<&DroppedFiles::session>},
  };
  const auto bytes =
      sessions::readFileBytes(file, sessions::kMaxJsonBytes, sessions::FileUse::kFree);
  const sessions::JsonDocument document(file, sessions::asText(bytes));
  if (!document.root().has("format"))
    throw std::runtime_error(
        file.string() +
        ": has no \"format\", such as \"boresight-camera\"; a camera or a pose "
        "copied out of a dataset needs \"format\" and \"version\"");
  const std::string format = document.root().at("format").nonEmptyText();
  if (const Take take = findTake(kFormats, format)) return take;
  throw std::runtime_error(
      file.string() + ": the format '" + format +
      "' cannot be opened in the window (camera, pose, transform, dataset, session)");
}

/// Throws when it is nothing known.
Take takeOf(const std::filesystem::path& file) {
  static const std::vector<FileKind> kExtensions = {
      {{".png", ".jpg", ".jpeg", ".tif", ".tiff"}, takeImage},
      {{".ply", ".obj", ".stl", ".gltf", ".glb"}, takeMesh},
      {{".whsr"}, takeAs<&DroppedFiles::record>},
      {{".sqlite"}, takeAs<&DroppedFiles::results>},
  };
  const std::string extension = sessions::lowerCase(file.extension().string());
  if (const Take take = findTake(kExtensions, extension)) return take;
  if (extension == ".json") return takeOfJson(file);
  if (extension == ".zip")
    throw std::runtime_error(file.string() + ": an archive; unpack it, then open its session");
  if (sessions::isCahvorFile(file)) return takeCamera;
  if (sessions::hasImageLabel(file)) return takeImage;
  throw std::runtime_error(
      file.string() +
      ": not an image (png, jpg, tif, or with a VICAR, PDS3 or PDS4 label), a mesh (ply, obj, "
      "stl, gltf, glb), a camera (json, cahvor), an onboard record (whsr), results (sqlite) "
      "or a json file");
}

}  // namespace

bool DroppedFiles::has(InputKind kind) const {
  const bool labelled = label_camera_remark && label_camera_remark->empty();
  return !fileOf(kind).empty() || (kind == InputKind::kCamera && labelled);
}

std::filesystem::path DroppedFiles::fileOf(InputKind kind) const {
  switch (kind) {
    case InputKind::kImage:
      return one.image;
    case InputKind::kCamera:
      return one.camera;
    case InputKind::kMesh:
      return one.parts.empty() ? std::filesystem::path() : one.parts.front().mesh;
    case InputKind::kSeed:
      return one.seed;
  }
  return {};
}

int DroppedFiles::count() const {
  return static_cast<int>(
      std::ranges::count_if(kAllInputs, [this](InputKind kind) { return has(kind); }));
}

bool DroppedFiles::isCase() const { return count() == sessions::kInputKinds; }

bool DroppedFiles::isSeedless() const {
  return count() == sessions::kInputKinds - 1 && !has(InputKind::kSeed);
}

bool DroppedFiles::isRecordAlone() const {
  return record && !dataset && count() == 0 && !one.truth;
}

std::string DroppedFiles::missing() const {
  std::vector<std::string> names;
  for (const InputKind kind : kAllInputs) {
    if (has(kind)) continue;
    names.emplace_back(kMissingNames[static_cast<std::size_t>(kind)]);
    if (kind == InputKind::kCamera && label_camera_remark)
      names.back() += ": " + *label_camera_remark;
  }
  return sessions::listText(names);
}

bool DroppedFiles::startsNewCase(const DroppedFiles& earlier) const {
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
  DroppedFiles dropped_files;
  dropped_files.one = earlier.one;
  dropped_files.record = earlier.record;
  dropped_files.label_camera_remark = earlier.label_camera_remark;
  dropped_files.one.parts.clear();
  for (const std::filesystem::path& file : files) {
    try {
      takeOf(file)(file, dropped_files);
    } catch (const std::exception& error) {
      dropped_files.problems.emplace_back(error.what());
    }
  }
  if (dropped_files.one.parts.empty()) dropped_files.one.parts = earlier.one.parts;
  return dropped_files;
}

}  // namespace boresight::ui
