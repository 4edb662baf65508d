// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "sessions/session/session.h"
#include "sessions/session/stale_runs.h"
#include "ui/models/cases_model.h"

namespace boresight::ui {

/// The session's cases as the list of cases shows them. `running` is the id of the one at work, or
/// empty; `file` is the session's, for messages; `known` is kept from one call to the next.
std::vector<CaseRow> caseRows(const sessions::Session& session, const QString& running,
                              const std::filesystem::path& file, sessions::StaleRuns& known);

}  // namespace boresight::ui
