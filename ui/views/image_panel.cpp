// SPDX-License-Identifier: Apache-2.0
#include "ui/views/image_panel.h"

#include <cmath>
#include <utility>

#include <QtWidgets>

#include "sessions/text/text_table.h"
#include "sessions/trace/doubtful_pose.h"
#include "sessions/trace/run_text.h"
#include "sessions/trace/surface_point.h"
#include "ui/models/text.h"
#include "ui/run/task_runner.h"
#include "ui/style/icons.h"
#include "ui/views/canvas_chips.h"
#include "ui/views/display_image.h"
#include "ui/views/image_view.h"
#include "ui/views/layer_legend.h"
#include "ui/views/measure_tool.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr int kBlinkMs = 500;
/// In the colour of a rejected pose, with dashes instead of dots.
constexpr LineToken kDoubtfulLine = {kRejectedLine.color, 2.2, 8, 5, true};
using RenderPtr = std::shared_ptr<const sessions::RenderTrace>;
using Marks = std::vector<Mark>;
using MapsPtr = std::shared_ptr<const sessions::AgreementMaps>;

/// From the stage Pose on the corrected pose is shown.
bool isCorrected(const sessions::IterationTrace& iteration, Stage stage) {
  return stage >= Stage::kPose &&
         !(iteration.camera_from_station == iteration.camera_from_station_before);
}

/// "Iteration 2.3, match".
QString shownText(const ViewState& state) {
  if (!state.iteration()) return state.snapshot() ? ImagePanel::tr("Seed") : QString();
  const Stage stage = state.cursor().stage;
  const bool before_pose = stage >= Stage::kRender && stage <= Stage::kMatch;
  return ImagePanel::tr("Iteration %1%2")
      .arg(fromText(sessions::iterationName(*state.snapshot(), state.cursor().iteration)),
           before_pose ? QStringLiteral(", ") + QLatin1String(stageText(stage)) : QString());
}

}  // namespace

ImagePanel::ImagePanel(ViewState& state, TaskRunner& tasks, QWidget* parent)
    : QWidget(parent),
      state_(state),
      tasks_(tasks),
      view_(named(new ImageView, "imageView")),
      canvases_(new QSplitter),
      display_(new DisplayImage(state, tasks, this)),
      chips_(new CanvasChips(*view_)) {
  withoutMargins(new QVBoxLayout(this))->addWidget(canvases_);
  canvases_->addWidget(view_);
  canvases_->setChildrenCollapsible(false);
  measure_ = new MeasureTool(*view_, state, this);
  legend_ = new LayerLegend(*this);
  chips_->setLegend(legend_);
  connect(legend_, &LayerLegend::allLayersRequested, this, &ImagePanel::allLayersRequested);
  setHint({});
  buildTools();
  connect(display_, &DisplayImage::pictureChanged, this, &ImagePanel::showImage);
  connect(display_, &DisplayImage::failed, this, &ImagePanel::failed);
  connect(view_, &ImageView::cursorMoved, this, &ImagePanel::showPlace);
  connect(view_, &ImageView::cursorLeft, this, [this] {
    Q_EMIT placeText(QString());
    Q_EMIT stationPlaceHovered(std::nullopt);
  });
  connect(view_, &ImageView::contextMenuRequested, this, &ImagePanel::showContextMenu);
  connect(view_, &ImageView::itemClicked, this, [this](LayerId layer, int item) {
    if (layer == LayerId::kPoints) return;
    state_.selectTemplate(item);
    Q_EMIT templateClicked();
  });
  state_.onChange(ViewChange::kCase, this, &ImagePanel::showCase);
  state_.onChange(ViewChange::kCursor, this, &ImagePanel::showIteration);
  state_.onChange(ViewChange::kTemplate, this, &ImagePanel::showTemplates);
  state_.onChange(ViewChange::kAlternative, this, &ImagePanel::showAlternative);
}

QToolBar& ImagePanel::tools() { return chips_->tools(); }

void ImagePanel::setTitle(const QString& text) { chips_->setTitle(text); }

