// SPDX-License-Identifier: Apache-2.0
#include "ui/review/pose_export.h"

#include <algorithm>

#include <QtWidgets>

#include "sessions/exchange/annotation_exchange.h"
#include "sessions/report/pose_report.h"
#include "sessions/review/review_status.h"
#include "sessions/review/validated_pose_file.h"
#include "ui/models/text.h"
#include "ui/run/export_runner.h"

namespace boresight::ui {

QString fileNameOf(const std::filesystem::path& file) {
  return QString::fromStdString(file.filename().string());
}

QString joinedNotes(const std::vector<std::string>& notes) {
  QStringList texts;
  for (const std::string& note : notes) texts << fromText(note);
  return texts.join(QLatin1Char(' '));
}

QString exportNote(const sessions::ExportReport& report, const std::filesystem::path& path) {
  return PoseExport::tr("%1 poses written to %2. %3")
      .arg(report.case_ids.size())
      .arg(fileNameOf(path), joinedNotes(report.notes));
}

QString writingText(const std::filesystem::path& path) {
  return PoseExport::tr("Writing %1").arg(fileNameOf(path));
}

QString inSessionFolder(const Document& document, const QString& name) {
  // Sessions without a name lie in a folder that file dialogs do not list.
  const bool hidden = document.isUntitled() || !document.isOpen();
  const std::filesystem::path folder =
      hidden
          ? std::filesystem::path(
                QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation).toStdString())
          : document.file().parent_path();
  return fromText((folder / name.toStdString()).string());
}

std::filesystem::path askForNewFile(QWidget& window, const QString& title, const QString& proposed,
                                    const QString& filter) {
  QFileDialog dialog(&window, title, QFileInfo(proposed).path(), filter);
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QFileInfo(proposed).suffix());  // before it asks whether to replace
  dialog.selectFile(proposed);
  return dialog.exec() == QDialog::Accepted ? dialog.selectedFiles().value(0).toStdString()
                                            : std::string();
}

PoseExport::PoseExport(QWidget& window, Document& document, ViewState& state, ExportRunner& exports)
    : QObject(&window), window_(window), document_(document), state_(state), exports_(exports) {}

void PoseExport::addTo(QMenu& menu) {
  QAction* pose = menu.addAction(tr("&Pose for hand-over..."), this, &PoseExport::askForPose);
  pose->setStatusTip(tr("Pose of the shown case with checks, decision and provenance, as JSON"));
  QAction* report = menu.addAction(tr("&Report (PDF)..."), this, &PoseExport::askForReport);
  report->setStatusTip(
      tr("Pose of the shown case on two pages: overlay, inputs, decision, checks, residuals"));
  QAction* bop = menu.addAction(tr("&BOP results (CSV)..."), this, &PoseExport::askForBopResults);
  bop->setStatusTip(tr("All poses in the format of the BOP challenges"));
  QAction* colmap = menu.addAction(tr("&COLMAP text model..."), this, &PoseExport::askForColmap);
  colmap->setStatusTip(tr("All poses as a COLMAP text model"));
  connect(&menu, &QMenu::aboutToShow, &menu, [this, pose, report, bop, colmap] {
    for (QAction* q_action : {pose, report}) q_action->setEnabled(!caseId().empty());
    for (QAction* all : {bop, colmap}) all->setEnabled(!document_.session().cases.empty());
  });
}

bool PoseExport::isValidated(const std::string& case_id) const {
  return sessions::reviewStatusOf(document_.session(), case_id).state ==
         sessions::ReviewState::kValidated;
}

QString PoseExport::poseFileName() const {
  return caseFileName("_validated_pose.json", "_pose_NOT_VALIDATED.json");
}

QString PoseExport::reportFileName() const {
  return caseFileName("_pose_report.pdf", "_pose_report_NOT_VALIDATED.pdf");
}

QString PoseExport::caseFileName(const char* validated, const char* not_validated) const {
  return fromText(caseId()).replace(QLatin1Char('/'), QLatin1Char('_')) +
         QLatin1String(isValidated(caseId()) ? validated : not_validated);
}

QString PoseExport::bopResultsFileName() const {
  const bool all = std::ranges::all_of(document_.session().cases,
                                       [this](const auto& item) { return isValidated(item->id); });
  return all ? QStringLiteral("boresight_results.csv")
             : QStringLiteral("boresight_%1_results.csv")
                   .arg(QLatin1String(sessions::kNotValidatedName));
}

