// SPDX-License-Identifier: Apache-2.0
#include "ui/window/annotation_files.h"

#include <exception>

#include <QtWidgets>

#include "sessions/annotation/annotations_file.h"
#include "sessions/annotation/landmarks.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/annotation/annotation_panel.h"
#include "ui/models/text.h"
#include "ui/review/pose_export.h"
#include "ui/run/export_runner.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"

namespace boresight::ui {
namespace {

QString annotationsFilter() {
  return AnnotationFiles::tr("Annotations (*.json *.csv);;points.json (*.json);;Table (*.csv)");
}

}  // namespace

AnnotationFiles::AnnotationFiles(QWidget& window, WindowParts& parts, AnnotationPanel& panel)
    : QObject(&window), window_(window), parts_(parts) {
  QMenu& menu = panel.filesMenu();
  menu.addAction(tr("Import annotations ..."), this, &AnnotationFiles::importAnnotations);
  menu.addAction(tr("Export annotations ..."), this, &AnnotationFiles::exportAnnotations);
  menu.addSeparator();
  menu.addAction(tr("Export all poses for COLMAP ..."), this, [this] {
    exportPoses(&sessions::exportColmap, tr("New folder for a COLMAP text model"),
                QStringLiteral("colmap"));
  });
  menu.addAction(tr("Export all poses as a BOP scene ..."), this, [this] {
    exportPoses(&sessions::exportBop, tr("New folder for a BOP scene"), QStringLiteral("000001"));
  });
  menu.addAction(tr("Import truths from COLMAP ..."), this, [this] {
    importPoses(&sessions::importColmap,
                tr("Folder of a COLMAP text model (cameras.txt, images.txt)"));
  });
  menu.addAction(tr("Import truths from a BOP scene ..."), this, [this] {
    importPoses(&sessions::importBop,
                tr("Folder of a BOP scene (scene_gt.json, scene_camera.json)"));
  });
  connect(&panel, &AnnotationPanel::openLandmarksRequested, this, &AnnotationFiles::openLandmarks);
  connect(&panel, &AnnotationPanel::saveLandmarksRequested, this, &AnnotationFiles::saveLandmarks);
}

template <class Action>
void AnnotationFiles::attempt(Action&& action) {
  try {
    action();
  } catch (const std::exception& error) {
    Q_EMIT failed(QString::fromUtf8(error.what()));
  }
}

/// Whether the case that a dialog was opened for is still open; tells where it is not.
bool AnnotationFiles::isStillOpen(const CaseOpening& seen) {
  if (seen == parts_.state.opening()) return true;
  Q_EMIT failed(leftText(seen));
  return false;
}

void AnnotationFiles::importAnnotations() {
  const CaseOpening seen = parts_.state.opening();
  const QString file =
      QFileDialog::getOpenFileName(&window_, tr("Import annotations"),
                                   inSessionFolder(parts_.document, {}), annotationsFilter());
  if (file.isEmpty() || !isStillOpen(seen) || !mayReplaceAnnotations() || !isStillOpen(seen))
    return;
  attempt([&, path = std::filesystem::path(file.toStdString())] {
    parts_.annotation.finishMove();
    const sessions::ImportReport report =
        sessions::importAnnotations(parts_.document.session(), caseId(), path, true);
    if (!parts_.document.edit(report.session, tr("Import annotations of %1").arg(fileNameOf(path))))
      return;
    Q_EMIT noted(tr("Annotations read from %1.").arg(fileNameOf(path)));
  });
}

void AnnotationFiles::exportAnnotations() {
  parts_.annotation.finishMove();
  const sessions::Annotations annotations = parts_.annotation.annotations();  // of the shown case
  const auto file = askForNewFile(window_, tr("Export the annotations of this case"),
                                  inSessionFolder(parts_.document, QStringLiteral("points.json")),
                                  annotationsFilter());
  if (file.empty()) return;
  attempt([&] {
    sessions::writeAnnotations(file, annotations);
    Q_EMIT noted(tr("Annotations written to %1.").arg(fileNameOf(file)));
  });
}

void AnnotationFiles::exportPoses(Exporter exporter, const QString& title, const QString& name) {
  parts_.annotation.finishMove();
  const sessions::Session session = parts_.document.session();
  const std::filesystem::path folder =
      QFileDialog::getSaveFileName(&window_, title, inSessionFolder(parts_.document, name))
          .toStdString();
  if (folder.empty()) return;
  parts_.exports.start(
      writingText(folder), tr("annotated poses of all cases"),
      [exporter, folder, session](const ExportRunner::Progress& progress) {
        return exporter(session, folder, sessions::annotatedPoses(session, {}), progress);
      },
      [this, folder](const sessions::ExportReport& report) {
        Q_EMIT noted(exportNote(report, folder));
      });
}

void AnnotationFiles::importPoses(Importer importer, const QString& title) {
  const CaseOpening seen = parts_.state.opening();
  const std::filesystem::path folder =
      QFileDialog::getExistingDirectory(&window_, title, inSessionFolder(parts_.document, {}))
          .toStdString();
  if (folder.empty() || !isStillOpen(seen)) return;
  attempt([&] {
    parts_.annotation.finishMove();
    const sessions::ImportReport report = importer(parts_.document.session(), folder, true);
    if (!parts_.document.edit(report.session, tr("Import poses of %1").arg(fileNameOf(folder))))
      return;
    Q_EMIT noted(tr("%1 cases now have their truth from %2. %3")
                     .arg(report.case_ids.size())
                     .arg(fileNameOf(folder), joinedNotes(report.notes)));
  });
}

void AnnotationFiles::openLandmarks() {
  const CaseOpening seen = parts_.state.opening();
  const std::filesystem::path file =
      QFileDialog::getOpenFileName(&window_, tr("Open landmarks of the station"),
                                   inSessionFolder(parts_.document, {}), tr("Landmarks (*.json)"))
          .toStdString();
  if (file.empty() || !isStillOpen(seen)) return;
  attempt([&] {
    const auto landmarks = sessions::readLandmarks(file);  // before the session names it
    if (parts_.annotation.setLandmarksFile(file))
      Q_EMIT noted(tr("%1 landmarks of %2.").arg(landmarks.size()).arg(fileNameOf(file)));
  });
}

void AnnotationFiles::saveLandmarks() {
  const CaseOpening seen = parts_.state.opening();
  const sessions::SessionCase* session_case = shownCase(parts_.document, parts_.state);
  const auto file =
      askForNewFile(window_, tr("Save the annotations as landmarks"),
                    session_case && session_case->landmarks
                        ? fromText(session_case->landmarks->string())
                        : inSessionFolder(parts_.document, QStringLiteral("landmarks.json")),
                    tr("Landmarks (*.json)"));
  if (file.empty() || !isStillOpen(seen)) return;
  attempt([&] {
    AnnotationController& annotation = parts_.annotation;
    sessions::writeLandmarks(
        file, sessions::withAnnotations(annotation.landmarks(), annotation.annotations()));
    annotation.setLandmarksFile(file);
    const QString left_out = fromText(sessions::leftOutOfLandmarks(annotation.annotations()));
    Q_EMIT noted(tr("Landmarks written to %1. %2").arg(fileNameOf(file), left_out).trimmed());
  });
}

bool AnnotationFiles::mayReplaceAnnotations() {
  const sessions::Annotations& annotations = parts_.annotation.annotations();
  if (annotations.empty()) return true;
  const std::size_t count = annotations.points.size() + annotations.lines.size();
  return QMessageBox::question(&window_, tr("Import annotations"),
                               tr("%1 has %2 annotations. Replace them? Undo restores them; to "
                                  "keep both, set them aside first (Rounds).")
                                   .arg(fromText(caseId()))
                                   .arg(count)) == QMessageBox::Yes;
}

}  // namespace boresight::ui
