// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include <QDialog>
#include <QWidget>

#include "ui_decision_form.h"
#include "ui_limits_dialog.h"
#include "ui_review_panel.h"

#include "ui/models/rows_model.h"
#include "ui/review/review_controller.h"

namespace boresight::ui {

class EmptyHint;
class ReviewController;

/// Who decides what about the shown case, for what reason, and what was decided before.
/// What cannot be done now is disabled, and said why in place.
class DecisionForm : public QWidget {
  Q_OBJECT

 public:
  /// Setting that remembers who decided last.
  static constexpr const char* kNameKey = "review/name";

  explicit DecisionForm(ReviewController& controller, QWidget* parent = nullptr);

  /// What stands in the way of the next step, as it is shown.
  const QString& obstacle() const { return obstacle_; }
  /// Something to read while deciding, above the former decisions.
  void setNote(const QString& html);
  /// The failed check whose waiver can be typed here; "": none.
  void setFailedCheck(const std::string& id, const QString& title, const QString& reason);

 private:
  using Act = ReviewController::Act;

  sessions::Signature signature() const;
  void decide(Act act);
  void showWhatIsPossible();
  void showReading();
  Act nextStep() const;

  ReviewController& controller_;
  std::map<Act, QPushButton*> buttons_;
  std::map<Act, QString> tips_;
  QString obstacle_;
  QString note_;
  QString read_;
  std::string failed_check_;
  Ui::DecisionForm ui_;
};

/// Limits of the session's checks: preset, single limits, and whether a second person must approve.
/// Stays open next to the checks; every change is an edit at once.
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
  QString reason;  ///< for passing over it, or empty

  bool operator==(const CheckRow&) const = default;
};

/// The checks of a pose: failed ones first, then passed ones, then what could not be asked. The
/// reason for passing over a failed one is edited here.
class ChecksModel : public RowsModel<CheckRow> {
  Q_OBJECT

 public:
  enum Column { kCheck, kFound, kLimit, kReason };

  explicit ChecksModel(QObject* parent = nullptr);

  /// `current` false: they are of something that has changed since, and are shown as such. Rows of
  /// the same checks change in place, so that selections and editors stay.
  void setRows(std::vector<CheckRow> rows, bool current);
  sessions::CheckState state(int row) const { return at(row).check.state; }
  int count(sessions::CheckState state) const;
  bool isFailed(int row) const { return at(row).check.state == sessions::CheckState::kFailed; }
  /// "✓", "✗" or "–": each state has a shape of its own.
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

/// The reviewer's desk: where the case stands, the checks of its pose with their figures and
/// limits, and the decision.
class ReviewPanel : public QWidget {
  Q_OBJECT

 public:
  ReviewPanel(Document& document, ViewState& state, QWidget* parent = nullptr);

  ReviewController& controller() { return controller_; }
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
  void showReasons();
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