void ImagePanel::setHint(const QString& hint) {
  view_->setHint(
      !hint.isEmpty()
          ? hint
          : tr("Drop an image, a mesh, a camera (unless the image's label has one) and a seed "
               "here, with transforms where their frames differ; or a dataset.json, or a "
               "session"));
}

void ImagePanel::buildTools() {
  QToolBar& strip = tools();
  const auto add = [&](Icon icon, const QString& text, const QString& tip, bool checkable) {
    QAction* action = strip.addAction(overlayIcon(icon), text);
    action->setToolTip(tip);
    action->setCheckable(checkable);
    return action;
  };
  connect(add(Icon::kFit, tr("Fit"), tr("Show the whole image (0, or a double click)"), false),
          &QAction::triggered, view_, &ImageView::fit);
  connect(add(Icon::kOneToOne, tr("1:1"), tr("One image pixel on one screen pixel (1)"), false),
          &QAction::triggered, view_, &ImageView::showOneToOne);
  QAction* measure =
      add(Icon::kRuler, tr("Measure"),
          tr("Drag on the image: distance in pixels, and in mm where both ends are on the station"),
          true);
  connect(measure, &QAction::toggled, measure_, &MeasureTool::setActive);
  connect(measure_, &MeasureTool::activeChanged, measure, &QAction::setChecked);
  strip.addSeparator();
  blink_ = add(Icon::kEye, tr("Blink"),
               tr("Blink the layers every half second (B); hold H to hide them"), true);
  swipe_ = add(Icon::kSwipe, tr("Swipe"),
               tr("Show the layers only left of a line (V); drag the line"), true);
  side_by_side_ = add(Icon::kSideBySide, tr("Side by side"),
                      tr("A second canvas with linked zoom and pointer: the seed, the truth, "
                         "another run, another camera"),
                      true);
  side_by_side_->setVisible(false);  // until there is one
  core_view_ = add(Icon::kAlgorithm, tr("Algorithm's view"),
                   tr("Show the 8-bit image of the algorithm instead of a stretched image (C). "
                      "Stretching does not change runs."),
                   true);
  strip.addSeparator();
  connect(core_view_, &QAction::toggled, display_, &DisplayImage::setShowsCore);
  connect(display_, &DisplayImage::levelsChanged, this,
          [this] { core_view_->setChecked(display_->showsCore()); });
  blink_timer_.setInterval(kBlinkMs);
  connect(&blink_timer_, &QTimer::timeout, this,
          [this] { view_->setLayersHidden(!view_->layersHidden()); });
  connect(blink_, &QAction::toggled, this, [this](bool on) {
    view_->setLayersHidden(false);
    on ? blink_timer_.start() : blink_timer_.stop();
  });
  connect(swipe_, &QAction::toggled, this,
          [this](bool on) { view_->setSwipe(on ? std::optional<double>(0.5) : std::nullopt); });
}

void ImagePanel::setBeside(QWidget* canvas) {
  canvases_->addWidget(canvas);
  canvas->hide();
  for (int i = 0; i < canvases_->count(); ++i) canvases_->setStretchFactor(i, 1);
  side_by_side_->setVisible(true);
  connect(side_by_side_, &QAction::toggled, this, [this, canvas](bool on) {
    canvas->setVisible(on);
    if (on) canvases_->setSizes({width() / 2, width() / 2});
  });
}

void ImagePanel::showBeside(bool shown) { side_by_side_->setChecked(shown); }

const LayerStyle& ImagePanel::style(LayerId id) const { return view_->layer(id).style; }

void ImagePanel::setStyle(LayerId id, const LayerStyle& style) {
  if (style == view_->layer(id).style) return;
  if (stage_layer_ == id) stage_layer_.reset();  // the operator has decided
  view_->setStyle(id, style);
  askForRenders();
  Q_EMIT stylesChanged();
}

void ImagePanel::showLayer(LayerId id, bool visible) {
  LayerStyle changed = style(id);
  changed.visible = visible;
  setStyle(id, changed);
}

void ImagePanel::setNudgedRender(RenderPtr render, int level) {
  view_->setPart(LayerId::kNudgedEdges, &Layer::lines, render ? linesOf(*render, level) : nullptr);
}

