// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include <QWidget>

#include "ui/review/review_controller.h"

class QHBoxLayout;
class QLineEdit;
class QPushButton;
class QTextBrowser;

namespace boresight::ui {

/// Who decides what about the shown case, on what grounds, and what was decided before. What cannot
/// be done now is disabled, and said why in place.
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

 private:
  using Act = ReviewController::Act;

  void buildFields(QHBoxLayout& row);
  QPushButton* button(Act act, const char* name, const QString& text, const QString& tip);
  sessions::Signature signature() const;
  void decide(Act act);
  void showWhatIsPossible();
  void showReading();
  Act nextStep() const;

  ReviewController& controller_;
  QLineEdit* name_ = nullptr;
  QLineEdit* comment_ = nullptr;
  std::map<Act, QPushButton*> buttons_;
  std::map<Act, QString> tips_;
  QString obstacle_;
  QString note_;
  QString read_;
  QTextBrowser* reading_ = nullptr;
};

}  // namespace boresight::ui
