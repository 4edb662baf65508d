// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_file.h"

#include <algorithm>
#include <cmath>

#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/io/meshes/mesh_container.h"

namespace boresight::sessions {

using nlohmann::ordered_json;

namespace {

constexpr double kMaxCoordinate_px = 1e6;
constexpr auto kSide_px = integerIn(1, kMaxImageSide_px);
constexpr auto kStroke = choiceOf<StrokeKind>("brush", "polygon", "saturation");
constexpr auto kOrigin =
    choiceOf<TransformSource>("unstated", "telemetry", "calibration", "label", "commanded");
constexpr auto kTruthOrigin = choiceOf<TruthOrigin>("given", "annotated", "imported", "run");
constexpr auto kFrame = jsonCodec<FrameName>(&readFrameName);
constexpr auto kPartFrame = Codec{&partFrameJson, &readPartFrame};
constexpr auto kRole = choiceOf<PartRole>(kPartRoleNames[0], kPartRoleNames[1], kPartRoleNames[2]);
constexpr auto kCamera =
    jsonCodec<CameraFile>([](const JsonReader& json) { return readCameraFile(json); });
constexpr auto kUncertainty = jsonCodec<DeclaredUncertainty>(&readUncertainty);
constexpr auto kRequirement = jsonCodec<Requirement>(&readRequirement);
constexpr auto kDirection =
    jsonCodec<Eigen::Vector3d>([](const JsonReader& json) { return json.vector3(); });
constexpr auto kCovariance = jsonCodec<Matrix6d>(&readCovariance);

constexpr auto kPixel = jsonCodec<Eigen::Vector2d>([](const JsonReader& json) {
  Eigen::Vector2d pixel = json.vector2();
  if (pixel.cwiseAbs().maxCoeff() > kMaxCoordinate_px)
    json.fail("is more than " + numberText(kMaxCoordinate_px) + " px away");
  return pixel;
});

constexpr auto kLabelItem = Codec{[](const LabelItem& item) {
                                    return ordered_json::array({item.name, item.value});
                                  },
                                  [](const JsonReader& json) {
                                    const auto pair = json.elements(2);
                                    return LabelItem{pair[0].nonEmptyText(), pair[1].text()};
                                  }};

// ---- how samples become 8 bit

ordered_json eightBitJson(const ImageReadOptions& options) {
  ordered_json json;
  json["rule"] = options.levels ? "levels" : options.table.empty() ? "linear" : "table";
  if (options.bit_depth) json["bit_depth"] = *options.bit_depth;
  if (!options.table.empty()) json["table"] = options.table;
  if (options.levels) {
    json["black"] = options.levels->black;
    json["white"] = options.levels->white;
  }
  if (options.bayer) json["bayer"] = kBayerPatternNames[static_cast<std::size_t>(*options.bayer)];
  return json;
}

ImageReadOptions readEightBit(const JsonReader& json) {
  ImageReadOptions options;
  if (const auto depth = json.find("bit_depth"))
    options.bit_depth = static_cast<int>(depth->integer(1, 16));
  if (const auto bayer = json.find("bayer"))
    options.bayer =
        bayerPatternNamed(bayer->choice({kBayerPatternNames[0], kBayerPatternNames[1],
                                         kBayerPatternNames[2], kBayerPatternNames[3]}));
  const std::string rule = json.at("rule").choice({"linear", "levels", "table"});
  if (rule != "table" && json.has("table"))
    json.failMember("table", "given although the rule is " + rule);
  if (rule == "linear") return options;
  if (rule == "levels") {
    const std::int64_t largest = (std::int64_t{1} << json.at("bit_depth").integer(1, 16)) - 1;
    const std::int64_t black = json.at("black").integer(0, largest - 1);
    const std::int64_t white = json.at("white").integer(black + 1, largest);
    options.levels = GrayLevels{static_cast<int>(black), static_cast<int>(white)};
    return options;
  }
  const JsonReader table = json.at("table");
  for (const JsonReader& value : table.elements())
    options.table.push_back(static_cast<std::uint8_t>(value.integer(0, 255)));
  const std::size_t count = std::size_t{1} << json.at("bit_depth").integer(1, 16);
  if (options.table.size() != count)
    table.fail("has " + std::to_string(options.table.size()) + " values, but bit_depth needs " +
               std::to_string(count));
  return options;
}

/// Whether a file that is being read has the member.
template <class Archive>
bool hasMember(const Archive& archive, const char* name) {
  if constexpr (Archive::kReads)
    return archive.json().has(name);
  else
    return false;
}

void requireMesh(const JsonReader& json, const PartSource& part) {
  const std::optional<MeshFormat> format = knownMeshFormat(part.mesh);
  if (!format) json.failMember("file", unknownMeshFormat(part.mesh));
  if (!part.mesh_unit.empty() && !metresPerUnit(part.mesh_unit))
    json.failMember("mesh_unit", "unknown unit '" + part.mesh_unit + "'");
  if (part.mesh_unit.empty() && !carriesUnit(*format))
    json.failMember("mesh_unit",
                    std::string("missing: ") + meshFormatName(*format) + " carries no unit");
}

}  // namespace

template <class Archive, ConstOr<InputFile> Self>
void fields(Archive& archive, Self& input) {
  archive.path("file", input.file);
  archive.field("sha256", input.sha256, kSha256);
}

template <class Archive, ConstOr<ImageInput> Self>
void fields(Archive& archive, Self& image) {
  fields(archive, image.source);
  archive.field("width", image.width, kSide_px);
  archive.field("height", image.height, kSide_px);
  archive.field("pixels_sha256", image.pixels_sha256, kSha256);
  archive.optional("color_sha256", image.color_sha256, kSha256);
  archive.optional("label", image.label, listOf(kLabelItem));
  if constexpr (Archive::kReads)
    image.eight_bit = readEightBit(archive.json());
  else
    archive.add(eightBitJson(image.eight_bit));
}

template <class Archive, ConstOr<MeshInput> Self>
void fields(Archive& archive, Self& part) {
  archive.path("file", part.source.mesh);
  archive.field("sha256", part.sha256, kSha256);
  archive.optional("mesh_unit", part.source.mesh_unit, kNonEmptyText);
  archive.optional("name", part.source.name, kNonEmptyText);
  if (Archive::kReads || part.source.frame != kStationFrame)
    archive.defaulted("frame", part.source.frame, kPartFrame);
  archive.optional("frame_from_mesh", part.source.frame_from_mesh, kExactPose);
  archive.field("normal_threshold_rad", part.source.normal_threshold_rad, numberIn(1e-3, 3.15));
  archive.field("depth_threshold_m", part.source.depth_threshold_m, numberIn(1e-6, 1000.0));
  archive.optional("albedo", part.source.albedo, numberIn(0.0, 1.0));
  if constexpr (Archive::kReads) {
    part.source.state = readPartState(archive.json());
    // As older files call it.
    if (!archive.json().has("frame_from_mesh"))
      archive.optional("station_from_mesh", part.source.frame_from_mesh, kExactPose);
    requireMesh(archive.json(), part.source);
  } else {
    archive.field("role", part.source.state.role, kRole);
    if (!part.source.state.present) archive.field("present", false, kFlag);
  }
}

template <class Archive, ConstOr<MaskStroke> Self>
void fields(Archive& archive, Self& stroke) {
  archive.field("kind", stroke.kind, kStroke);
  archive.field("erase", stroke.erase, kFlag);
  archive.optional("name", stroke.name, kNonEmptyText);
  if (stroke.kind == StrokeKind::kSaturation)
    return archive.field("level", stroke.level, integerIn(0, 255));
  if (stroke.kind == StrokeKind::kBrush)
    archive.field("radius_px", stroke.radius_px, numberIn(0.0, kMaxImageSide_px));
  archive.field("points", stroke.points, listOf(kPixel));
}

/// A frame whose name may be missing: that of a text file of calibration.
template <class Archive, ConstOr<FrameName> Self>
void fields(Archive& archive, Self& frame) {
  if constexpr (Archive::kReads) {
    if (archive.json().has("name")) frame = readFrameName(archive.json());
  } else if (!frame.name.empty()) {
    archive.add(toJson(frame));
  }
}

template <class Archive, ConstOr<CameraReference> Self>
void fields(Archive& archive, Self& reference) {
  fields(archive, reference.frame);
  archive.field("camera_from_reference", reference.camera_from_reference, kExactPose);
}

template <class Archive, ConstOr<FrameTransform> Self>
void fields(Archive& archive, Self& transform) {
  std::string file = transform.file.filename().string();
  const bool located = Archive::kReads ? hasMember(archive, "path") : transform.file.is_absolute();
  archive.field("target", transform.target, kFrame);
  archive.field("source", transform.source, kFrame);
  archive.field("target_from_source", transform.target_from_source, kExactPose);
  archive.optional("covariance", transform.covariance, kCovariance);
  archive.field("origin", transform.origin, kOrigin);
  archive.field("comment", transform.comment, kNonEmptyText);
  if (located)
    archive.path("path", transform.file);
  else
    archive.field("file", file, kNonEmptyText);  // of version 1.0, or apart from a session
  archive.field("sha256", transform.file_sha256, kSha256);
  if constexpr (Archive::kReads)
    if (!located) transform.file = file;
}

template <class Archive, ConstOr<TruthSource> Self>
void fields(Archive& archive, Self& source) {
  archive.field("origin", source.origin, kTruthOrigin);
  archive.optional("file", source.file, kNonEmptyText);
  archive.optional("sha256", source.sha256, kSha256);
  archive.optional("run", source.run, kSha256);
}

template <class Archive, ConstOr<AxisSymmetry> Self>
void fields(Archive& archive, Self& symmetry) {
  archive.field("axis", symmetry.axis, kDirection);
  archive.field("point_m", symmetry.point_m, kDirection);
  if constexpr (Archive::kReads)
    if (!(std::abs(symmetry.axis.squaredNorm() - 1.0) <= 1e-9))
      archive.json().failMember("axis", "is not of unit length");
}

template <class Archive, ConstOr<Symmetries> Self>
void fields(Archive& archive, Self& symmetries) {
  archive.optional("discrete", symmetries.discrete, listOf(kExactPose));
  archive.optionalList("continuous", symmetries.continuous);
}

template <class Archive, ConstOr<Rig> Self>
void fields(Archive& archive, Self& rig) {
  archive.field("id", rig.id, kNonEmptyText);
  archive.field("camera_from_rig", rig.camera_from_rig, kExactPose);
}

namespace {

/// Refuses parts that have no place in the scene, and a scene without a matched part.
void requireScene(const JsonReader& json, const SessionCase& session_case) {
  const std::vector<PartSource> parts = partsOf(session_case);
  if (!anyMatched(parts)) json.failMember("parts", "no part is to be matched");
  const FrameTree frames = framesOf(session_case);
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (const PartConcern concern = partConcern(parts[i], frames); !concern.member.empty())
      json.at("parts").elements()[i].failMember(concern.member, concern.reason);
}

}  // namespace

template <class Archive, ConstOr<SessionCase> Self>
void fields(Archive& archive, Self& self) {
  archive.field("id", self.id, kNonEmptyText);
  archive.optional("station", self.station, kNonEmptyText);
  archive.object("image", self.image);
  CameraFile camera{self.camera, std::nullopt, self.calibration_sigma, self.camera_covariance};
  archive.field("camera", camera, kCamera);
  archive.list("parts", self.parts);
  std::optional<Symmetries> symmetries;
  if (!self.symmetries.empty()) symmetries = self.symmetries;
  archive.object("symmetries", symmetries);
  archive.optional("feature_size_m", self.feature_size_m, numberIn(1e-6, 100.0));
  archive.optional("mesh_scale_sigma", self.mesh_scale_sigma, numberIn(0.0, kMaxScaleSigma));
  std::optional<Pose> seed;
  if (!Archive::kReads && self.has_seed) seed = self.camera_from_station_seed;
  archive.optional("seed", seed, kExactPose);
  archive.field("uncertainty", self.uncertainty, kUncertainty);
  archive.object("camera_reference", self.camera_reference);
  archive.object("station_frame", self.station_frame);
  archive.object("truth_frame", self.truth_frame);
  archive.optional("truth", self.camera_from_station_truth, kExactPose);
  archive.optional("truth_covariance", self.truth_covariance, kCovariance);
  archive.object("truth_source", self.truth_source);
  archive.optional("working", self.camera_from_station_working, kExactPose);
  archive.object("ignore", self.ignore);
  archive.optionalList("ignore_strokes", self.ignore_strokes);
  archive.object("onboard_record", self.onboard_record);
  archive.object("rig", self.rig);
  archive.optional("tags", self.tags, listOf(kNonEmptyText));
  archive.optional("requirement", self.requirement, kRequirement);
  archive.optional("camera_from_end_effector", self.camera_from_end_effector, kExactPose);
  archive.optionalList("frames", self.frames);
  archive.optionalPath("landmarks", self.landmarks, FileUse::kLandmarks);
  if constexpr (Archive::kReads) {
    self.symmetries = symmetries.value_or(Symmetries());
    self.camera = camera.camera;
    self.calibration_sigma = camera.calibration_sigma;
    self.camera_covariance = camera.covariance;
    self.has_seed = seed.has_value();
    self.camera_from_station_seed = seed.value_or(Pose());
    requireScene(archive.json(), self);
  }
}

ordered_json toJson(const SessionCase& session_case, const PathWriter& path) {
  return fieldsJson(session_case, &path);
}
SessionCase readSessionCase(const JsonReader& json) { return readFields<SessionCase>(json); }

/// The parts that a run is given, in the members of version 1 of session files: fingerprints of
/// cases without later members stay as they are.
ordered_json fingerprintParts(const SessionCase& session_case) {
  const FrameTree frames = framesOf(session_case);
  ordered_json json = ordered_json::array();
  for (const MeshInput& input : session_case.parts) {
    if (!input.source.state.used()) continue;
    const bool placeable = partConcern(input.source, frames).member.empty();
    const PartSource part = placeable ? placedPart(input.source, frames) : input.source;
    ordered_json& entry = json.emplace_back();
    entry["file"] = PathWriter("/")("/");  // where the file is makes no difference
    entry["sha256"] = input.sha256;
    if (!part.mesh_unit.empty()) entry["mesh_unit"] = part.mesh_unit;
    if (part.frame != kStationFrame) entry["frame"] = partFrameJson(part.frame);
    if (part.frame_from_mesh != Pose())
      entry["station_from_mesh"] = exactPoseJson(part.frame_from_mesh);
    entry["normal_threshold_rad"] = part.normal_threshold_rad;
    entry["depth_threshold_m"] = part.depth_threshold_m;
    entry["match"] = part.state.matched();
    if (part.albedo) entry["albedo"] = *part.albedo;
  }
  return json;
}

ordered_json toJson(const FrameTransform& transform) {
  FrameTransform apart = transform;
  apart.file = transform.file.filename();
  return fieldsJson(apart);
}

ordered_json toJson(const std::vector<LabelItem>& label) { return listOf(kLabelItem).write(label); }

}  // namespace boresight::sessions