void ImagePanel::showCase() {
  const ViewState::CasePtr before = std::exchange(shown_case_, state_.currentCase());
  const ViewState::CasePtr& after = shown_case_;
  const bool same_case = before && after && before->source.id == after->source.id;
  if (!same_case) {
    view_->cancelGesture();
    view_->fit();
  }
  // An edit of the mask leaves the image and the renders as they are.
  const bool same_scene = same_case && before->source.camera == after->source.camera &&
                          sessions::sameScene(before->source, after->source);
  if (!same_scene ||
      !(before->source.camera_from_station_seed == after->source.camera_from_station_seed))
    forget(LayerId::kSeedEdges);
  if (!same_scene ||
      !(before->source.camera_from_station_truth == after->source.camera_from_station_truth))
    forget(LayerId::kTruthEdges);
  if (!same_scene) {
    agreement_of_.reset();
    pose_lines_ = {};
    view_->setPart(LayerId::kAgreement, &Layer::bits, {});
    for (const LayerId id : {LayerId::kIterationEdges, LayerId::kNudgedEdges, LayerId::kChosenEdges,
                             LayerId::kHypothesisEdges})
      forget(id);
  }
  view_->setPart(LayerId::kIgnoreMask, &Layer::bits, ignoreBits(after));
  askForRenders();
}

void ImagePanel::forget(LayerId id) {
  asked_[static_cast<std::size_t>(id)] = false;
  view_->setPart(id, &Layer::lines, nullptr);
}

/// A hypothesis and the pose that the run went on with.
void ImagePanel::showAlternative() {
  forget(LayerId::kChosenEdges);
  forget(LayerId::kHypothesisEdges);
  const auto& other = state_.alternative();
  view_->setPart(LayerId::kHypothesisEdges, &Layer::name,
                 other ? alternativeTitle(*other) : QString());
  view_->setPart(LayerId::kChosenEdges, &Layer::name, other ? chosenTitle(*other) : QString());
  showTemplates();
  // While two poses are compared, the edges of others are drawn faintly.
  for (const LayerId id : {LayerId::kSeedEdges, LayerId::kIterationEdges})
    view_->setPart(id, &Layer::faded, other.has_value());
  askForRenders();
}

void ImagePanel::showImage() {
  view_->setImage(display_->picture());
  if (!display_->picture().isNull()) view_->setValues(display_->corePicture());
}

void ImagePanel::showIteration() {
  const auto iteration = state_.iteration();
  chips_->setShown(shownText(state_));
  showPoseLook();
  askForPoseLines();
  view_->setPart(LayerId::kMask, &Layer::bits, maskBits(iteration));
  const auto edges = state_.snapshot() ? state_.snapshot()->edges : nullptr;
  view_->setPart(LayerId::kTestEdges, &Layer::bits,
                 testEdgeBits(edges, iteration ? iteration->level : 0));
  const bool posed = iteration && state_.cursor().stage >= Stage::kPose;
  view_->setPart(LayerId::kResiduals, &Layer::marks,
                 posed ? residualMarks(*iteration, state_.currentCase()->source.camera) : Marks());
  if (agreement_of_ != iteration) {
    agreement_of_.reset();
    view_->setPart(LayerId::kAgreement, &Layer::bits, {});
  }
  bringLayerOfStage();
  showTemplates();
  askForRenders();
}

void ImagePanel::showPoseLook() {
  Layer layer = view_->layer(LayerId::kIterationEdges);
  const auto& run = state_.snapshot();
  const bool rejected = run && isRejected(*run);
  const auto doubtful = run ? sessions::doubtfulPose(*run) : std::nullopt;
  // Iterations before the last one have other poses.
  if (doubtful && state_.iterationPose() == doubtful->camera_from_station) {
    layer.line = kDoubtfulLine;
    layer.name =
        tr("Doubtful pose, %1").arg(fromText(sessions::probabilityPercent(doubtful->probability)));
  } else {
    layer.line = rejected ? std::optional<LineToken>(kRejectedLine) : std::nullopt;
    layer.name = rejected                  ? tr("Rejected pose")
                 : run && run->converged() ? tr("Pose found")
                                           : QString();
  }
  view_->setLayer(std::move(layer));
}

