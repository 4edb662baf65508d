// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>

/// The matchers that most tests use, by their bare names.
namespace boresight {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

}  // namespace boresight
