// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/ambiguity_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QtWidgets>

#include "ui_ambiguity_view.h"

#include "sessions/annotation/edge_band.h"
#include "ui/views/layer.h"

namespace boresight::ui {
namespace {

constexpr double kRoundMarks = 0.35;  // of the marks' box, round it
constexpr double kLeastSide_px = 64;  // px of the image
constexpr int kDrawn_px = 480;        // side of a picture before it is scaled to its place
constexpr double kStep_px = 4.0;

struct Drawing {
  ViewState::CasePtr one;
  StationSnapper::MeshPtr mesh;
  sessions::Marks marks;
  Camera camera;
  std::array<Pose, 2> camera_from_station;
};

/// A square round the marks in the image, px.
QRectF areaOf(const Drawing& drawing) {
  QRectF box;
  for (const sessions::PointPair& point : drawing.marks.points)
    if (point.used()) box |= QRectF(point.pixel->x() - 0.5, point.pixel->y() - 0.5, 1.0, 1.0);
  const double side =
      std::max((1.0 + 2.0 * kRoundMarks) * std::max(box.width(), box.height()), kLeastSide_px);
  return {box.center().x() - 0.5 * side, box.center().y() - 0.5 * side, side, side};
}

QImage backdrop(const boresight::ImageView& image, const QRectF& area) {
  QImage drawn(kDrawn_px, kDrawn_px, QImage::Format_RGB32);
  drawn.fill(Qt::darkGray);
  for (int y = 0; y < kDrawn_px; ++y)
    for (int x = 0; x < kDrawn_px; ++x) {
      const int column =
          static_cast<int>(std::lround(area.x() + (x + 0.5) / kDrawn_px * area.width()));
      const int row =
          static_cast<int>(std::lround(area.y() + (y + 0.5) / kDrawn_px * area.height()));
      if (column < 0 || row < 0 || column >= image.width || row >= image.height) continue;
      const int gray = image.at(column, row);
      drawn.setPixel(x, y, qRgb(gray, gray, gray));
    }
  return drawn;
}

QImage draw(const Drawing& drawing, std::size_t which) {
  const QRectF area = areaOf(drawing);
  QImage drawn = backdrop(drawing.one->image.view(), area);
  QPainter painter(&drawn);
  painter.setRenderHint(QPainter::Antialiasing);
  const double scale = kDrawn_px / area.width();
  const auto place = [&](const Eigen::Vector2d& pixel) {
    return QPointF((pixel.x() - area.x()) * scale, (pixel.y() - area.y()) * scale);
  };
  painter.setPen(QPen(kAnnotatedColor, 2.0));
  const auto pieces =
      sessions::edgeBand(*drawing.mesh, drawing.camera, drawing.camera_from_station[which],
                         Matrix6d::Zero(), kStep_px);
  for (const sessions::BandPiece& piece : pieces) {
    QPolygonF line;
    for (const sessions::BandPlace& each : piece.places) line << place(each.pixel);
    painter.drawPolyline(line);
  }
  painter.setPen(QPen(QColor(255, 210, 0), 2.0));
  for (const sessions::PointPair& point : drawing.marks.points)
    if (point.used()) painter.drawEllipse(place(*point.pixel), 6.0, 6.0);
  return drawn;
}

}  // namespace

AmbiguityView::AmbiguityView(AnnotationController& controller, ViewState& state,
                             StationSnapper& snapper, QWidget* parent)
    : QWidget(parent),
      controller_(controller),
      state_(state),
      snapper_(snapper),
      ui_(std::make_unique<Ui::AmbiguityView>()) {
  ui_->setupUi(this);
  setObjectName(QStringLiteral("ambiguityView"));
  for (QLabel* picture : {ui_->bestPicture, ui_->otherPicture})
    picture->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Ignored);
  connect(ui_->showOtherPose, &QPushButton::clicked, this, [this] {
    if (const auto pose = other()) Q_EMIT otherRequested(*pose);
  });
  connect(&controller_, &AnnotationController::solutionChanged, this, &AmbiguityView::showSolution);
  connect(&snapper_, &StationSnapper::meshChanged, this, &AmbiguityView::showSolution);
  showSolution();
}

AmbiguityView::~AmbiguityView() = default;

std::optional<Pose> AmbiguityView::other() const {
  const auto& solution = controller_.solution();
  return solution ? solution->ambiguous_camera_from_station() : std::nullopt;
}

void AmbiguityView::showSolution() {
  const auto pose = controller_.solvedPose();
  const auto other_pose = other();
  setVisible(pose && other_pose);
  if (!pose || !other_pose) return;
  const sessions::MarksSolution& solution = *controller_.solution()->result.solution;
  ui_->oursCaption->setText(tr("this: %1 px rms").arg(QString::number(solution.rms_px, 'f', 3)));
  ui_->otherCaption->setText(
      tr("other: %1 px rms").arg(QString::number(solution.ambiguous->rms_px, 'f', 3)));
  if (!snapper_.mesh() || !state_.currentCase()) return;
  const sessions::MarkedView& view = controller_.solution()->marks.views.front();
  const Drawing drawing = {
      state_.currentCase(), snapper_.mesh(), view.marks, view.camera, {*pose, *other_pose}};
  runner_.start(
      QStringLiteral("draw ambiguous poses"),
      [drawing](const std::stop_token&) {
        return std::array<QImage, 2>{draw(drawing, 0), draw(drawing, 1)};
      },
      [this](const std::array<QImage, 2>& drawn) {
        drawn_ = drawn;
        showPictures();
      });
}

void AmbiguityView::showPictures() {
  const std::array<QLabel*, 2> labels = {ui_->bestPicture, ui_->otherPicture};
  for (std::size_t i : {0u, 1u}) {
    if (drawn_[i].isNull()) continue;
    const double ratio = devicePixelRatioF();
    QPixmap scaled = QPixmap::fromImage(
        drawn_[i].scaled(labels[i]->size() * ratio, Qt::KeepAspectRatio, Qt::SmoothTransformation));
    scaled.setDevicePixelRatio(ratio);
    labels[i]->setPixmap(scaled);
  }
}

void AmbiguityView::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  showPictures();
}

}  // namespace boresight::ui
