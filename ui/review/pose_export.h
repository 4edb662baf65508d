// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <QObject>
#include <QString>

#include "sessions/exchange/annotation_exchange.h"

class QMenu;
class QWidget;

namespace boresight::ui {

class Document;
class TaskRunner;
class ViewState;

/// Of a file or a folder, without where it lies.
QString fileNameOf(const std::filesystem::path& file);
/// Notes of an export or an import as one text.
QString joinedNotes(const std::vector<std::string>& notes);
/// What came of an export to `path`, for the status bar.
QString exportNote(const sessions::ExportReport& report, const std::filesystem::path& path);

/// Poses to hand over, as files. What is not validated is called so in its name and in the file.
/// The functions with a path do what the ones without do after they have asked for one; they are
/// done when `noted` says so, and the task runner says what could not be done.
class PoseExport : public QObject {
  Q_OBJECT

 public:
  PoseExport(QWidget& window, Document& document, ViewState& state, TaskRunner& tasks);

  /// The entries of File > Export.
  void addTo(QMenu& menu);
  /// The shown case's pose, with its checks and where everything in it comes from.
  void exportPose(const std::filesystem::path& file);
  /// The same on two pages for people.
  void exportReport(const std::filesystem::path& file);
  /// Proposed for the pose: says in its name when the case is not validated.
  QString poseFileName() const;
  /// The poses of all cases that have one: a BOP19 results file, whose name has to say when one of
  /// them is not validated, and a COLMAP text model in a new folder.
  void exportBopResults(const std::filesystem::path& file, int scene_id);
  void exportColmap(const std::filesystem::path& folder);
  QString bopResultsFileName() const;

 public Q_SLOTS:
  void askForPose();
  void askForReport();
  void askForBopResults();
  void askForColmap();

 Q_SIGNALS:
  /// What happened, for the status bar.
  void noted(const QString& message);

 private:
  std::string caseId() const;
  bool isValidated(const std::string& case_id) const;
  template <class Write>
  void exportOne(const QString& key, const std::filesystem::path& file, const QString& note,
                 Write write);
  template <class Write>
  void exportAll(const std::filesystem::path& path, Write write);
  /// "NOT VALIDATED: converged", for titles.
  QString reviewStatus() const;
  std::filesystem::path askForFile(const QString& title, const QString& name,
                                   const QString& filter);
  QString inSessionFolder(const QString& name) const;

  QWidget& window_;
  Document& document_;
  ViewState& state_;
  TaskRunner& tasks_;
};

}  // namespace boresight::ui
