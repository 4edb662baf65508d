// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QString>

#include "ui/window/window_parts.h"

class QDockWidget;
class QMainWindow;
class QWidget;

namespace boresight::ui {

class AnnotationPanel;
class Banner;
class CanvasFrame;
class CasesPanel;
class CompareView;
class ConfigurationPanel;
class FramesPanel;
class ImageAnnotation;
class ImagePanel;
class InputSheetPanel;
class LayersPanel;
class LevelsPanel;
class MaskEditor;
class MaskPanel;
class NudgeGizmo;
class PartsPanel;
class PosePanel;
class QueuePanel;
class RemediesPanel;
class ReviewPanel;
class SceneView;
class StationSnapper;

/// The panels of the window and their docks; Workspaces places the docks. Each dock has an object
/// name, by which its position is stored and by which pictures of it are requested.
class WindowDocks {
 public:
  /// `body` holds the docks; `window` owns objects that are not in `body`.
  WindowDocks(QMainWindow& body, QWidget& window, WindowParts& parts);

  ImagePanel& image;
  CasesPanel& cases;
  ConfigurationPanel& configuration;
  InputSheetPanel& inputs;
  FramesPanel& frames;
  PartsPanel& station_parts;
  PosePanel& poses;
  MaskEditor& mask_editor;
  MaskPanel& mask;
  LevelsPanel& levels;
  AnnotationPanel& annotation;
  QueuePanel& queue;
  ReviewPanel& review;
  StationSnapper& snapper;  ///< for every view
  SceneView& scene;
  ImageAnnotation& image_annotation;
  LayersPanel& layers;
  CompareView& compare;
  NudgeGizmo& gizmo;
  Banner& findings;  ///< above the image: files that are missing or have changed
  RemediesPanel& remedies;
  CanvasFrame& canvas;  ///< round the image

  /// In the order in which menus list them.
  const std::vector<QDockWidget*>& all() const { return docks_; }
  /// The dock that holds a panel.
  QDockWidget& dockOf(const QWidget& panel) const;

 private:
  void linkViews(WindowParts& parts);
  void add(const char* name, const char* title, QWidget* widget);

  QMainWindow& body_;
  std::vector<QDockWidget*> docks_;
};

}  // namespace boresight::ui
