// SPDX-License-Identifier: Apache-2.0
// The poses that cases are handed over with, for other programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sessions/exchange/annotation_exchange.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// As handedPoses gives them, for `writeColmapOf` and `writeBopOf`. InputError when there is none.
CasePoses posesToHandOver(const Session& session, const std::vector<std::string>& case_ids);

/// Writes them as a BOP19 results file: images and objects are numbered as `exportBop` does, in
/// this scene; the score is 1 for a validated pose or one from marks, else the edge support of its
/// run. The format has no room for a remark: when one of the poses is not validated, the file's
/// name has to say so (kNotValidatedName in it), InputError otherwise. OutputError.
ExportReport exportBopResults(const Session& session, const std::filesystem::path& file,
                              const std::vector<std::string>& case_ids, int scene_id);
inline constexpr const char* kNotValidatedName = "NOT-VALIDATED";

}  // namespace boresight::sessions
