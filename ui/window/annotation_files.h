// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <QObject>
#include <QString>

#include "sessions/exchange/annotation_exchange.h"
#include "ui/window/window_parts.h"

class QWidget;

namespace boresight::ui {

class AnnotationPanel;

/// Marks, annotated poses and landmarks from and to files. The functions with a path do what the
/// ones without do after they have asked for one.
class AnnotationFiles : public QObject {
  Q_OBJECT

 public:
  AnnotationFiles(QWidget& window, const WindowParts& parts, AnnotationPanel& panel);

  /// points.json or a table (.csv): the marks of the shown case become these.
  bool importMarks(const std::filesystem::path& file);
  bool exportMarks(const std::filesystem::path& file);
  /// Annotated poses of all cases that have any, in a new folder; done when `noted` says so.
  void exportColmap(const std::filesystem::path& folder);
  void exportBop(const std::filesystem::path& folder);
  /// Poses of a COLMAP text model or a BOP scene become the truths of the cases they name.
  bool importColmap(const std::filesystem::path& folder);
  bool importBop(const std::filesystem::path& folder);
  bool openLandmarks(const std::filesystem::path& file);
  /// The station's landmarks with the marks of this image, which the case then uses.
  bool saveLandmarks(const std::filesystem::path& file);

 public Q_SLOTS:
  void askForImport();
  void askForExport();
  void askForColmapExport();
  void askForBopExport();
  void askForColmapImport();
  void askForBopImport();
  void askForLandmarks();
  void askWhereToSaveLandmarks();

 Q_SIGNALS:
  /// Something could not be done; one sentence.
  void failed(const QString& message);
  /// What happened, for the status bar.
  void noted(const QString& message);

 private:
  using Exporter = sessions::ExportReport (*)(const sessions::Session&,
                                              const std::filesystem::path&,
                                              const std::vector<std::string>&, bool);
  using Importer = sessions::ImportReport (*)(const sessions::Session&,
                                              const std::filesystem::path&, bool);
  void exportPoses(Exporter exporter, const std::filesystem::path& folder);
  bool importPoses(Importer importer, const std::filesystem::path& folder);
  std::string caseId() const;
  QString sessionFolder() const;
  bool mayReplaceMarks();
  QString newFolder(const QString& title, const QString& name);
  template <class Action>
  bool attempt(Action&& action);

  QWidget& window_;
  WindowParts parts_;
};

}  // namespace boresight::ui
