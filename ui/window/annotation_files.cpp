// SPDX-License-Identifier: Apache-2.0
#include "ui/window/annotation_files.h"

#include <exception>

#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QStringList>

#include "sessions/annotation/landmarks.h"
#include "sessions/annotation/marks_file.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/annotation/annotation_panel.h"
#include "ui/models/number_text.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"

namespace boresight::ui {
namespace {

QString marksFilter() {
  return AnnotationFiles::tr("Marks (*.json *.csv);;points.json (*.json);;Table (*.csv)");
}

QString nameOf(const std::filesystem::path& file) {
  return QString::fromStdString(file.filename().string());
}

}  // namespace

AnnotationFiles::AnnotationFiles(QWidget& window, const WindowParts& parts, AnnotationPanel& panel)
    : QObject(&window), window_(window), parts_(parts) {
  connect(&panel, &AnnotationPanel::importRequested, this, &AnnotationFiles::askForImport);
  connect(&panel, &AnnotationPanel::exportRequested, this, &AnnotationFiles::askForExport);
  connect(&panel, &AnnotationPanel::exportColmapRequested, this,
          &AnnotationFiles::askForColmapExport);
  connect(&panel, &AnnotationPanel::exportBopRequested, this, &AnnotationFiles::askForBopExport);
  connect(&panel, &AnnotationPanel::importColmapRequested, this,
          &AnnotationFiles::askForColmapImport);
  connect(&panel, &AnnotationPanel::importBopRequested, this, &AnnotationFiles::askForBopImport);
  connect(&panel, &AnnotationPanel::openLandmarksRequested, this,
          &AnnotationFiles::askForLandmarks);
  connect(&panel, &AnnotationPanel::saveLandmarksRequested, this,
          &AnnotationFiles::askWhereToSaveLandmarks);
}

template <class Action>
bool AnnotationFiles::attempt(Action&& action) {
  try {
    action();
    return true;
  } catch (const std::exception& error) {
    Q_EMIT failed(QString::fromUtf8(error.what()));
    return false;
  }
}

bool AnnotationFiles::importMarks(const std::filesystem::path& file) {
  return attempt([&] {
    parts_.annotation.finishMove();
    const std::string id = caseId();
    const sessions::ImportReport report =
        sessions::importMarks(parts_.document.session(), id, file, true);
    parts_.document.edit(report.session, tr("Import marks of %1").arg(nameOf(file)));
    Q_EMIT noted(tr("Marks taken from %1.").arg(nameOf(file)));
  });
}

bool AnnotationFiles::exportMarks(const std::filesystem::path& file) {
  return attempt([&] {
    sessions::writeMarks(file, parts_.annotation.marks());
    Q_EMIT noted(tr("Marks written to %1.").arg(nameOf(file)));
  });
}

/// Images may have to be undistorted: off this thread.
void AnnotationFiles::exportPoses(Exporter exporter, const std::filesystem::path& folder) {
  parts_.annotation.finishMove();
  parts_.tasks.start(
      QStringLiteral("export poses"),
      [exporter, folder, session = parts_.document.session(), robust = parts_.annotation.robust()](
          const std::stop_token&) { return exporter(session, folder, {}, robust); },
      [this, folder](const sessions::ExportReport& report) {
        QStringList notes;
        for (const std::string& note : report.notes) notes << fromText(note);
        Q_EMIT noted(tr("%1 poses written to %2. %3")
                         .arg(report.case_ids.size())
                         .arg(nameOf(folder), notes.join(QLatin1Char(' '))));
      });
}

bool AnnotationFiles::importPoses(Importer importer, const std::filesystem::path& folder) {
  return attempt([&] {
    parts_.annotation.finishMove();
    const sessions::ImportReport report = importer(parts_.document.session(), folder, true);
    QStringList notes;
    for (const std::string& note : report.notes) notes << fromText(note);
    if (!parts_.document.edit(report.session, tr("Import poses of %1").arg(nameOf(folder)))) return;
    Q_EMIT noted(tr("%1 cases have their truth from %2 now. %3")
                     .arg(report.case_ids.size())
                     .arg(nameOf(folder), notes.join(QLatin1Char(' '))));
  });
}

void AnnotationFiles::exportColmap(const std::filesystem::path& folder) {
  exportPoses(&sessions::exportColmap, folder);
}

void AnnotationFiles::exportBop(const std::filesystem::path& folder) {
  exportPoses(&sessions::exportBop, folder);
}

bool AnnotationFiles::importColmap(const std::filesystem::path& folder) {
  return importPoses(&sessions::importColmap, folder);
}

bool AnnotationFiles::importBop(const std::filesystem::path& folder) {
  return importPoses(&sessions::importBop, folder);
}

bool AnnotationFiles::openLandmarks(const std::filesystem::path& file) {
  return attempt([&] {
    const auto landmarks = sessions::readLandmarks(file);  // before the session names it
    parts_.annotation.setLandmarksFile(file);
    Q_EMIT noted(tr("%1 landmarks of %2.").arg(landmarks.size()).arg(nameOf(file)));
  });
}

bool AnnotationFiles::saveLandmarks(const std::filesystem::path& file) {
  return attempt([&] {
    AnnotationController& annotation = parts_.annotation;
    sessions::writeLandmarks(file, sessions::withMarks(annotation.landmarks(), annotation.marks()));
    annotation.setLandmarksFile(file);
    Q_EMIT noted(tr("Landmarks written to %1.").arg(nameOf(file)));
  });
}

std::string AnnotationFiles::caseId() const {
  const ViewState::CasePtr& one = parts_.state.currentCase();
  return one ? one->source.id : std::string();
}

/// Where people look for what belongs to the session.
QString AnnotationFiles::sessionFolder() const {
  return QString::fromStdString(parts_.document.file().parent_path().string());
}

bool AnnotationFiles::mayReplaceMarks() {
  const sessions::Marks& marks = parts_.annotation.marks();
  if (marks.empty()) return true;
  const std::size_t count = marks.points.size() + marks.lines.size();
  return QMessageBox::question(
             &window_, tr("Import marks"),
             tr("%1 has %2 marks. Replace them? Undo brings them back; to keep both, put them "
                "aside first (Passes).")
                 .arg(fromText(caseId()))
                 .arg(count)) == QMessageBox::Yes;
}

void AnnotationFiles::askForImport() {
  const QString file =
      QFileDialog::getOpenFileName(&window_, tr("Import marks"), sessionFolder(), marksFilter());
  if (!file.isEmpty() && mayReplaceMarks()) importMarks(file.toStdString());
}

void AnnotationFiles::askForExport() {
  QString file =
      QFileDialog::getSaveFileName(&window_, tr("Export the marks of this case"),
                                   sessionFolder() + QStringLiteral("/points.json"), marksFilter());
  if (file.isEmpty()) return;
  if (QFileInfo(file).suffix().isEmpty()) file += QStringLiteral(".json");
  exportMarks(file.toStdString());
}

QString AnnotationFiles::newFolder(const QString& title, const QString& name) {
  return QFileDialog::getSaveFileName(&window_, title, sessionFolder() + QLatin1Char('/') + name);
}

void AnnotationFiles::askForColmapExport() {
  const QString folder =
      newFolder(tr("New folder for a COLMAP text model"), QStringLiteral("colmap"));
  if (!folder.isEmpty()) exportColmap(folder.toStdString());
}

void AnnotationFiles::askForBopExport() {
  const QString folder = newFolder(tr("New folder for a BOP scene"), QStringLiteral("000001"));
  if (!folder.isEmpty()) exportBop(folder.toStdString());
}

void AnnotationFiles::askForColmapImport() {
  const QString folder = QFileDialog::getExistingDirectory(
      &window_, tr("Folder of a COLMAP text model (cameras.txt, images.txt)"), sessionFolder());
  if (!folder.isEmpty()) importColmap(folder.toStdString());
}

void AnnotationFiles::askForBopImport() {
  const QString folder = QFileDialog::getExistingDirectory(
      &window_, tr("Folder of a BOP scene (scene_gt.json, scene_camera.json)"), sessionFolder());
  if (!folder.isEmpty()) importBop(folder.toStdString());
}

void AnnotationFiles::askForLandmarks() {
  const QString file = QFileDialog::getOpenFileName(&window_, tr("Open landmarks of the station"),
                                                    sessionFolder(), tr("Landmarks (*.json)"));
  if (!file.isEmpty()) openLandmarks(file.toStdString());
}

void AnnotationFiles::askWhereToSaveLandmarks() {
  const sessions::SessionCase* one = parts_.document.session().findCase(caseId());
  const QString known = one && one->landmarks ? QString::fromStdString(one->landmarks->string())
                                              : sessionFolder() + QStringLiteral("/landmarks.json");
  QString file = QFileDialog::getSaveFileName(&window_, tr("Save the marks as landmarks"), known,
                                              tr("Landmarks (*.json)"));
  if (file.isEmpty()) return;
  if (QFileInfo(file).suffix().isEmpty()) file += QStringLiteral(".json");
  saveLandmarks(file.toStdString());
}

}  // namespace boresight::ui
