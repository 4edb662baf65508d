// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// Writes one zip archive that opens elsewhere: below a folder of the session's name the session,
/// `inputs/` with every file that it names (once, under the beginning of its hash, so that files of
/// the same name do not meet), and the traces of its runs. The session in it names its files
/// relatively. The archive is read again before it gets its name. Returns what people should know:
/// traces and landmarks that are missing and were left out. InputError when an input is missing or
/// not the one that the session was made with; OutputError.
std::vector<std::string> packSession(const Session& session,
                                     const std::filesystem::path& session_file,
                                     const std::filesystem::path& archive);

}  // namespace boresight::sessions
