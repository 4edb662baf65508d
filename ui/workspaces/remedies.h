// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <QString>

#include "sessions/trace/trace.h"
#include "ui/workspaces/step.h"

namespace boresight::ui {

/// A remedy for a failed run, and its cause.
struct Remedy {
  Step step;
  const char* cause;   ///< observed cause, for the operator
  bool tried = false;  ///< tried before the run, which still failed

  bool operator==(const Remedy&) const = default;
};

/// Remedies, the most likely first, those already tried last; none for a run that converged or has
/// not ended. `tried` adds to the remedies that the run itself shows.
std::vector<Remedy> remediesFor(const sessions::LocalizationTrace& trace,
                                const std::vector<Step>& tried = {});

/// The step that shows where the figure of a failed check comes from.
Step stepOfCheck(const std::string& check_id);

/// "wider search, nudged seed"; empty when nothing was tried.
QString triedText(const std::vector<Remedy>& remedies);

/// The remedies taken for each case since the session was opened.
class RemedyMemory {
 public:
  /// Records a remedy taken for the failed run of this digest.
  void note(const std::string& case_id, const std::string& digest, Step step);
  /// Remedies taken for runs before this one.
  std::vector<Step> before(const std::string& case_id, const std::string& digest) const;
  void clear() { taken_.clear(); }

 private:
  struct Taken {
    std::string digest;  ///< of the failed run
    Step step;
  };
  std::map<std::string, std::vector<Taken>> taken_;  ///< by case
};

}  // namespace boresight::ui
