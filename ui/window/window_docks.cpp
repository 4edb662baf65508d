// SPDX-License-Identifier: Apache-2.0
#include "ui/window/window_docks.h"

#include <QtWidgets>

#include "ui/annotation/ambiguity_view.h"
#include "ui/annotation/annotation_panel.h"
#include "ui/annotation/image_annotation.h"
#include "ui/annotation/station_snapper.h"
#include "ui/panels/annotate/levels_panel.h"
#include "ui/panels/annotate/mask_panel.h"
#include "ui/panels/case/calibration_panel.h"
#include "ui/panels/case/cases_panel.h"
#include "ui/panels/case/frames_panel.h"
#include "ui/panels/case/history_panel.h"
#include "ui/panels/case/input_sheet_panel.h"
#include "ui/panels/case/parts_panel.h"
#include "ui/panels/case/trends_panel.h"
#include "ui/panels/diagnose/configuration_panel.h"
#include "ui/panels/diagnose/hypotheses_panel.h"
#include "ui/panels/diagnose/iterations_panel.h"
#include "ui/panels/diagnose/match_inspector_panel.h"
#include "ui/panels/run/close_ups_panel.h"
#include "ui/panels/run/nudge_gizmo.h"
#include "ui/panels/run/pose_panel.h"
#include "ui/panels/run/runs_panel.h"
#include "ui/review/onboard_controller.h"
#include "ui/review/onboard_panel.h"
#include "ui/review/queue_panel.h"
#include "ui/review/review_panel.h"
#include "ui/scene/scene_view.h"
#include "ui/views/compare_view.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/views/layers_panel.h"
#include "ui/views/mask_editor.h"
#include "ui/widgets/panel_area.h"
#include "ui/widgets/widgets.h"
#include "ui/window/case_controller.h"
#include "ui/workspaces/canvas_frame.h"
#include "ui/workspaces/remedies_panel.h"
#include "ui/workspaces/result_panel.h"

