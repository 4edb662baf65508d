// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace boresight::sessions {

/// Says which blocks of a map no other map refers to: those with its number, until it is copied.
class BlockOwner {
 public:
  BlockOwner() = default;
  BlockOwner(const BlockOwner& other) { other.number_ = 0; }
  BlockOwner(BlockOwner&& other) noexcept : number_(other.number_.exchange(0)) {}
  BlockOwner& operator=(const BlockOwner& other) {
    other.number_ = number_ = 0;
    return *this;
  }
  BlockOwner& operator=(BlockOwner&& other) noexcept {
    number_ = other.number_.exchange(0);
    return *this;
  }
  ~BlockOwner() = default;

  std::uint64_t number() {
    static std::atomic<std::uint64_t> last{0};
    if (number_ == 0) number_ = ++last;
    return number_;
  }

 private:
  /// 0: none. Atomic, since threads may copy one map at the same time.
  mutable std::atomic<std::uint64_t> number_{0};
};

/// A map in the order of its keys, in blocks that copies share: a copy costs a pointer, a change of
/// a copy one block, a comparison of two copies their different blocks. Otherwise like std::map,
/// with random access; a change makes iterators and references invalid.
template <class Key, class Value>
class BlockMap {
 public:
  using key_type = Key;
  using mapped_type = Value;
  using value_type = std::pair<Key, Value>;

 private:
  struct Block {
    std::vector<value_type> entries;  ///< never empty
    std::uint64_t owner = 0;
  };
  struct Node {
    std::shared_ptr<Block> block;  ///< nullptr of the last node, which is the end
    std::size_t start = 0;         ///< rank of its first entry
  };
  struct Root {
    std::vector<Node> nodes = {Node()};
    std::uint64_t owner = 0;
  };

 public:
  /// Over entries, or over values alone.
  template <class Element>
  class Iterator {
   public:
    using iterator_category = std::random_access_iterator_tag;
    using value_type = std::remove_const_t<Element>;
    using difference_type = std::ptrdiff_t;
    using pointer = Element*;
    using reference = Element&;

    Iterator() = default;
    Iterator(const Node* node, std::size_t offset) : node_(node), offset_(offset) {}

    reference operator*() const {
      if constexpr (std::is_same_v<value_type, BlockMap::value_type>)
        return entry();
      else
        return entry().second;
    }
    pointer operator->() const { return &**this; }
    reference operator[](difference_type n) const { return *(*this + n); }
    /// Index of the entry in the map.
    std::size_t rank() const { return node_ == nullptr ? 0 : node_->start + offset_; }

    Iterator& operator++() {
      if (++offset_ == node_->block->entries.size()) *this = {node_ + 1, 0};
      return *this;
    }
    Iterator& operator--() {
      if (offset_ == 0) *this = {node_ - 1, (node_ - 1)->block->entries.size()};
      --offset_;
      return *this;
    }
    Iterator& operator+=(difference_type n) {
      if (n == 0) return *this;
      const std::size_t rank = this->rank() + static_cast<std::size_t>(n);
      while (rank < node_->start) --node_;
      while (node_->block != nullptr && rank >= (node_ + 1)->start) ++node_;
      offset_ = rank - node_->start;
      return *this;
    }
    Iterator operator++(int) {
      const Iterator before = *this;
      ++*this;
      return before;
    }
    Iterator operator--(int) {
      const Iterator before = *this;
      --*this;
      return before;
    }
    Iterator& operator-=(difference_type n) { return *this += -n; }
    friend Iterator operator+(Iterator it, difference_type n) { return it += n; }
    friend Iterator operator+(difference_type n, Iterator it) { return it += n; }
    friend Iterator operator-(Iterator it, difference_type n) { return it -= n; }
    friend difference_type operator-(const Iterator& a, const Iterator& b) {
      return static_cast<difference_type>(a.rank()) - static_cast<difference_type>(b.rank());
    }
    bool operator==(const Iterator& other) const = default;
    auto operator<=>(const Iterator& other) const { return rank() <=> other.rank(); }

   private:
    friend class BlockMap;
    auto& entry() const { return node_->block->entries[offset_]; }

    const Node* node_ = nullptr;
    std::size_t offset_ = 0;
  };
  using const_iterator = Iterator<const value_type>;
  using iterator = const_iterator;
  using ConstValueIterator = Iterator<const Value>;
  using ValueIterator = Iterator<Value>;

