// SPDX-License-Identifier: Apache-2.0
#include "core/record/problem_bytes.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

#include "core/base/bytes.h"
#include "core/base/digest.h"
#include "core/localizer/value_writers.h"
#include "core/pnp/correspondence.h"

namespace boresight {
namespace {

constexpr std::array<std::uint8_t, 8> kProblemMagic = {'B', 'O', 'R', 'S', 'I', 'G', 'H', 'T'};
constexpr std::size_t kDigestBytes = 32;

std::string_view bytesAsText(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::array<std::uint8_t, kDigestBytes> checksumOf(std::span<const std::uint8_t> bytes) {
  Sha256 sha;
  sha.update(bytes);
  return sha.digest();
}

// -- Writing --

void writeMesh(const MeshView& mesh, ByteWriter& writer) {
  writer.u32(static_cast<std::uint32_t>(mesh.parts.size()));
  writeParts(mesh, writer);
  writer.u32(static_cast<std::uint32_t>(mesh.vertices_in_station_m.size()));
  writeVertices(mesh, writer);
  writer.u32(static_cast<std::uint32_t>(mesh.faces.size()));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const std::int32_t vertex : mesh.faces[f].vertex) writer.i32(vertex);
    writer.u16(mesh.part_of_face[f]);
  }
}

void writeIgnore(const BitImage* ignore, ByteWriter& writer) {
  writer.u8(ignore != nullptr ? 1 : 0);
  if (ignore != nullptr) writeWords(*ignore, writer);
}

/// All but the checksum; `size` is that of the whole.
void writeProblem(const LocalizationProblem& problem, const LocalizerOptions& options,
                  std::size_t size, ByteWriter& writer) {
  writer.bytes(kProblemMagic);
  writer.u32(kProblemVersion);
  writer.u32(static_cast<std::uint32_t>(size));
  writeOptions(options, writer);
  const Camera& camera = problem.camera;
  writeIntegers({static_cast<std::int32_t>(camera.model), camera.width, camera.height}, writer);
  writeOptics(camera, writer);
  writePose(problem.camera_from_station_seed, writer);
  writeUncertainty(problem.uncertainty, writer);
  writeReals(problem.end_effector_in_camera_m, writer);
  writeMesh(problem.mesh, writer);
  writeIgnore(problem.ignore, writer);
}

// -- Reading --

template <class Field>
bool readOption(OptionKind kind, std::uint64_t bits, Field& field) {
  if (kind != optionKindOf<Field>()) return false;
  if constexpr (std::is_floating_point_v<Field>) {
    field = std::bit_cast<double>(bits);
    return true;
  } else {
    using Integer = std::conditional_t<
        std::is_same_v<Field, std::int64_t>, std::int64_t,
        std::conditional_t<std::is_same_v<Field, bool>, std::uint8_t, std::int32_t>>;
    const auto value = static_cast<std::int64_t>(bits);
    if (value < std::int64_t{std::numeric_limits<Integer>::min()} ||
        value > std::int64_t{std::numeric_limits<Integer>::max()}) {
      return false;
    }
    if (std::is_same_v<Field, bool> && value > 1) return false;
    field = static_cast<Field>(value);
    return true;
  }
}

Eigen::Vector3d readVector(ByteReader& reader) {
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) vector[i] = reader.f64();
  return vector;
}

void readLens(ByteReader& reader, CahvLens& lens) {
  lens.skew_px = reader.f64();
  lens.optical_axis = readVector(reader);
  lens.radial = readVector(reader);
  lens.entrance_m = readVector(reader);
  lens.linearity = reader.f64();
}

ProblemFault readCamera(ByteReader& reader, Camera& camera) {
  const std::int32_t model = reader.i32();
  if (model < 0 || model > static_cast<std::int32_t>(kLastCameraModel))
    return ProblemFault::kCamera;
  camera.model = static_cast<CameraModel>(model);
  camera.width = reader.i32();
  camera.height = reader.i32();
  for (double* value : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) *value = reader.f64();
  for (double& value : camera.distortion) value = reader.f64();
  if (isCahvFamily(camera.model)) readLens(reader, camera.cahv);
  if (reader.failed()) return ProblemFault::kContent;
  // Edge pixels are stored in 16 bits.
  constexpr int kMostSide_px = 16384;
  const bool plausible = camera.width <= kMostSide_px && camera.height <= kMostSide_px;
  return plausible && prepareCamera(camera) == Status::kOk ? ProblemFault::kNone
                                                           : ProblemFault::kCamera;
}

