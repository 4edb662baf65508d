// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "sessions/session/session_difference.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

/// Place of a value among those that wait: the smallest is made first.
using WaitingRank = std::pair<int, int>;

/// How the value of a case is made. A value for which `make` throws stays as it was.
template <class Value>
struct CaseWork {
  using Make = std::function<Value(const sessions::Session&, const std::string& id, Value former)>;
  /// A value, and whether it is the whole value.
  using Glance = std::function<std::pair<Value, bool>(const sessions::Session&,
                                                      const std::string& id, Value former)>;

  /// Whether the case is listed; without it all are.
  std::function<bool(const sessions::Session&, const std::string& id)> listed;
  /// Of a new case, on the UI's thread: takes about a microsecond.
  std::function<Value(const sessions::Session&, const std::string& id)> first;
  /// Of a few changed cases, on the UI's thread: takes less than a millisecond.
  Glance glance;
  /// The whole value, on the worker's thread.
  Make make;
  /// Order in which values are made; without it that of the session.
  std::function<WaitingRank(const Value&)> rank;
};

/// A value for each case of a session, made again on a worker thread when data of the case, of its
/// rig or of the whole session has changed. Until then the former value is shown. An edit of one
/// case costs the same in a session of any size; one of all cases, some 100 ns a case.
template <class Value>
class CaseByCase {
 public:
  /// Places in the list of values that have changed or are no longer current; nullptr: other cases
  /// are listed.
  using Changed = std::function<void(const std::vector<std::size_t>* places)>;

  CaseByCase(CaseWork<Value> work, Changed changed)
      : work_(std::move(work)), changed_(std::move(changed)) {}

  /// Sets the session of the values.
  void follow(const sessions::Session& session) {
    const sessions::SessionDifference difference = sessions::differenceOf(session_, session);
    const auto ids = sessions::withCasesOfRigs(difference.cases, session_, session);
    session_ = session;
    const bool lists = difference.list || isListedOtherwise(ids);
    if (lists) listAgain();
    std::vector<std::size_t> places;
    if (difference.ofAllCases())
      for (std::size_t place = 0; place < entries_.size(); ++place) places.push_back(place);
    else
      for (const std::string& id : ids)
        if (const auto found = places_.find(id); found != places_.end())
          places.push_back(found->second);
    if (places.size() == entries_.size()) clearWaiting();  // all are put into it again
    for (const std::size_t place : places) makeStale(place, places.size() <= kAtOnce);
    order();
    if (lists || !places.empty()) changed_(lists ? nullptr : &places);
    goOn();
  }
  /// Drops all values.
  void clear() {
    clearWaiting();
    stale_ = 0;
    places_.clear();
    entries_.clear();
    session_ = {};
  }

  /// No value is made while inactive (not visible, or halted).
  void setActive(bool active) {
    active_ = active;
    goOn();
  }
  bool isBusy() const { return making_; }

  std::size_t size() const { return entries_.size(); }
  const Value& value(std::size_t place) const { return entries_[place]->value; }
  /// Whether the value is of the session as it is.
  bool isCurrent(std::size_t place) const { return entries_[place]->current; }
  std::size_t currentCount() const { return entries_.size() - stale_; }
  /// Of a listed case; else size().
  std::size_t placeOf(const std::string& id) const {
    const auto found = places_.find(id);
    return found == places_.end() ? entries_.size() : found->second;
  }

 private:
  struct Entry {
    std::string id;
    Value value;
    bool current = false;
    /// Another one after each change of what it depends on; never that of an earlier entry.
    std::uint64_t version = 0;
  };
  /// An entry that waits for its value, unless it has another version by now.
  struct Waiting {
    WaitingRank rank;
    std::size_t place = 0;
    std::uint64_t version = 0;

    auto operator<=>(const Waiting&) const = default;
  };
  /// A value that is being made.
  struct Order {
    std::string id;
    std::uint64_t version = 0;
    Value value;
  };

  static constexpr std::size_t kAtOnce = 16;  ///< changed cases that are looked at on this thread
  static constexpr std::size_t kOrders = 32;  ///< of one task
  static constexpr std::chrono::milliseconds kSlice{50};  ///< then a task ends with what it has

  bool isListed(const std::string& id) const { return !work_.listed || work_.listed(session_, id); }
  bool isListedOtherwise(const std::set<std::string>& ids) const {
    if (!work_.listed) return false;
    for (const std::string& id : ids)
      if (places_.contains(id) != (session_.findCase(id) != nullptr && isListed(id))) return true;
    return false;
  }

  /// In the order of the session; known cases keep their values.
  void listAgain() {
    std::vector<std::unique_ptr<Entry>> former = std::exchange(entries_, {});
    std::unordered_map<std::string, std::size_t> former_places = std::exchange(places_, {});
    clearWaiting();
    stale_ = 0;
    for (const auto& session_case : std::as_const(session_).cases) {  // else it loses its index
      const std::string& id = session_case->id;
      if (!isListed(id)) continue;
      const auto found = former_places.find(id);
      entries_.push_back(
          found == former_places.end()
              ? std::make_unique<Entry>(Entry{id, work_.first(session_, id), false, ++versions_})
              : std::move(former[found->second]));
      const std::size_t place = entries_.size() - 1;
      places_[id] = place;
      if (entries_[place]->current) continue;
      ++stale_;
      wait(place);
    }
    order();
  }

