// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/json_reader.h"
#include "sessions/run/view_outcome.h"

namespace boresight::sessions {

struct Session;

/// What a session notes of a run that was solved for together with other views of the case's rig:
/// enough to run all of them again.
struct TogetherRecord {
  std::vector<ViewOutcome> views;  ///< in their order, this case's among them; the first one led
  std::string inputs_sha256;       ///< viewsDigest of them when they ran

  bool operator==(const TogetherRecord&) const = default;
};

/// The cases of a record's views.
std::vector<std::string> casesOf(const TogetherRecord& record);

/// SHA-256 over what a run of these cases together depends on: the inputs of each but for the seeds
/// of those that follow the first, and how the cameras lie to each other. Empty when a case is not
/// there any more, or is of no rig.
std::string viewsDigest(const Session& session, const std::vector<std::string>& case_ids);

/// A text that localizationStatusText gives; InputError for any other.
std::string readRunStatus(const JsonReader& json);

nlohmann::ordered_json toJson(const TogetherRecord& record);
/// InputError.
TogetherRecord readTogether(const JsonReader& json);

}  // namespace boresight::sessions