  std::size_t size() const { return root_ ? root_->nodes.back().start : 0; }
  bool empty() const { return size() == 0; }
  const_iterator begin() const { return first<const value_type>(); }
  const_iterator end() const { return last<const value_type>(); }
  ConstValueIterator beginValues() const { return first<const Value>(); }
  ConstValueIterator endValues() const { return last<const Value>(); }

  /// The first entry whose key is not less.
  const_iterator lower_bound(const Key& key) const {
    if (empty()) return end();
    const auto [node, offset] = placeOf(key);
    const bool past = offset == node->block->entries.size();
    return past ? const_iterator(node + 1, 0) : const_iterator(node, offset);
  }
  const_iterator find(const Key& key) const {
    const const_iterator found = lower_bound(key);
    return found == end() || key < found->first ? end() : found;
  }
  bool contains(const Key& key) const { return find(key) != end(); }
  std::size_t count(const Key& key) const { return contains(key) ? 1 : 0; }
  const Value& at(const Key& key) const {
    const const_iterator found = find(key);
    if (found == end()) throw std::out_of_range("no entry has this key");
    return found->second;
  }
  /// The entry of a rank below size().
  const_iterator nth(std::size_t rank) const {
    const std::vector<Node>& nodes = root_->nodes;
    const auto after = std::partition_point(
        nodes.begin(), nodes.end(), [rank](const Node& node) { return node.start <= rank; });
    return {&*(after - 1), rank - (after - 1)->start};
  }

  void clear() { *this = BlockMap(); }
  void insert_or_assign(Key key, Value value) {
    Root& root = ownRoot();
    std::size_t at = 0, offset = 0;
    if (!empty()) {
      const auto place = placeOf(key);
      at = static_cast<std::size_t>(place.first - root.nodes.data());
      offset = place.second;
      const std::vector<value_type>& entries = root.nodes[at].block->entries;
      if (offset < entries.size() && !(key < entries[offset].first)) {
        ownBlock(root.nodes[at]).entries[offset].second = std::move(value);
        return;
      }
      if (entries.size() == kMostEntries) makeRoom(root, at, offset);
    }
    if (empty() || offset == kMostEntries) {
      at += empty() ? 0 : 1;
      offset = 0;
      insertBlock(root, at, {});
    }
    Block& block = ownBlock(root.nodes[at]);
    block.entries.insert(block.entries.begin() + static_cast<std::ptrdiff_t>(offset),
                         {std::move(key), std::move(value)});
    for (std::size_t i = at + 1; i < root.nodes.size(); ++i) ++root.nodes[i].start;
  }
  std::size_t erase(const Key& key) {
    const const_iterator found = find(key);
    if (found == end()) return 0;
    const auto at = static_cast<std::size_t>(found.node_ - root_->nodes.data());
    Root& root = ownRoot();
    Block& block = ownBlock(root.nodes[at]);
    block.entries.erase(block.entries.begin() + static_cast<std::ptrdiff_t>(found.offset_));
    for (std::size_t i = at + 1; i < root.nodes.size(); ++i) --root.nodes[i].start;
    if (block.entries.empty())
      root.nodes.erase(root.nodes.begin() + static_cast<std::ptrdiff_t>(at));
    return 1;
  }
  /// `predicate` of an entry.
  template <class Predicate>
  void eraseIf(Predicate&& predicate) {
    std::vector<Key> keys;
    for (const value_type& entry : *this)
      if (predicate(entry)) keys.push_back(entry.first);
    if (keys.size() == size()) return clear();
    for (const Key& key : keys) erase(key);
  }

  /// Values that may be changed: of a rank below size(), of all.
  ///@{
  Value& changeable(std::size_t rank) {
    Root& root = ownRoot();
    const const_iterator found = nth(rank);
    return ownBlock(root.nodes[static_cast<std::size_t>(found.node_ - root.nodes.data())])
        .entries[found.offset_]
        .second;
  }
  ValueIterator beginChangeable() {
    ownAll();
    return first<Value>();
  }
  ValueIterator endChangeable() {
    ownAll();
    return last<Value>();
  }
  ///@}

  /// Whether both have as many entries and `same(entry, entry)` holds for those of the same rank.
  template <class Same>
  bool equals(const BlockMap& other, const Same& same) const {
    if (root_ == other.root_) return true;
    if (size() != other.size()) return false;
    const_iterator a = begin(), b = other.begin();
    while (a != end()) {
      if (skipShared(a, b)) continue;
      if (!same(*a, *b)) return false;
      ++a;
      ++b;
    }
    return true;
  }
  bool operator==(const BlockMap& other) const {
    return equals(other, [](const value_type& a, const value_type& b) { return a == b; });
  }

