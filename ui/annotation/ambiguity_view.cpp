// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/ambiguity_view.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <QtWidgets>

#include "sessions/annotation/edge_band.h"
#include "ui/annotation/annotation_content.h"
#include "ui/views/display_image.h"

namespace boresight::ui {
namespace {

constexpr double kRoundAnnotations = 0.35;  // of the annotations' box, round it
constexpr double kLeastSide_px = 64;        // px of the image
constexpr double kStep_px = 4.0;

QRectF areaOf(const sessions::Annotations& annotations) {
  QRectF box;
  for (const sessions::PointPair& point : annotations.points)
    if (point.used()) box |= QRectF(point.pixel->x() - 0.5, point.pixel->y() - 0.5, 1.0, 1.0);
  const double side = std::max(
      (1.0 + 2.0 * kRoundAnnotations) * std::max(box.width(), box.height()), kLeastSide_px);
  return {box.center().x() - 0.5 * side, box.center().y() - 0.5 * side, side, side};
}

}  // namespace

AmbiguityView::AmbiguityView(AnnotationController& controller, ViewState& state,
                             StationSnapper& snapper, QWidget* parent)
    : QWidget(parent), controller_(controller), state_(state), snapper_(snapper) {
  ui_.setupUi(this);
  setObjectName(QStringLiteral("ambiguityView"));
  for (ImageView* view : pictures()) {
    LayerStyle band = view->layer(LayerId::kAnnotationBand).style;
    band.visible = true;
    view->setStyle(LayerId::kAnnotationBand, band);
  }
  connect(ui_.showOtherPose, &QPushButton::clicked, this, [this] {
    if (const auto pose = other()) Q_EMIT otherRequested(*pose);
  });
  connect(&controller_, &AnnotationController::solutionChanged, this, &AmbiguityView::showSolution);
  connect(&snapper_, &StationSnapper::meshChanged, this, &AmbiguityView::showSolution);
  showSolution();
}

std::optional<Pose> AmbiguityView::other() const {
  const auto& solution = controller_.solution();
  return solution ? solution->ambiguous_camera_from_station() : std::nullopt;
}

void AmbiguityView::showSolution() {
  const auto pose = controller_.solvedPose();
  const auto other_pose = other();
  setVisible(pose && other_pose);
  if (!pose || !other_pose || !state_.currentCase()) return;
  const sessions::AnnotationsSolution& solution = *controller_.solution()->result.solution;
  ui_.oursCaption->setText(tr("this: %1 px rms").arg(QString::number(solution.rms_px, 'f', 3)));
  ui_.otherCaption->setText(
      tr("other: %1 px rms").arg(QString::number(solution.ambiguous->rms_px, 'f', 3)));
  const sessions::Annotations& annotations =
      controller_.solution()->annotations.views.front().annotations;
  area_ = areaOf(annotations);
  const AnnotationLook look = {{}, {}, state_.currentCase()->source.camera, *pose};
  showImage();
  for (ImageView* view : pictures())
    view->setPart(LayerId::kPoints, &Layer::marks, annotationSigns(annotations, look));
  zoomToAnnotations();
  if (snapper_.mesh()) drawEdges({*pose, *other_pose});
}

/// Once for a case, without the edges of another.
void AmbiguityView::showImage() {
  if (image_of_.lock() == state_.currentCase()) return;
  image_of_ = state_.currentCase();
  const QImage gray = grayImage(state_.currentCase()->image.view());
  for (ImageView* view : pictures()) {
    view->setImage(gray);
    view->setPart(LayerId::kAnnotationBand, &Layer::marks, {});
  }
}

void AmbiguityView::drawEdges(const std::array<Pose, 2>& camera_from_station) {
  using Edges = std::array<std::vector<sessions::BandPiece>, 2>;
  runner_.replace(
      drawing_,
      [mesh = snapper_.mesh(), camera = state_.currentCase()->source.camera,
       camera_from_station](const std::stop_token&) {
        Edges edges;
        for (std::size_t i = 0; i < edges.size(); ++i)
          edges[i] =
              sessions::edgeBand(*mesh, camera, camera_from_station[i], Matrix6d::Zero(), kStep_px);
        return edges;
      },
      [this](const Edges& edges) {
        for (std::size_t i = 0; i < edges.size(); ++i)
          pictures()[i]->setPart(LayerId::kAnnotationBand, &Layer::marks, bandSigns(edges[i]));
      },
      [this](const QString& message) { ui_.otherCaption->setText(message); });
}

void AmbiguityView::zoomToAnnotations() {
  for (ImageView* view : pictures()) {
    ViewTransform transform;
    transform.zoomAt({}, std::min(view->width(), view->height()) / area_.width());
    transform.centreOn(area_.center(), view->size());
    view->setTransform(transform);
  }
}

void AmbiguityView::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  if (!area_.isEmpty()) zoomToAnnotations();
}

}  // namespace boresight::ui
