// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace boresight::app {

/// Exit codes of the programs.
enum ExitCode : int {
  kDone = 0,  ///< and, for localize, converged
  kInternalFault = 1,
  kUsage = 2,
  kBadInput = 3,  ///< or an output that cannot be written
  kNotConverged = 4,
  kWithinLimits = 5,  ///< compare: different, within the limits
  kDifferent = 6,     ///< compare, verify, tables --against, run --again
};

/// Exit codes of whs, for its help.
inline constexpr const char* kExitStatusText =
    "0 done (localize: converged), 2 usage, 3 bad input or an output that cannot be written, 4 did "
    "not converge, 5 different within the limits (compare), 6 different (compare, verify, tables, "
    "run --again), 1 internal fault, 128 + signal: interrupted.";

}  // namespace boresight::app
