// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_inputs.h"

#include <cmath>
#include <utility>

#include "core/base/math.h"
#include "sessions/io/cameras/camera_field.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/meshes/mesh_file.h"
#include "sessions/run/problem.h"
#include "sessions/session/case_frames.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

std::string sizeInPixels(int width, int height) { return sizeText(width, height) + " px"; }

/// Why a run would reject these inputs, as far as they are known; nullptr: not known.
std::optional<InputConcern> concernOf(const Camera& camera, const GrayImage* image,
                                      const SceneMesh* scene,
                                      const Pose* camera_from_station_seed) {
  if (image != nullptr && (image->width != camera.width || image->height != camera.height))
    return InputConcern{InputKind::kCamera,
                        "The camera is for " + sizeInPixels(camera.width, camera.height) +
                            ", the image is " + sizeInPixels(image->width, image->height) + "."};
  if (const std::string field = fieldConcern(camera); !field.empty())
    return InputConcern{InputKind::kCamera, asSentence(field)};
  if (scene == nullptr || camera_from_station_seed == nullptr) return std::nullopt;
  const Pose& seed = *camera_from_station_seed;
  if (const std::string scale = scaleConcern(matchedBounds(scene->view()), seed); !scale.empty())
    return InputConcern{InputKind::kMesh, asSentence(scale)};
  if (const std::string concern = seedConcern(camera, scene->view(), seed); !concern.empty())
    return InputConcern{InputKind::kSeed, asSentence(concern)};
  return std::nullopt;
}

/// What the files are as far as they could be read.
struct ReadFiles {
  std::optional<GrayImage> image;
  std::optional<CameraFile> camera;
  std::optional<SceneMesh> scene;
  std::optional<Pose> camera_from_station_seed;
};

/// Notes why a file cannot be read; the operator sees its name already.
template <class Read>
void judge(JudgedFile& file, Read&& read) {
  try {
    file.text = read();
  } catch (const FileError& error) {
    file.problem =
        asSentence(error.field().empty() ? error.reason() : error.field() + ": " + error.reason());
  } catch (const std::exception& error) {
    file.problem = asSentence(error.what());
  }
}

std::string fieldOfViewText(const Camera& camera) {
  const double x_deg = 2.0 * std::atan(0.5 * camera.width / camera.fx) / kDegree_rad;
  const double y_deg = 2.0 * std::atan(0.5 * camera.height / std::abs(camera.fy)) / kDegree_rad;
  return fixedText(x_deg, 1) + " x " + fixedText(y_deg, 1) + " deg";
}

bool hasCameraFile(const CaseFiles& files) {
  if (!files.camera.empty()) return true;
  if (files.image.empty() || !hasImageLabel(files.image)) return false;
  return readImageLabel(files.image).camera.has_value();
}

ReadFiles readEach(const CaseFiles& files, JudgedFiles& judged) {
  ReadFiles read;
  const auto of = [&judged](InputKind kind) -> JudgedFile& {
    return judged[static_cast<std::size_t>(kind)];
  };
  if (!files.image.empty())
    judge(of(InputKind::kImage), [&] {
      read.image = readImage(files.image, files.eight_bit);
      return sizeInPixels(read.image->width, read.image->height) + ", " +
             std::to_string(read.image->bit_depth) + " bit";
    });
  judge(of(InputKind::kCamera), [&]() -> std::string {
    if (!hasCameraFile(files)) return "";
    read.camera = readChosenCamera(files.camera, files.image);
    const Camera& camera = read.camera->camera;
    return sizeInPixels(camera.width, camera.height) + ", " + fieldOfViewText(camera);
  });
  if (!files.parts.empty())
    judge(of(InputKind::kMesh), [&] {
      std::vector<PartSource> parts = files.parts;
      for (PartSource& part : parts)
        if (part.mesh_unit.empty() && !statesUnit(part.mesh)) part.mesh_unit = "m";
      read.scene = readScene(parts);
      return std::to_string(read.scene->faces.size()) + " faces";
    });
  if (!files.seed.empty())
    judge(of(InputKind::kSeed), [&] {
      PoseFrames frames;
      if (read.camera) frames.reference = read.camera->reference;
      frames.transforms = readTransforms(files);
      const PoseFile pose = readPose(files.seed, frames);
      read.camera_from_station_seed = pose.camera_from_station;
      return "station " + fixedText(pose.camera_from_station.translation_m.norm(), 2) + " m away";
    });
  return read;
}