/// The edges before stay until these are there: stepping does not flicker.
void ImagePanel::askForPoseLines() {
  const auto iteration = state_.iteration();
  const PoseLines wanted = {iteration, iteration && isCorrected(*iteration, state_.cursor().stage)};
  if (wanted == pose_lines_) return;
  pose_lines_ = wanted;
  if (!iteration) {
    tasks_.cancel(drawing_pose_);
    view_->setPart(LayerId::kIterationEdges, &Layer::lines, nullptr);
    return;
  }
  tasks_.replace(
      drawing_pose_,
      [wanted, loaded_case = state_.currentCase()](const std::stop_token&) {
        return wanted.corrected ? linesOf(*loaded_case, wanted.iteration->camera_from_station)
                                : linesOf(wanted.iteration->render, wanted.iteration->level);
      },
      [this, wanted](const LinesPtr& lines) {
        if (wanted == pose_lines_) view_->setPart(LayerId::kIterationEdges, &Layer::lines, lines);
      },
      reportTo(this, &ImagePanel::failed));
}

/// What a stage made is shown while the operator looks at it.
void ImagePanel::bringLayerOfStage() {
  const Stage stage = state_.cursor().stage;
  std::optional<LayerId> wanted;
  if (state_.iteration() && stage == Stage::kTemplates) wanted = LayerId::kTemplates;
  if (state_.iteration() && stage == Stage::kMatch) wanted = LayerId::kMatches;
  if (wanted && stage_layer_ == wanted) return;
  if (const auto former = std::exchange(stage_layer_, std::nullopt)) {
    showLayer(*former, false);
  }
  if (!wanted || style(*wanted).visible) return;
  showLayer(*wanted, true);
  stage_layer_ = wanted;
}

void ImagePanel::showTemplates() {
  const auto iteration = state_.iteration();
  const Stage stage = state_.cursor().stage;
  const int selected = state_.selectedTemplate();
  const bool placed = iteration && stage >= Stage::kTemplates;
  const bool matched = iteration && stage >= Stage::kMatch;
  view_->setPart(LayerId::kTemplates, &Layer::marks,
                 placed ? templateMarks(*iteration, selected) : Marks());
  view_->setPart(LayerId::kWindows, &Layer::marks,
                 placed ? chosenMarks(*iteration, selected, matched) : Marks());
  // Arrows of the pose that was chosen do not hold for another hypothesis.
  const bool arrows = matched && !state_.alternative();
  view_->setPart(LayerId::kMatches, &Layer::marks,
                 arrows ? matchMarks(*iteration, selected) : Marks());
}

void ImagePanel::askForRenders() {
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  if (!loaded_case) return;
  if (loaded_case->source.has_seed)
    askForRender(LayerId::kSeedEdges, loaded_case->source.camera_from_station_seed);
  if (const auto truth = poseOf(state_, PoseRole::kTruth))
    askForRender(LayerId::kTruthEdges, *truth);
  if (const auto& other = state_.alternative()) {
    if (other->has_pose) askForRender(LayerId::kHypothesisEdges, other->camera_from_station);
    if (!other->chosen) askForRender(LayerId::kChosenEdges, other->camera_from_station_chosen);
  }
  askForAgreement();
}

void ImagePanel::askForRender(LayerId id, const Pose& camera_from_station) {
  bool& asked = asked_[static_cast<std::size_t>(id)];
  if (asked || !style(id).visible) return;
  asked = true;
  const ViewState::CasePtr loaded_case = state_.currentCase();
  tasks_.replace(
      drawing_[static_cast<std::size_t>(id)],
      [loaded_case, camera_from_station](const std::stop_token&) {
        return linesOf(*loaded_case, camera_from_station);
      },
      [this, loaded_case, id](const LinesPtr& lines) {
        const ViewState::CasePtr& current = state_.currentCase();
        if (current && asked_[static_cast<std::size_t>(id)] &&
            loaded_case->source.id == current->source.id)
          view_->setPart(id, &Layer::lines, lines);
      },
      reportTo(this, &ImagePanel::failed));
}

