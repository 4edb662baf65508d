// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// The edits since the session was saved.
struct Journal {
  std::string base_sha256;         ///< of the session file that the first edit changed
  std::string time;                ///< UTC, of the last edit
  std::vector<std::string> edits;  ///< descriptions, in their order
};

/// Edits that were made but not saved when a program ended.
struct Recovery : Journal {
  Session session;  ///< with all edits
};

/// Writes a journal in place of any other, whole or not at all; on the disk when this returns.
/// `session_text` is the `sessionText` after the last edit:
///
///     {"format": "boresight-journal", "version": 1, "base_sha256": "...", "time": "...",
///      "edits": ["...", ...], "session": {"format": "boresight-session", ...}}
///
/// OutputError; then the former journal is as it was.
void writeJournal(const std::filesystem::path& file, const Journal& journal,
                  const std::string& session_text);

/// InputError for a missing file and one that is not a journal.
Recovery readJournal(const std::filesystem::path& file);

}  // namespace boresight::sessions
