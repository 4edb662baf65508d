// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace boresight::sessions {

/// One edit of a session.
struct JournalEntry {
  std::int64_t sequence = 0;  ///< 1, 2, 3, ...
  std::string text;           ///< what was done, for people
  std::string time;           ///< UTC
  std::string after_sha256;   ///< of sessionText after the edit
  std::string patch;          ///< JSON, see json_patch.h

  bool operator==(const JournalEntry&) const = default;
};

/// What a journal file says. Lines count up to the first one that is damaged.
struct JournalContents {
  std::string
      base_sha256;  ///< of the session file that the first entry changes; "" when unreadable
  std::vector<JournalEntry> entries;
  std::size_t lost_lines = 0;  ///< at the first damaged line and after it; a torn last one counts
  std::string problem;         ///< why nothing can be read, or ""
};

/// The journal is text. The first line is a header, each further line an edit:
///
///     CRC {"format": "boresight-journal", "version": 1, "base_sha256": "..."}
///     CRC {"seq": 1, "time": "...", "text": "...", "after_sha256": "...", "patch": [...]}
///
/// CRC is eight hexadecimal digits: CRC-32 of the CRC text of the line before and this line's JSON,
/// so that a line counts only behind the lines that it was written behind.
///
/// InputError when the file exists but cannot be read; a missing file is the caller's to notice.
JournalContents readJournal(const std::filesystem::path& file);

/// Appends edits to a journal; owns the descriptor.
class Journal {
 public:
  /// A new journal with these entries, written atomically in place of any other. OutputError.
  Journal(const std::filesystem::path& file, const std::string& base_sha256,
          const std::vector<JournalEntry>& entries = {});
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  ~Journal();

  /// Returns when the entry is on the disk; its sequence number is set here. On OutputError the
  /// journal is as it was before.
  void append(JournalEntry entry);

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  std::int64_t sequence_ = 0;
  std::string last_crc_;
  std::int64_t size_bytes_ = 0;
  bool damaged_ = false;  ///< a half-written line could not be taken back
};

}  // namespace boresight::sessions
