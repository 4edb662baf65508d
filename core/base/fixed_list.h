// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace boresight {

/// A list of at most kCapacity items in place. Items beyond the capacity are dropped.
template <class Item, int kCapacity>
class FixedList {
 public:
  /// Removes all items.
  void clear() { count_ = 0; }
  /// Appends an item.
  void add(const Item& item) {
    if (count_ < kCapacity) items_[static_cast<std::size_t>(count_++)] = item;
  }
  /// Inserts an item before item `index`, 0 ... size(); the last item of a full list is dropped.
  /// The item must not be one of this list.
  void insert(int index, const Item& item) {
    if (index >= kCapacity) return;
    if (count_ < kCapacity) ++count_;
    for (int i = count_ - 1; i > index; --i) (*this)[i] = (*this)[i - 1];
    (*this)[index] = item;
  }
  /// Keeps the first `count` items, if there are more.
  void keepFirst(int count) { count_ = count < count_ ? count : count_; }
  /// Number of items.
  int size() const { return count_; }
  /// The items in the order of add().
  std::span<const Item> items() const {
    return std::span(items_).first(static_cast<std::size_t>(count_));
  }
  /// An item, index 0 ... size() - 1.
  Item& operator[](int index) { return items_[static_cast<std::size_t>(index)]; }
  /// The same, for reading.
  const Item& operator[](int index) const { return items_[static_cast<std::size_t>(index)]; }

 private:
  std::array<Item, static_cast<std::size_t>(kCapacity)> items_;
  int count_ = 0;
};

}  // namespace boresight
