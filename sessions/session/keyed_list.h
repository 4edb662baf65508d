// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "sessions/session/block_map.h"

namespace boresight::sessions {

/// The elements of a list are in no groups.
struct NoGroup {
  template <class T>
  const std::string* operator()(const T& /*element*/) const {
    return nullptr;
  }
};

/// A list that finds the elements of a key, `KeyOf()(element)`, by an index: sessions hold tens of
/// thousands of cases and runs, which are looked up by case. So are the elements of a group,
/// `GroupOf()(element)` (nullptr: of none). Copies share what is the same in both, as those of
/// BlockMap. Otherwise like std::vector, but a change makes references invalid. After access to
/// elements that may be changed the list is searched, until it is copied.
template <class T, class KeyOf, class GroupOf = NoGroup>
class KeyedList {
  /// Elements by a number that grows along the list and stays with the element.
  using Values = BlockMap<std::uint64_t, T>;
  /// Hash of the key and number of each element.
  using Places = BlockMap<std::pair<std::size_t, std::uint64_t>, std::monostate>;

 public:
  using value_type = T;
  using const_iterator = typename Values::ConstValueIterator;
  using iterator = typename Values::ValueIterator;

  KeyedList() = default;
  KeyedList(std::vector<T> values) {  // NOLINT: a list
    for (T& value : values) push_back(std::move(value));
  }
  KeyedList(const KeyedList& other)
      : values_(other.values_),
        places_(other.places_),
        groups_(other.groups_),
        indexed_(other.indexed_) {
    index();
  }
  KeyedList(KeyedList&&) noexcept = default;
  KeyedList& operator=(const KeyedList& other) { return *this = KeyedList(other); }
  KeyedList& operator=(KeyedList&&) noexcept = default;
  ~KeyedList() = default;

  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  const T& operator[](std::size_t i) const { return values_.nth(i)->second; }
  const T& front() const { return (*this)[0]; }
  const T& back() const { return (*this)[size() - 1]; }
  const_iterator begin() const { return values_.beginValues(); }
  const_iterator end() const { return values_.endValues(); }
  auto rbegin() const { return std::make_reverse_iterator(end()); }
  auto rend() const { return std::make_reverse_iterator(begin()); }

  /// Elements that may be changed: the list no longer shares them.
  ///@{
  T& operator[](std::size_t i) { return changeable().changeable(i); }
  T& front() { return (*this)[0]; }
  T& back() { return (*this)[size() - 1]; }
  iterator begin() { return changeable().beginChangeable(); }
  iterator end() { return changeable().endChangeable(); }
  ///@}

  void push_back(T value) { putAt(empty() ? 0 : lastNumber() + 1, std::move(value)); }
  /// Replaces the last element of the value's key, or appends the value.
  void put(T value) {
    index();
    const auto found = lastPlace(KeyOf()(value));
    if (found == places_.end()) return push_back(std::move(value));
    replaceAt(found->first.second, std::move(value));
  }
  /// Replaces the element at an index.
  void replace(std::size_t i, T value) { replaceAt(values_.nth(i)->first, std::move(value)); }
  void erase(std::size_t i) {
    const std::uint64_t number = values_.nth(i)->first;
    forget(number);
    values_.erase(number);
  }
  /// Inserts before the element at an index, or at the end.
  void insert(std::size_t i, T value) {
    if (i == size()) return push_back(std::move(value));
    const std::uint64_t after = values_.nth(i)->first;
    const std::uint64_t least = i == 0 ? 0 : values_.nth(i - 1)->first + 1;
    if (least < after) return putAt(least, std::move(value));
    std::vector<T> values(std::as_const(*this).begin(), std::as_const(*this).end());
    values.insert(values.begin() + static_cast<std::ptrdiff_t>(i), std::move(value));
    *this = std::move(values);
  }
  void clear() { *this = KeyedList(); }
  template <class Predicate>
  void eraseIf(Predicate&& predicate) {
    std::vector<std::uint64_t> numbers;
    for (const auto& [number, value] : values_)
      if (predicate(value)) numbers.push_back(number);
    if (numbers.size() == size()) return clear();
    for (const std::uint64_t number : numbers) {
      forget(number);
      values_.erase(number);
    }
  }
  /// Only among the elements of a key, which need no search.
  template <class Predicate>
  void eraseIf(const std::string& key, Predicate&& predicate) {
    index();
    for (const std::uint64_t number : numbersOf(places_, key, KeyOf())) {
      if (!predicate(values_.at(number))) continue;
      forget(number);
      values_.erase(number);
    }
  }

