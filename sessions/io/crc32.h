// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/crc32.h"

namespace boresight::sessions {

using boresight::crc32;

}  // namespace boresight::sessions
