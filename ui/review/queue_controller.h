// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <QImage>
#include <QObject>
#include <QSize>
#include <QString>

#include "sessions/review/queue.h"
#include "sessions/review/review_status.h"
#include "sessions/review/run_difference.h"
#include "sessions/session/session.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

/// A value for each case of a session, computed on a worker thread one case at a time, again when
/// its key (of all inputs) changes. Until then the previous value is shown.
template <class Value>
class CaseByCase {
 public:
  struct Entry {
    std::string id;
    std::string key;
    std::optional<Value> value;
    bool current = false;  ///< the value is of this key
  };
  /// Called on the worker's thread. A case for which it throws has no value, and is not tried again
  /// before its key changes.
  using Make = std::function<Value(const sessions::Session& session, const std::string& id)>;
  using Keys = std::vector<std::pair<std::string, std::string>>;  ///< id and key, in order
  using Before = std::function<bool(const Entry&, const Entry&)>;

  /// `changed` is called on the UI's thread whenever an entry has changed.
  CaseByCase(Make make, std::function<void()> changed)
      : make_(std::move(make)), changed_(std::move(changed)) {}

  /// Sets the cases and keys of the values.
  void follow(const sessions::Session& session, const Keys& keys) {
    session_ = session;
    std::map<std::string, Entry> former;
    for (Entry& entry : entries_) former.emplace(entry.id, std::move(entry));
    entries_.clear();
    for (const auto& [id, key] : keys) {
      Entry& entry = entries_.emplace_back();
      if (const auto found = former.find(id); found != former.end())
        entry = std::move(found->second);
      entry.current = entry.current && entry.key == key;
      entry.id = id;
      entry.key = key;
    }
    goOn();
    changed_();
  }

  /// No value is computed while inactive (not visible, or halted).
  void setActive(bool active) {
    active_ = active;
    goOn();
  }
  bool isBusy() const { return making_; }
  /// Order in which waiting values are computed; without it the order is that of the keys.
  void setOrder(Before before) { before_ = std::move(before); }

  const std::vector<Entry>& entries() const { return entries_; }
  int currentCount() const {
    return static_cast<int>(std::ranges::count(entries_, true, &Entry::current));
  }

 private:
  Entry* next() {
    Entry* found = nullptr;
    for (Entry& entry : entries_)
      if (!entry.current && (!found || (before_ && before_(entry, *found)))) found = &entry;
    return found;
  }

  void goOn() {
    Entry* entry = active_ && !making_ ? next() : nullptr;
    if (!entry) return;
    making_ = true;
    runner_.queue(
        [session = session_, id = entry->id, make = make_](const std::stop_token&) {
          return make(session, id);
        },
        [this, id = entry->id, key = entry->key](Value value) { take(id, key, std::move(value)); },
        [this, id = entry->id, key = entry->key](const QString&) { take(id, key, {}); });
  }

  /// Drops a value whose key has changed.
  void take(const std::string& id, const std::string& key, std::optional<Value> value) {
    making_ = false;
    const auto entry = std::ranges::find(entries_, id, &Entry::id);
    if (entry != entries_.end() && entry->key == key) {
      entry->value = std::move(value);
      entry->current = true;
    }
    goOn();
    changed_();
  }

  Make make_;
  std::function<void()> changed_;
  Before before_;
  sessions::Session session_;
  std::vector<Entry> entries_;
  bool active_ = false;
  bool making_ = false;
  TaskRunner runner_;  ///< declared last: it ends before the members that its work uses
};

class Document;

/// A case of the queue as shown.
struct QueueEntry {
  sessions::QueueRow row;  ///< before its check, only data of the session
  QImage thumbnail;
  bool checked = false;  ///< whether the row is of the document's current state
};

/// A case's last run against the one before.
struct DifferenceEntry {
  std::string case_id;
  std::optional<sessions::RunDifference> difference = {};
  QString problem = {};  ///< why there is none
};

/// The queue of the document's cases, and the differences between their last two runs: both filled
/// on a worker thread while visible.
class QueueController : public QObject {
  Q_OBJECT

 public:
  enum class List { kNone, kTrouble, kDifferences };

  /// `thumbnail_px`: largest size of the pictures, in device pixels.
  QueueController(Document& document, const QSize& thumbnail_px);

  /// Sets the list that is visible; the other one is not filled.
  void setLookedAt(List list);

  /// One per case, in the order of the session.
  std::vector<QueueEntry> queue() const;
  /// One per case that was run twice.
  std::vector<DifferenceEntry> differences() const;

  /// Of the visible list.
  int doneCount() const;
  int count() const;
  bool isBusy() const;
  bool isHalted() const { return halted_; }
  /// The case that is being checked is finished first.
  void setHalted(bool halted);

 Q_SIGNALS:
  void changed();

 private:
  using Rows = CaseByCase<QueueEntry>;
  using Differences = CaseByCase<DifferenceEntry>;

  void follow();
  void fillVisible();
  sessions::QueueRow rowOf(const Rows::Entry& entry) const;

  Document& document_;
  List looked_at_ = List::kNone;
  bool halted_ = false;
  Rows rows_;
  Differences differences_;
};

}  // namespace boresight::ui
