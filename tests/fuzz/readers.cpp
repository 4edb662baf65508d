// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/readers.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/crc32.h"
#include "core/base/digest.h"
#include "sessions/annotation/annotations_file.h"
#include "sessions/annotation/landmarks.h"
#include "sessions/io/cameras/cahvor_file.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/io/images/image_file.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/images/labels/label_reading.h"
#include "sessions/io/json/config_file.h"
#include "sessions/io/meshes/mesh_file.h"
#include "sessions/record/onboard_record.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_file.h"
#include "sessions/trace/trace_file.h"

namespace boresight::test {
namespace {

void putBigEndian(std::uint64_t value, std::span<std::uint8_t> to) {
  for (std::size_t i = to.size(); i-- > 0; value >>= 8) to[i] = static_cast<std::uint8_t>(value);
}

std::uint64_t bigEndian(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

// Each makes the checksums of a file right again, so that what was changed in it gets behind them.
// Bytes that are too few for the format stay as they are.

/// Length and SHA-256 of a trace.
void sealTrace(std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kHeader = 20, kSum = 32;
  if (bytes.size() < kHeader + kSum) return;
  const std::span<std::uint8_t> all(bytes);
  putBigEndian(bytes.size() - kHeader - kSum, all.subspan(12, 8));
  Sha256 sha;
  sha.update(all.first(bytes.size() - kSum));
  const auto sum = sha.digest();
  std::copy(sum.begin(), sum.end(), bytes.end() - static_cast<std::ptrdiff_t>(kSum));
}

/// The CRC of every block of an onboard record.
void sealRecord(std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kHeader = 12, kBlockHeader = 12, kSum = 4;
  std::span<std::uint8_t> left(bytes);
  if (left.size() < kHeader) return;
  left = left.subspan(kHeader);
  while (left.size() >= kBlockHeader + kSum) {
    const std::uint64_t content = bigEndian(left.subspan(8, 4));
    if (content > left.size() - kBlockHeader - kSum) return;
    const std::size_t length = kBlockHeader + static_cast<std::size_t>(content);
    putBigEndian(crc32(left.first(length)), left.subspan(length, kSum));
    left = left.subspan(length + kSum);
  }
}

/// The sums of the lines of a journal.
void sealJournal(std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kSum = 16;
  std::string sum;
  for (auto line = bytes.begin(); line != bytes.end();) {
    const auto end = std::find(line, bytes.end(), '\n');
    if (*line == '{' || end == bytes.end() || end - line <= static_cast<std::ptrdiff_t>(kSum))
      return;
    sum = sessions::sha256Text(sum + std::string(line + kSum + 1, end)).substr(0, kSum);
    std::copy(sum.begin(), sum.end(), line);
    line[kSum] = ' ';
    line = end + 1;
  }
}

using Path = std::filesystem::path;

/// A mesh that is read is valid, however damaged its file is.
void readMetres(const Path& file) {
  const sessions::Mesh mesh = sessions::readMesh(file, "m");
  const std::vector<std::uint16_t> part_of_face(mesh.faces.size(), 0);
  const ScenePart part;
  if (validateMesh({mesh.vertices_m, mesh.faces, part_of_face, {&part, 1}}) != Status::kOk)
    throw std::logic_error("the mesh that was read is invalid");
}

/// For poses in frames of their own.
sessions::PoseFrames roverFrames() {
  sessions::CameraReference reference;
  reference.frame = {"ROVER_FRAME", {194, 835, 1}};
  sessions::FrameTransform transform;
  transform.target = {"SITE_FRAME", {194}};
  transform.source = reference.frame;
  transform.comment = "a transform";
  transform.file = "t.json";
  return {reference, {transform}};
}

void readLabelled(const Path& file) {
  (void)sessions::readSamples(file);
  (void)sessions::readImageLabel(file);
}

/// The pixels that the corpus' labels name.
void readPds4(const Path& file) {
  const Path pixels = file.parent_path() / "pixels.img";
  if (!std::filesystem::exists(pixels))
    std::ofstream(pixels, std::ios::binary) << std::string(512, '\x2a');
  readLabelled(file);
}

/// What GDAL makes of a label, without GDAL: {"format", "width", "height", "label", "vicar"}.
void readTree(const Path& file) {
  const auto bytes = sessions::readFileBytes(file, sessions::kMegabyte);
  const auto json = nlohmann::json::parse(bytes.begin(), bytes.end(), nullptr, false);
  if (!json.is_object() || !json.contains("label")) return;
  sessions::LabelPicture picture{1024, 1024, 1, {16}};
  const auto side = [&json](const char* key) {
    return json.contains(key) && json[key].is_number_integer()
               ? std::clamp(json[key].get<int>(), 1, sessions::kMaxImageSide_px)
               : 1024;
  };
  picture.width = side("width");
  picture.height = side("height");
  const nlohmann::json vicar = json.value("vicar", nlohmann::json());
  for (const sessions::LabelFormat format :
       {sessions::LabelFormat::kVicar, sessions::LabelFormat::kPds3, sessions::LabelFormat::kPds4})
    (void)sessions::readLabelTree(format, json["label"], vicar, picture);
}

constexpr FuzzedReader kReaders[] = {
    {"cahvor", "camera.cahvor", [](const Path& file) { (void)sessions::readCahvorFile(file); }},
    {"camera", "camera.json", [](const Path& file) { (void)sessions::readCameraFile(file); }},
    {"config", "config.json", [](const Path& file) { (void)sessions::readConfig(file); }},
    {"dataset", "dataset.json", [](const Path& file) { (void)sessions::readDataset(file); }},
    {"image_jpeg", "image.jpg", [](const Path& file) { (void)sessions::readSamples(file); }},
    {"image_pds3", "image.img", readLabelled},
    {"image_pds4", "image.xml", readPds4},
    {"image_png", "image.png", [](const Path& file) { (void)sessions::readSamples(file); }},
    {"image_tiff", "image.tif", [](const Path& file) { (void)sessions::readSamples(file); }},
    {"image_vicar", "image.vic", readLabelled},
    {"journal", "journal", [](const Path& file) { (void)sessions::readJournal(file, {}); },
     sealJournal},
    {"label_tree", "label.json", readTree},
    {"landmarks", "landmarks.json", [](const Path& file) { (void)sessions::readLandmarks(file); }},
    {"annotations", "points.json", [](const Path& file) { (void)sessions::readAnnotations(file); }},
    {"mesh_glb", "mesh.glb", readMetres},
    {"mesh_gltf", "mesh.gltf", readMetres},
    {"mesh_obj", "mesh.obj", readMetres},
    {"mesh_ply", "mesh.ply", readMetres},
    {"mesh_stl", "mesh.stl", readMetres},
    {"pose", "pose.json", [](const Path& file) { (void)sessions::readPose(file, roverFrames()); }},
    {"record", "run.whsr", [](const Path& file) { (void)sessions::readRecord(file); }, sealRecord},
    {"session", "s.boresight.json",
     [](const Path& file) { (void)sessions::readSessionFile(file); }},
    {"transform", "transform.json",
     [](const Path& file) { (void)sessions::readFrameTransforms(file); }},
    {"trace", "run.trace", [](const Path& file) { (void)sessions::loadTrace(file); }, sealTrace},
};

void feedOnce(const FuzzedReader& reader, std::span<const std::uint8_t> bytes, const Path& folder) {
  const Path file = folder / reader.file_name;
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  try {
    reader.read(file);
  } catch (const sessions::InputError&) {
  }
}

}  // namespace

std::span<const FuzzedReader> fuzzedReaders() { return kReaders; }

const FuzzedReader* fuzzedReader(std::string_view name) {
  const auto* found = std::ranges::find(kReaders, name, &FuzzedReader::name);
  return found == std::end(kReaders) ? nullptr : found;
}

void feed(const FuzzedReader& reader, std::span<const std::uint8_t> bytes,
          const std::filesystem::path& folder) {
  feedOnce(reader, bytes, folder);
  if (reader.seal == nullptr) return;
  std::vector<std::uint8_t> sealed(bytes.begin(), bytes.end());
  reader.seal(sealed);
  feedOnce(reader, sealed, folder);
}

}  // namespace boresight::test