ProblemFault readSeed(ByteReader& reader, LocalizationProblem& problem) {
  Pose& seed = problem.camera_from_station_seed;
  const double w = reader.f64();
  seed.rotation.vec() = readVector(reader);
  seed.rotation.w() = w;
  seed.translation_m = readVector(reader);
  problem.uncertainty.translation_m = readVector(reader);
  problem.uncertainty.rotation_rad = readVector(reader);
  problem.uncertainty.pivot_in_camera_m = readVector(reader);
  problem.end_effector_in_camera_m = readVector(reader);
  if (reader.failed()) return ProblemFault::kContent;
  return isUsable(PosePrior{seed, problem.uncertainty}) &&
                 problem.end_effector_in_camera_m.allFinite()
             ? ProblemFault::kNone
             : ProblemFault::kPose;
}

/// Room for a counted list whose elements take `bytes_each` in the file; its length comes first.
template <class T>
ProblemFault allocateList(ByteReader& reader, std::size_t bytes_each, Arena& arena,
                          std::span<T>& list) {
  const std::uint32_t count = reader.u32();
  if (!reader.fits(count, bytes_each)) return ProblemFault::kContent;
  list = arena.allocate<T>(count);
  return list.size() == count ? ProblemFault::kNone : ProblemFault::kArenaTooSmall;
}

std::array<std::int32_t, 3>& verticesOf(Face& face) { return face.vertex; }
std::array<std::uint16_t, 3>& verticesOf(ShortFace& face) { return face; }

ProblemFault readParts(ByteReader& reader, Arena& arena, MeshView& mesh) {
  std::span<ScenePart> parts;
  const ProblemFault fault = allocateList(reader, 17, arena, parts);
  if (fault != ProblemFault::kNone) return fault;
  for (ScenePart& part : parts) {
    part.normal_threshold_rad = reader.f64();
    part.depth_threshold_m = reader.f64();
    const std::uint8_t role = reader.u8();
    if (role > 2) return ProblemFault::kMesh;
    part.match = role == 1;
    part.fixed_to_camera = role == 2;
  }
  mesh.parts = parts;
  return ProblemFault::kNone;
}

ProblemFault readVertices(ByteReader& reader, Arena& arena, MeshView& mesh) {
  std::span<Eigen::Vector3f> vertices;
  const ProblemFault fault = allocateList(reader, 12, arena, vertices);
  if (fault != ProblemFault::kNone) return fault;
  for (Eigen::Vector3f& vertex : vertices) {
    for (int i = 0; i < 3; ++i) vertex[i] = reader.f32();
  }
  mesh.vertices_in_station_m = vertices;
  return ProblemFault::kNone;
}

/// Faces of one form. Indices that the form cannot hold are rejected here, others by
/// validateMesh().
template <class Stored, class Index>
ProblemFault readFacesAs(ByteReader& reader, Arena& arena, MeshView& mesh) {
  std::span<Stored> faces;
  const ProblemFault fault = allocateList(reader, 14, arena, faces);
  if (fault != ProblemFault::kNone) return fault;
  const std::span<std::uint16_t> part_of_face = arena.allocate<std::uint16_t>(faces.size());
  if (part_of_face.size() != faces.size()) return ProblemFault::kArenaTooSmall;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (Index& index : verticesOf(faces[f])) {
      const std::int32_t vertex = reader.i32();
      index = static_cast<Index>(vertex);
      if (std::int64_t{index} != vertex) return ProblemFault::kMesh;
    }
    part_of_face[f] = reader.u16();
  }
  mesh.faces = FaceList(std::span<const Stored>(faces));
  mesh.part_of_face = part_of_face;
  return ProblemFault::kNone;
}

