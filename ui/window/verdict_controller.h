// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QObject>
#include <QString>
#include <QTimer>

#include "ui/review/review_controller.h"
#include "ui/window/window_parts.h"
#include "ui/workspaces/remedies.h"
#include "ui/workspaces/verdict.h"

class QWidget;

namespace boresight::ui {

class InputFindings;
class SessionFiles;
class VerdictBar;
class WindowDocks;
class Workspaces;

/// Updates the verdict bar, and performs the steps of its buttons and of the remedies' buttons.
class VerdictController : public QObject {
  Q_OBJECT

 public:
  VerdictController(WindowParts& parts, const WindowDocks& docks, Workspaces& workspaces,
                    SessionFiles& files, InputFindings& findings, VerdictBar& bar, QWidget& window);

  Situation situation() const;
  /// Updates the bar; called automatically after changes, once per event loop.
  void update();
  /// The undecided case after the shown one: in the queue's order while the queue is visible, else
  /// in the session's order, cyclically. Empty when there is none; nullopt when none was found.
  std::optional<QString> nextCase() const;

 public Q_SLOTS:
  void perform(boresight::ui::Step step);
  /// The same for a step that the bar offers; without effect once another case is open than the bar
  /// told of.
  void performShown(boresight::ui::Step step);
  /// Asks in the review of the shown case, which is brought to the front.
  void askForDecision(boresight::ui::ReviewController::Act act);

 Q_SIGNALS:
  void exportRequested(boresight::ui::Step step);
  /// A step was not performed; one sentence.
  void failed(const QString& message);

 private:
  std::optional<QString> nextUndecided() const;
  void follow();
  AnnotationSituation annotationSituation() const;
  ReviewSituation reviewSituation() const;
  void changeInput();
  void nudgeSeed();
  void annotateFromPose();
  void disablePair();
  void askForUncertainty();

  WindowParts& parts_;
  const WindowDocks& docks_;
  Workspaces& workspaces_;
  SessionFiles& files_;
  InputFindings& findings_;
  VerdictBar& bar_;
  QWidget& window_;
  QTimer soon_;
  RemedyMemory taken_;
  CaseOpening told_;      ///< the case of the bar
  bool has_next_ = true;  ///< another case is to be decided
};

}  // namespace boresight::ui
