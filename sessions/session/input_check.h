// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sessions/session/session.h"

namespace boresight::sessions {

enum class FindingKind { kMissing, kChanged, kUnreadable };

/// Something that a session names and that is not as the session knows it.
struct Finding {
  FindingKind kind = FindingKind::kMissing;
  std::string case_id;
  std::string what;  ///< place in the case: "image", "parts[0]", "ignore", "onboard_record", "run"
  std::filesystem::path file;
  std::string text;  ///< one sentence for people

  bool operator==(const Finding&) const = default;
};

/// Reads every file that the session names, each once, and compares its hash. What is found is
/// reported and nothing is changed; a run of a case refuses changed inputs by itself.
std::vector<Finding> checkInputs(const Session& session);

/// SHA-256 of a file as sessions know it: of its bytes, for glTF with the buffers beside it, for an
/// image with a label of both where they are two files.
/// InputError.
std::string inputSha256(const std::filesystem::path& file);
std::string meshSha256(const PartSource& part);

/// A file that was moved, and where it is now.
struct Relink {
  std::filesystem::path missing;
  std::filesystem::path found;

  bool operator==(const Relink&) const = default;
};

/// Looks for missing files below the folder of the session: first where the ends of their paths
/// lead, then everywhere by name (at most 100000 entries). Only a file with the right hash counts.
std::vector<Relink> findMissing(const Session& session, const std::filesystem::path& session_file);

/// The same session with each missing path replaced by the found one; hashes stay.
Session relinked(const Session& session, const std::vector<Relink>& relinks);

/// The same session with the hashes that the case's files have now: somebody has looked and accepts
/// them. Runs of the case become stale. InputError when a file cannot be read.
Session acceptingInputs(const Session& session, const std::string& case_id);

}  // namespace boresight::sessions
