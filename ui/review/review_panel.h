// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QWidget>

#include "ui/review/checks_model.h"
#include "ui/review/review_controller.h"

class QComboBox;
class QHBoxLayout;
class QPushButton;
class QSpinBox;
class QTableView;
class QToolButton;

namespace boresight::ui {

class DecisionForm;
class EmptyHint;
class Banner;

/// The reviewer's desk: where the case stands, the checks of its pose with their figures and
/// limits, and the decision.
class ReviewPanel : public QWidget {
  Q_OBJECT

 public:
  ReviewPanel(Document& document, ViewState& state, QWidget* parent = nullptr);

  ReviewController& controller() { return controller_; }
  QTableView& table() { return *table_; }

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  QHBoxLayout* buildTop();
  void buildTable();
  void showStanding();
  void showSources();
  void showChecks();
  void showChosen();
  void showBasin();
  void askForBasin();
  void openLimits();
  QString hint() const;

  ReviewController controller_;
  ChecksModel model_;
  Banner* banner_ = nullptr;
  QComboBox* source_ = nullptr;
  QPushButton* limits_ = nullptr;
  QTableView* table_ = nullptr;
  EmptyHint* hint_ = nullptr;
  QSpinBox* seeds_ = nullptr;
  QPushButton* basin_ = nullptr;
  DecisionForm* decision_ = nullptr;
};

}  // namespace boresight::ui
