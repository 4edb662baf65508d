// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace boresight::sessions {

/// Where a chain of symbolic links ends, which need not exist: the one name of a file, by which its
/// companions are named and which a rename replaces. A name that is no link is returned as it is,
/// as is that of an open file of this process, to which /dev/stdout leads. OutputError for links
/// without an end.
std::filesystem::path linkTarget(const std::filesystem::path& file);

}  // namespace boresight::sessions
