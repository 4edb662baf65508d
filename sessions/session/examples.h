// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace boresight::sessions {

/// The folder of the examples that ship: share/boresight/examples beside an installed program,
/// sessions/examples above one that runs from its build tree. InputError when there is neither.
std::filesystem::path examplesFolder();

}  // namespace boresight::sessions
