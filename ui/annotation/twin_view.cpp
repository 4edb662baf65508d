// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/twin_view.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <QtWidgets>

#include "sessions/annotation/edge_band.h"
#include "ui/annotation/mark_content.h"
#include "ui/views/display_image.h"

namespace boresight::ui {
namespace {

constexpr double kRoundMarks = 0.35;  // of the marks' box, round it
constexpr double kLeastSide_px = 64;  // px of the image
constexpr double kStep_px = 4.0;

QRectF areaOf(const sessions::Marks& marks) {
  QRectF box;
  for (const sessions::PointPair& point : marks.points)
    if (point.used()) box |= QRectF(point.pixel->x() - 0.5, point.pixel->y() - 0.5, 1.0, 1.0);
  const double side =
      std::max((1.0 + 2.0 * kRoundMarks) * std::max(box.width(), box.height()), kLeastSide_px);
  return {box.center().x() - 0.5 * side, box.center().y() - 0.5 * side, side, side};
}

void setMarks(ImageView& view, LayerId id, std::vector<Mark> marks) {
  Layer layer = view.layer(id);
  layer.style.visible = true;
  layer.marks = std::move(marks);
  view.setLayer(std::move(layer));
}

}  // namespace

TwinView::TwinView(AnnotationController& controller, ViewState& state, StationSnapper& snapper,
                   QWidget* parent)
    : QWidget(parent), controller_(controller), state_(state), snapper_(snapper) {
  ui_.setupUi(this);
  setObjectName(QStringLiteral("twinView"));
  connect(ui_.lookAtTwin, &QPushButton::clicked, this, [this] {
    if (const auto pose = other()) Q_EMIT otherRequested(*pose);
  });
  connect(&controller_, &AnnotationController::solutionChanged, this, &TwinView::showSolution);
  connect(&snapper_, &StationSnapper::meshChanged, this, &TwinView::showSolution);
  showSolution();
}

std::optional<Pose> TwinView::other() const {
  const auto& solution = controller_.solution();
  return solution ? solution->twin_camera_from_station() : std::nullopt;
}

void TwinView::showSolution() {
  const auto pose = controller_.solvedPose();
  const auto twin = other();
  setVisible(pose && twin);
  if (!pose || !twin || !state_.currentCase()) return;
  const sessions::MarksSolution& solution = *controller_.solution()->result.solution;
  ui_.oursCaption->setText(tr("this: %1 px rms").arg(QString::number(solution.rms_px, 'f', 3)));
  ui_.otherCaption->setText(
      tr("other: %1 px rms").arg(QString::number(solution.twin->rms_px, 'f', 3)));
  const sessions::Marks& marks = controller_.solution()->marks.views.front().marks;
  area_ = areaOf(marks);
  const MarkLook look = {{}, {}, state_.currentCase()->source.camera, *pose};
  for (ImageView* view : {ui_.twinOurs, ui_.twinOther}) {
    view->setImage(grayImage(state_.currentCase()->image.view()));
    setMarks(*view, LayerId::kPoints, markSigns(marks, look));
  }
  zoomToMarks();
  if (snapper_.mesh()) drawEdges({*pose, *twin});
}

void TwinView::drawEdges(const std::array<Pose, 2>& camera_from_station) {
  using Edges = std::array<std::vector<sessions::BandPiece>, 2>;
  runner_.start(
      QStringLiteral("draw twins"),
      [mesh = snapper_.mesh(), camera = state_.currentCase()->source.camera,
       camera_from_station](const std::stop_token&) {
        Edges edges;
        for (std::size_t i = 0; i < edges.size(); ++i)
          edges[i] =
              sessions::edgeBand(*mesh, camera, camera_from_station[i], Matrix6d::Zero(), kStep_px);
        return edges;
      },
      [this](const Edges& edges) {
        setMarks(*ui_.twinOurs, LayerId::kAnnotationBand, bandSigns(edges[0]));
        setMarks(*ui_.twinOther, LayerId::kAnnotationBand, bandSigns(edges[1]));
      });
}

void TwinView::zoomToMarks() {
  for (ImageView* view : {ui_.twinOurs, ui_.twinOther}) {
    ViewTransform transform;
    transform.zoomAt({}, std::min(view->width(), view->height()) / area_.width());
    transform.centreOn(area_.center(), view->size());
    view->setTransform(transform);
  }
}

void TwinView::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  if (!area_.isEmpty()) zoomToMarks();
}

}  // namespace boresight::ui
