// SPDX-License-Identifier: Apache-2.0
#include "ui/window/window_docks.h"

#include <QDockWidget>
#include <QMainWindow>

#include "ui/panels/cases_panel.h"
#include "ui/panels/configuration_panel.h"
#include "ui/panels/input_sheet_panel.h"
#include "ui/panels/iterations_panel.h"
#include "ui/panels/match_inspector_panel.h"
#include "ui/panels/pose_panel.h"
#include "ui/views/image_panel.h"
#include "ui/views/layers_panel.h"
#include "ui/vtk/scene_view.h"

namespace boresight::ui {
namespace {

QString tr(const char* text) { return QMainWindow::tr(text); }

}  // namespace

WindowDocks::WindowDocks(QMainWindow& window, const WindowParts& parts)
    : window_(window),
      image_(new ImagePanel(parts.state, parts.tasks)),
      cases_(new CasesPanel),
      configuration_(new ConfigurationPanel(parts.state)),
      inputs_(new InputSheetPanel),
      poses_(new PosePanel(parts.state)) {
  window_.setDockOptions(QMainWindow::AnimatedDocks | QMainWindow::AllowNestedDocks |
                         QMainWindow::AllowTabbedDocks);
  window_.setCentralWidget(image_);
  add(QStringLiteral("cases"), tr("Cases"), cases_, Qt::LeftDockWidgetArea);
  QDockWidget* layers = add(QStringLiteral("layers"), tr("Layers"), new LayersPanel(*image_),
                            Qt::RightDockWidgetArea);
  QDockWidget* configuration = add(QStringLiteral("configuration"), tr("Configuration"),
                                   configuration_, Qt::RightDockWidgetArea);
  QDockWidget* inputs =
      add(QStringLiteral("inputs"), tr("Inputs"), inputs_, Qt::RightDockWidgetArea);
  QDockWidget* poses = add(QStringLiteral("pose"), tr("Pose"), poses_, Qt::RightDockWidgetArea);
  QDockWidget* scene = add(QStringLiteral("scene"), tr("Scene"), new SceneView(parts.state),
                           Qt::RightDockWidgetArea);
  QDockWidget* iterations = add(QStringLiteral("iterations"), tr("Iterations"),
                                new IterationsPanel(parts.state), Qt::BottomDockWidgetArea);
  QDockWidget* inspector = add(QStringLiteral("inspector"), tr("Match inspector"),
                               new MatchInspectorPanel(parts.state), Qt::BottomDockWidgetArea);
  for (QDockWidget* each : {configuration, inputs, poses, scene})
    window_.tabifyDockWidget(layers, each);
  window_.tabifyDockWidget(iterations, inspector);
  layers->raise();
  iterations->raise();
}

QDockWidget* WindowDocks::add(const QString& name, const QString& title, QWidget* widget,
                              Qt::DockWidgetArea area) {
  auto* made = new QDockWidget(title, &window_);
  made->setObjectName(name);
  made->setWidget(widget);
  window_.addDockWidget(area, made);
  docks_.push_back(made);
  return made;
}

}  // namespace boresight::ui