  /// Calls `visit(place in before, place in after)` for each key whose values differ, in the order
  /// of the keys; a place is nullptr in the map that does not have the key.
  template <class Visit>
  static void forEachDifference(const BlockMap& before, const BlockMap& after, Visit&& visit) {
    if (before.root_ == after.root_) return;
    const const_iterator no_a = before.end(), no_b = after.end();
    const_iterator a = before.begin(), b = after.begin();
    while (a != no_a || b != no_b) {
      if (a != no_a && b != no_b && skipShared(a, b)) continue;
      const bool take_a = b == no_b || (a != no_a && !(b->first < a->first));
      const bool take_b = a == no_a || (b != no_b && !(a->first < b->first));
      const bool differ = !(take_a && take_b) || !(a->second == b->second);
      if (differ) visit(take_a ? &a : nullptr, take_b ? &b : nullptr);
      if (take_a) ++a;
      if (take_b) ++b;
    }
  }

 private:
  static constexpr std::size_t kMostEntries = 128;

  template <class Element>
  Iterator<Element> first() const {
    return {root_ ? root_->nodes.data() : nullptr, 0};
  }
  template <class Element>
  Iterator<Element> last() const {
    return {root_ ? &root_->nodes.back() : nullptr, 0};
  }
  /// The block and the offset in it, maybe at its end, where a key is or is to be. Not of an empty
  /// map.
  std::pair<const Node*, std::size_t> placeOf(const Key& key) const {
    const std::vector<Node>& nodes = root_->nodes;
    auto node = std::partition_point(nodes.begin(), nodes.end() - 1, [&key](const Node& candidate) {
      return !(key < candidate.block->entries.front().first);
    });
    if (node != nodes.begin()) --node;
    const std::vector<value_type>& entries = node->block->entries;
    const auto found =
        std::partition_point(entries.begin(), entries.end(),
                             [&key](const value_type& entry) { return entry.first < key; });
    return {&*node, static_cast<std::size_t>(found - entries.begin())};
  }
  /// Moves both behind a block that both maps share and where both begin.
  static bool skipShared(const_iterator& a, const_iterator& b) {
    if (a.offset_ != 0 || b.offset_ != 0 || a.node_->block != b.node_->block) return false;
    ++a.node_;
    ++b.node_;
    return true;
  }

  Root& ownRoot() {
    const std::uint64_t owner = owner_.number();
    if (!root_ || root_->owner != owner) {
      root_ = root_ ? std::make_shared<Root>(*root_) : std::make_shared<Root>();
      root_->owner = owner;
    }
    return *root_;
  }
  Block& ownBlock(Node& node) {
    const std::uint64_t owner = owner_.number();
    if (node.block->owner != owner) {
      node.block = std::make_shared<Block>(*node.block);
      node.block->owner = owner;
    }
    return *node.block;
  }
  void ownAll() {
    if (empty()) return;
    for (Node& node : ownRoot().nodes)
      if (node.block) ownBlock(node);
  }
  /// Splits a full block, unless the new entry is behind it: lists that grow have full blocks.
  void makeRoom(Root& root, std::size_t& at, std::size_t& offset) {
    if (offset == kMostEntries) return;
    constexpr std::ptrdiff_t kHalf = kMostEntries / 2;
    std::vector<value_type>& entries = ownBlock(root.nodes[at]).entries;
    insertBlock(root, at + 1,
                std::vector<value_type>(std::make_move_iterator(entries.begin() + kHalf),
                                        std::make_move_iterator(entries.end())));
    entries.erase(entries.begin() + kHalf, entries.end());
    root.nodes[at + 1].start = root.nodes[at].start + kHalf;
    if (offset <= static_cast<std::size_t>(kHalf)) return;
    ++at;
    offset -= static_cast<std::size_t>(kHalf);
  }
  /// A block of its own; later entries keep their ranks.
  void insertBlock(Root& root, std::size_t at, std::vector<value_type> entries) {
    const std::size_t start = root.nodes[at].start;
    root.nodes.insert(
        root.nodes.begin() + static_cast<std::ptrdiff_t>(at),
        Node{std::make_shared<Block>(Block{std::move(entries), owner_.number()}), start});
  }

  std::shared_ptr<Root> root_;
  BlockOwner owner_;
};

}  // namespace boresight::sessions
