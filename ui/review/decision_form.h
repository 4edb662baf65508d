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

/// Form of all decisions on the shown case: name, decision, reason, and former decisions. Actions
/// that are not possible now are disabled, with the reason shown. The name is asked once in each
/// session.
class DecisionForm : public QWidget {
  Q_OBJECT

 public:
  using Act = ReviewController::Act;
  /// Id of the undecided case to show after the shown one; empty: there is none; nullopt: none was
  /// found.
  using Next = std::function<std::optional<QString>()>;

  explicit DecisionForm(ReviewController& controller);

  /// The shown reason why the next step is not possible.
  const QString& obstacle() const { return obstacle_; }
  /// Without it no next case is shown.
  void setNext(Next next) { next_ = std::move(next); }
  /// Clears the name: the reviewer of another session may be another person.
  void forgetName();
  /// Called by a key: asks for a missing name and reason, then decides and goes to the next case.
  /// Until it can be decided the question stays, and with it the focus; Escape withdraws it.
  void ask(ReviewController::Act act);

 Q_SIGNALS:
  /// One sentence.
  void decided(const QString& what);
  void nextRequested(const QString& id);
  /// A question started by a key was answered, rejected or withdrawn.
  void questionEnded();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  struct Question {
    Act act;
    std::string case_id;
    std::string run;  ///< digest of the run that was shown when it was asked
  };

  sessions::Signature signature() const;
  /// Returns false, with the reason shown, where nothing was decided.
  bool decide(Act act, bool then_next);
  bool refuse(const QString& reason);
  bool overrules(Act act);
  void answer();
  void endQuestion();
  void followCase();
  void showWhatIsPossible();
  void showReading();
  Act nextStep() const;

  ReviewController& controller_;
  Next next_;
  std::optional<Question> question_;
  std::optional<Act> overruling_;  ///< of a decision that holds; requested once
  std::string shown_id_;
  std::map<std::string, QString> drafts_;  ///< comments by case
  std::map<Act, QPushButton*> buttons_;
  std::map<Act, QString> tips_;
  QString obstacle_;
  QString refusal_;  ///< reason why the last request was rejected
  QString read_;
  Ui::DecisionForm ui_;
};

}  // namespace boresight::ui
