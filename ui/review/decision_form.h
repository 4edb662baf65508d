// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include <memory>

#include <QWidget>

#include "ui/review/review_controller.h"

class QPushButton;

namespace boresight::ui {

namespace Ui {
class DecisionForm;
}

/// Who decides what about the shown case, on what grounds, and what was decided before. What cannot
/// be done now is disabled, and said why in place.
class DecisionForm : public QWidget {
  Q_OBJECT

 public:
  /// Setting that remembers who decided last.
  static constexpr const char* kNameKey = "review/name";

  explicit DecisionForm(ReviewController& controller, QWidget* parent = nullptr);
  ~DecisionForm() override;

  /// What stands in the way of the next step, as it is shown.
  const QString& obstacle() const { return obstacle_; }
  /// Something to read while deciding, above the former decisions.
  void setNote(const QString& html);

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
  const std::unique_ptr<Ui::DecisionForm> ui_;
};

}  // namespace boresight::ui
