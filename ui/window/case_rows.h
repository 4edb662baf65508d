// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sessions/session/session.h"
#include "ui/models/cases_model.h"

namespace boresight::ui {

/// The session's cases as the list of cases shows them. `running` is the id of the one at work, or
/// empty.
std::vector<CaseRow> caseRows(const sessions::Session& session, const QString& running);

}  // namespace boresight::ui
