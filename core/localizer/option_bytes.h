// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

#include "core/base/bytes.h"
#include "core/localizer/localizer_options.h"

namespace boresight {

/// How an option's value is written.
enum class OptionKind : std::uint8_t { kBoolean = 0, kInteger = 1, kReal = 2, kChoice = 3 };

template <class Field>
constexpr OptionKind optionKindOf() {
  if constexpr (std::is_same_v<Field, bool>) return OptionKind::kBoolean;
  if constexpr (std::is_enum_v<Field>) return OptionKind::kChoice;
  if constexpr (std::is_floating_point_v<Field>) return OptionKind::kReal;
  return OptionKind::kInteger;
}

/// u32 how many, then each in the order of visitFields: u8 length, name, u8 kind, u64 value (a
/// real's bits; a signed integer else).
void writeOptions(const LocalizerOptions& options, ByteWriter& writer);

}  // namespace boresight
