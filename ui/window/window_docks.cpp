// SPDX-License-Identifier: Apache-2.0
#include "ui/window/window_docks.h"

#include <QtWidgets>

#include "ui/annotation/ambiguity_view.h"
#include "ui/annotation/annotation_panel.h"
#include "ui/annotation/image_annotation.h"
#include "ui/annotation/station_snapper.h"
#include "ui/panels/cases_panel.h"
#include "ui/panels/configuration_panel.h"
#include "ui/panels/history_panel.h"
#include "ui/panels/hypotheses_panel.h"
#include "ui/panels/input_sheet_panel.h"
#include "ui/panels/iterations_panel.h"
#include "ui/panels/levels_panel.h"
#include "ui/panels/mask_panel.h"
#include "ui/panels/match_inspector_panel.h"
#include "ui/panels/nudge_gizmo.h"
#include "ui/panels/pose_panel.h"
#include "ui/panels/runs_panel.h"
#include "ui/panels/widgets.h"
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
#include "ui/window/case_controller.h"

namespace boresight::ui {
namespace {

constexpr double kCasesShare = 0.20;  // of the window's width
constexpr double kRightShare = 0.30;
constexpr double kBottomShare = 0.34;  // of its height
constexpr double kSceneShare = 0.40;

QString windowText(const char* text) { return QMainWindow::tr(text); }

}  // namespace

WindowDocks::WindowDocks(QMainWindow& window, const WindowParts& parts)
    : image(*new ImagePanel(parts.state, parts.tasks)),
      cases(*new CasesPanel),
      configuration(*new ConfigurationPanel(parts.state)),
      inputs(*new InputSheetPanel),
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
      warnings(*new Banner),
      findings(*new Banner),
      window_(window) {
  window_.setDockOptions(QMainWindow::AnimatedDocks | QMainWindow::AllowNestedDocks |
                         QMainWindow::AllowTabbedDocks);
  // Tables of poses and options are long, the one of iterations is wide.
  window_.setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  auto* ambiguity = new AmbiguityView(parts.annotation, parts.state, snapper);
  QObject::connect(ambiguity, &AmbiguityView::otherRequested, &poses.nudgeController(),
                   &NudgeController::setPose);
  annotation.addBeside(ambiguity);
  scene.setAnnotation(parts.annotation, snapper);
  linkViews(parts);
  buildCentre();
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
  add(QStringLiteral("history"), windowText("History"), new HistoryPanel(parts.document));
  auto* runs = new RunsPanel(parts.document, parts.state);
  add(QStringLiteral("runs"), windowText("Runs"), runs);
  QObject::connect(runs, &RunsPanel::openRequested, &parts.cases, &CaseController::showRun);
  QObject::connect(runs, &RunsPanel::compareRequested, &compare, &CompareView::showRun);
  add(QStringLiteral("onboard"), windowText("Onboard"),
      new OnboardPanel(parts.onboard, parts.state, parts.run));
  place();
}

/// What is pointed at in one view is marked in the other.
void WindowDocks::linkViews(const WindowParts& parts) {
  QObject::connect(&image, &ImagePanel::stationPlaceHovered, &scene, &SceneView::showStationPlace);
  QObject::connect(&scene, &SceneView::stationPlaceHovered, &image, &ImagePanel::showStationPlace);
  QObject::connect(&image, &ImagePanel::templateClicked, &image,
                   [this] { raise(QStringLiteral("inspector")); });
  QObject::connect(&image, &ImagePanel::allLayersRequested, &image, [this] {
    layers.showAll();
    raise(QStringLiteral("layers"));
  });
  image.tools().addAction(&gizmo.action());
  image.setBeside(&compare);
  QObject::connect(&parts.onboard, &OnboardController::changed, &compare,
                   [this, &onboard = parts.onboard] {
                     compare.setOnboardRun(onboard.review() ? onboard.review()->replay : nullptr);
                   });
}

void WindowDocks::buildCentre() {
  warnings.setAction(windowText("Inputs"), windowText("Show the inputs' properties and warnings"));
  findings.setAction(
      windowText("Fix ..."),
      windowText("Search missing files below the session's folder, or accept changed files"));
  for (Banner* each : {&warnings, &findings}) each->showWarnings({});
  auto* centre = new QWidget;
  auto* column = new QVBoxLayout(centre);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(&findings);
  column->addWidget(&warnings);
  column->addWidget(&image, 1);
  window_.setCentralWidget(centre);
}

QDockWidget* WindowDocks::dock(const QString& name) const {
  return window_.findChild<QDockWidget*>(name);
}

void WindowDocks::raise(const QString& name) const {
  QDockWidget* found = dock(name);
  if (!found) return;
  found->show();
  found->raise();
}

void WindowDocks::arrange() const {
  place();
  giveSizes();
}

void WindowDocks::place() const {
  for (QDockWidget* each : docks_) each->setFloating(false);
  QDockWidget* layers_dock = dock(QStringLiteral("layers"));
  QDockWidget* iterations = dock(QStringLiteral("iterations"));
  window_.addDockWidget(Qt::LeftDockWidgetArea, dock(QStringLiteral("cases")));
  window_.addDockWidget(Qt::RightDockWidgetArea, dock(QStringLiteral("scene")));
  window_.addDockWidget(Qt::RightDockWidgetArea, layers_dock);
  // As many as can be named at 1280 pixels.
  for (const char* name : {"mask", "levels", "pose", "configuration"})
    window_.tabifyDockWidget(layers_dock, dock(QLatin1String(name)));
  window_.addDockWidget(Qt::BottomDockWidgetArea, iterations);
  for (const char* name : {"hypotheses", "inspector", "annotation", "review", "queue", "onboard",
                           "inputs", "history", "runs"})
    window_.tabifyDockWidget(iterations, dock(QLatin1String(name)));
  for (QDockWidget* each : docks_) each->show();
  layers_dock->raise();
  iterations->raise();
}

void WindowDocks::giveSizes() const {
  window_.layout()->activate();  // as minimum sizes are now
  QDockWidget* iterations = dock(QStringLiteral("iterations"));
  const int width = window_.width();
  const int height = window_.height();
  window_.resizeDocks(
      {dock(QStringLiteral("cases")), dock(QStringLiteral("layers"))},
      {static_cast<int>(kCasesShare * width), static_cast<int>(kRightShare * width)},
      Qt::Horizontal);
  window_.resizeDocks(
      {iterations, dock(QStringLiteral("scene"))},
      {static_cast<int>(kBottomShare * height), static_cast<int>(kSceneShare * height)},
      Qt::Vertical);
}

void WindowDocks::add(const QString& name, const QString& title, QWidget* widget) {
  auto* result = new QDockWidget(title, &window_);
  result->setObjectName(name);
  result->setWidget(widget);
  docks_.push_back(result);
}

}  // namespace boresight::ui