ProblemFault readFaces(ByteReader& reader, Arena& arena, MeshView& mesh) {
  return mesh.vertices_in_station_m.size() <= kShortVertices
             ? readFacesAs<ShortFace, std::uint16_t>(reader, arena, mesh)
             : readFacesAs<Face, std::int32_t>(reader, arena, mesh);
}

ProblemFault readMesh(ByteReader& reader, Arena& arena, MeshView& mesh) {
  ProblemFault fault = readParts(reader, arena, mesh);
  if (fault == ProblemFault::kNone) fault = readVertices(reader, arena, mesh);
  if (fault == ProblemFault::kNone) fault = readFaces(reader, arena, mesh);
  if (fault != ProblemFault::kNone) return fault;
  return validateMesh(mesh) == Status::kOk ? ProblemFault::kNone : ProblemFault::kMesh;
}

bool hasBitsBeyond(const BitImage& image) {
  const int used = image.width & 63;
  if (used == 0) return false;
  for (int y = 0; y < image.height; ++y)
    if ((image.row(y)[image.words_per_row - 1] >> used) != 0) return true;
  return false;
}

ProblemFault readIgnore(ByteReader& reader, Arena& arena, LocalizationProblem& problem) {
  problem.ignore = nullptr;
  const std::uint8_t stored = reader.u8();
  if (stored > 1) return ProblemFault::kContent;
  if (stored == 0) return ProblemFault::kNone;
  const Camera& camera = problem.camera;
  const auto row_bytes = 8 * static_cast<std::size_t>(BitImage::wordsPerRow(camera.width));
  if (!reader.fits(static_cast<std::uint64_t>(camera.height), row_bytes))
    return ProblemFault::kContent;
  const std::span<BitImage> ignore = arena.allocate<BitImage>(1);
  if (ignore.empty()) return ProblemFault::kArenaTooSmall;
  ignore[0] = BitImage::create(arena, camera.width, camera.height);
  if (arena.exhausted()) return ProblemFault::kArenaTooSmall;
  for (std::uint64_t& word : ignore[0].words) word = reader.u64();
  problem.ignore = ignore.data();
  return hasBitsBeyond(ignore[0]) ? ProblemFault::kIgnore : ProblemFault::kNone;
}

/// Everything between header and checksum.
ProblemCheck readContent(ByteReader& reader, Arena& arena, LocalizationProblem& problem,
                         LocalizerOptions& options) {
  const ProblemCheck check = readOptions(reader, options);
  if (check.fault != ProblemFault::kNone) return check;
  ProblemFault fault = readCamera(reader, problem.camera);
  if (fault == ProblemFault::kNone) fault = readSeed(reader, problem);
  if (fault == ProblemFault::kNone) fault = readMesh(reader, arena, problem.mesh);
  if (fault == ProblemFault::kNone) fault = readIgnore(reader, arena, problem);
  if (fault == ProblemFault::kNone && (reader.failed() || reader.left() > 0))
    fault = ProblemFault::kContent;
  return {fault, nullptr};
}

}  // namespace

void writeOptions(const LocalizerOptions& options, ByteWriter& writer) {
  std::uint32_t count = 0;
  LocalizerOptions::visitFields(options, [&count](const OptionInfo&, const auto&) { ++count; });
  writer.u32(count);
  LocalizerOptions::visitFields(options, [&writer](const OptionInfo& info, const auto& field) {
    using Field = std::remove_cvref_t<decltype(field)>;
    const std::size_t length = std::strlen(info.name);
    writer.u8(static_cast<std::uint8_t>(length));
    writer.bytes({reinterpret_cast<const std::uint8_t*>(info.name), length});
    writer.u8(static_cast<std::uint8_t>(optionKindOf<Field>()));
    if constexpr (std::is_floating_point_v<Field>) {
      writer.f64(field);
    } else {
      writer.u64(static_cast<std::uint64_t>(static_cast<std::int64_t>(field)));
    }
  });
}

