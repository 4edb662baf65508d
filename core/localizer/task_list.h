// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/nth.h"

namespace boresight {

/// Independent tasks of a stage, which may run at the same time in any order.
class TaskList {
 public:
  /// Allocates for at most `most` tasks.
  void create(std::size_t most, Arena& arena) { done_ = arena.allocate<std::uint8_t>(most); }
  /// Starts a list of `count` tasks, none of them done.
  void open(int count) {
    count_ = count;
    next_ = 0;
    std::fill_n(done_.begin(), count, std::uint8_t{0});
  }
  /// Number of tasks in the list.
  int count() const { return count_; }
  /// Whether a task is done; tasks count from 0.
  bool isDone(int task) const { return nth(done_, task) != 0; }
  /// Notes a task as done.
  void markDone(int task) { nth(done_, task) = 1; }
  /// Moves next() to the first task that is not done; false when there is none.
  bool findNext() {
    while (next_ < count_ && isDone(next_)) ++next_;
    return next_ < count_;
  }
  /// The first task that is not done, as of findNext().
  int next() const { return next_; }

 private:
  std::span<std::uint8_t> done_;
  int count_ = 0;
  int next_ = 0;
};

}  // namespace boresight
