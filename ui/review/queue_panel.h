// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <memory>

#include <QSortFilterProxyModel>
#include <QWidget>

#include "ui/review/queue_controller.h"
#include "ui/review/queue_model.h"

class QTableView;

namespace boresight::ui {

namespace Ui {
class QueuePanel;
}

class EmptyHint;

/// A batch of cases, the most troubled first, each to be opened, accepted or rejected by one key;
/// and what changed between the two last runs of each. Filled only while it is in sight.
class QueuePanel : public QWidget {
  Q_OBJECT

 public:
  explicit QueuePanel(Document& document, QWidget* parent = nullptr);
  ~QueuePanel() override;

  QueueController& controller() { return controller_; }
  /// Whether somebody can see it: behind another panel's tab nobody does, though Qt calls it
  /// visible. Nothing is checked out of sight.
  void setInSight(bool in_sight);
  /// Of the chosen row of the list that is shown, or empty.
  QString chosenCase() const;
  /// What was said last: why something cannot be done, what is asked for, what was done.
  QString message() const;

 public Q_SLOTS:
  /// Asks for the chosen case, at the iteration that failed or at the last one.
  void openChosen();
  void accept();
  void reject();
  void next();
  void previous();
  void showDifferences(bool shown);
  void focusList();

 Q_SIGNALS:
  /// `iteration` is an index into the run of this digest, -1 for the last.
  void openRequested(const QString& id, const QString& run_digest, int iteration);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void showEvent(QShowEvent* event) override;

 private:
  using Act = QueueController::Act;

  void buildTables();
  void buildForm();
  QTableView* table() const;
  void switchList();
  void decide(Act act);
  bool asksForSignature(Act act, const QString& id);
  void signedNow();
  void dropQuestion();
  QString nextOpen() const;
  void choose(const QString& id);
  void step(int rows);
  void lookAt();
  void showEntries();
  void showProgress();
  void tell(const QString& text);
  void fitColumns();

  QueueController controller_;
  QueueModel model_;
  QueueFilter filter_;
  DifferencesModel differences_;
  QSortFilterProxyModel differences_filter_;
  EmptyHint* queue_hint_ = nullptr;
  EmptyHint* differences_hint_ = nullptr;
  std::optional<Act> pending_;  ///< waits for name and comment
  QString pending_case_;
  bool in_sight_ = false;
  bool fitted_ = false;
  const std::unique_ptr<Ui::QueuePanel> ui_;
};

}  // namespace boresight::ui
