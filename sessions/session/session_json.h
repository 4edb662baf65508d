// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/json_reader.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

inline constexpr const char* kSessionFormat = "boresight-session";
inline constexpr int kSessionVersion = 1;

/// What the session file holds (README.md beside this file); paths relative to the folder of
/// `file`. Numbers read back as the same bits. OutputError when a text is not UTF-8.
nlohmann::ordered_json toJson(const Session& session, const std::filesystem::path& file);

/// The same as text: a session has exactly one, so that its SHA-256 tells one from another.
std::string sessionText(const Session& session, const std::filesystem::path& file);

/// The reverse. InputError (file, field, reason): another format, a newer version, a member that
/// this version does not know, an id given twice, a reference to a case that does not exist, values
/// out of range, options that do not exist.
Session readSession(const JsonReader& json);

}  // namespace boresight::sessions
