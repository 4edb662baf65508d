// SPDX-License-Identifier: Apache-2.0
// One case inside the session file.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/json_reader.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// Paths are written relative to the folder of the session, where there is such a path.
class PathWriter {
 public:
  /// `file` is the session's.
  explicit PathWriter(const std::filesystem::path& file);

  std::string operator()(const std::filesystem::path& file) const;

 private:
  std::filesystem::path folder_;
};

nlohmann::ordered_json toJson(const SessionCase& one, const PathWriter& path);
/// The reverse, without whether its id is given twice. InputError.
SessionCase readSessionCase(const JsonReader& json);

/// {rotation_wxyz, translation_m}: reads back as the same bits.
nlohmann::ordered_json exactPoseJson(const Pose& pose);
/// The reverse. InputError.
Pose readExactPose(const JsonReader& json);

/// 64 lower-case hexadecimal digits. InputError.
std::string readSha256(const JsonReader& json);
/// Absolute and without detours. InputError.
std::filesystem::path readPath(const JsonReader& json, FileUse use = FileUse::kInput);

}  // namespace boresight::sessions
