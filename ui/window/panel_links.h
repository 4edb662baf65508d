// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QObject>

#include "sessions/session/stale_runs.h"
#include "ui/window/window_parts.h"

namespace boresight::ui {

class CaseDetails;
class PoseRenderer;
class WindowDocks;

/// Keeps the panels in step with the document, the worker and the view state, and hands on what a
/// person asks of them. Panels that follow the view state alone are not known here.
class PanelLinks : public QObject {
  Q_OBJECT

 public:
  PanelLinks(const WindowParts& parts, const WindowDocks& docks, QObject* parent = nullptr);

 Q_SIGNALS:
  /// A panel cannot show something; one sentence.
  void failed(const QString& message);

 private:
  void linkCases();
  void linkConfiguration();
  void linkPoses();
  void showCases();
  void showConfiguration();
  void showInputs();
  void askForSigmas();
  void showJudgement();
  void showNudgedPose();

  WindowParts parts_;
  const WindowDocks& docks_;
  CaseDetails* details_;
  PoseRenderer* nudged_;
  sessions::StaleRuns stale_runs_;
};

}  // namespace boresight::ui