const char* problemFaultText(ProblemFault fault) {
  switch (fault) {
    case ProblemFault::kNone:
      return "ok";
    case ProblemFault::kNotAProblem:
      return "not a problem file";
    case ProblemFault::kVersion:
      return "written in another version of the format; export it again";
    case ProblemFault::kSize:
      return "truncated or longer than its stored size; export it again";
    case ProblemFault::kChecksum:
      return "damaged: the checksum does not match; export it again";
    case ProblemFault::kOption:
      return "an option is unknown, missing, misplaced or out of range; export it again";
    case ProblemFault::kCamera:
      return "the camera's parameters are invalid";
    case ProblemFault::kPose:
      return "the seed or its uncertainty is not finite, or not a rotation";
    case ProblemFault::kMesh:
      return "the mesh has no faces, indices out of range, or is not finite";
    case ProblemFault::kIgnore:
      return "the ignore mask has bits beyond the image";
    case ProblemFault::kContent:
      return "counts and size contradict each other";
    case ProblemFault::kArenaTooSmall:
      return "mesh and mask do not fit into memory; use a coarser mesh";
  }
  return "unknown";
}

ProblemFault checkHeader(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t> magic,
                         std::uint32_t version, std::size_t checksum_bytes) {
  ByteReader reader(bytes);
  const std::span<const std::uint8_t> front = reader.take(magic.size());
  const std::uint32_t stored_version = reader.u32();
  const std::uint32_t size = reader.u32();
  if (reader.failed() || !std::equal(magic.begin(), magic.end(), front.begin()))
    return ProblemFault::kNotAProblem;
  if (stored_version != version) return ProblemFault::kVersion;
  if (size != bytes.size() || reader.left() < checksum_bytes) return ProblemFault::kSize;
  return ProblemFault::kNone;
}

ProblemCheck readOptions(ByteReader& reader, LocalizerOptions& options) {
  ProblemCheck check;
  std::uint32_t left = reader.u32();
  LocalizerOptions::visitFields(options, [&](const OptionInfo& info, auto& field) {
    if (check.fault != ProblemFault::kNone) return;
    const std::size_t length = left > 0 ? reader.u8() : 0;
    const std::span<const std::uint8_t> name = reader.take(length);
    const auto kind = static_cast<OptionKind>(reader.u8());
    const std::uint64_t bits = reader.u64();
    if (left == 0 || reader.failed() || bytesAsText(name) != info.name ||
        !readOption(kind, bits, field)) {
      check = {ProblemFault::kOption, info.name};
    }
    --left;
  });
  if (check.fault != ProblemFault::kNone) return check;
  if (left > 0) return {ProblemFault::kOption, nullptr};  // more options than exist
  const char* invalid = firstInvalidOption(options);
  if (invalid != nullptr) return {ProblemFault::kOption, invalid};
  return check;
}

std::size_t encodeProblem(const LocalizationProblem& problem, const LocalizerOptions& options,
                          std::span<std::uint8_t> out) {
  ByteWriter counter;
  writeProblem(problem, options, 0, counter);
  const std::size_t size = counter.written() + kDigestBytes;
  if (out.size() < size) return size;
  ByteWriter writer(out);
  writeProblem(problem, options, size, writer);
  writer.bytes(checksumOf(out.first(writer.written())));
  return size;
}

ProblemCheck decodeProblem(std::span<const std::uint8_t> bytes, Arena& arena,
                           LocalizationProblem& problem, LocalizerOptions& options) {
  problem = {};
  options = {};
  const ProblemFault fault = checkHeader(bytes, kProblemMagic, kProblemVersion, kDigestBytes);
  if (fault != ProblemFault::kNone) return {fault, nullptr};
  const auto summed = bytes.first(bytes.size() - kDigestBytes);
  const auto stored = bytes.last(kDigestBytes);
  const std::array<std::uint8_t, kDigestBytes> sum = checksumOf(summed);
  if (!std::equal(sum.begin(), sum.end(), stored.begin()))
    return {ProblemFault::kChecksum, nullptr};

  ByteReader reader(summed.subspan(headerBytes(kProblemMagic)));
  return readContent(reader, arena, problem, options);
}

}  // namespace boresight