  void makeStale(std::size_t place, bool glances) {
    Entry& entry = *entries_[place];
    if (std::exchange(entry.current, false)) ++stale_;
    entry.version = ++versions_;
    if (glances)
      std::tie(entry.value, entry.current) =
          work_.glance(session_, entry.id, std::move(entry.value));
    if (entry.current)
      --stale_;
    else
      wait(place);
  }
  void clearWaiting() {
    waiting_.clear();
    in_work_.clear();
    ordered_ = 0;
  }
  /// Is ordered among those that wait by order().
  void wait(std::size_t place) {
    const Entry& entry = *entries_[place];
    waiting_.push_back(
        {work_.rank ? work_.rank(entry.value) : WaitingRank(), place, entry.version});
  }
  bool waits(const Waiting& waiting) const {
    return waiting.place < entries_.size() && !entries_[waiting.place]->current &&
           entries_[waiting.place]->version == waiting.version;
  }
  /// A heap, the smallest first. Entries that do not wait any more are skipped when it is their
  /// turn; here, where they are many.
  void order() {
    if (waiting_.size() > 2 * entries_.size() + kOrders) {
      std::erase_if(waiting_, [this](const Waiting& waiting) { return !waits(waiting); });
      ordered_ = 0;
    }
    if (waiting_.size() > 2 * ordered_)
      std::ranges::make_heap(waiting_, std::greater());
    else
      for (std::size_t end = ordered_ + 1; end <= waiting_.size(); ++end)
        std::ranges::push_heap(waiting_.begin(), waiting_.begin() + std::ptrdiff_t(end),
                               std::greater());
    ordered_ = waiting_.size();
  }
  std::optional<std::size_t> takeNext() {
    while (!waiting_.empty()) {
      std::ranges::pop_heap(waiting_, std::greater());
      const Waiting next = waiting_.back();
      waiting_.pop_back();
      ordered_ = waiting_.size();
      if (waits(next)) return next.place;
    }
    return std::nullopt;
  }

  void goOn() {
    if (!active_ || making_) return;
    std::vector<Order> orders;
    while (orders.size() < kOrders) {
      const std::optional<std::size_t> place = takeNext();
      if (!place) break;
      const Entry& entry = *entries_[*place];
      orders.push_back({entry.id, entry.version, entry.value});
    }
    if (orders.empty()) return;
    making_ = true;
    in_work_.clear();
    for (const Order& order : orders) in_work_.emplace_back(order.id, order.version);
    runner_.queue(
        [session = session_, orders, make = work_.make](const std::stop_token& stop) {
          const auto end = std::chrono::steady_clock::now() + kSlice;
          std::vector<Order> made;
          for (const Order& order : orders) {
            if (stop.stop_requested() || (!made.empty() && std::chrono::steady_clock::now() > end))
              break;
            made.push_back(order);
            try {
              made.back().value = make(session, order.id, order.value);
            } catch (const std::exception&) {  // it stays as it was
            }
          }
          return made;
        },
        [this](std::vector<Order> made) { take(std::move(made)); },
        [this, orders, task = ++tasks_](const QString&) {
          if (making_ && task == tasks_) take(orders);  // as they were: not tried again
        });
  }

  /// A value of a case that has changed meanwhile still waits.
  void take(std::vector<Order> made) {
    making_ = false;
    std::vector<std::size_t> places;
    for (Order& order : made) {
      const std::size_t place = placeOf(order.id);
      if (place == entries_.size() || entries_[place]->version != order.version) continue;
      Entry& entry = *entries_[place];
      entry.value = std::move(order.value);
      entry.current = true;
      --stale_;
      places.push_back(place);
    }
    for (const auto& [id, version] : std::exchange(in_work_, {})) {  // not made in its time
      const std::size_t place = placeOf(id);
      if (place == entries_.size() || entries_[place]->version != version) continue;
      if (!entries_[place]->current) wait(place);
    }
    order();
    goOn();
    if (!places.empty()) changed_(&places);
  }

  CaseWork<Value> work_;
  Changed changed_;
  sessions::Session session_;
  std::vector<std::unique_ptr<Entry>> entries_;
  std::unordered_map<std::string, std::size_t> places_;  ///< by id
  std::vector<Waiting> waiting_;                         ///< a heap up to ordered_
  std::size_t ordered_ = 0;
  std::size_t stale_ = 0;                                       ///< entries that are not current
  std::vector<std::pair<std::string, std::uint64_t>> in_work_;  ///< of the task under way
  bool active_ = false;
  bool making_ = false;
  std::uint64_t tasks_ = 0;
  std::uint64_t versions_ = 0;  ///< never restarts: a task of a removed entry may still end
  TaskRunner runner_;           ///< declared last: it ends before the members that its work uses
};

}  // namespace boresight::ui
