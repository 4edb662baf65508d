// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/cameras/frame_transform.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// Files next to `name.json`: `name.journal`, `name.lock`, `name.runs/`; next to a `name` without
/// .json: `name-journal`, ... A file has the same ones by all its names only where these are no
/// symbolic links: linkTarget().
std::filesystem::path journalFileOf(const std::filesystem::path& session_file);
std::filesystem::path lockFileOf(const std::filesystem::path& session_file);
std::filesystem::path runsFolderOf(const std::filesystem::path& session_file);
/// Path of a run's trace, named by its digest.
std::filesystem::path runFileOf(const std::filesystem::path& session_file,
                                const std::string& digest);

/// Largest session file, and journal: some 100,000 cases.
inline constexpr std::size_t kMaxSessionBytes = 512 * kMegabyte;

/// A session as it was read, and the hash of the file's bytes, which names this saved state.
struct SavedSession {
  Session session;
  std::string file_sha256;
  std::size_t size_bytes = 0;  ///< of the file
};

/// InputError (file, field, reason) when it is missing or invalid. The inputs that it names are not
/// read (input_check.h).
SavedSession readSessionFile(const std::filesystem::path& file);

/// Writes atomically and returns the hash of the bytes. OutputError; then the old file is
/// unchanged.
std::string writeSessionFile(const std::filesystem::path& file, const Session& session);

/// sessionText() for a file: OutputError when it is longer than the limit.
std::string sessionFileText(const Session& session, const std::filesystem::path& file);

class PathWriter;

nlohmann::ordered_json toJson(const SessionCase& session_case, const PathWriter& path);
/// Inverse of toJson; does not detect duplicate ids. InputError.
SessionCase readSessionCase(const JsonReader& json);

nlohmann::ordered_json toJson(const RunRecord& run, const PathWriter& path);
RunRecord readRunRecord(const JsonReader& json);  ///< Inverse of toJson. InputError.
nlohmann::ordered_json toJson(const AnnotationRounds& rounds);
AnnotationRounds readRounds(const JsonReader& json);  ///< Inverse of toJson. InputError.
nlohmann::ordered_json toJson(const DocumentView& view);
DocumentView readView(const JsonReader& json);  ///< Inverse of toJson. InputError.

/// The parts of a case as included in inputsDigest.
nlohmann::ordered_json fingerprintParts(const SessionCase& session_case);

/// {"target", "source", "target_from_source", "covariance", "origin", "comment", "file", "sha256"}:
/// the file's name alone, since its numbers are here.
nlohmann::ordered_json toJson(const FrameTransform& transform);

/// An array of [keyword, value].
nlohmann::ordered_json toJson(const std::vector<LabelItem>& label);

inline constexpr const char* kSessionFormat = "boresight-session";
inline constexpr int kSessionVersion = 1;

/// Content of the session file (README.md); paths are relative to the folder of `file`. Numbers
/// read back as the same bits. OutputError when a text is not UTF-8.
nlohmann::ordered_json toJson(const Session& session, const std::filesystem::path& file);

/// The same as text: each session has exactly one text, whose SHA-256 identifies it.
std::string sessionText(const Session& session, const std::filesystem::path& file);

/// Inverse of toJson. InputError (file, field, reason): another format, a newer version, unknown
/// members or options, a duplicate id, a reference to a missing case, values out of range.
Session readSession(const JsonReader& json);

}  // namespace boresight::sessions