template <class Write>
void PoseExport::exportOne(const std::filesystem::path& file, const QString& note,
                           const Exported& exported, Write write) {
  const QString id = fromText(exported.case_id);
  exports_.start(
      writingText(file), tr("the pose of %1 is measured again").arg(id),
      [write, exported](const ExportRunner::Progress&) {
        return write(exported.session, exported.case_id);
      },
      [this, file, note, id](const std::string& status) {
        Q_EMIT noted(note.arg(id, fileNameOf(file), fromText(status)));
      });
}

void PoseExport::exportPose(const std::filesystem::path& file, const Exported& exported) {
  exportOne(file, tr("Pose of %1 written to %2. It is %3."), exported,
            [file](const sessions::Session& session, const std::string& id) {
              return sessions::writeValidatedPose(file, session, id).review_status;
            });
}

void PoseExport::exportReport(const std::filesystem::path& file, const Exported& exported) {
  exportOne(file, tr("Report of %1 written to %2. It is %3."), exported,
            [file](const sessions::Session& session, const std::string& id) {
              const sessions::PoseReport report = sessions::poseReport(session, id);
              sessions::writePoseReport(file, report);
              return report.pose.review_status;
            });
}

template <class Write>
void PoseExport::exportAll(const std::filesystem::path& path, const sessions::Session& session,
                           Write write) {
  exports_.start(
      writingText(path), tr("poses of all cases"),
      [write, session](const ExportRunner::Progress& progress) { return write(session, progress); },
      [this, path](const sessions::ExportReport& report) {
        Q_EMIT noted(exportNote(report, path));
      });
}

void PoseExport::exportBopResults(const std::filesystem::path& file, int scene_id,
                                  const sessions::Session& session) {
  exportAll(file, session, [file, scene_id](const sessions::Session& whole, const auto& progress) {
    return sessions::exportBopResults(whole, file, {}, scene_id, progress);
  });
}

void PoseExport::exportColmap(const std::filesystem::path& folder,
                              const sessions::Session& session) {
  exportAll(folder, session, [folder](const sessions::Session& whole, const auto& progress) {
    return sessions::exportColmap(whole, folder, sessions::posesToHandOver(whole, {}, progress));
  });
}

void PoseExport::askForBopResults() {
  const sessions::Session session = document_.session();
  const QString proposed = inSessionFolder(document_, bopResultsFileName());
  bool chosen = false;
  const int scene_id = QInputDialog::getInt(&window_, tr("BOP results"),
                                            tr("Number of the scene that the images are of"), 1, 0,
                                            999999, 1, &chosen);
  if (!chosen) return;
  const auto file = askForNewFile(window_, tr("Poses of all cases as BOP results"), proposed,
                                  tr("Table (*.csv)"));
  if (!file.empty()) exportBopResults(file, scene_id, session);
}

void PoseExport::askForColmap() {
  const sessions::Session session = document_.session();
  const QString folder =
      QFileDialog::getSaveFileName(&window_, tr("New folder for a COLMAP text model"),
                                   inSessionFolder(document_, QStringLiteral("colmap_poses")));
  if (!folder.isEmpty()) exportColmap(folder.toStdString(), session);
}

std::filesystem::path PoseExport::askForFile(const QString& title, const QString& name,
                                             const QString& filter) {
  if (caseId().empty()) {
    Q_EMIT failed(tr("No case is shown: select one in the list of cases."));
    return {};
  }
  const auto status = sessions::reviewStatusOf(document_.session(), caseId());
  return askForNewFile(window_,
                       title.arg(fromText(caseId()), fromText(sessions::reviewStatusText(status))),
                       inSessionFolder(document_, name), filter);
}

void PoseExport::askForPose() {
  const Exported exported = shown();
  const auto file = askForFile(tr("Pose of %1 (%2)"), poseFileName(), tr("Pose (*.json)"));
  if (!file.empty()) exportPose(file, exported);
}

void PoseExport::askForReport() {
  const Exported exported = shown();
  const auto file = askForFile(tr("Report of %1 (%2)"), reportFileName(), tr("PDF (*.pdf)"));
  if (!file.empty()) exportReport(file, exported);
}

}  // namespace boresight::ui
