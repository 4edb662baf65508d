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
class ConfigurationPanel;
class ImageAnnotation;
class ImagePanel;
class InputSheetPanel;
class LevelsPanel;
class MaskEditor;
class MaskPanel;
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

  ImagePanel& image() const { return *image_; }
  CasesPanel& cases() const { return *cases_; }
  ConfigurationPanel& configuration() const { return *configuration_; }
  InputSheetPanel& inputs() const { return *inputs_; }
  PosePanel& poses() const { return *poses_; }
  MaskEditor& maskEditor() const { return *mask_editor_; }
  MaskPanel& mask() const { return *mask_; }
  LevelsPanel& levels() const { return *levels_; }
  AnnotationPanel& annotation() const { return *annotation_; }
  QueuePanel& queue() const { return *queue_; }
  ReviewPanel& review() const { return *review_; }
  /// What of the current case's mesh can be snapped to, for every view.
  StationSnapper& snapper() const { return *snapper_; }
  SceneView& scene() const { return *scene_; }
  ImageAnnotation& imageAnnotation() const { return *image_annotation_; }
  /// Above the image: what looks wrong with the case's inputs.
  Banner& warnings() const { return *warnings_; }
  /// The same for files that are missing or have changed.
  Banner& findings() const { return *findings_; }
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
  void place() const;
  QDockWidget* dock(const QString& name) const;
  void add(const QString& name, const QString& title, QWidget* widget);

  QMainWindow& window_;
  std::vector<QDockWidget*> docks_;
  ImagePanel* image_;
  CasesPanel* cases_;
  ConfigurationPanel* configuration_;
  InputSheetPanel* inputs_;
  PosePanel* poses_;
  MaskEditor* mask_editor_;
  MaskPanel* mask_;
  LevelsPanel* levels_;
  AnnotationPanel* annotation_;
  QueuePanel* queue_;
  ReviewPanel* review_;
  StationSnapper* snapper_;
  SceneView* scene_;
  ImageAnnotation* image_annotation_;
  Banner* warnings_;
  Banner* findings_;
};

}  // namespace boresight::ui
