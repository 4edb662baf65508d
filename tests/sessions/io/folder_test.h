// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace boresight::sessions {

/// A test with a folder of its own.
class FolderTest : public testing::Test {
 protected:
  const test::TemporaryFolder folder_;
};

}  // namespace boresight::sessions
