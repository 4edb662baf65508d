// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "sessions/session/session_file.h"

namespace boresight::sessions {

/// The edits since the session was saved.
struct Journal {
  std::string base_sha256;         ///< of the session file that the first edit changed
  std::string time;                ///< UTC, of the last edit
  std::vector<std::string> edits;  ///< descriptions, in their order
};

/// Edits that were made but not saved when a program ended.
struct Recovery : Journal {
  Session session;     ///< with all edits
  std::string damage;  ///< why later edits cannot be read: one sentence, or empty
};

/// Writes the journal of a session: a line an edit.
///
///     SUM {"format": "boresight-journal", "version": 2, "base_sha256": "..."}
///     SUM {"edit": "...", "time": "...", "change": {...}}
///     SUM {"saved_sha256": "..."}
///
/// `change` is a sessionChange. A line of `saved_sha256` precedes the saving of the file. SUM: the
/// first 16 hexadecimal digits of SHA-256 over the SUM of the line before and the JSON text.
class JournalWriter {
 public:
  /// For edits of the saved state `base_sha256`. The first entry replaces a file of this name.
  JournalWriter(std::filesystem::path file, std::string base_sha256);

  /// Both are on the disk when they return, or have not happened. OutputError, also when another
  /// program has changed the journal.
  ///@{
  void addEdit(const std::string& text, const std::string& change);
  void addSaved(const std::string& sha256);
  ///@}
  std::size_t size_bytes() const { return size_bytes_; }

 private:
  void append(const std::string& json);

  std::filesystem::path file_;
  std::string base_sha256_;
  std::string sum_;             ///< of the last line
  std::size_t size_bytes_ = 0;  ///< 0: no file yet
};

/// Whether a file begins as journals do; false for a missing one.
bool isJournal(const std::filesystem::path& file);

/// The edits of a journal that the saved session lacks: none when it has all of them. An unfinished
/// last line was never confirmed and is ignored. InputError for a missing file, one that is not a
/// journal, and one of another state of the session file.
Recovery readJournal(const std::filesystem::path& file, const SavedSession& saved);

/// A journal of version 1, which holds the whole session:
///
///     {"format": "boresight-journal", "version": 1, "base_sha256": "...", "time": "...",
///      "edits": ["...", ...], "session": {"format": "boresight-session", ...}}
Recovery readWholeJournal(const std::filesystem::path& file);

}  // namespace boresight::sessions
