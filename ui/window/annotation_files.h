// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <QObject>
#include <QString>

#include "sessions/exchange/annotation_exchange.h"
#include "ui/state/view_state.h"
#include "ui/window/window_parts.h"

class QWidget;

namespace boresight::ui {

class AnnotationPanel;

/// Imports and exports annotations, annotated poses and landmarks; asks the operator for the files.
class AnnotationFiles : public QObject {
  Q_OBJECT

 public:
  AnnotationFiles(QWidget& window, WindowParts& parts, AnnotationPanel& panel);

  /// Replaces the annotations of the shown case by those of a points.json or a table (.csv).
  void importAnnotations();
  void exportAnnotations();

 Q_SIGNALS:
  /// An action failed; one sentence.
  void failed(const QString& message);
  /// The result, for the status bar.
  void noted(const QString& message);

 private:
  using Exporter = sessions::ExportReport (*)(const sessions::Session&,
                                              const std::filesystem::path&,
                                              const sessions::HandedPoses&,
                                              const sessions::ExportProgress&);
  using Importer = sessions::ImportReport (*)(const sessions::Session&,
                                              const std::filesystem::path&, bool);
  /// Exports the annotated poses of all cases to a new folder; noted() is emitted when done.
  void exportPoses(Exporter exporter, const QString& title, const QString& name);
  /// Sets the truths of cases from the poses of the folder.
  void importPoses(Importer importer, const QString& title);
  void openLandmarks();
  /// Saves the station's landmarks with the annotations of this image; the case then uses this
  /// file.
  void saveLandmarks();
  std::string caseId() const { return shownCaseId(parts_.document, parts_.state); }
  bool isStillOpen(const CaseOpening& seen);
  bool mayReplaceAnnotations();
  template <class Action>
  void attempt(Action&& action);

  QWidget& window_;
  WindowParts& parts_;
};

}  // namespace boresight::ui
