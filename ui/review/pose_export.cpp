// SPDX-License-Identifier: Apache-2.0
#include "ui/review/pose_export.h"

#include <QAction>
#include <QFileDialog>
#include <QFileInfo>
#include <QMenu>

#include "sessions/review/standing.h"
#include "sessions/review/validated_pose_file.h"
#include "ui/models/number_text.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"

namespace boresight::ui {
namespace {

QString nameOf(const std::filesystem::path& file) {
  return QString::fromStdString(file.filename().string());
}

}  // namespace

PoseExport::PoseExport(QWidget& window, Document& document, ViewState& state, TaskRunner& tasks)
    : QObject(&window), window_(window), document_(document), state_(state), tasks_(tasks) {}

void PoseExport::addTo(QMenu& menu) {
  QAction* pose = menu.addAction(tr("&Pose for hand-over..."), this, &PoseExport::askForPose);
  pose->setStatusTip(
      tr("The shown case's pose with its checks, who decided on it and where it "
         "comes from, as JSON"));
  connect(&menu, &QMenu::aboutToShow, &menu, [this, pose] { pose->setEnabled(!caseId().empty()); });
}

std::string PoseExport::caseId() const {
  const ViewState::CasePtr& one = state_.currentCase();
  return one && document_.session().findCase(one->source.id) ? one->source.id : std::string();
}

bool PoseExport::isValidated() const {
  return sessions::standingOf(document_.session(), caseId()).state ==
         sessions::CaseStanding::kValidated;
}

QString PoseExport::standing() const {
  return fromText(sessions::standingText(sessions::standingOf(document_.session(), caseId())));
}

QString PoseExport::poseFileName() const {
  return isValidated() ? QStringLiteral("validated_pose.json")
                       : QStringLiteral("pose_NOT_VALIDATED.json");
}

/// Where people look for what belongs to the session.
QString PoseExport::inSessionFolder(const QString& name) const {
  return QString::fromStdString(document_.file().parent_path().string()) + QLatin1Char('/') + name;
}

/// Inputs are hashed and a trace is read: off this thread.
void PoseExport::exportPose(const std::filesystem::path& file) {
  tasks_.start(
      QStringLiteral("export pose"),
      [file, session = document_.session(), id = caseId()](const std::stop_token&) {
        const sessions::HandedPose pose = sessions::handedPose(session, id);
        sessions::writeValidatedPose(file, session, pose);
        return pose.standing;
      },
      [this, file, id = fromText(caseId())](const std::string& standing) {
        Q_EMIT noted(
            tr("Pose of %1 written to %2. It is %3.").arg(id, nameOf(file), fromText(standing)));
      });
}

void PoseExport::askForPose() {
  if (caseId().empty()) return;
  QString file = QFileDialog::getSaveFileName(
      &window_, tr("Pose of %1 (%2)").arg(fromText(caseId()), standing()),
      inSessionFolder(poseFileName()), tr("Pose (*.json)"));
  if (file.isEmpty()) return;
  if (QFileInfo(file).suffix().isEmpty()) file += QStringLiteral(".json");
  exportPose(file.toStdString());
}

}  // namespace boresight::ui