void ImagePanel::askForAgreement() {
  const auto iteration = state_.iteration();
  if (!iteration || !style(LayerId::kAgreement).visible || agreement_of_ == iteration) return;
  if (!state_.snapshot()->edges) return;
  agreement_of_ = iteration;
  tasks_.replace(
      comparing_,
      [iteration, edges = state_.snapshot()->edges](const std::stop_token&) -> MapsPtr {
        return std::make_shared<const sessions::AgreementMaps>(sessions::agreementOf(
            iteration->render, edges->level[static_cast<std::size_t>(iteration->level)]));
      },
      [this, iteration](const MapsPtr& maps) {
        if (agreement_of_ == iteration)
          view_->setPart(LayerId::kAgreement, &Layer::bits, agreementBits(maps, iteration->level));
      },
      reportTo(this, &ImagePanel::failed));
}

/// The point of the station at a pixel; empty outside the station, and while no pose is known.
std::optional<Eigen::Vector3d> ImagePanel::surfacePoint(const QPointF& pixel) const {
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  const std::optional<Pose> pose = state_.knownPose();
  if (!loaded_case || !pose) return std::nullopt;
  const Camera& camera = loaded_case->source.camera;
  if (surface_at_) return surface_at_(camera, *pose, vectorOf(pixel));
  const auto surface =
      sessions::surfacePointAt(camera, loaded_case->scene.view(), *pose, vectorOf(pixel));
  return surface ? std::optional(surface->in_station_m) : std::nullopt;
}

void ImagePanel::showPlace(const QPointF& pixel) {
  view_->setLinkedCursor(std::nullopt);  // of another view
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  if (!loaded_case) return;
  QString text = tr("x %1  y %2").arg(pixel.x(), 0, 'f', 1).arg(pixel.y(), 0, 'f', 1);
  const int x = static_cast<int>(std::floor(pixel.x() + 0.5));
  const int y = static_cast<int>(std::floor(pixel.y() + 0.5));
  std::optional<Eigen::Vector3d> place;
  if (x >= 0 && y >= 0 && x < loaded_case->image.width && y < loaded_case->image.height) {
    text += tr("  gray %1").arg(loaded_case->image.view().at(x, y));
    if (const auto& samples = display_->samples(); samples && samples->sample_bits > 8)
      text += tr(" (sample %1)").arg(sampleText(*samples, x, y));
    place = surfacePoint(pixel);
    if (place)
      text += tr("  station %1  %2  %3 mm, %4 m away")
                  .arg(1e3 * place->x(), 0, 'f', 2)
                  .arg(1e3 * place->y(), 0, 'f', 2)
                  .arg(1e3 * place->z(), 0, 'f', 2)
                  .arg((*state_.knownPose() * *place).z(), 0, 'f', 3);
  }
  Q_EMIT placeText(text);
  Q_EMIT stationPlaceHovered(place);
}

void ImagePanel::showStationPlace(const std::optional<Eigen::Vector3d>& point_in_station_m) {
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  Eigen::Vector2d pixel;
  const std::optional<Pose> pose = state_.knownPose();
  const bool seen = loaded_case && pose && point_in_station_m &&
                    project(loaded_case->source.camera, *pose * *point_in_station_m, pixel);
  view_->setLinkedCursor(seen ? std::optional(pointOf(pixel)) : std::nullopt);
}

void ImagePanel::showContextMenu(const QPointF& pixel, const QPoint& global) {
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  if (!loaded_case) return;
  QMenu menu(this);
  menu.addActions(tools().actions());
  menu.addSeparator();
  const auto copy = [&](const QString& name, const QString& text) {
    menu.addAction(tr("Copy %1:  %2").arg(name, text),
                   [text] { QGuiApplication::clipboard()->setText(text); });
  };
  copy(tr("pixel"), QStringLiteral("%1 %2").arg(pixel.x(), 0, 'f', 2).arg(pixel.y(), 0, 'f', 2));
  if (const auto point = surfacePoint(pixel))
    copy(tr("station point, m"), QStringLiteral("%1 %2 %3")
                                     .arg(point->x(), 0, 'f', 6)
                                     .arg(point->y(), 0, 'f', 6)
                                     .arg(point->z(), 0, 'f', 6));
  menu.exec(global);
}

}  // namespace boresight::ui
