// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace boresight::sessions {

/// What turns one JSON value into another, as small as its structure allows: a list of
///     ["set", PATH, value]        a member or element gets a value (a member may be new)
///     ["remove", PATH]            a member goes
///     ["splice", PATH, i, n, []]  in a list, n elements from i on are replaced by others
/// PATH is the list of keys and indices from the top. RFC 6902 patches are not used because their
/// usual generator rewrites all elements behind an inserted one and takes 0.0 and -0.0, or 1 and
/// 1.0, for the same.
nlohmann::json jsonPatch(const nlohmann::json& before, const nlohmann::json& after);

/// Applies a patch in place. False, with `value` in an undefined state, when it is not a patch or
/// does not fit the value.
[[nodiscard]] bool applyJsonPatch(const nlohmann::json& patch, nlohmann::json& value);

}  // namespace boresight::sessions
