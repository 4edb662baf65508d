// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <QImage>
#include <QObject>
#include <QSize>
#include <QString>

#include "sessions/review/decide.h"
#include "sessions/review/queue.h"
#include "sessions/review/run_difference.h"
#include "ui/review/case_by_case.h"

namespace boresight::ui {

class Document;

/// A case of the queue as it is shown.
struct QueueEntry {
  sessions::QueueRow row;  ///< before it was checked, what the session alone tells
  QImage thumbnail;
  bool checked = false;  ///< of what the document holds now
};

/// A case's last run against the one before.
struct DifferenceEntry {
  std::string case_id;
  std::optional<sessions::RunDifference> difference;
  QString problem;  ///< why there is none
  bool current = false;
};

/// The queue of the document's cases, and what changed between their two last runs: both filled
/// off the UI's thread while somebody looks. Decides on cases of it; every decision is one edit.
class QueueController : public QObject {
  Q_OBJECT

 public:
  enum class Act { kAccept, kReject };
  enum class List { kNone, kTrouble, kDifferences };

  /// The pictures have at most this size, in device pixels.
  QueueController(Document& document, const QSize& thumbnail_px, QObject* parent = nullptr);
  ~QueueController() override;

  /// Which of the two somebody looks at; the other one is not filled.
  void setLookedAt(List list);

  /// One per case, in the order of the session.
  std::vector<QueueEntry> queue() const;
  /// One per case that was run twice.
  std::vector<DifferenceEntry> differences() const;

  /// Of the list that is looked at.
  int doneCount() const;
  int count() const;
  bool isBusy() const;
  bool isHalted() const { return halted_; }
  /// A case that is being checked is finished first.
  void setHalted(bool halted);

  /// Why this cannot be done to a case now whoever signs, or empty.
  QString obstacle(Act act, const QString& id) const;
  /// Why it was not done, or empty: then it is one edit of the document.
  QString decide(Act act, const QString& id, const sessions::Signature& who);

 Q_SIGNALS:
  void changed();

 private:
  struct Made {
    sessions::QueueRow row;
    QImage thumbnail;
  };
  struct Compared {
    std::optional<sessions::RunDifference> difference;
    QString problem;
  };
  using Rows = CaseByCase<Made>;
  using Differences = CaseByCase<Compared>;

  static Made make(const sessions::Session& session, const std::string& id, const QSize& size_px);
  static Compared compare(const sessions::Session& session, const std::string& id);
  void follow();
  sessions::QueueRow rowOf(const Rows::Entry& entry) const;
  sessions::Session after(Act act, const sessions::QueueRow& row,
                          const sessions::Signature& who) const;

  Document& document_;
  List looked_at_ = List::kNone;
  bool halted_ = false;
  Rows rows_;
  Differences differences_;
};

}  // namespace boresight::ui
