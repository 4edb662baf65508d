// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/frame_transform.h"

#include <nlohmann/json.hpp>

#include "sessions/io/file_bytes.h"
#include "sessions/io/json_reader.h"
#include "sessions/io/json_writer.h"
#include "sessions/io/pose_file.h"

namespace boresight::sessions {
namespace {

constexpr const char* kTransformFormat = "boresight-transform";
constexpr int kTransformVersion = 1;
constexpr double kSameTranslation_m = 1e-6;
constexpr double kSameRotation_rad = 1e-6;

/// The message where no transform is given, or only some between other frames.
std::string noWayText(const FrameName& a, const FrameName& b,
                      std::span<const FrameTransform> given) {
  const std::string needed =
      "the pose is given in " + frameText(b) + ", but the camera model in " + frameText(a);
  if (a.name.empty())
    return needed +
           "; if both are one frame, leave reference_frame out of the pose; else state the "
           "camera's frame in a camera.json and give their transform";
  if (given.empty()) return needed + "; give the transform between the two (transform.json)";
  std::string others;
  for (const FrameTransform& frame_transform : given)
    others += (others.empty() ? "" : ", ") + frame_transform.file.filename().string() +
              " leads from " + frameText(frame_transform.source) + " to " +
              frameText(frame_transform.target);
  return needed + ", and " + others;
}

/// The transform from `b` to `a` where this one or its inverse is it.
std::optional<Pose> joinBy(const FrameTransform& transform, const FrameName& a,
                           const FrameName& b) {
  if (transform.target == a && transform.source == b) return transform.target_from_source;
  if (transform.target == b && transform.source == a) return transform.target_from_source.inverse();
  return std::nullopt;
}

FrameTransform readTransformMembers(const JsonReader& root) {
  FrameTransform transform;
  transform.target = readFrameName(root.at("target"));
  transform.source = readFrameName(root.at("source"));
  if (transform.target == transform.source)
    root.failMember("source", "is the same frame as the target");
  transform.target_from_source = readTransform(root.at("target_from_source"));
  transform.comment = root.at("comment").nonEmptyText();
  return transform;
}

/// As two files of one transform agree whose digits were rounded.
bool nearlySame(const Pose& a, const Pose& b) {
  return (a.translation_m - b.translation_m).norm() <= kSameTranslation_m &&
         a.rotation.angularDistance(b.rotation) <= kSameRotation_rad;
}

}  // namespace

FrameTransform readFrameTransform(const std::filesystem::path& file) {
  const auto bytes = readFileBytes(file, kMaxJsonBytes);
  FrameTransform transform = JsonDocument(file, asText(bytes))
                                 .read(kTransformFormat, kTransformVersion, readTransformMembers);
  transform.file = file;
  transform.file_sha256 = sha256Text(bytes);
  return transform;
}

std::vector<FrameTransform> readFrameTransforms(const std::vector<std::string>& files) {
  std::vector<FrameTransform> transforms;
  for (const std::string& file : files) transforms.push_back(readFrameTransform(file));
  return transforms;
}

JoinedFrames joinFrames(const FrameName& a, const FrameName& b,
                        std::span<const FrameTransform> given, const JsonReader& at) {
  if (!a.name.empty() && a == b) return {};
  std::optional<JoinedFrames> joined;
  for (const FrameTransform& frame_transform : given) {
    const std::optional<Pose> a_from_b = joinBy(frame_transform, a, b);
    if (!a_from_b) continue;
    if (joined && !nearlySame(joined->a_from_b, *a_from_b))
      at.fail("of the given transforms " + joined->by->file.string() + " and " +
              frame_transform.file.filename().string() + " lead from " + frameText(b) + " to " +
              frameText(a) + " with different values; give only the valid one");
    if (joined) continue;
    joined = JoinedFrames{*a_from_b, frame_transform};
    joined->by->file = frame_transform.file.filename();
  }
  if (!joined) at.fail(noWayText(a, b, given));
  return *joined;
}

}  // namespace boresight::sessions
