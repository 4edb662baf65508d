// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/frame_transform.h"

#include <nlohmann/json.hpp>

#include "sessions/io/file_bytes.h"
#include "sessions/io/json_document.h"
#include "sessions/io/json_writer.h"
#include "sessions/io/pose_file.h"

namespace boresight::sessions {
namespace {

constexpr const char* kFormat = "boresight-transform";
constexpr int kVersion = 1;

/// What people are told who gave none, or only some between other frames.
std::string noWayText(const FrameName& a, const FrameName& b,
                      std::span<const FrameTransform> given) {
  const std::string needed =
      "the pose is given in " + frameText(b) + ", but the camera model in " + frameText(a);
  if (a.name.empty())
    return needed +
           "; if these are one frame leave reference_frame out of the pose, else name the "
           "camera's frame in a camera.json and give the transform between the two";
  if (given.empty()) return needed + "; give the transform between the two (transform.json)";
  std::string others;
  for (const FrameTransform& one : given)
    others += (others.empty() ? "" : ", ") + one.file.filename().string() + " leads from " +
              frameText(one.source) + " to " + frameText(one.target);
  return needed + ", and " + others;
}

}  // namespace

FrameTransform readFrameTransform(const std::filesystem::path& file) {
  const auto bytes = readFileBytes(file, kMaxJsonBytes);
  const JsonDocument document(file, asText(bytes));
  const JsonReader root = document.root(kFormat, kVersion);
  FrameTransform transform;
  transform.target = readFrameName(root.at("target"));
  transform.source = readFrameName(root.at("source"));
  if (sameFrame(transform.target, transform.source))
    root.failMember("source", "is the same frame as the target");
  transform.target_from_source = readTransform(root.at("target_from_source"));
  transform.comment = root.at("comment").nonEmptyText();
  transform.file = file;
  transform.file_sha256 = sha256Text(bytes);
  return transform;
}

std::vector<FrameTransform> readFrameTransforms(const std::vector<std::string>& files) {
  std::vector<FrameTransform> transforms;
  for (const std::string& file : files) transforms.push_back(readFrameTransform(file));
  return transforms;
}

bool sameFrame(const FrameName& a, const FrameName& b) { return a == b; }

JoinedFrames joinFrames(const FrameName& a, const FrameName& b,
                        std::span<const FrameTransform> given, const JsonReader& at) {
  if (!a.name.empty() && sameFrame(a, b)) return {};
  for (const FrameTransform& one : given) {
    JoinedFrames joined{one.target_from_source, one};
    joined.by->file = one.file.filename();
    if (sameFrame(one.target, a) && sameFrame(one.source, b)) return joined;
    joined.a_from_b = one.target_from_source.inverse();
    if (sameFrame(one.target, b) && sameFrame(one.source, a)) return joined;
  }
  at.fail(noWayText(a, b, given));
}

void writeFrameTransform(const std::filesystem::path& file, const FrameTransform& transform) {
  nlohmann::ordered_json json;
  json["format"] = kFormat;
  json["version"] = kVersion;
  json["target"] = toJson(transform.target);
  json["source"] = toJson(transform.source);
  json["target_from_source"] = toJson(transform.target_from_source);
  json["comment"] = transform.comment;
  writeJsonFile(file, json);
}

}  // namespace boresight::sessions
