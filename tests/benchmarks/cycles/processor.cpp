// SPDX-License-Identifier: Apache-2.0
#include "processor.h"

#include <algorithm>

namespace boresight::cycles {
namespace {

constexpr int kFetchWidth = 4;
constexpr std::uint32_t kNoLine = ~0U;

Cycle cycles(int count) { return static_cast<Cycle>(count); }

}  // namespace

void Processor::missFetch(const Found& found) {
  fetch_.moveTo(std::max(fetch_.cycle, read(fetch_.cycle, {0, kNoLine, found})));
}

/// The cycle in which the next instruction enters the instruction queue.
Cycle Processor::fetchOne() {
  const Cycle room = dispatches_[(count_ - kQueue) % kRing];
  if (room > fetch_.cycle) fetch_.moveTo(room);
  const Cycle fetched = fetch_.cycle;
  if (++fetch_.taken == kFetchWidth) fetch_.moveTo(fetched + 1);
  return fetched;
}

Cycle Processor::dispatch(Cycle earliest) {
  const Cycle room = completions_[(dispatched_count_ - kQueue) % kRing];
  return dispatch_.take(std::max(earliest, room), assumptions_.width);
}

void Processor::complete(Cycle finished) {
  completions_[dispatched_count_++ % kRing] = completion_.take(finished, assumptions_.width);
}

Cycle Processor::read(Cycle time, const DataAccess& access) {
  const Found& found = access.found;
  if (assumptions_.level2 && found.level2) return time + cycles(assumptions_.level2_cycles);
  const Cycle begin = std::max(time, bus_free_);
  bus_free_ = begin + cycles(assumptions_.line_cycles);
  if (access.line != kNoLine) {
    pending_line_ = access.line;
    pending_until_ = bus_free_;
  }
  const bool writes = assumptions_.level2 ? found.writes_back_level2 : found.writes_back;
  if (writes) bus_free_ += cycles(assumptions_.write_cycles);
  return begin + cycles(assumptions_.first_word_cycles);
}

Cycle Processor::readyTime(const Instruction& instruction) const {
  Cycle time = 0;
  for (const std::uint8_t source : instruction.sources) time = std::max(time, ready_[source]);
  return time;
}

/// Simple integer instructions run in the unit that is free first.
Unit Processor::chooseUnit(const Instruction& instruction) const {
  if (instruction.unit != Unit::kInteger) return instruction.unit;
  const auto freeOf = [this](Unit unit) { return units_[static_cast<std::size_t>(unit)].free; };
  return freeOf(Unit::kFirstInteger) < freeOf(Unit::kInteger) ? Unit::kFirstInteger
                                                              : Unit::kInteger;
}

/// A load of what a queued store writes starts after that store.
Cycle Processor::waitForStore(Cycle start, const DataAccess& access) const {
  for (std::size_t i = 1; i <= kStores; ++i) {
    const std::size_t place = (store_count_ - i) % kRing;
    if (stored_words_[place] == access.double_word) return std::max(start, stored_[place]);
  }
  return start;
}

/// When a load has its data.
Cycle Processor::load(Cycle start, Cycle finish, std::span<const DataAccess> accesses) {
  for (const DataAccess& access : accesses) {
    finish += waitForStore(start, access) - start;
    if (!access.found.level1) {
      finish = std::max(finish, read(start + 1, access) + 1);
    } else if (access.line == pending_line_ && finish < pending_until_) {
      finish = pending_until_;
    }
  }
  return finish;
}

/// A store leaves its queue in order, and reads a missing line first.
void Processor::completeStore(const DataAccess& access) {
  const Cycle last = stored_[(store_count_ - 1) % kRing];
  stored_words_[store_count_ % kRing] = access.double_word;
  Cycle& stored = stored_[store_count_++ % kRing];
  const Cycle begin = std::max(completion_.cycle, last) + 1;
  if (!access.found.level1) {
    read(begin, access);
    stored = assumptions_.level2 && access.found.level2 ? begin + cycles(assumptions_.level2_cycles)
                                                        : pending_until_;
  } else {
    stored = access.line == pending_line_ ? std::max(begin, pending_until_) : begin;
  }
}

/// Delays the dispatch of the instructions behind this one.
void Processor::holdDispatch(const Instruction& instruction, Cycle start, Cycle finish) {
  const bool multiple = instruction.memory && instruction.occupancy > 1;
  const bool missed = instruction.memory && finish > start + cycles(instruction.latency);
  Cycle held = 0;
  if (multiple || (missed && !assumptions_.overlaps)) held = finish;
  if (!assumptions_.overlaps) held = std::max(held, start - 1);
  if (held > dispatch_.cycle) dispatch_.moveTo(held);
}

void Processor::execute(const Instruction& instruction, std::span<const DataAccess> accesses) {
  const Cycle fetched = fetchOne();
  UnitState& unit = units_[static_cast<std::size_t>(chooseUnit(instruction))];
  // The load-store unit has two reservation stations, each other unit one.
  const Cycle station = unit.starts[instruction.unit == Unit::kLoadStore ? 0 : 1];
  const Cycle dispatched = dispatch(std::max(fetched + 1, station));
  dispatches_[count_++ % kRing] = dispatched;
  Cycle start = std::max({dispatched + 1, readyTime(instruction), unit.free});
  const bool serialized =
      instruction.serialized || (instruction.uses_carry && assumptions_.carry_serializes);
  if (serialized) start = std::max(start, completion_.cycle + 1);
  int latency = instruction.latency;
  int occupancy = instruction.occupancy;
  if (instruction.kind == Kind::kMultiply)
    latency = occupancy = std::min(latency, assumptions_.multiply_cycles);
  Cycle finish = start + cycles(latency);
  if (instruction.memory && !instruction.store) finish = load(start, finish, accesses);
  unit.starts = {unit.starts[1], start};
  unit.free = start + cycles(occupancy);
  holdDispatch(instruction, start, finish);
  for (const std::uint8_t target : instruction.targets) ready_[target] = finish;
  // The updated address register does not wait for the data.
  if (instruction.memory && instruction.targets[1] != kNone)
    ready_[instruction.targets[1]] = start + 1;
  ready_[kNone] = 0;
  Cycle finished = std::max(finish, unresolved_);
  if (instruction.store) finished = std::max(finished, stored_[(store_count_ - kStores) % kRing]);
  complete(finished);
  if (!instruction.store) return;
  for (const DataAccess& access : accesses) completeStore(access);
}

void Processor::branch(const Instruction& instruction, bool taken, bool predicted,
                       bool target_cached) {
  const Cycle fetched = fetchOne();
  // A branch that writes the link or count register takes a place of the queues, no other does.
  Cycle entered = fetched + 1;
  if (instruction.links || instruction.counts) {
    entered = dispatch(fetched + 1);
    complete(std::max(entered + 1, unresolved_));
    if (instruction.links) ready_[kLink] = entered + 1;
  }
  dispatches_[count_++ % kRing] = entered;
  Cycle time = fetched + 1;
  // The registers must be there; a condition may be predicted.
  time = std::max({time, ready_[instruction.sources[1]], ready_[instruction.sources[2]]});
  const Cycle resolved = instruction.conditional ? ready_[instruction.sources[0]] : 0;
  if (resolved > time) {
    time = std::max(time, unresolved_);  // one predicted branch at a time
    unresolved_ = std::max(unresolved_, resolved);
    if (!predicted && resolved > time) return fetch_.moveTo(resolved + 1);
  }
  if (taken)
    fetch_.moveTo(time + (target_cached && !instruction.indirect ? 0 : 1));
  else if (time > fetched + 1 && time > fetch_.cycle)
    fetch_.moveTo(time);
}

}  // namespace boresight::cycles
