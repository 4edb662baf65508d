// SPDX-License-Identifier: Apache-2.0
// What the results of a case depend on: its files and its data, each listed once. Input check,
// relinking, acceptance, packing, the fingerprint of decisions and `whs verify` ask these lists.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// Calls `visit(place, path, sha256)` for each file that a case depends on; the places are "image",
/// "parts[0]", "ignore", "onboard_record", "frames[0]". A transform of a session by version 1.0
/// names its file without a folder: it is not visited.
template <class Case, class Visit>
void forEachFile(Case& session_case, Visit&& visit) {
  const auto place = [](const char* list, std::size_t index) {
    return list + ("[" + std::to_string(index) + "]");
  };
  visit("image", session_case.image.source.file, session_case.image.source.sha256);
  for (std::size_t i = 0; i < session_case.parts.size(); ++i)
    visit(place("parts", i), session_case.parts[i].source.mesh, session_case.parts[i].sha256);
  if (session_case.ignore) visit("ignore", session_case.ignore->file, session_case.ignore->sha256);
  if (session_case.onboard_record)
    visit("onboard_record", session_case.onboard_record->file, session_case.onboard_record->sha256);
  for (std::size_t i = 0; i < session_case.frames.size(); ++i)
    if (session_case.frames[i].file.is_absolute())
      visit(place("frames", i), session_case.frames[i].file, session_case.frames[i].file_sha256);
}

/// SHA-256 by name of all data of a case that a result, its checks or a commanded correction depend
/// on: "inputs" (of runs), "image" (file and its conversion), "image_label", "names", "frames",
/// "truth", "input_sigmas", "requirement" (with symmetries), "end_effector",
/// "onboard_record", and "others": every further member of the case in the session file. Not
/// included: the rig, which is of several cases, the nudged pose, tags, landmarks, folders of
/// files, and the feature size, which is an option of runs.
std::map<std::string, std::string> dependencyDigests(const SessionCase& session_case);

}  // namespace boresight::sessions
