// SPDX-License-Identifier: Apache-2.0
#include "ui/window/window_docks.h"

#include <algorithm>

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

WindowDocks::WindowDocks(QMainWindow& body, QWidget& window, WindowParts& parts)
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
  image.setSurfaceAt([&one = snapper](const Camera& camera, const Pose& camera_from_station,
                                      const Eigen::Vector2d& pixel) {
    return one.surfaceAt(camera, camera_from_station, pixel);
  });
  linkViews(parts);
  findings.setAction(
      windowText("Fix ..."),
      windowText("Search missing files below the session's folder, or accept changed files"));
  findings.showWarnings({});
  add("cases", "Cases", &cases);
  add("layers", "Layers", &layers);
  add("mask", "Mask", &mask);
  add("levels", "Levels", &levels);
  add("pose", "Pose", &poses);
  add("configuration", "Configuration", &configuration);
  add("scene", "Scene", &scene);
  add("iterations", "Iterations", new IterationsPanel(parts.state));
  add("hypotheses", "Hypotheses", new HypothesesPanel(parts.state));
  add("inspector", "Match inspector", new MatchInspectorPanel(parts.state));
  add("annotation", "Annotation", &annotation);
  add("review", "Review", &review);
  add("queue", "Queue", &queue);
  add("inputs", "Inputs", &inputs);
  add("closeUps", "Close-ups", new CloseUpsPanel(image, parts.state));
  add("parts", "Parts", &station_parts);
  add("frames", "Frames", &frames);
  add("calibration", "Calibration", new CalibrationPanel(parts.document, parts.state, parts.tasks));
  add("result", "Result", new ResultPanel(parts.state, parts.quality));
  add("remedies", "What may help", &remedies);
  add("onboard", "Onboard", new OnboardPanel(parts.onboard, parts.state, parts.run));
  add("history", "History", new HistoryPanel(parts.document));
  auto* trends = new TrendsPanel(parts.document);
  add("trends", "Trends", trends);
  QObject::connect(trends, &TrendsPanel::openRequested, &parts.cases, &CaseController::chooseCase);
  auto* runs = new RunsPanel(parts.document, parts.state);
  add("runs", "Runs", runs);
  QObject::connect(runs, &RunsPanel::openRequested, &parts.cases, &CaseController::showRun);
  QObject::connect(runs, &RunsPanel::compareRequested, &compare, &CompareView::showRun);
}

/// What is pointed at in one view is marked in the other.
void WindowDocks::linkViews(WindowParts& parts) {
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

QDockWidget& WindowDocks::dockOf(const QWidget& panel) const {
  return **std::ranges::find_if(
      docks_, [&panel](const QDockWidget* dock) { return dock->isAncestorOf(&panel); });
}

void WindowDocks::add(const char* name, const char* title, QWidget* widget) {
  auto* result = named(new QDockWidget(windowText(title), &body_), name);
  result->setWidget(new PanelArea(widget));
  docks_.push_back(result);
}

}  // namespace boresight::ui
