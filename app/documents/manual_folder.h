// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace boresight::documents {

/// Text that a Markdown reader shows as it is, also in a cell of a table.
std::string markdownText(const std::string& text);

/// What becomes of a link's or a picture's target: where it leads instead, or "" to leave its text
/// alone.
using LinkTarget = std::function<std::string(const std::string& target)>;

/// Markdown with every inline link `[text](target)` and picture `![text](target)` as `target_of`
/// says. Blocks between ``` stay as they are.
std::string withLinks(const std::string& markdown, const LinkTarget& target_of);

/// Pages of the manual that the programs write of themselves, by file name: "options.md".
using WrittenPages = std::map<std::string, std::string>;

/// Puts the manual together as it is installed, one folder without links out of it:
/// - resources/manual/*.md (not its README.md), with their pictures in pictures/;
/// - pages that stand elsewhere in the source beside what they tell of, under a name of their own;
/// - `written`.
/// Links to any of these lead to their place in the folder. Of other links into the source only the
/// text is left. The folder is made, and emptied if it is there. What went wrong, or "".
[[nodiscard]] std::string assembleManual(const std::filesystem::path& source,
                                         const WrittenPages& written,
                                         const std::filesystem::path& folder);

}  // namespace boresight::documents
