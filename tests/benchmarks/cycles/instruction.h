// SPDX-License-Identifier: Apache-2.0
// What the cycle model knows about an instruction of the PowerPC 750.
#pragma once

#include <array>
#include <cstdint>

namespace boresight::cycles {

/// Execution units. Every integer instruction runs in the first integer unit; multiplications and
/// divisions run there only.
enum class Unit : std::uint8_t { kInteger, kFirstInteger, kFloat, kLoadStore, kSystem, kBranch };

/// Classes of the printed instruction mix.
enum class Kind : std::uint8_t {
  kInteger,
  kMultiply,
  kDivide,
  kLoad,
  kStore,
  kBranch,
  kFloatAdd,
  kFloatMultiply,
  kFloatDivide,
  kFloatOther,
  kSystem,
  kCount
};

/// Numbers of registers: 32 of integers, 32 of floats, 8 fields of conditions, then these.
inline constexpr int kFirstFloat = 32;
inline constexpr int kFirstCondition = 64;
inline constexpr int kLink = 72;
inline constexpr int kCount = 73;
inline constexpr int kCarry = 74;
inline constexpr int kNone = 75;  ///< source: always ready; target: dropped
inline constexpr int kRegisters = 76;

struct Instruction {
  std::uint32_t word = 0;
  Unit unit = Unit::kInteger;
  Kind kind = Kind::kInteger;
  std::uint8_t latency = 1;    ///< cycles until a dependent instruction may start
  std::uint8_t occupancy = 1;  ///< cycles until the unit accepts the next instruction
  std::array<std::uint8_t, 4> sources{kNone, kNone, kNone, kNone};
  std::array<std::uint8_t, 3> targets{kNone, kNone, kNone};
  bool serialized = false;  ///< waits until all earlier instructions are complete
  bool uses_carry = false;  ///< serialized as well, in the estimates that say so
  bool memory = false;      ///< accesses the data cache
  bool store = false;
  // Branches:
  bool conditional = false;  ///< on a condition field, sources[0]
  bool counts = false;       ///< decrements the count register
  bool indirect = false;     ///< to the link or count register, sources[1]
  bool links = false;        ///< a call
};

/// Decodes a word with the latencies of the user's manual (MPC750UM, 750GX UM, chapter 6).
Instruction decode(std::uint32_t word);

}  // namespace boresight::cycles
