// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QObject>

#include "sessions/annotation/edge_band.h"
#include "ui/annotation/annotation_content.h"
#include "ui/annotation/annotation_controller.h"

namespace boresight::ui {

class ImagePanel;
class ImageView;
class Loupe;
class AnnotationTool;
class PoseRenderer;
class StationSnapper;

/// Annotating on the image: the pointer tool, the loupe, and the layers for annotations, residuals,
/// proposals, the solved pose's edges and their band.
class ImageAnnotation : public QObject {
  Q_OBJECT

 public:
  ImageAnnotation(ImagePanel& image, AnnotationController& controller, ViewState& state,
                  StationSnapper& snapper, QObject* parent = nullptr);

  AnnotationTool& tool() { return *tool_; }
  Loupe& loupe() { return *loupe_; }

  /// Magnification of residuals on the image.
  double magnification() const { return magnification_; }
  void setMagnification(double magnification);

 Q_SIGNALS:
  void failed(const QString& message);

 private:
  using Band = std::vector<sessions::BandPiece>;

  void showSamples();
  void showAnnotations();
  void showSolution();
  void hideWhileBlind();
  void askForBand();
  void lookThroughLoupe();
  void paint(QPainter& painter) const;
  QString nextStep() const;
  void paintResidualScale(QPainter& painter, const QPointF& at) const;

  ImagePanel& image_;
  AnnotationController& controller_;
  ViewState& state_;
  StationSnapper& snapper_;
  ImageView& view_;
  AnnotationTool* tool_;
  Loupe* loupe_;
  PoseRenderer* edges_;
  ViewState::CasePtr rendered_case_;
  std::optional<Pose> rendered_pose_;
  AnnotationController::SolutionPtr band_of_;
  double magnification_ = 40.0;
  std::vector<LayerId> hidden_;  ///< while a round is blind
  TaskRunner runner_;
  TaskKind drawing_;  ///< the band
};

}  // namespace boresight::ui
