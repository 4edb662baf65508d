// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace boresight::peers {

/// What came of some work.
struct GuardedAnswer {
  std::optional<std::string> answer;  ///< nothing when the work was lost
  std::string loss;                   ///< how: "took more than 60 s", "signal 11", ...
};

/// Does `work` in a child process that is killed after `limit_s` of processor time (or 30 times as
/// much of wall time); what it prints goes nowhere. An exception, a crash or a hang costs its
/// answer and nothing else. Only for a process that has one thread. std::runtime_error when there
/// can be no child.
GuardedAnswer runGuarded(const std::function<std::string()>& work, double limit_s);

}  // namespace boresight::peers
