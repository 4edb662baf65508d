// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// Files beside `name.json`: `name.journal`, `name.lock`, `name.runs/`. Another extension than
/// .json is kept as part of the name.
std::filesystem::path journalFileOf(const std::filesystem::path& session_file);
std::filesystem::path lockFileOf(const std::filesystem::path& session_file);
std::filesystem::path runsFolderOf(const std::filesystem::path& session_file);
/// Where a run's trace lies: named by its digest.
std::filesystem::path runFileOf(const std::filesystem::path& session_file,
                                const std::string& digest);

/// A session as it was read, and the hash of the file's bytes, which names this saved state.
struct SavedSession {
  Session session;
  std::string file_sha256;
};

/// InputError (file, field, reason) when it is missing or wrong in any way. The inputs that it
/// names are not looked at (input_check.h).
SavedSession readSessionFile(const std::filesystem::path& file);

/// Writes atomically and returns the hash of what was written. OutputError; then the old file is
/// as it was.
std::string writeSessionFile(const std::filesystem::path& file, const Session& session);

}  // namespace boresight::sessions
