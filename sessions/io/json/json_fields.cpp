// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/json/json_fields.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/localizer/localizer.h"
#include "sessions/io/json/json_writer.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr double kMaxLength_m = 1e6;

}  // namespace

PathWriter::PathWriter(const fs::path& file) : folder_(fs::absolute(file).parent_path()) {}

std::string PathWriter::operator()(const fs::path& file) const {
  if (file.empty()) return "";  // of an input that is not there
  const fs::path whole = fs::absolute(file).lexically_normal();
  const fs::path relative = whole.lexically_relative(folder_.lexically_normal());
  return relative.empty() ? whole.string() : relative.string();
}

bool isSha256Text(const std::string& text) {
  return text.size() == 64 && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

std::string readSha256(const JsonReader& json) {
  std::string text = json.text();
  if (!isSha256Text(text)) json.fail("not a SHA-256 (64 lower-case hexadecimal digits)");
  return text;
}

std::string readTime(const JsonReader& json) {
  constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:ddZ";
  std::string text = json.text();
  const auto fits = [](char c, char form) {
    return form == 'd' ? std::isdigit(static_cast<unsigned char>(c)) != 0 : c == form;
  };
  if (!std::equal(text.begin(), text.end(), kForm.begin(), kForm.end(), fits))
    json.fail("not a time like 2026-01-31T23:59:59Z");
  return text;
}

std::string readRunStatus(const JsonReader& json) {
  const std::string text = json.text();
  std::string known;
  for (int i = 0; i <= static_cast<int>(kLastLocalizationStatus); ++i) {
    const std::string status = localizationStatusText(static_cast<LocalizationStatus>(i));
    if (text == status) return text;
    known += (known.empty() ? "" : ", ") + status;
  }
  json.fail("'" + text + "' is not a status of a run: use one of " + known);
}

ordered_json exactPoseJson(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  return {{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation_m", toJson(pose.translation_m)}};
}

Pose readExactPose(const JsonReader& json) {
  const JsonReader rotation = json.at("rotation_wxyz");
  const std::vector<JsonReader> q = rotation.elements(4);
  Pose pose;
  pose.rotation = Eigen::Quaterniond(q[0].number(), q[1].number(), q[2].number(), q[3].number());
  if (!(std::abs(pose.rotation.squaredNorm() - 1.0) <= 1e-9))
    rotation.fail("not a unit quaternion: its length is " + numberText(pose.rotation.norm()));
  pose.translation_m = json.at("translation_m").vector3(-kMaxLength_m, kMaxLength_m);
  return pose;
}

}  // namespace boresight::sessions
