// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/options.h"
#include "sessions/io/dataset_file.h"
#include "sessions/io/option_value.h"

namespace boresight::sessions {

/// Limits of the checks, declared once for the panel, the session's file and the command line.
struct CheckLimits {
  double inlier_count = 12.0;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"check.inlier_count", "", 0.0, 10000.0,
                     "Inliers that the last matching iteration must have at least."},
          self.inlier_count);
  }
};

/// Limits under a name, and the requirement of cases that have none of their own.
struct CheckPreset {
  std::string name;
  std::string help;  ///< one sentence: what it is for
  Requirement requirement;
  CheckLimits limits;
};

inline constexpr const char* kDefaultCheckPreset = "sample_transfer";

/// All of them; the default comes first.
const std::vector<CheckPreset>& checkPresets();
/// nullptr when there is none of this name.
const CheckPreset* findCheckPreset(const std::string& name);

/// A preset's limits with those of a session in their place. OptionError when one does not exist or
/// is out of range; std::invalid_argument when there is no such preset.
CheckLimits checkLimits(const std::string& preset, const OptionList& changed);

}  // namespace boresight::sessions
