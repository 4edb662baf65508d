// SPDX-License-Identifier: Apache-2.0
#include "ui/window/window_docks.h"

#include <QtWidgets>

#include "ui/annotation/ambiguity_view.h"
#include "ui/annotation/annotation_panel.h"
#include "ui/annotation/image_annotation.h"
#include "ui/annotation/station_snapper.h"
#include "ui/panels/banner.h"
#include "ui/panels/cases_panel.h"
#include "ui/panels/configuration_panel.h"
#include "ui/panels/hypotheses_panel.h"
#include "ui/panels/input_sheet_panel.h"
#include "ui/panels/iterations_panel.h"
#include "ui/panels/levels_panel.h"
#include "ui/panels/mask_panel.h"
#include "ui/panels/match_inspector_panel.h"
#include "ui/panels/pose_panel.h"
#include "ui/review/onboard_panel.h"
#include "ui/review/queue_panel.h"
#include "ui/review/review_panel.h"
#include "ui/scene/scene_view.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/views/layers_panel.h"
#include "ui/views/mask_editor.h"

namespace boresight::ui {
namespace {

constexpr double kCasesShare = 0.20;  // of the window's width
constexpr double kRightShare = 0.30;
constexpr double kBottomShare = 0.34;  // of its height
constexpr double kSceneShare = 0.40;

QString windowText(const char* text) { return QMainWindow::tr(text); }

}  // namespace

WindowDocks::WindowDocks(QMainWindow& window, const WindowParts& parts)
    : window_(window),
      image_(new ImagePanel(parts.state, parts.tasks)),
      cases_(new CasesPanel),
      configuration_(new ConfigurationPanel(parts.state)),
      inputs_(new InputSheetPanel),
      poses_(new PosePanel(parts.state)),
      mask_editor_(new MaskEditor(image_->view(), image_)),
      mask_(new MaskPanel(*mask_editor_)),
      levels_(new LevelsPanel(image_->display())),
      annotation_(new AnnotationPanel(parts.document, parts.annotation, parts.state)),
      queue_(new QueuePanel(parts.document)),
      review_(new ReviewPanel(parts.document, parts.state)),
      snapper_(new StationSnapper(parts.state, &window)),
      scene_(new SceneView(parts.state)),
      image_annotation_(
          new ImageAnnotation(*image_, parts.annotation, parts.state, *snapper_, image_)),
      warnings_(new Banner),
      findings_(new Banner) {
  window_.setDockOptions(QMainWindow::AnimatedDocks | QMainWindow::AllowNestedDocks |
                         QMainWindow::AllowTabbedDocks);
  // Tables of poses and options are long, the one of iterations is wide.
  window_.setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  auto* ambiguity = new AmbiguityView(parts.annotation, parts.state, *snapper_);
  QObject::connect(ambiguity, &AmbiguityView::otherRequested, &poses_->nudgeController(),
                   &NudgeController::setPose);
  annotation_->addBeside(ambiguity);
  scene_->setAnnotation(parts.annotation, *snapper_);
  buildCentre();
  add(QStringLiteral("cases"), windowText("Cases"), cases_);
  add(QStringLiteral("layers"), windowText("Layers"), new LayersPanel(*image_));
  add(QStringLiteral("mask"), windowText("Mask"), mask_);
  add(QStringLiteral("levels"), windowText("Levels"), levels_);
  add(QStringLiteral("pose"), windowText("Pose"), poses_);
  add(QStringLiteral("configuration"), windowText("Configuration"), configuration_);
  add(QStringLiteral("scene"), windowText("Scene"), scene_);
  add(QStringLiteral("iterations"), windowText("Iterations"), new IterationsPanel(parts.state));
  add(QStringLiteral("hypotheses"), windowText("Hypotheses"), new HypothesesPanel(parts.state));
  add(QStringLiteral("inspector"), windowText("Match inspector"),
      new MatchInspectorPanel(parts.state));
  add(QStringLiteral("annotation"), windowText("Annotation"), annotation_);
  add(QStringLiteral("review"), windowText("Review"), review_);
  add(QStringLiteral("queue"), windowText("Queue"), queue_);
  add(QStringLiteral("inputs"), windowText("Inputs"), inputs_);
  add(QStringLiteral("onboard"), windowText("Onboard"),
      new OnboardPanel(parts.onboard, parts.state, parts.run));
  place();
}

void WindowDocks::buildCentre() {
  warnings_->setAction(windowText("Inputs"), windowText("Show all that is known of the inputs"));
  findings_->setAction(windowText("Fix ..."),
                       windowText("Look for missing files below the session's folder, or take "
                                  "changed ones as they are"));
  for (Banner* each : {warnings_, findings_}) each->showWarnings({});
  auto* centre = new QWidget;
  auto* column = new QVBoxLayout(centre);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(findings_);
  column->addWidget(warnings_);
  column->addWidget(image_, 1);
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
  QDockWidget* cases = dock(QStringLiteral("cases"));
  QDockWidget* scene = dock(QStringLiteral("scene"));
  QDockWidget* layers = dock(QStringLiteral("layers"));
  QDockWidget* iterations = dock(QStringLiteral("iterations"));
  window_.addDockWidget(Qt::LeftDockWidgetArea, cases);
  window_.addDockWidget(Qt::RightDockWidgetArea, scene);
  window_.addDockWidget(Qt::RightDockWidgetArea, layers);
  // As many as can be named at 1280 pixels.
  for (const char* name : {"mask", "levels", "pose", "configuration"})
    window_.tabifyDockWidget(layers, dock(QLatin1String(name)));
  window_.addDockWidget(Qt::BottomDockWidgetArea, iterations);
  for (const char* name :
       {"hypotheses", "inspector", "annotation", "review", "queue", "onboard", "inputs"})
    window_.tabifyDockWidget(iterations, dock(QLatin1String(name)));
  for (QDockWidget* each : docks_) each->show();
  layers->raise();
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
  auto* made = new QDockWidget(title, &window_);
  made->setObjectName(name);
  made->setWidget(widget);
  docks_.push_back(made);
}

}  // namespace boresight::ui
