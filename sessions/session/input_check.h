// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/meshes/scene_mesh.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

enum class FindingKind { kMissing, kChanged, kUnreadable };

/// A file of a session that is missing, changed or unreadable.
struct Finding {
  FindingKind kind = FindingKind::kMissing;
  std::string case_id;
  std::string what;  ///< place in the case by forEachFile, or "run"
  std::filesystem::path file;
  std::string text;  ///< one readable sentence

  bool operator==(const Finding&) const = default;
};

/// Reads every file that the session names, each once, and compares its hash. Findings are reported
/// and nothing is changed; a run of a case rejects changed inputs as well. After a stop, which
/// takes effect between two files, the findings are incomplete.
std::vector<Finding> checkInputs(const Session& session, const std::stop_token& stop = {});

/// A moved file and its new path.
struct Relink {
  std::filesystem::path missing;
  std::filesystem::path found;

  bool operator==(const Relink&) const = default;
};

/// Searches missing files below the folder of the session: first at the ends of their paths, then
/// everywhere by name (at most 100000 entries), then by extension. Only a file with the right hash
/// counts. After a stop, which takes effect between two files, the list is incomplete.
std::vector<Relink> findMissing(const Session& session, const std::filesystem::path& session_file,
                                const std::stop_token& stop = {});

/// The same session with each missing path replaced by the found one; hashes stay.
Session relinked(const Session& session, const std::vector<Relink>& relinks);

/// The same session with the current hashes of the case's files, and the numbers of changed
/// transforms (withFrames): the operator accepts them. Runs of the case become stale. InputError
/// when a file cannot be read, or no longer has a transform.
Session acceptingInputs(const Session& session, const std::string& case_id);

/// The session with the hashes and transforms of `accepted`, which acceptingInputs() returned for
/// `before`, for those files of the case that are still the same files as in `before`.
Session withAccepted(const Session& session, const SessionCase& before,
                     const SessionCase& accepted);

/// Reads the image by `eight_bit`, which may differ from the session's. InputError when it cannot
/// be read, or its files differ from those of the session.
GrayImage readKnownImage(const ImageInput& image, const ImageReadOptions& eight_bit);

/// Reads the meshes of a case that are in use. InputError, also for files that differ from those of
/// the session, which are not parsed: meshes, and files of frames.
SceneMesh readKnownScene(const SessionCase& session_case);

/// The mask image of a case, all false without one. InputError when it cannot be read, has another
/// size, or differs from that of the session.
IgnoreMask readKnownMask(const SessionCase& session_case, int width, int height);

/// InputError naming `what` of the file, unless the hashes are the same.
void requireKnown(const std::filesystem::path& file, const std::string& what,
                  const std::string& found_sha256, const std::string& known_sha256);

/// The same image, converted to 8 bit by another rule. Reads the file; InputError when it differs
/// from that of the session, or the rule does not fit it.
ImageInput converted(const ImageInput& image, const ImageReadOptions& eight_bit);

/// The image of a case after a conversion.
struct Conversion {
  std::string case_id;
  ImageInput image;
};
/// The session with these images, except for cases whose image was replaced meanwhile.
Session withConversions(const Session& session, const std::vector<Conversion>& conversions);

}  // namespace boresight::sessions
