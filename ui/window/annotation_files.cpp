// SPDX-License-Identifier: Apache-2.0
#include "ui/window/annotation_files.h"

#include <exception>

#include <QFileDialog>
#include <QFileInfo>

#include "sessions/annotation/landmarks.h"
#include "sessions/annotation/marks_file.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/annotation/annotation_panel.h"
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
    parts_.annotation.setMarks(sessions::readMarks(file),
                               tr("Import marks of %1").arg(nameOf(file)));
    Q_EMIT noted(tr("Marks taken from %1.").arg(nameOf(file)));
  });
}

bool AnnotationFiles::exportMarks(const std::filesystem::path& file) {
  return attempt([&] {
    sessions::writeMarks(file, parts_.annotation.marks());
    Q_EMIT noted(tr("Marks written to %1.").arg(nameOf(file)));
  });
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

void AnnotationFiles::askForImport() {
  const QString file =
      QFileDialog::getOpenFileName(&window_, tr("Import marks"), {}, marksFilter());
  if (!file.isEmpty()) importMarks(file.toStdString());
}

void AnnotationFiles::askForExport() {
  QString file = QFileDialog::getSaveFileName(&window_, tr("Export the marks of this case"),
                                              QStringLiteral("points.json"), marksFilter());
  if (file.isEmpty()) return;
  if (QFileInfo(file).suffix().isEmpty()) file += QStringLiteral(".json");
  exportMarks(file.toStdString());
}

void AnnotationFiles::askForLandmarks() {
  const QString file = QFileDialog::getOpenFileName(&window_, tr("Open landmarks of the station"),
                                                    {}, tr("Landmarks (*.json)"));
  if (!file.isEmpty()) openLandmarks(file.toStdString());
}

void AnnotationFiles::askWhereToSaveLandmarks() {
  const sessions::SessionCase* one = parts_.document.session().findCase(
      parts_.state.currentCase() ? parts_.state.currentCase()->source.id : std::string());
  const QString known = one && one->landmarks ? QString::fromStdString(one->landmarks->string())
                                              : QStringLiteral("landmarks.json");
  QString file = QFileDialog::getSaveFileName(&window_, tr("Save the marks as landmarks"), known,
                                              tr("Landmarks (*.json)"));
  if (file.isEmpty()) return;
  if (QFileInfo(file).suffix().isEmpty()) file += QStringLiteral(".json");
  saveLandmarks(file.toStdString());
}

}  // namespace boresight::ui
