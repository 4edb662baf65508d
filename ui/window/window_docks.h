// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QString>

#include "ui/window/window_parts.h"

class QDockWidget;
class QMainWindow;

namespace boresight::ui {

class AnnotationPanel;
class Banner;
class CasesPanel;
class CompareView;
class ConfigurationPanel;
class ImageAnnotation;
class ImagePanel;
class InputSheetPanel;
class LayersPanel;
class LevelsPanel;
class MaskEditor;
class MaskPanel;
class NudgeGizmo;
class PosePanel;
class QueuePanel;
class ReviewPanel;
class SceneView;
class StationSnapper;

/// The panels of the window and the docks that they lie in, as they are when the program starts for
/// the first time. Each dock has an object name by which its place is remembered and by which
/// pictures of it are asked for.
class WindowDocks {
 public:
  WindowDocks(QMainWindow& window, const WindowParts& parts);

  ImagePanel& image;
  CasesPanel& cases;
  ConfigurationPanel& configuration;
  InputSheetPanel& inputs;
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
  Banner& warnings;  ///< above the image: what looks wrong with the case's inputs
  Banner& findings;  ///< above the image: files that are missing or have changed

  /// Brings a dock to the front.
  void raise(const QString& name) const;
  /// Every dock where it was when the program started for the first time.
  void arrange() const;
  /// Sizes that suit the window as large as it is now; only once it is shown.
  void giveSizes() const;
  /// In the order in which menus list them.
  const std::vector<QDockWidget*>& all() const { return docks_; }

 private:
  void buildCentre();
  void linkViews(const WindowParts& parts);
  void place() const;
  QDockWidget* dock(const QString& name) const;
  void add(const QString& name, const QString& title, QWidget* widget);

  QMainWindow& window_;
  std::vector<QDockWidget*> docks_;
};

}  // namespace boresight::ui