/// Only what was read can contradict the rest.
void compareFiles(const CaseFiles& files, const ReadFiles& read, JudgedFiles& judged) {
  if (!read.camera) return;
  bool units_known = true;
  for (const PartSource& part : files.parts)
    units_known &= !part.mesh_unit.empty() || statesUnit(part.mesh);
  const auto concern =
      concernOf(read.camera->camera, read.image ? &*read.image : nullptr,
                read.scene && units_known ? &*read.scene : nullptr,
                read.camera_from_station_seed ? &*read.camera_from_station_seed : nullptr);
  if (concern) judged[static_cast<std::size_t>(concern->kind)].problem = concern->text;
}

/// What withInputFile() sets for this kind.
void takeInput(SessionCase& to, const SessionCase& from, InputKind kind) {
  switch (kind) {
    case InputKind::kImage:
      to.image = from.image;
      to.frames = from.frames;
      return;
    case InputKind::kCamera:
      to.camera = from.camera;
      to.camera_reference = from.camera_reference;
      to.calibration_sigma = from.calibration_sigma;
      to.camera_covariance = from.camera_covariance;
      return;
    case InputKind::kMesh:
      to.parts.front().source.mesh = from.parts.front().source.mesh;
      to.parts.front().source.mesh_unit = from.parts.front().source.mesh_unit;
      to.parts.front().sha256 = from.parts.front().sha256;
      return;
    case InputKind::kSeed:
      to.has_seed = from.has_seed;
      to.camera_from_station_seed = from.camera_from_station_seed;
      to.station_frame = from.station_frame;
      to.uncertainty = from.uncertainty;
      return;
  }
}

/// Whether two cases have the same input of this kind, and read a file of it alike.
bool sameInput(const SessionCase& a, const SessionCase& b, InputKind kind) {
  const bool uses_frames = kind == InputKind::kSeed || kind == InputKind::kImage;
  if (uses_frames && !(a.camera_reference == b.camera_reference && a.frames == b.frames))
    return false;
  SessionCase with_input = a;
  takeInput(with_input, b, kind);
  return with_input == a;
}

/// The frames of the image's label in place of those of the former image's.
void takeLabelFrames(const fs::path& former_image, SessionCase& session_case) {
  std::erase_if(session_case.frames, [&former_image](const FrameTransform& transform) {
    return transform.origin == TransformSource::kLabel && transform.file == former_image;
  });
  addLabelFrames(session_case.image.source.file, session_case.camera_reference,
                 session_case.frames);
}

}  // namespace

bool statesUnit(const fs::path& mesh) {
  const std::string end = lowerCase(mesh.extension().string());
  return end == ".gltf" || end == ".glb";
}

std::optional<InputConcern> inputConcern(const LoadedCase& loaded) {
  const SessionCase& session_case = loaded.source;
  if (!session_case.has_seed) return std::nullopt;
  return concernOf(session_case.camera, &loaded.image, &loaded.scene,
                   &session_case.camera_from_station_seed);
}

JudgedFiles judgeFiles(const CaseFiles& files) {
  JudgedFiles judged;
  ReadFiles read = readEach(files, judged);
  compareFiles(files, read, judged);
  if (read.image)
    judged[static_cast<std::size_t>(InputKind::kImage)].image =
        std::make_shared<const GrayImage>(std::move(*read.image));
  return judged;
}

SessionCase withInputFile(SessionCase session_case, InputKind kind, const fs::path& file,
                          const std::string& mesh_unit) {
  const SessionCase former = session_case;
  if (kind == InputKind::kImage) {
    session_case.image = imageInput(file, former.image.eight_bit);
    takeLabelFrames(former.image.source.file, session_case);
    followFrames(former, session_case);
  } else if (kind == InputKind::kCamera) {
    setCamera(session_case, readChosenCamera(file, {}));
    followFrames(former, session_case);
  } else if (kind == InputKind::kMesh) {
    PartSource part = session_case.parts.front().source;
    part.mesh = file;
    part.mesh_unit = mesh_unit;
    session_case.parts.front() = meshInputs({part}).front();
  } else {
    const PoseFile seed = readPose(file, {session_case.camera_reference, session_case.frames});
    session_case.has_seed = true;
    session_case.camera_from_station_seed = seed.camera_from_station;
    session_case.station_frame = seed.station_frame;
    session_case.uncertainty = seed.uncertainty.value_or(DeclaredUncertainty());
    session_case.camera_from_station_working.reset();
  }
  return session_case;
}

std::optional<Session> withInput(const Session& session, InputKind kind, const SessionCase& before,
                                 const SessionCase& changed) {
  const SessionCase* found = session.findCase(before.id);
  if (found == nullptr || !sameInput(*found, before, kind)) return std::nullopt;
  SessionCase next = *found;
  takeInput(next, changed, kind);
  if (kind == InputKind::kImage || kind == InputKind::kCamera)
    return withChangedFrames(session, std::move(next));
  if (kind == InputKind::kSeed) next.camera_from_station_working.reset();
  return withCase(session, std::move(next));
}

}  // namespace boresight::sessions
