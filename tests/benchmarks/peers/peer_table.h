// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "sessions/evaluation/run_result.h"

namespace boresight::peers {

/// Markdown: what each method reached of each group of cases, whs last: completed, within the
/// requirement, false positives, errors (mean / standard deviation / max) of successful and of all
/// completed runs, and seconds. Photographs (tag "real") are one group unless `each_station`.
std::string peerTable(std::span<const sessions::RunResult> runs, bool each_station);

}  // namespace boresight::peers
