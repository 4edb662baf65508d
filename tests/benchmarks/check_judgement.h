// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace boresight::test {

/// Whether none of a line's checks fails by the presets' limits as they are now.
bool passes(const nlohmann::json& line);

/// Judges measured checks by the presets' limits as they are now and prints, for either half of the
/// cases (by a hash of the case's id), how many wrong poses pass and how many right ones are
/// refused, which these are, and by which checks. 1 when a wrong one passes.
int judge(const std::vector<std::string>& files);

}  // namespace boresight::test
