// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "sessions/trace/record.h"
#include "sessions/trace/run_snapshot.h"
#include "tests/support/loaded_example.h"

namespace boresight::test {

/// The run of a case with the default options.
inline std::shared_ptr<const sessions::RunSnapshot> ranExample(
    const std::shared_ptr<const ui::LoadedCase>& one) {
  return std::make_shared<const sessions::RunSnapshot>(sessions::snapshotOf(
      sessions::localize(one->problem(), LocalizerOptions(), sessions::RecordLevel::kFull)));
}

}  // namespace boresight::test