namespace boresight::ui {
namespace {

QString windowText(const char* text) { return QMainWindow::tr(text); }

}  // namespace

WindowDocks::WindowDocks(QMainWindow& body, QWidget& window, const WindowParts& parts)
    : image(*new ImagePanel(parts.state, parts.tasks)),
      cases(*new CasesPanel),
      configuration(*new ConfigurationPanel(parts.state)),
      inputs(*new InputSheetPanel),
      frames(*new FramesPanel(parts.state)),
      station_parts(*new PartsPanel(parts.document, parts.state)),
      poses(*new PosePanel(parts.state)),
      mask_editor(*new MaskEditor(image.view(), &image)),
      mask(*new MaskPanel(mask_editor)),
      levels(*new LevelsPanel(image.display())),
      annotation(*new AnnotationPanel(parts.document, parts.annotation, parts.state)),
      queue(*new QueuePanel(parts.document)),
      review(*new ReviewPanel(parts.document, parts.state)),
      snapper(*new StationSnapper(parts.state, &window)),
      scene(*new SceneView(parts.state)),
      image_annotation(*new ImageAnnotation(image, parts.annotation, parts.state, snapper, &image)),
      layers(*new LayersPanel(image)),
      compare(*new CompareView(image, parts.document, parts.state, parts.tasks)),
      gizmo(*new NudgeGizmo(image.view(), poses.nudgeController(), parts.state, &image)),
      findings(*new Banner),
      remedies(*new RemediesPanel(parts.state)),
      canvas(*new CanvasFrame(image)),
      body_(body) {
  body_.setDockOptions(QMainWindow::AllowNestedDocks | QMainWindow::AllowTabbedDocks);
  auto* ambiguity = new AmbiguityView(parts.annotation, parts.state, snapper);
  QObject::connect(ambiguity, &AmbiguityView::otherRequested, &poses.nudgeController(),
                   &NudgeController::setPose);
  annotation.addBeside(ambiguity);
  scene.setAnnotation(parts.annotation, snapper);
  annotation.setSnapper(snapper);
  linkViews(parts);
  findings.setAction(
      windowText("Fix ..."),
      windowText("Search missing files below the session's folder, or accept changed files"));
  findings.showWarnings({});
  add(QStringLiteral("cases"), windowText("Cases"), &cases);
  add(QStringLiteral("layers"), windowText("Layers"), &layers);
  add(QStringLiteral("mask"), windowText("Mask"), &mask);
  add(QStringLiteral("levels"), windowText("Levels"), &levels);
  add(QStringLiteral("pose"), windowText("Pose"), &poses);
  add(QStringLiteral("configuration"), windowText("Configuration"), &configuration);
  add(QStringLiteral("scene"), windowText("Scene"), &scene);
  add(QStringLiteral("iterations"), windowText("Iterations"), new IterationsPanel(parts.state));
  add(QStringLiteral("hypotheses"), windowText("Hypotheses"), new HypothesesPanel(parts.state));
  add(QStringLiteral("inspector"), windowText("Match inspector"),
      new MatchInspectorPanel(parts.state));
  add(QStringLiteral("annotation"), windowText("Annotation"), &annotation);
  add(QStringLiteral("review"), windowText("Review"), &review);
  add(QStringLiteral("queue"), windowText("Queue"), &queue);
  add(QStringLiteral("inputs"), windowText("Inputs"), &inputs);
  add(QStringLiteral("closeUps"), windowText("Close-ups"), new CloseUpsPanel(image, parts.state));
  add(QStringLiteral("parts"), windowText("Parts"), &station_parts);
  add(QStringLiteral("frames"), windowText("Frames"), &frames);
  add(QStringLiteral("calibration"), windowText("Calibration"),
      new CalibrationPanel(parts.document, parts.state, parts.tasks));
  add(QStringLiteral("result"), windowText("Result"), new ResultPanel(parts.state, parts.quality));
  add(QStringLiteral("remedies"), windowText("What may help"), &remedies);
  add(QStringLiteral("onboard"), windowText("Onboard"),
      new OnboardPanel(parts.onboard, parts.state, parts.run));
  add(QStringLiteral("history"), windowText("History"), new HistoryPanel(parts.document));
  auto* trends = new TrendsPanel(parts.document);
  add(QStringLiteral("trends"), windowText("Trends"), trends);
  QObject::connect(trends, &TrendsPanel::openRequested, &parts.cases, &CaseController::chooseCase);
  auto* runs = new RunsPanel(parts.document, parts.state);
  add(QStringLiteral("runs"), windowText("Runs"), runs);
  QObject::connect(runs, &RunsPanel::openRequested, &parts.cases, &CaseController::showRun);
  QObject::connect(runs, &RunsPanel::compareRequested, &compare, &CompareView::showRun);
}

/// What is pointed at in one view is marked in the other.
void WindowDocks::linkViews(const WindowParts& parts) {
  QObject::connect(&image, &ImagePanel::stationPlaceHovered, &scene, &SceneView::showStationPlace);
  QObject::connect(&scene, &SceneView::stationPlaceHovered, &image, &ImagePanel::showStationPlace);
  image.tools().addAction(&gizmo.action());
  auto* frame = new CanvasFrame(compare);
  compare.show();  // as soon as its frame is
  image.setBeside(frame);
  QObject::connect(&compare, &CompareView::chosen, frame, [frame](bool onboard_run) {
    frame->setSource(onboard_run ? CanvasSource::kOnboard : CanvasSource::kOnly);
  });
  QObject::connect(&parts.onboard, &OnboardController::changed, &compare,
                   [this, &onboard = parts.onboard] {
                     compare.setOnboardRun(onboard.review() ? onboard.review()->replay : nullptr);
                   });
}

void WindowDocks::add(const QString& name, const QString& title, QWidget* widget) {
  auto* result = new QDockWidget(title, &body_);
  result->setObjectName(name);
  result->setWidget(new PanelArea(widget));
  docks_.push_back(result);
}

}  // namespace boresight::ui
