// SPDX-License-Identifier: Apache-2.0
#include "ui/window/panel_links.h"

#include <string>
#include <utility>
#include <vector>

#include <QtWidgets>

#include "sessions/session/case_frames.h"
#include "sessions/session/input_sheet.h"
#include "sessions/session/stated_inputs.h"
#include "ui/annotation/annotation_panel.h"
#include "ui/models/text.h"
#include "ui/panels/case/cases_panel.h"
#include "ui/panels/case/frames_panel.h"
#include "ui/panels/case/input_sheet_panel.h"
#include "ui/panels/case/parts_panel.h"
#include "ui/panels/diagnose/configuration_panel.h"
#include "ui/panels/run/nudge_gizmo.h"
#include "ui/panels/run/pose_panel.h"
#include "ui/review/queue_panel.h"
#include "ui/run/pose_renderer.h"
#include "ui/run/run_controller.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/widgets/widgets.h"
#include "ui/window/case_controller.h"
#include "ui/window/case_details.h"
#include "ui/window/window_docks.h"

namespace boresight::ui {

QueueLinks::QueueLinks(WindowParts& parts, const WindowDocks& docks, QObject* parent)
    : QObject(parent), parts_(parts) {
  connect(&docks.queue, &QueuePanel::openRequested, this,
          [this](const QString& id, const QString& digest, int iteration) {
            parts_.cases.chooseCase(id);
            wanted_ = Place{parts_.state.opening(), digest.toStdString(), iteration};
            goThere();
          });
  connect(&docks.dockOf(docks.queue), &QDockWidget::visibilityChanged, &docks.queue,
          &QueuePanel::setInSight);
  parts_.state.onChange(ViewChange::kSnapshot, this, &QueueLinks::goThere);
}

/// As soon as the case is shown with its run. Another run of it that is shown stays as it is.
void QueueLinks::goThere() {
  const ViewState::SnapshotPtr& run = parts_.state.snapshot();
  if (!wanted_ || !run || wanted_->opening != parts_.state.opening()) return;
  const Place place = *wanted_;
  wanted_.reset();
  const int count = static_cast<int>(run->iterations.size());
  const bool exists = run->digest == place.run_digest && place.iteration < count;
  parts_.state.setCursor(
      {exists && place.iteration >= 0 ? place.iteration : count - 1, Stage::kFinished});
}

PanelLinks::PanelLinks(WindowParts& parts, const WindowDocks& docks, QObject* parent)
    : QObject(parent),
      parts_(parts),
      docks_(docks),
      details_(new CaseDetails(parts.tasks, this)),
      nudged_(new PoseRenderer(this)),
      rows_(caseRowWork(), [this](const std::vector<std::size_t>* places) {
        if (!places) return showCases();
        for (const std::size_t place : *places)
          if (rows_.isCurrent(place)) showCase(place);  // a row that is out of date stays shown
      }) {
  linkCases();
  linkConfiguration();
  linkPoses();
  linkFrames();
  parts_.state.onChange(ViewChange::kCase, this, &PanelLinks::showInputs);
  connect(&docks_.inputs, &InputSheetPanel::sigmasRequested, this, &PanelLinks::askForSigmas);
  connect(&docks_.inputs, &InputSheetPanel::judgementRequested, this, &PanelLinks::askForJudgement);
}

void PanelLinks::linkCases() {
  CasesPanel& panel = docks_.cases;
  CaseController& cases = parts_.cases;
  connect(&panel, &CasesPanel::openRequested, &cases, &CaseController::chooseCase);
  connect(&panel, &CasesPanel::runRequested, this,
          [this](const QString& id) { parts_.cases.runAll({id}); });
  connect(&panel, &CasesPanel::runAllRequested, &cases, &CaseController::runAll);
  parts_.state.onChange(ViewChange::kOtherCase, this, [this] {
    const QString id = parts_.cases.caseId();
    showWorking();
    docks_.cases.setCurrent(id);
    docks_.queue.setCurrent(id);
  });
  const auto document_shown = [this] {
    details_->setSession(parts_.document.session());
    rows_.follow(parts_.document.session());
  };
  connect(&parts_.document, &Document::opened, this, [this] {
    rows_.clear();
    showCases();  // what follows shows nothing where the session has no case
  });
  connectEach(parts_.document, this, document_shown, &Document::opened, &Document::changed);
  connect(details_, &CaseDetails::changed, this, [this](const std::set<std::string>& ids) {
    for (const std::string& id : ids) showCase(rows_.placeOf(id));
  });
  connect(&parts_.run, &RunController::stateChanged, this, &PanelLinks::showWorking);
  connect(&cases, &CaseController::batchChanged, this, &PanelLinks::showWorking);
  rows_.setActive(true);
}

void PanelLinks::linkConfiguration() {
  ConfigurationPanel& panel = docks_.configuration;
  connect(&panel, &ConfigurationPanel::optionsEdited, &parts_.cases, &CaseController::setOptions);
  connect(&panel, &ConfigurationPanel::runAgainRequested, &parts_.cases, &CaseController::runAgain);
  connectEach(parts_.document, this, &PanelLinks::showConfiguration, &Document::opened,
              &Document::changed);
}

void PanelLinks::linkPoses() {
  CaseController* cases = &parts_.cases;
  const NudgeController* nudge = &docks_.poses.nudgeController();
  connect(nudge, &NudgeController::useAsSeedRequested, cases, &CaseController::useAsSeed);
  connect(&docks_.annotation, &AnnotationPanel::openCaseRequested, cases,
          &CaseController::chooseCase);
  connect(&docks_.annotation, &AnnotationPanel::imageRequested, this,
          [this] { docks_.image.view().setFocus(); });
  connect(nudge, &NudgeController::gestureFinished, cases, &CaseController::keepNudgedPose);
  parts_.state.onChange(ViewChange::kCase, this, &PanelLinks::showJudgement);
  parts_.state.onChange(ViewChange::kNudgedPose, this, &PanelLinks::showNudgedPose);
  connect(nudged_, &PoseRenderer::rendered, &docks_.image, &ImagePanel::setNudgedRender);
}

CaseRow PanelLinks::rowAt(std::size_t place) const {
  CaseRow row = rows_.value(place);
  details_->fill(row);
  if (row.id != running_) return row;
  row.state = CaseState::kRunning;
  row.stale = false;
  return row;
}

void PanelLinks::showCases() {
  std::vector<CaseRow> rows;
  for (std::size_t place = 0; place < rows_.size(); ++place) rows.push_back(rowAt(place));
  docks_.cases.setRows(std::move(rows));
}

void PanelLinks::showCase(std::size_t place) {
  if (place < rows_.size()) docks_.cases.setRow(static_cast<int>(place), rowAt(place));
}

void PanelLinks::showWorking() {
  const auto& batch = parts_.cases.batch();
  const bool working = parts_.cases.isWorking();
  const QString running = batch ? batch->case_id : working ? parts_.cases.caseId() : QString();
  const QString former = std::exchange(running_, running);
  if (former != running)
    for (const QString& id : {former, running}) showCase(rows_.placeOf(id.toStdString()));
  docks_.cases.setRunnable(!working);
}

void PanelLinks::showConfiguration() {
  docks_.configuration.setEnabled(parts_.document.isOpen());  // options are a session's
  try {
    const sessions::Session& session = parts_.document.session();
    docks_.configuration.setOptions(QString::fromStdString(session.profile),
                                    sessions::sessionOptions(session, parts_.document.file()));
    const ViewState::CasePtr& loaded_case = parts_.state.currentCase();
    docks_.configuration.setCaseFeatureSize(
        loaded_case ? loaded_case->source.feature_size_m.value_or(0.0) : 0.0);
  } catch (const std::exception& error) {
    Q_EMIT failed(QString::fromUtf8(error.what()));
  }
}

/// Figures of the inputs take a look at every pixel and face: off this thread.
void PanelLinks::showInputs() {
  const ViewState::CasePtr loaded_case = parts_.state.currentCase();
  docks_.inputs.setSheet(std::nullopt);
  Q_EMIT warningsChanged({});
  showConfiguration();
  if (!loaded_case) return;
  parts_.tasks.replace(
      describing_,
      [loaded_case](const std::stop_token&) { return sessions::inputSheet(*loaded_case); },
      [this, loaded_case](sessions::InputSheet sheet) {
        if (loaded_case != parts_.state.currentCase()) return;
        QStringList flags;
        for (const sessions::RedFlag& flag : sheet.flags) flags << fromText(flag.text);
        Q_EMIT warningsChanged(flags);
        docks_.inputs.setSheet(std::move(sheet));
      },
      reportTo(this, &PanelLinks::failed));
}

/// Whether the case that a dialog was opened for is still open; tells where it is not.
bool PanelLinks::isStillOpen(const CaseOpening& seen) {
  if (seen == parts_.state.opening()) return true;
  Q_EMIT failed(leftText(seen));
  return false;
}

void PanelLinks::askForSigmas() {
  const sessions::SessionCase* session_case = shownCase(parts_.document, parts_.state);
  if (!session_case) return;
  const std::string id = session_case->id;
  const CaseOpening seen = parts_.state.opening();
  InputSigmasDialog dialog(*session_case, docks_.inputs.window());
  if (dialog.exec() != QDialog::Accepted || !isStillOpen(seen)) return;
  parts_.document.edit(
      sessions::withInputSigmas(parts_.document.session(), id, dialog.meshScaleSigma(),
                                dialog.calibrationSigma()),
      tr("State the uncertainty of mesh and camera of %1").arg(fromText(id)));
}

void PanelLinks::askForJudgement() {
  const sessions::SessionCase* session_case = shownCase(parts_.document, parts_.state);
  if (!session_case) return;
  const std::string id = session_case->id;
  const CaseOpening seen = parts_.state.opening();
  JudgementDialog dialog(*session_case,
                         sessions::requirementOf(parts_.document.session(), *session_case),
                         docks_.inputs.window());
  if (dialog.exec() != QDialog::Accepted || !isStillOpen(seen)) return;
  const auto state = [&dialog](sessions::SessionCase& changed) {
    changed.camera_from_end_effector = dialog.cameraFromEndEffector();
    changed.requirement = dialog.requirement();
  };
  const sessions::Session next = sessions::withChanged(parts_.document.session(), id, state);
  parts_.document.edit(
      sessions::withSymmetries(next, id, dialog.symmetries()),
      tr("State end effector, requirement and symmetries of %1").arg(fromText(id)));
}

void PanelLinks::linkFrames() {
  connect(&docks_.station_parts, &PartsPanel::failed, this, &PanelLinks::failed);
  connect(&docks_.frames, &FramesPanel::addRequested, this, &PanelLinks::addFrames);
  connect(&docks_.frames, &FramesPanel::removeRequested, this,
          [this](const sessions::FrameTransform& transform) {
            const sessions::SessionCase* shown = shownCase(parts_.document, parts_.state);
            if (!shown) return;
            std::vector<sessions::FrameTransform> frames = shown->frames;
            std::erase(frames, transform);
            try {
              parts_.document.edit(
                  sessions::withFrames(parts_.document.session(), shown->id, frames),
                  tr("Remove %1 of %2").arg(fromText(transform.comment), fromText(shown->id)));
            } catch (const std::exception& error) {
              Q_EMIT failed(QString::fromUtf8(error.what()));
            }
          });
}

void PanelLinks::addFrames() {
  const std::string id = shownCaseId(parts_.document, parts_.state);
  if (id.empty()) return;
  const CaseOpening seen = parts_.state.opening();
  const QString file =
      QFileDialog::getOpenFileName(docks_.frames.window(), tr("Add transforms between frames"), {},
                                   tr("Transforms (*.json);;All files (*)"));
  if (file.isEmpty() || !isStillOpen(seen)) return;
  try {
    sessions::StatedInputs stated;
    stated.frames = sessions::readFrameTransforms(std::filesystem::path(file.toStdString()));
    parts_.document.edit(sessions::withStated(parts_.document.session(), id, stated),
                         tr("Add frames to %1").arg(fromText(id)));
  } catch (const std::exception& error) {
    Q_EMIT failed(QString::fromUtf8(error.what()));
  }
}

void PanelLinks::showJudgement() {
  const ViewState::CasePtr& loaded_case = parts_.state.currentCase();
  nudged_->setCase(loaded_case);
  PoseJudgement judgement;
  if (loaded_case) {
    judgement.requirement = loaded_case->source.requirement;
    judgement.truth_covariance = loaded_case->source.truth_covariance;
    judgement.comparer = sessions::differenceComparer(*loaded_case);
  }
  docks_.poses.setJudgement(judgement);
}

void PanelLinks::showNudgedPose() {
  if (parts_.state.nudgedPose()) {
    nudged_->setPose(*parts_.state.nudgedPose());
  } else {
    nudged_->clear();
    docks_.image.setNudgedRender(nullptr, 0);
  }
}

}  // namespace boresight::ui
