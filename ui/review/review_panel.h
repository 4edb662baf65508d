// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <QDialog>
#include <QWidget>

#include "ui_limits_dialog.h"
#include "ui_review_panel.h"

#include "ui/models/rows_model.h"
#include "ui/review/decision_form.h"
#include "ui/review/review_controller.h"

namespace boresight::ui {

class EmptyHint;

/// Limits of the session's checks: preset, single limits, and whether a second person must approve.
/// Stays open next to the checks; every change is immediately an edit.
class LimitsDialog : public QDialog {
  Q_OBJECT

 public:
  LimitsDialog(ReviewController& controller, QWidget* parent);

 private:
  void change(const std::string& name, const std::string& value);
  void showSettings();

  ReviewController& controller_;
  Ui::LimitsDialog ui_;
};

/// A check as the table shows it.
struct CheckRow {
  sessions::Check check;
  QString reason;  ///< for waiving it, or empty

  bool operator==(const CheckRow&) const = default;
};

/// The checks of a pose: failed ones first, then passed ones, then those not applicable. The reason
/// for waiving a failed one is edited here.
class ChecksModel : public RowsModel<CheckRow> {
  Q_OBJECT

 public:
  enum Column { kCheck, kFound, kLimit, kReason };

  explicit ChecksModel(QObject* parent = nullptr);

  /// `current` false: their inputs have changed since, and they are shown as outdated. Rows of the
  /// same checks change in place, so that selections and editors stay.
  void setRows(std::vector<CheckRow> rows, bool current);
  sessions::CheckState state(int row) const { return at(row).check.state; }
  int count(sessions::CheckState state) const;
  bool isFailed(int row) const { return at(row).check.state == sessions::CheckState::kFailed; }
  /// "✓", "✗" or "–": each state has a unique shape.
  static QString sign(sessions::CheckState state);

  bool setData(const QModelIndex& index, const QVariant& value, int role = Qt::EditRole) override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 Q_SIGNALS:
  void reasonEdited(const std::string& check_id, const QString& reason);

 protected:
  QVariant look(const CheckRow& row, int column, int role) const override;

 private:
  QString countsText() const;

  bool current_ = true;
};

/// Panel for the review: the case's review status, the checks of its pose with their figures and
/// limits, and the decision.
class ReviewPanel : public QWidget {
  Q_OBJECT

 public:
  ReviewPanel(Document& document, ViewState& state, QWidget* parent = nullptr);

  ReviewController& controller() { return controller_; }
  DecisionForm& decision() { return *decision_; }
  QTableView& table();

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  void buildTable();
  void showReviewStatus();
  void showSources();
  void showChecks();
  void showChosen();
  void showColumns();
  void showFolds();
  void showConvergence();
  void askForConvergenceTest();
  void openLimits();

  ReviewController controller_;
  ChecksModel model_;
  EmptyHint* hint_ = nullptr;
  DecisionForm* decision_ = nullptr;
  Ui::ReviewPanel ui_;
};

}  // namespace boresight::ui
