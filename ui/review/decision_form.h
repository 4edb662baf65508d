// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <QWidget>

#include "ui_decision_form.h"

#include "ui/review/review_controller.h"

namespace boresight::ui {

/// Who decides what about the shown case, for what reason, and what was decided before: the one
/// place of decisions. What cannot be done now is disabled, and said why in place. The name is
/// asked once in each run of the program.
class DecisionForm : public QWidget {
  Q_OBJECT

 public:
  using Act = ReviewController::Act;
  /// Id of the undecided case to show after the shown one, or empty.
  using Next = std::function<QString()>;

  explicit DecisionForm(ReviewController& controller, QWidget* parent = nullptr);

  /// What stands in the way of the next step, as it is shown.
  const QString& obstacle() const { return obstacle_; }
  /// Something to read while deciding, above the former decisions.
  void setNote(const QString& html);
  /// The failed check whose waiver can be typed here; "": none.
  void setFailedCheck(const std::string& id, const QString& title, const QString& reason);
  /// Without it no case follows.
  void setNext(Next next) { next_ = std::move(next); }
  /// By a key: asks for name and reason where they are missing, then decides and goes to the next
  /// case; Escape withdraws the question.
  void ask(ReviewController::Act act);

 Q_SIGNALS:
  /// One sentence.
  void decided(const QString& what);
  void nextRequested(const QString& id);
  /// A question by a key was answered, refused or withdrawn.
  void questionEnded();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  struct Question {
    Act act;
    std::string case_id;
  };

  sessions::Signature signature() const;
  void decide(Act act, bool then_next);
  void endQuestion();
  void followCase();
  bool isDecided() const;
  void showWhatIsPossible();
  void showReading();
  QString nextCase() const { return next_ ? next_() : QString(); }
  Act nextStep() const;

  ReviewController& controller_;
  Next next_;
  std::optional<Question> question_;
  std::string shown_id_;
  std::map<Act, QPushButton*> buttons_;
  std::map<Act, QString> tips_;
  QString obstacle_;
  QString refusal_;  ///< of what was asked for last
  QString note_;
  QString read_;
  std::string failed_check_;
  Ui::DecisionForm ui_;
};

}  // namespace boresight::ui
