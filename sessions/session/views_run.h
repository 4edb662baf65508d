// SPDX-License-Identifier: Apache-2.0
// Cases of a rig that are solved together.
#pragma once

#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "core/views/views_problem.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Why the other views of a case's rig cannot be solved together with it, as a sentence; empty when
/// they can.
std::string whyAlone(const Session& session, const std::string& case_id);

/// Views of one rig, read, to be run as one; immutable. Seed and uncertainty are those of the first
/// view's case.
struct LoadedViews {
  std::vector<std::shared_ptr<const LoadedCase>> cases;
  std::vector<View> views;  ///< point into the cases

  /// Points into this object.
  ViewsProblem problem() const;
  std::vector<std::string> ids() const;

  LoadedViews() = default;
  LoadedViews(const LoadedViews&) = delete;
  LoadedViews& operator=(const LoadedViews&) = delete;
};

/// The other cases of a case's rig, in the order of the session.
std::vector<SessionCase> otherViews(const Session& session, const std::string& case_id);

/// A case that is read already, and others of its rig. InputError when one cannot be read, or an
/// image is not of its camera's size.
std::shared_ptr<const LoadedViews> loadViews(std::shared_ptr<const LoadedCase> first,
                                             const std::vector<SessionCase>& others);

/// Runs a case together with the other views of its rig, by the session's options; one snapshot per
/// view, the case's first. The digest is the same for every caller. A stop leaves the status at
/// kRunning. InputError for inputs that cannot be run.
std::vector<LocalizationTrace> runViews(const Session& session, const std::string& case_id,
                                        const std::stop_token& stop = {});

/// Stores the result of each view, as storeRun does, as a run of the view's case that names the
/// others.
std::vector<RunRecord> storeViews(const Session& session,
                                  const std::vector<LocalizationTrace>& views,
                                  const std::filesystem::path& session_file);

/// Repeats a recorded run with its own options, with the other views if there were any. InputError
/// when its inputs have changed, or its views do not end as recorded.
LocalizationTrace repeatRun(const RunRecord& run, const Session& session,
                            const std::filesystem::path& session_file,
                            RecordLevel level = RecordLevel::kFull);

}  // namespace boresight::sessions
