// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include <QDialog>
#include <QWidget>

#include "ui_limits_dialog.h"
#include "ui_review_panel.h"

#include "ui/models/rows_model.h"
#include "ui/review/check_cards.h"
#include "ui/review/decision_form.h"
#include "ui/review/review_controller.h"

namespace boresight::ui {

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

/// The checks of a pose: failed ones first, then passed ones, then those not applicable.
class ChecksModel : public RowsModel<sessions::Check> {
  Q_OBJECT

 public:
  enum Column { kCheck, kFound, kLimit };

  ChecksModel();

  /// `current` false: their inputs have changed since, and they are shown as outdated. Rows of the
  /// same checks change in place, so that selections stay.
  void setChecks(std::vector<sessions::Check> checks, bool current);
  /// "✓", "✗" or "–": each state has a unique shape.
  static QString sign(sessions::CheckState state);

 protected:
  QVariant look(const sessions::Check& row, int column, int role) const override;

 private:
  bool current_ = true;
};

/// Panel for the review: the case's review status, the failed checks of its pose as cards, the
/// others folded to a line, and the decision.
class ReviewPanel : public QWidget {
  Q_OBJECT

 public:
  ReviewPanel(Document& document, ViewState& state);

  ReviewController& controller() { return controller_; }
  DecisionForm& decision() { return *decision_; }
  QTableView& table() { return *ui_.checks; }

 Q_SIGNALS:
  /// Requests to show the source of a failed check's figure.
  void checkShowRequested(const std::string& check_id);

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
  void showFolds();
  void showConvergence();
  void openLimits();

  ReviewController controller_;
  ChecksModel model_;
  DecisionForm* decision_ = nullptr;
  std::optional<std::array<bool, 2>> sources_;  ///< listed: a run's pose, an annotated pose
  Ui::ReviewPanel ui_;
};

}  // namespace boresight::ui
