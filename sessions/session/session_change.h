// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/json/json_reader.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// The members in which a session differs from another one, {} when they are equal:
///
///     {"profile": ..., "options": ..., "robust_annotations": ..., "review": ..., "view": ...,
///      "annotations": {CASE: ... or null}, "rounds": {CASE: ... or null},
///      "cases": {"replace": [[INDEX, ...], ...], "erase": [INDEX, ...],
///                "insert": [[INDEX, ...], ...]}, "decisions": ..., "runs": ...}
///
/// Elements are written as in the session file, with paths relative to the folder of `file`.
/// Elements are first replaced, then erased (indices of `before`), then inserted (indices of
/// `after`), in ascending order. The cost grows with the difference of sessions that share their
/// other elements (KeyedList), not with their size.
nlohmann::ordered_json sessionChange(const Session& before, const Session& after,
                                     const std::filesystem::path& file);

/// Inverse of sessionChange: the session after the change. InputError (file, field, reason) for
/// what readSession refuses: two cases of one id, a reference to a missing case, values out of
/// range.
Session withChange(const Session& before, const JsonReader& change);

}  // namespace boresight::sessions
