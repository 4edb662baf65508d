// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <QString>

#include "sessions/trace/trace.h"
#include "ui/workspaces/step.h"

namespace boresight::ui {

/// What may help a run that failed, and when.
struct Remedy {
  Step step;
  const char* cause;   ///< what is seen, for the operator
  bool tried = false;  ///< before the run, which failed all the same
};

/// The most likely first, those that were tried last; none for a run that converged or has not
/// ended. `tried` adds to what the run itself shows to have been tried.
std::vector<Remedy> remediesFor(const sessions::LocalizationTrace& trace,
                                const std::vector<Step>& tried = {});

/// "wider search, nudged seed"; empty when nothing was tried.
QString triedText(const std::vector<Remedy>& remedies);

/// The remedies that were taken for each case since the window has its session.
class RemedyMemory {
 public:
  /// A remedy is taken for the failed run of this digest.
  void note(const std::string& case_id, const std::string& digest, Step step);
  /// What was taken for earlier runs than this one.
  std::vector<Step> before(const std::string& case_id, const std::string& digest) const;
  void clear() { taken_.clear(); }

 private:
  struct Taken {
    std::string digest;
    Step step;
  };
  std::map<std::string, std::vector<Taken>> taken_;  ///< by case
};

}  // namespace boresight::ui
