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

/// Annotations, annotated poses and landmarks from and to files that the operator is asked for.
class AnnotationFiles : public QObject {
  Q_OBJECT

 public:
  AnnotationFiles(QWidget& window, const WindowParts& parts, AnnotationPanel& panel);

  /// points.json or a table (.csv): the annotations of the shown case are replaced by these.
  void importAnnotations();
  void exportAnnotations();

 Q_SIGNALS:
  /// Something could not be done; one sentence.
  void failed(const QString& message);
  /// What happened, for the status bar.
  void noted(const QString& message);

 private:
  using Exporter = sessions::ExportReport (*)(const sessions::Session&,
                                              const std::filesystem::path&,
                                              const sessions::CasePoses&);
  using Importer = sessions::ImportReport (*)(const sessions::Session&,
                                              const std::filesystem::path&, bool);
  /// Annotated poses of all cases that have any, in a new folder; done when `noted` says so.
  void exportPoses(Exporter exporter, const QString& title, const QString& name);
  /// Poses of the folder become the truths of the cases that it names.
  void importPoses(Importer importer, const QString& title);
  void openLandmarks();
  /// The station's landmarks with the annotations of this image, which the case then uses.
  void saveLandmarks();
  std::string caseId() const { return shownCaseId(parts_.document, parts_.state); }
  bool mayReplaceAnnotations();
  template <class Action>
  void attempt(Action&& action);

  QWidget& window_;
  WindowParts parts_;
};

}  // namespace boresight::ui
