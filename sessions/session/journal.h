// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace boresight::sessions {

/// One edit of a session.
struct JournalEntry {
  std::string text;          ///< what was done, for people
  std::string time;          ///< UTC
  std::string after_sha256;  ///< of sessionText after the edit

  bool operator==(const JournalEntry&) const = default;
};

/// The edits since the session was saved, and the whole session after the last of them.
struct Journal {
  std::string base_sha256;  ///< of the session file that the first entry changed
  std::vector<JournalEntry> entries;
  std::string session_text;  ///< sessionText after the last entry
};

/// Writes a journal in place of any other, whole or not at all; on the disk when this returns.
/// A line with the SHA-256 of all that follows, a line of JSON, the session as its file would be:
///
///     SHA256
///     {"format": "boresight-journal", "version": 2, "base_sha256": "...", "edits": [...]}
///     {"format": "boresight-session", ...
///
/// OutputError; then the former journal is as it was.
void writeJournal(const std::filesystem::path& file, const Journal& journal);

/// A journal, or `problem`: why the file is none.
struct JournalContents : Journal {
  std::string problem;
};
/// InputError when the file exists but cannot be read; a missing file is the caller's to notice.
JournalContents readJournal(const std::filesystem::path& file);

}  // namespace boresight::sessions
