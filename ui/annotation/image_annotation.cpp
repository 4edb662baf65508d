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

namespace boresight::ui {
namespace {

constexpr double kShortestScale = 50.0;  ///< on the screen
constexpr int kNoteMargin = 40;          ///< clear of the title
constexpr int kBesideTools = 56;         ///< clear of the strip of tools

std::optional<QPointF> placeOf(const AnnotationController& controller) {
  const sessions::PointPair* point = controller.selectedPoint();
  if (point && point->pixel) return QPointF(point->pixel->x(), point->pixel->y());
  const sessions::LinePair* line = controller.selectedLine();
  if (line && line->line) return QPointF(line->line->start.x(), line->line->start.y());
  return std::nullopt;
}

}  // namespace

ImageAnnotation::ImageAnnotation(ImagePanel& image, AnnotationController& controller,
                                 ViewState& state, StationSnapper& snapper, QObject* parent)
    : QObject(parent),
      image_(image),
      controller_(controller),
      state_(state),
      snapper_(snapper),
      view_(&image.view()),
      tool_(new AnnotationTool(image.view(), controller, state, snapper, this)),
      loupe_(new Loupe(image.view())),
      edges_(new PoseRenderer(this)) {
  image_.view().setOverlay(this, [this](QPainter& painter) { paint(painter); });
  connect(tool_, &AnnotationTool::aimChanged, this, &ImageAnnotation::lookThroughLoupe);
  connect(&image_.display(), &DisplayImage::pictureChanged, this, &ImageAnnotation::showSamples);
  connect(&image_.display(), &DisplayImage::levelsChanged, this, &ImageAnnotation::showSamples);
  connect(&image_.view(), &ImageView::itemClicked, this, [this](LayerId layer, int item) {
    if (layer == LayerId::kPoints) controller_.select(idOfSign(controller_.annotations(), item));
  });
  for (auto signal : {&AnnotationController::annotationsChanged,
                      &AnnotationController::selectionChanged, &AnnotationController::modeChanged})
    connect(&controller_, signal, this, &ImageAnnotation::showAnnotations);
  state_.onChange(ViewChange::kCase | ViewChange::kCursor | ViewChange::kNudgedPose, this,
                  &ImageAnnotation::showAnnotations);
  connect(&controller_, &AnnotationController::solutionChanged, this,
          &ImageAnnotation::hideWhileBlind);
  connect(&image_, &ImagePanel::stylesChanged, this, &ImageAnnotation::hideWhileBlind);
  connect(&controller_, &AnnotationController::solutionChanged, this,
          &ImageAnnotation::showSolution);
  state_.onChange(ViewChange::kCase, this, &ImageAnnotation::showSolution);
  connect(&image_, &ImagePanel::stylesChanged, this, &ImageAnnotation::showSolution);
  connect(&snapper_, &StationSnapper::meshChanged, this, &ImageAnnotation::askForBand);
  connect(edges_, &PoseRenderer::rendered, this,
          [this](const std::shared_ptr<const sessions::RenderTrace>& render, int level) {
            image_.setLines(LayerId::kAnnotationEdges, linesOf(*render, level));
            loupe_->update();
          });
  showSamples();
  showSolution();
}

ImageAnnotation::~ImageAnnotation() {
  if (view_) view_->setOverlay(this, {});
}

void ImageAnnotation::setMagnification(double magnification) {
  if (magnification == magnification_) return;
  magnification_ = magnification;
  showAnnotations();
}

/// The file's samples where they are read, else what the core sees.
void ImageAnnotation::showSamples() {
  const DisplayImage& display = image_.display();
  if (display.samples() && !display.showsCore()) {
    loupe_->setSamples(display.samples());
  } else if (!display.corePicture().isNull()) {
    loupe_->setSamples(
        std::make_shared<const sessions::ImageSamples>(samplesOf(display.corePicture())));
  } else {
    loupe_->setSamples(nullptr);
  }
}

AnnotationLook ImageAnnotation::look() const {
  AnnotationLook annotation_look;
  annotation_look.selected = controller_.selected();
  annotation_look.camera = state_.currentCase()->source.camera;
  annotation_look.camera_from_station = tool_->stationPose();
  if (controller_.solution())
    annotation_look.outliers = controller_.solution()->outlierAnnotations();
  return annotation_look;
}

void ImageAnnotation::showAnnotations() {
  if (!state_.currentCase()) {
    for (const LayerId id : {LayerId::kPoints, LayerId::kProposals, LayerId::kAnnotationResiduals})
      image_.setMarks(id, {});
    return;
  }
  const AnnotationLook shown = look();
  const sessions::Annotations& annotations = controller_.annotations();
  image_.setMarks(LayerId::kPoints, annotationSigns(annotations, shown));
  image_.setMarks(LayerId::kProposals, proposalSigns(controller_.answer().proposals));
  std::vector<Mark> residuals;
  if (const std::optional<Pose> solved = controller_.solvedPose()) {
    const sessions::AnnotatedView view{{}, shown.camera, {}, annotations};
    residuals = residualSigns(sessions::annotationVectors(view, *solved), shown, magnification_,
                              controller_.stale());
  }
  image_.setMarks(LayerId::kAnnotationResiduals, std::move(residuals));
  lookThroughLoupe();
}

/// In a blind round all that a pose predicts would show where to click; after it the layers are as
/// before.
void ImageAnnotation::hideWhileBlind() {
  const auto show = [this](LayerId id, bool visible) {
    LayerStyle style = image_.style(id);
    style.visible = visible;
    image_.setStyle(id, style);
  };
  if (!controller_.answer().blind) {
    for (const LayerId id : std::exchange(hidden_, {})) show(id, true);
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
    show(id, false);
  }
}

void ImageAnnotation::showSolution() {
  if (rendered_case_ != state_.currentCase()) {
    rendered_case_ = state_.currentCase();
    rendered_pose_.reset();
    edges_->setCase(rendered_case_);
    image_.setLines(LayerId::kAnnotationEdges, nullptr);
  }
  const bool shown = image_.style(LayerId::kAnnotationEdges).visible;
  const std::optional<Pose> solved = shown ? controller_.solvedPose() : std::nullopt;
  if (solved != rendered_pose_) {
    rendered_pose_ = solved;
    if (solved) {
      edges_->setPose(*solved);
    } else {
      edges_->clear();
      image_.setLines(LayerId::kAnnotationEdges, nullptr);
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
    runner_.cancel(QStringLiteral("band"));
    image_.setMarks(LayerId::kAnnotationBand, {});
    return;
  }
  if (band_of_ == solution) return;
  band_of_ = solution;
  runner_.start(
      QStringLiteral("band"),
      [solution, mesh = snapper_.mesh()](const std::stop_token&) {
        const sessions::AnnotationsSolution& solved = *solution->result.solution;
        const sessions::AnnotatedView& view = solution->annotations.views.front();
        return sessions::edgeBand(*mesh, view.camera, solved.camera_from_station.front(),
                                  sessions::cameraCovariance(solved, view));
      },
      [this, solution](const Band& band) {
        if (band_of_ == solution) image_.setMarks(LayerId::kAnnotationBand, bandSigns(band));
      });
}

void ImageAnnotation::lookThroughLoupe() {
  const bool annotates = controller_.mode() != PlaceMode::kOff && state_.currentCase();
  loupe_->lookAt(!annotates       ? std::nullopt
                 : tool_->focus() ? tool_->focus()
                                  : placeOf(controller_),
                 tool_->aim());
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
  const Layer& residuals = image_.view().layer(LayerId::kAnnotationResiduals);
  if (residuals.style.visible && !residuals.marks.empty()) paintResidualScale(painter, at);
  tool_->paint(painter, loupe_->isVisible() ? QRectF(loupe_->geometry()) : QRectF());
}

void ImageAnnotation::paintResidualScale(QPainter& painter, const QPointF& at) const {
  const double screen_per_px = magnification_ * image_.view().transform().scale();
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
