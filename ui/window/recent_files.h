// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <QStringList>

namespace boresight::ui {

/// Sessions that were opened or saved last, the newest first, as absolute paths. Kept in the
/// program's settings; files that are gone are left out.
QStringList recentFiles();
void noteRecentFile(const std::filesystem::path& file);

}  // namespace boresight::ui
