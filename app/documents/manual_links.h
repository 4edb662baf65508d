// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace boresight::documents {

/// What becomes of a link's or a picture's target: where it leads instead, or "" to leave its text
/// alone.
using LinkTarget = std::function<std::string(const std::string& target)>;

/// Markdown with every inline link `[text](target)` and picture `![text](target)` as `target_of`
/// says. Blocks between ``` stay as they are.
std::string withLinks(const std::string& markdown, const LinkTarget& target_of);

}  // namespace boresight::documents
