// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include <QObject>
#include <QString>
#include <QStringList>

#include "ui/panels/case/cases_panel.h"
#include "ui/run/case_by_case.h"
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
  void showCase(std::size_t place);
  void showWorking();
  CaseRow rowAt(std::size_t place) const;
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
  QString running_;      ///< id of the case under way, or empty
  TaskKind describing_;  ///< the inputs
  CaseByCase<CaseRow> rows_;
};

}  // namespace boresight::ui
