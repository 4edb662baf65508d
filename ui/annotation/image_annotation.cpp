// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/image_annotation.h"

#include <algorithm>
#include <utility>

#include <QPainter>

#include "ui/annotation/annotation_tool.h"
#include "ui/annotation/loupe.h"
#include "ui/annotation/station_snapper.h"
#include "ui/models/text.h"
#include "ui/run/pose_renderer.h"
#include "ui/views/display_image.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/views/layer.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr double kShortestScale = 50.0;  ///< on the screen
constexpr int kNoteMargin = 40;          ///< clear of the title
constexpr int kBesideTools = 56;         ///< clear of the strip of tools

}  // namespace

ImageAnnotation::ImageAnnotation(ImagePanel& image, AnnotationController& controller,
                                 ViewState& state, StationSnapper& snapper, QObject* parent)
    : QObject(parent),
      image_(image),
      controller_(controller),
      state_(state),
      snapper_(snapper),
      view_(image.view()),
      tool_(new AnnotationTool(image.view(), controller, state, snapper, this)),
      loupe_(new Loupe(image.view())),
      edges_(new PoseRenderer(this)) {
  view_.addOverlay(this, [this](QPainter& painter) { paint(painter); });
  connect(tool_, &AnnotationTool::aimChanged, this, &ImageAnnotation::lookThroughLoupe);
  connectEach(image_.display(), this, &ImageAnnotation::showSamples, &DisplayImage::pictureChanged,
              &DisplayImage::levelsChanged);
  connect(&view_, &ImageView::itemClicked, this, [this](LayerId layer, int item) {
    if (layer == LayerId::kPoints) controller_.select(idOfSign(controller_.annotations(), item));
  });
  using Controller = AnnotationController;
  connectEach(controller_, this, &ImageAnnotation::showAnnotations, &Controller::annotationsChanged,
              &Controller::selectionChanged, &Controller::modeChanged);
  state_.onChange(ViewChange::kCase | ViewChange::kCursor | ViewChange::kNudgedPose, this,
                  &ImageAnnotation::showAnnotations);
  connect(&controller_, &AnnotationController::solutionChanged, this,
          &ImageAnnotation::showSolution);
  state_.onChange(ViewChange::kCase, this, &ImageAnnotation::showSolution);
  connect(&image_, &ImagePanel::stylesChanged, this, &ImageAnnotation::showSolution);
  connect(&snapper_, &StationSnapper::meshChanged, this, &ImageAnnotation::askForBand);
  connect(edges_, &PoseRenderer::rendered, this,
          [this](const std::shared_ptr<const sessions::RenderTrace>& render, int level) {
            view_.setPart(LayerId::kAnnotationEdges, &Layer::lines, linesOf(*render, level));
            loupe_->update();
          });
  showSamples();
  showSolution();
}

void ImageAnnotation::setMagnification(double magnification) {
  if (magnification == magnification_) return;
  magnification_ = magnification;
  showAnnotations();
}

/// The file's samples where they are read, else what the core sees.
void ImageAnnotation::showSamples() {
  const DisplayImage& display = image_.display();
  DisplayImage::SamplesPtr samples = display.showsCore() ? nullptr : display.samples();
  if (!samples && !display.corePicture().isNull())
    samples = std::make_shared<const sessions::ImageSamples>(samplesOf(display.corePicture()));
  loupe_->setSamples(std::move(samples));
}

void ImageAnnotation::showAnnotations() {
  if (!state_.currentCase()) {
    for (const LayerId id : {LayerId::kPoints, LayerId::kProposals, LayerId::kAnnotationResiduals})
      view_.setPart(id, &Layer::marks, {});
    return;
  }
  AnnotationLook shown = {
      controller_.selected(), {}, state_.currentCase()->source.camera, tool_->stationPose()};
  if (controller_.solution()) shown.outliers = controller_.solution()->outlierAnnotations();
  const sessions::Annotations& annotations = controller_.annotations();
  view_.setPart(LayerId::kPoints, &Layer::marks, annotationSigns(annotations, shown));
  view_.setPart(LayerId::kProposals, &Layer::marks, proposalSigns(controller_.answer().proposals));
  std::vector<Mark> residuals;
  if (const std::optional<Pose> solved = controller_.solvedPose()) {
    const sessions::AnnotatedView view{{}, shown.camera, {}, annotations};
    residuals = residualSigns(sessions::annotationVectors(view, *solved), shown, magnification_,
                              controller_.stale());
  }
  view_.setPart(LayerId::kAnnotationResiduals, &Layer::marks, std::move(residuals));
  lookThroughLoupe();
}

/// In a blind round all that a pose predicts would show where to click; after it the layers are as
/// before.
void ImageAnnotation::hideWhileBlind() {
  if (!controller_.answer().blind) {
    for (const LayerId id : std::exchange(hidden_, {})) image_.showLayer(id, true);
    return;
  }
  constexpr LayerId kPredicted[] = {
      LayerId::kMask,        LayerId::kAgreement,   LayerId::kSeedEdges,
      LayerId::kTruthEdges,  LayerId::kNudgedEdges, LayerId::kIterationEdges,
      LayerId::kChosenEdges, LayerId::kWindows,     LayerId::kHypothesisEdges,
      LayerId::kTemplates,   LayerId::kMatches,     LayerId::kResiduals};
  for (const LayerId id : kPredicted) {
    if (!image_.style(id).visible) continue;
    if (std::ranges::count(hidden_, id) == 0) hidden_.push_back(id);
    image_.showLayer(id, false);
  }
}

