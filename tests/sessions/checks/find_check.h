// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <string>

#include "sessions/decision/check.h"

namespace boresight::test {

/// The check of an id; an empty one, and a failure, when there is none.
inline sessions::Check findCheck(std::span<const sessions::Check> checks, const std::string& id) {
  for (const sessions::Check& check : checks)
    if (check.id == id) return check;
  ADD_FAILURE() << "there is no check " << id;
  return {};
}

}  // namespace boresight::test
