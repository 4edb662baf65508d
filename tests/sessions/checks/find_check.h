// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sessions/decision/check.h"
#include "sessions/session/case_run.h"

namespace boresight::test {

/// The check of an id; an empty one, and a failure, when there is none.
inline sessions::Check findCheck(std::span<const sessions::Check> checks, const std::string& id) {
  for (const sessions::Check& check : checks)
    if (check.id == id) return check;
  ADD_FAILURE() << "there is no check " << id;
  return {};
}

/// The checks that one of the functions add...Checks adds for these arguments.
template <class Add, class... Arguments>
std::vector<sessions::Check> addedChecks(Add add, const Arguments&... arguments) {
  std::vector<sessions::Check> checks;
  add(arguments..., checks);
  return checks;
}

/// The same case, image and mesh, to be changed.
inline std::shared_ptr<sessions::LoadedCase> copyOf(const sessions::LoadedCase& loaded) {
  auto copy = std::make_shared<sessions::LoadedCase>();
  copy->source = loaded.source;
  copy->scene = loaded.scene;
  copy->image = loaded.image;
  return copy;
}

}  // namespace boresight::test
