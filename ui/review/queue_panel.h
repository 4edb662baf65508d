// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QSortFilterProxyModel>
#include <QWidget>

#include "ui_queue_panel.h"

#include "ui/models/rows_model.h"
#include "ui/review/queue_controller.h"

namespace boresight::ui {

class EmptyHint;

/// Differences between the last two runs of each case, as a table.
class DifferencesModel : public RowsModel<DifferenceEntry> {
  Q_OBJECT

 public:
  enum Column { kCase, kChange, kChecks, kInliers, kApart, kWhy };

  DifferencesModel();

  /// -1 when there is none.
  int rowOf(const QString& id) const;

 protected:
  QVariant look(const DifferenceEntry& entry, int column, int role) const override;
};

/// The queue's cases as a table.
class QueueModel : public RowsModel<QueueEntry> {
  Q_OBJECT

 public:
  enum Column { kCase, kStatus, kTrouble, kMargin, kFromSeed, kInliers };

  QueueModel();

  /// -1 when there is none.
  /// Marks a row whose checks are out of date. Its place stays: no signal is sent, and the view
  /// must be updated.
  void setUnchecked(int row);
  int rowOf(const QString& id) const;
  /// Review status of a case: a word after a sign whose shape is unique to the status.
  static QString reviewStatusText(const sessions::QueueRow& row);

 protected:
  QVariant look(const QueueEntry& entry, int column, int role) const override;
};

/// Cases in the queue's order when sorted by trouble, else in the order of the column; rows without
/// a number come last in either direction.
class QueueFilter : public RowsFilter {
  Q_OBJECT

 public:
  explicit QueueFilter(QueueModel& model);

 protected:
  bool lessThan(const QModelIndex& left, const QModelIndex& right) const override;

 private:
  QueueModel& model_;
};

/// A batch of cases, the worst first, and the differences between the last two runs of each. The
/// chosen row is the shown case: choosing another one shows it. Decisions are made in the review of
/// the shown case. Filled only while it is visible.
class QueuePanel : public QWidget {
  Q_OBJECT

 public:
  explicit QueuePanel(Document& document);

  QueueController& controller() { return controller_; }
  /// Sets whether the operator can see the panel: Qt also calls a panel behind another one's tab
  /// visible. Cases are checked only while it is in sight.
  void setInSight(bool in_sight);
  bool isInSight() const { return in_sight_; }
  /// Chooses the row of the case that the window shows.
  void setCurrent(const QString& id);
  /// Id of the chosen row of the shown list, or empty.
  QString chosenCase() const;
  /// The undecided case that is listed next after the shown one, from the top again at the end;
  /// empty when there is none.
  QString nextOpen() const;

 public Q_SLOTS:
  /// Requests the chosen case, at the iteration that failed or at the last one.
  void openChosen();
  void next();
  void previous();
  void showDifferences(bool shown);
  void focusList();

 Q_SIGNALS:
  /// `iteration` is an index into the run of this digest, -1 for the last.
  void openRequested(const QString& id, const QString& run_digest, int iteration);
  /// The shown case is to be validated, or rejected.
  void validationRequested();
  void rejectionRequested();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  void buildTables();
  QTableView* table() const;
  void switchList();
  void showChosen();
  void chooseShown();
  void step(int rows);
  void lookAt();
  void showEntries();
  void showRows();
  void showProgress();
  void fitColumns();

  QString current_;  ///< the case that the window shows
  QueueController controller_;
  QueueModel model_;
  QueueFilter filter_;
  DifferencesModel differences_;
  QSortFilterProxyModel differences_filter_;
  EmptyHint* queue_hint_ = nullptr;
  EmptyHint* differences_hint_ = nullptr;
  bool following_ = false;  ///< the list is being updated by the window, not the operator
  bool in_sight_ = false;
  bool fitted_ = false;
  Ui::QueuePanel ui_;
};

}  // namespace boresight::ui
