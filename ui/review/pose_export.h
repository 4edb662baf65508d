// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <QObject>
#include <QString>

#include "sessions/exchange/annotation_exchange.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"

class QMenu;
class QWidget;

namespace boresight::ui {

class ExportRunner;

/// Name of a file or a folder, without its path.
QString fileNameOf(const std::filesystem::path& file);
/// Notes of an export or an import as one text.
QString joinedNotes(const std::vector<std::string>& notes);
/// Result of an export to `path`, for the status bar.
QString exportNote(const sessions::ExportReport& report, const std::filesystem::path& path);

/// Name of an export under way.
QString writingText(const std::filesystem::path& path);

/// A path in the session's folder; for an untitled session, in the operator's documents.
QString inSessionFolder(const Document& document, const QString& name);
/// Asks for a file to write; a name without a suffix gets that of the proposed path. Empty when the
/// operator cancels.
std::filesystem::path askForNewFile(QWidget& window, const QString& title, const QString& proposed,
                                    const QString& filter);

/// Exports poses to be handed over. Poses that are not validated are marked so in the file and its
/// name. noted() is emitted when an export is done; the runner reports progress and failures.
class PoseExport : public QObject {
  Q_OBJECT

 public:
  PoseExport(QWidget& window, Document& document, ViewState& state, ExportRunner& exports);

  /// The entries of File > Export.
  void addTo(QMenu& menu);
  /// Asks for a file, then writes it.
  void askForPose();
  void askForReport();
  /// Exports the shown case's pose with its checks and provenance.
  void exportPose(const std::filesystem::path& file) { exportPose(file, shown()); }
  /// Exports the same as a report of two pages.
  void exportReport(const std::filesystem::path& file) { exportReport(file, shown()); }
  /// Proposed names for pose and report: that of the case, with a note when it is not validated.
  QString poseFileName() const;
  QString reportFileName() const;
  /// The poses of all cases that have one: a BOP19 results file, whose name must state when one of
  /// them is not validated, and a COLMAP text model in a new folder.
  void exportBopResults(const std::filesystem::path& file, int scene_id) {
    exportBopResults(file, scene_id, document_.session());
  }
  void exportColmap(const std::filesystem::path& folder) {
    exportColmap(folder, document_.session());
  }
  QString bopResultsFileName() const;

 Q_SIGNALS:
  /// The result, for the status bar.
  void noted(const QString& message);
  /// Nothing is exported; one sentence.
  void failed(const QString& message);

 private:
  /// A case as it was when its export was requested: the proposed name, the title of the dialog and
  /// the contents of the file are of the same state, whatever happens while the dialog is open.
  struct Exported {
    sessions::Session session;
    std::string case_id;
  };

  Exported shown() const { return {document_.session(), caseId()}; }
  void exportPose(const std::filesystem::path& file, const Exported& exported);
  void exportReport(const std::filesystem::path& file, const Exported& exported);
  void exportBopResults(const std::filesystem::path& file, int scene_id,
                        const sessions::Session& session);
  void exportColmap(const std::filesystem::path& folder, const sessions::Session& session);
  void askForBopResults();
  void askForColmap();
  std::string caseId() const { return shownCaseId(document_, state_); }
  bool isValidated(const std::string& case_id) const;
  QString caseFileName(const char* validated, const char* not_validated) const;
  template <class Write>
  void exportOne(const std::filesystem::path& file, const QString& note, const Exported& exported,
                 Write write);
  template <class Write>
  void exportAll(const std::filesystem::path& path, const sessions::Session& session, Write write);
  /// For the shown case; `title` takes its id and its review status.
  std::filesystem::path askForFile(const QString& title, const QString& name,
                                   const QString& filter);

  QWidget& window_;
  Document& document_;
  ViewState& state_;
  ExportRunner& exports_;
};

}  // namespace boresight::ui