  /// The last element of a key, or nullptr.
  const T* find(const std::string& key) const {
    if (!indexed_) {
      const auto found =
          std::find_if(rbegin(), rend(), [&key](const T& value) { return KeyOf()(value) == key; });
      return found == rend() ? nullptr : &*found;
    }
    const auto found = lastPlace(key);
    return found == places_.end() ? nullptr : &values_.at(found->first.second);
  }
  /// All elements of a key, in their order.
  std::vector<const T*> findAll(const std::string& key) const {
    return elementsOf(places_, key, KeyOf());
  }
  /// All elements of a group, in their order.
  std::vector<const T*> findGroup(const std::string& group) const {
    return elementsOf(groups_, group, GroupOf());
  }

  bool operator==(const KeyedList& other) const {
    return values_.equals(other.values_,
                          [](const auto& a, const auto& b) { return a.second == b.second; });
  }

  /// How a list differs from another: `replace(i, new)`, `erase(i)` with indices of `before`, and
  /// `insert(i, new)` with those of `after`, each in ascending order. Short for a list that was
  /// copied from the other; correct for any two.
  template <class Replace, class Erase, class Insert>
  static void forEachDifference(const KeyedList& before, const KeyedList& after,
                                const Replace& replace, const Erase& erase, const Insert& insert) {
    Values::forEachDifference(before.values_, after.values_, [&](const auto* from, const auto* to) {
      if (from != nullptr && to != nullptr)
        replace(from->rank(), (*to)->second);
      else if (from != nullptr)
        erase(from->rank());
      else
        insert(to->rank(), (*to)->second);
    });
  }

 private:
  static std::size_t hashOf(const std::string& key) { return std::hash<std::string>()(key); }
  std::uint64_t lastNumber() const { return values_.nth(size() - 1)->first; }

  Values& changeable() {
    indexed_ = false;
    places_.clear();
    groups_.clear();
    return values_;
  }
  void index() {
    if (indexed_) return;
    for (const auto& [number, value] : values_) note(number, value);
    indexed_ = true;
  }
  void putAt(std::uint64_t number, T value) {
    if (indexed_) note(number, value);
    values_.insert_or_assign(number, std::move(value));
  }
  void replaceAt(std::uint64_t number, T value) {
    forget(number);
    putAt(number, std::move(value));
  }
  /// Adds an element to the index.
  void note(std::uint64_t number, const T& value) {
    places_.insert_or_assign({hashOf(KeyOf()(value)), number}, {});
    if (const std::string* group = GroupOf()(value))
      groups_.insert_or_assign({hashOf(*group), number}, {});
  }
  /// Removes an element from the index.
  void forget(std::uint64_t number) {
    if (!indexed_) return;
    const T& value = values_.at(number);
    places_.erase({hashOf(KeyOf()(value)), number});
    if (const std::string* group = GroupOf()(value)) groups_.erase({hashOf(*group), number});
  }
  static bool equals(const std::string& name, const std::string& wanted) { return name == wanted; }
  static bool equals(const std::string* name, const std::string& wanted) {
    return name != nullptr && *name == wanted;
  }
  /// Of the last element of a key.
  auto lastPlace(const std::string& key) const {
    const std::size_t hash = hashOf(key);
    auto place = places_.lower_bound({hash, std::numeric_limits<std::uint64_t>::max()});
    while (place != places_.begin() && (--place)->first.first == hash)
      if (KeyOf()(values_.at(place->first.second)) == key) return place;
    return places_.end();
  }
  /// Of all elements with a key, or of a group.
  template <class NameOf>
  std::vector<std::uint64_t> numbersOf(const Places& places, const std::string& name,
                                       const NameOf& name_of) const {
    const std::size_t hash = hashOf(name);
    std::vector<std::uint64_t> numbers;
    for (auto place = places.lower_bound({hash, 0});
         place != places.end() && place->first.first == hash; ++place)
      if (equals(name_of(values_.at(place->first.second)), name))
        numbers.push_back(place->first.second);
    return numbers;
  }
  template <class NameOf>
  std::vector<const T*> elementsOf(const Places& places, const std::string& name,
                                   const NameOf& name_of) const {
    std::vector<const T*> found;
    if (indexed_)
      for (const std::uint64_t number : numbersOf(places, name, name_of))
        found.push_back(&values_.at(number));
    else
      for (const T& value : *this)
        if (equals(name_of(value), name)) found.push_back(&value);
    return found;
  }

  Values values_;
  Places places_;
  Places groups_;
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
