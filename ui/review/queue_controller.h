// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <QImage>
#include <QObject>
#include <QSize>
#include <QString>

#include "sessions/review/queue.h"
#include "sessions/review/review_status.h"
#include "sessions/review/run_difference.h"
#include "sessions/session/session.h"
#include "ui/run/case_by_case.h"

namespace boresight::ui {

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

/// The queue of the document's cases, and the differences between their last two runs: filled on a
/// worker thread while visible. After an edit only the rows of changed cases are made again.
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
  QueueEntry queueAt(std::size_t place) const;
  bool isChecked(std::size_t place) const { return rows_.isCurrent(place); }
  /// One per case that was run twice.
  std::vector<DifferenceEntry> differences() const;
  const DifferenceEntry& differenceAt(std::size_t place) const;

  /// Of the visible list.
  int doneCount() const;
  int count() const;
  bool isBusy() const;
  bool isHalted() const { return halted_; }
  /// The case that is being checked is finished first.
  void setHalted(bool halted);

 Q_SIGNALS:
  /// Other cases are listed, or it was halted.
  void changed();
  void queueRowsChanged(const std::vector<std::size_t>& places);
  void differenceRowsChanged(const std::vector<std::size_t>& places);

 private:
  /// A row with the key of its inputs; empty: not checked yet.
  struct Checked {
    sessions::QueueRow row;
    QImage thumbnail;
    std::string key;
  };
  struct Compared {
    DifferenceEntry entry;
    std::string key;
  };
  static CaseWork<Checked> checking(const QSize& thumbnail_px);
  static CaseWork<Compared> comparing();

  void follow();
  void fillVisible();

  Document& document_;
  List looked_at_ = List::kNone;
  bool halted_ = false;
  CaseByCase<Checked> rows_;
  CaseByCase<Compared> differences_;
};

}  // namespace boresight::ui
