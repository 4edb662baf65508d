// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QObject>
#include <QString>
#include <QStringList>

#include "sessions/session/session.h"
#include "ui/state/view_state.h"
#include "ui/window/window_parts.h"

namespace boresight::ui {

class WindowDocks;

/// Shows the case and the iteration that the queue requests.
class QueueLinks : public QObject {
  Q_OBJECT

 public:
  QueueLinks(WindowParts& parts, const WindowDocks& docks, QObject* parent);

 private:
  struct Place {
    CaseOpening opening;
    std::string run_digest;
    int iteration = -1;
  };

  void goThere();

  WindowParts& parts_;
  std::optional<Place> wanted_;  ///< while the case or its run is being read
};

class CaseDetails;
class PoseRenderer;
class WindowDocks;

/// Updates the panels from the document, the worker and the view state, and forwards the operator's
/// requests. Panels that follow only the view state are not included.
class PanelLinks : public QObject {
  Q_OBJECT

 public:
  PanelLinks(WindowParts& parts, const WindowDocks& docks, QObject* parent = nullptr);

 Q_SIGNALS:
  /// A panel cannot show something; one sentence.
  void failed(const QString& message);
  /// Probable errors of the shown case's inputs; sentences.
  void warningsChanged(const QStringList& sentences);

 private:
  void linkCases();
  void linkConfiguration();
  void linkPoses();
  void showCases();
  void showConfiguration();
  void showInputs();
  bool isStillOpen(const CaseOpening& seen);
  void askForSigmas();
  void askForJudgement();
  void linkFrames();
  void addFrames();
  void showJudgement();
  void showNudgedPose();

  WindowParts& parts_;
  const WindowDocks& docks_;
  CaseDetails* details_;
  PoseRenderer* nudged_;
  sessions::StaleRuns stale_runs_;
  TaskKind describing_;  ///< the inputs
};

}  // namespace boresight::ui