void ImageAnnotation::showSolution() {
  hideWhileBlind();
  if (rendered_case_ != state_.currentCase()) {
    rendered_case_ = state_.currentCase();
    rendered_pose_.reset();
    edges_->setCase(rendered_case_);
    view_.setPart(LayerId::kAnnotationEdges, &Layer::lines, nullptr);
  }
  const bool shown = image_.style(LayerId::kAnnotationEdges).visible;
  const std::optional<Pose> solved = shown ? controller_.solvedPose() : std::nullopt;
  if (solved != rendered_pose_) {
    rendered_pose_ = solved;
    if (solved) {
      edges_->setPose(*solved);
    } else {
      edges_->clear();
      view_.setPart(LayerId::kAnnotationEdges, &Layer::lines, nullptr);
    }
  }
  askForBand();
  showAnnotations();
}

/// A band of old annotations would be a wrong answer: a stale one is taken away.
void ImageAnnotation::askForBand() {
  const AnnotationController::SolutionPtr& solution = controller_.solution();
  const bool wanted = image_.style(LayerId::kAnnotationBand).visible && solution &&
                      solution->result.solution && !controller_.stale() && snapper_.mesh();
  if (!wanted) {
    band_of_.reset();
    runner_.cancel(drawing_);
    view_.setPart(LayerId::kAnnotationBand, &Layer::marks, {});
    return;
  }
  if (band_of_ == solution) return;
  band_of_ = solution;
  runner_.replace(
      drawing_,
      [solution, mesh = snapper_.mesh()](const std::stop_token&) {
        const sessions::AnnotationsSolution& solved = *solution->result.solution;
        const sessions::AnnotatedView& view = solution->annotations.views.front();
        return sessions::edgeBand(*mesh, view.camera, solved.camera_from_station.front(),
                                  sessions::cameraCovariance(solved, view));
      },
      [this, solution](const Band& band) {
        if (band_of_ == solution)
          view_.setPart(LayerId::kAnnotationBand, &Layer::marks, bandSigns(band));
      },
      reportTo(this, &ImageAnnotation::failed));
}

void ImageAnnotation::lookThroughLoupe() {
  std::optional<QPointF> place;
  if (controller_.mode() != PlaceMode::kOff && state_.currentCase()) {
    place = tool_->focus();
    if (const auto pixel = controller_.selectedPixel(); pixel && !place) place = pointOf(*pixel);
  }
  loupe_->lookAt(place, tool_->aim());
}

/// What the operator does next, for the pair at work.
QString ImageAnnotation::nextStep() const {
  const QString id = QString::fromStdString(controller_.selected());
  if (controller_.mode() == PlaceMode::kLine) {
    const sessions::LinePair* line = controller_.selectedLine();
    if (line && !line->line) return tr("%1: click two points of the line in the image").arg(id);
    if (line && !line->edge) return tr("%1: Ctrl+click its edge of the station").arg(id);
    return tr(
        "Lines: click two points of an edge in the image, or Ctrl+click an edge of the station");
  }
  const sessions::PointPair* point = controller_.selectedPoint();
  if (point && !point->pixel) return tr("%1: click its position in the image").arg(id);
  if (point && !point->point_in_station_m)
    return tr("%1: Ctrl+click its position on the station, or pick it in the scene").arg(id);
  return tr("Points: click a point in the image, or Ctrl+click a point of the station");
}

void ImageAnnotation::paint(QPainter& painter) const {
  if (!state_.currentCase()) return;
  const int line = painter.fontMetrics().height() + 6;
  QPointF at(kBesideTools, kNoteMargin);
  if (controller_.mode() != PlaceMode::kOff) {
    paintBox(painter, at, nextStep());
    at.ry() += line + 2;
  }
  const Layer& residuals = view_.layer(LayerId::kAnnotationResiduals);
  if (residuals.style.visible && !residuals.marks.empty()) paintResidualScale(painter, at);
  tool_->paint(painter, loupe_->isVisible() ? QRectF(loupe_->geometry()) : QRectF());
}

void ImageAnnotation::paintResidualScale(QPainter& painter, const QPointF& at) const {
  const double screen_per_px = magnification_ * view_.transform().scale();
  const double value_px = roundedUp(kShortestScale / screen_per_px);
  const double length = value_px * screen_per_px;
  const QString text = tr("residuals x %1:  %2 px").arg(magnification_).arg(value_px);
  const QRectF box = paintBox(painter, at, text, length + 10.0);
  const QColor color = image_.style(LayerId::kAnnotationResiduals).color;
  painter.setPen(QPen(color, 2.0));
  const double x = box.right() - length - 6.0;
  const double y = box.center().y();
  painter.drawLine(QPointF(x, y), QPointF(x + length, y));
  for (const double end : {x, x + length})
    painter.drawLine(QPointF(end, y - 4.0), QPointF(end, y + 4.0));
}

}  // namespace boresight::ui
