// SPDX-License-Identifier: Apache-2.0
// Names and numbers of a session's images and stations in the formats of other programs.
#pragma once

#include <string>
#include <vector>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// Paths of the cases' images below the folder that holds all of them, with '/', by case.
std::vector<std::string> imageNames(const Session& session);

/// 12 for 000012.png, when all images are numbered and each differently; else 1, 2, ... By case.
std::vector<int> imageNumbers(const Session& session);

/// 1, 2, ... for the stations in the order in which cases have them; cases of the same parts in the
/// same places are of the same station. By case.
std::vector<int> stationNumbers(const Session& session);

/// Whether `name`, a path, is the end of `file`, by whole components.
bool isEndOf(const std::string& name, const std::filesystem::path& file);

}  // namespace boresight::sessions
