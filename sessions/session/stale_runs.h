// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// `stalenessOf` for all cases of a session again and again as it is edited: what is known of cases
/// and options that are still the same is kept.
class StaleRuns {
 public:
  /// As `stalenessOf(run, session, file).stale()`; `one` is the run's case in the session.
  /// InputError of options that cannot be read.
  bool isStale(const RunRecord& run, const SharedValue<SessionCase>& one, const Session& session,
               const std::filesystem::path& file);

 private:
  struct Inputs {
    SharedValue<SessionCase> one;
    std::string digest;
  };
  void takeOptions(const Session& session);

  std::map<std::string, Inputs> inputs_;  ///< by case
  std::string profile_;
  OptionList options_;
  std::map<double, std::string> options_digests_;  ///< by the case's feature size, m
};

}  // namespace boresight::sessions
