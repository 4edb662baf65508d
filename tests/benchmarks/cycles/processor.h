// SPDX-License-Identifier: Apache-2.0
// When a PowerPC 750 dispatches, starts and completes instructions, from the sequence that it
// executes: six execution units, two instructions dispatched and completed a cycle, in order.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "cache.h"
#include "instruction.h"

namespace boresight::cycles {

using Cycle = std::uint64_t;

/// What published documents leave open: the board, and how well the processor overlaps.
struct Assumptions {
  const char* name = "";
  int width = 2;                 ///< instructions dispatched and completed a cycle
  int multiply_cycles = 4;       ///< 32-bit product: 2 to 5 by the operands
  bool carry_serializes = true;  ///< instructions that use the carry wait for all before them
  bool overlaps = true;  ///< instructions go on behind one that waits, or a load that misses
  bool level2 = false;   ///< has the level 2 cache
  int level2_cycles = 10;
  int first_word_cycles = 36;  ///< read of memory: until the missing word arrives
  int line_cycles = 45;        ///< until the line is whole and the bus is free
  int write_cycles = 24;       ///< line written to memory
};

/// An access of a load or a store, and where it found its line.
struct DataAccess {
  std::uint32_t double_word = 0;  ///< address in units of 8 bytes
  std::uint32_t line = 0;
  Found found;
};

class Processor {
 public:
  explicit Processor(const Assumptions& assumptions) : assumptions_(assumptions) {}

  /// A line of instructions that is not in the level 1 cache.
  void missFetch(const Found& found);
  /// `accesses`: of this instruction, in order.
  void execute(const Instruction& instruction, std::span<const DataAccess> accesses);
  /// A branch, after its direction is known.
  void branch(const Instruction& instruction, bool taken, bool predicted, bool target_cached);
  Cycle now() const { return dispatch_.cycle; }

 private:
  static constexpr std::size_t kRing = 8;  ///< numbers of instructions modulo this
  static constexpr std::size_t kQueue =
      6;  ///< entries of instruction queue and of completion queue
  static constexpr std::size_t kStores = 3;  ///< entries of the store queue

  Cycle fetchOne();
  Cycle dispatch(Cycle earliest);
  void complete(Cycle finished);
  void holdDispatch(const Instruction& instruction, Cycle start, Cycle finish);
  void completeStore(const DataAccess& access);
  /// Reads a line at `time` or later; when the missing word arrives.
  Cycle read(Cycle time, const DataAccess& access);
  Cycle readyTime(const Instruction& instruction) const;
  Unit chooseUnit(const Instruction& instruction) const;
  Cycle waitForStore(Cycle start, const DataAccess& access) const;
  Cycle load(Cycle start, Cycle finish, std::span<const DataAccess> accesses);

  /// A stage that takes a number of instructions a cycle.
  struct Stage {
    Cycle cycle = 0;
    int taken = 0;  ///< instructions in this cycle

    void moveTo(Cycle time) {
      cycle = time;
      taken = 0;
    }
    /// The cycle, `earliest` or later, in which the next instruction is taken.
    Cycle take(Cycle earliest, int width) {
      if (earliest > cycle)
        moveTo(earliest);
      else if (taken >= width)
        moveTo(cycle + 1);
      ++taken;
      return cycle;
    }
  };

  Assumptions assumptions_;
  std::array<Cycle, kRegisters> ready_{};
  Stage fetch_;                            ///< at the next fetch
  Stage dispatch_;                         ///< at the last dispatch
  std::array<Cycle, kRing> dispatches_{};  ///< of the last instructions
  Stage completion_;
  std::array<Cycle, kRing> completions_{};
  std::uint64_t count_ = 0;             ///< instructions fetched
  std::uint64_t dispatched_count_ = 0;  ///< instructions in the completion queue so far
  struct UnitState {
    Cycle free = 0;                 ///< accepts the next instruction
    std::array<Cycle, 2> starts{};  ///< of the last two instructions: reservation stations
  };
  std::array<UnitState, 6> units_{};  ///< by Unit; kInteger: the second integer unit
  Cycle unresolved_ = 0;              ///< when the last predicted branch is resolved
  Cycle bus_free_ = 0;
  std::uint32_t pending_line_ = 0;
  Cycle pending_until_ = 0;
  std::array<Cycle, kRing> stored_{};                ///< when the last stores left their queue
  std::array<std::uint32_t, kRing> stored_words_{};  ///< their double words
  std::uint64_t store_count_ = 0;
};

}  // namespace boresight::cycles
