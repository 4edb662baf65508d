// SPDX-License-Identifier: Apache-2.0
// Right and deliberately wrong cases to calibrate the checks of a pose on.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/localizer/localizer_options.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session.h"

namespace boresight::test {

/// One case as it is run, and what its pose is judged by.
struct CheckedVariant {
  std::shared_ptr<const sessions::LoadedCase> loaded;  ///< without truth
  bool wrong_mesh = false;  ///< of another station: no pose of it is right
  LocalizerOptions options;
  Pose camera_from_station_true;
  Camera true_camera;
};

bool isPhotograph(const sessions::SessionCase& session_case);

/// A copy of a case as it was read, to be changed.
std::shared_ptr<sessions::LoadedCase> copyOf(const sessions::LoadedCase& loaded);

/// Names of the variants of a case, in the order in which they are run.
std::vector<std::string> variantNames(bool photographs);

/// Makes one. `other` lends its mesh to "mesh of another station".
CheckedVariant makeVariant(const sessions::Session& session,
                           const sessions::SessionCase& session_case,
                           const sessions::SessionCase& other, const std::string& variant);

}  // namespace boresight::test
