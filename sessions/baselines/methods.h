// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <vector>

#include "sessions/baselines/method_options.h"
#include "sessions/run/matching_method.h"
#include "sessions/run/runner.h"

namespace boresight::sessions {

inline constexpr const char* kWhs = "whs";

bool isMethod(const std::string& name);
/// Whether the method is an external matcher, whose command must be given.
bool needsMatcher(const std::string& name);
/// "whs, ncc, ...", for messages.
std::string methodNames();

/// Setup of the methods other than WHS.
struct MethodSetup {
  MethodOptions options;
  std::string matcher;  ///< command of the external matcher of `external` and `loftr-*`
};

/// Localizes with a method chosen by name. Resources of a method (a child process) are reused by
/// later runs; several threads may run at the same time.
class Methods {
 public:
  explicit Methods(const MethodSetup& setup) : setup_(setup) {}

  /// As localize(), with the matches of the method; identical for WHS. A method with its own
  /// capacity raises templates.count to that capacity. MethodError when the method failed (this run
  /// is lost, the next one may succeed), std::invalid_argument for an unknown name.
  LocalizationTrace localize(const std::string& method, const LocalizationProblem& problem,
                             const LocalizerOptions& options, const RunSettings& settings,
                             const std::stop_token& stop = {});

 private:
  MethodSetup setup_;
  std::mutex mutex_;  ///< guards the members below
  std::map<std::string, std::vector<std::unique_ptr<MatchingMethod>>> idle_;
};

}  // namespace boresight::sessions
