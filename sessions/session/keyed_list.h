// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace boresight::sessions {

/// A list that finds the last element of a key, `KeyOf()(element)`, by an index: sessions hold tens
/// of thousands of cases and runs, which are looked up by case. Otherwise like std::vector. After
/// mutable access to elements find() searches the list, until the list is copied.
template <class T, class KeyOf>
class KeyedList {
 public:
  using value_type = T;

  KeyedList() = default;
  KeyedList(std::vector<T> values) : values_(std::move(values)) { index(); }  // NOLINT: a list
  KeyedList(const KeyedList& other)
      : values_(other.values_), places_(other.places_), indexed_(other.indexed_) {
    if (!indexed_) index();
  }
  KeyedList(KeyedList&&) noexcept = default;
  KeyedList& operator=(const KeyedList& other) { return *this = KeyedList(other); }
  KeyedList& operator=(KeyedList&&) noexcept = default;
  ~KeyedList() = default;

  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  const T& operator[](std::size_t i) const { return values_[i]; }
  const T& front() const { return values_.front(); }
  const T& back() const { return values_.back(); }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }
  auto rbegin() const { return values_.rbegin(); }
  auto rend() const { return values_.rend(); }

  /// Elements that may be changed.
  ///@{
  T& operator[](std::size_t i) { return changeable()[i]; }
  T& front() { return changeable().front(); }
  T& back() { return changeable().back(); }
  auto begin() { return changeable().begin(); }
  auto end() { return changeable().end(); }
  ///@}

  void push_back(T value) {
    values_.push_back(std::move(value));
    if (indexed_) enter(values_.size() - 1);
  }
  void clear() { *this = KeyedList(); }
  template <class Predicate>
  void eraseIf(Predicate&& predicate) {
    std::erase_if(values_, predicate);
    index();
  }

  /// The last element of a key, or nullptr.
  const T* find(const std::string& key) const {
    if (indexed_) {
      const auto place = places_.find(key);
      return place == places_.end() ? nullptr : &values_[place->second];
    }
    const auto found = std::find_if(values_.rbegin(), values_.rend(),
                                    [&key](const T& value) { return KeyOf()(value) == key; });
    return found == values_.rend() ? nullptr : &*found;
  }

  bool operator==(const KeyedList& other) const { return values_ == other.values_; }

 private:
  std::vector<T>& changeable() {
    indexed_ = false;
    return values_;
  }
  void enter(std::size_t i) { places_.insert_or_assign(KeyOf()(values_[i]), i); }
  void index() {
    places_.clear();
    for (std::size_t i = 0; i < values_.size(); ++i) enter(i);
    indexed_ = true;
  }

  std::vector<T> values_;
  std::unordered_map<std::string, std::size_t> places_;  ///< of the last element of each key
  bool indexed_ = true;
};

/// An immutable value that copies share: copying a session with a thousand cases copies pointers.
/// Compares by value; the same pointer is the same value.
template <class T>
class SharedValue {
 public:
  SharedValue() : SharedValue(T()) {}
  SharedValue(T value) : value_(std::make_shared<const T>(std::move(value))) {}  // NOLINT: a value

  const T& operator*() const { return *value_; }
  const T* operator->() const { return value_.get(); }
  /// Whether both share one value.
  bool sharesWith(const SharedValue& other) const { return value_ == other.value_; }

  bool operator==(const SharedValue& other) const {
    return sharesWith(other) || *value_ == *other.value_;
  }

 private:
  std::shared_ptr<const T> value_;
};

}  // namespace boresight::sessions
