// SPDX-License-Identifier: Apache-2.0
#include "ui/views/image_panel.h"

#include <cmath>
#include <utility>

#include <QtWidgets>

#include "sessions/run/scene_render.h"
#include "sessions/run/surface_point.h"
#include "ui/run/task_runner.h"
#include "ui/views/display_image.h"
#include "ui/views/layer.h"

namespace boresight::ui {
namespace {

constexpr int kBlinkMs = 500;
constexpr int kFaded = 50;  // opacity of 255 of what is drawn behind a hypothesis
using RenderPtr = std::shared_ptr<const sessions::RenderTrace>;
using MapsPtr = std::shared_ptr<const sessions::AgreementMaps>;

/// While two poses are compared, the edges of others stand back.
void fadeOthers(ImageView& view, bool fade) {
  for (const LayerId id : {LayerId::kSeedEdges, LayerId::kIterationEdges}) {
    Layer layer = view.layer(id);
    QColor color;  // the layer's own
    if (fade) {
      color = layer.style.color;
      color.setAlpha(kFaded);
    }
    for (LayerBits& bits : layer.bits) bits.color = color;
    view.setLayer(std::move(layer));
  }
}

}  // namespace

ImagePanel::ImagePanel(ViewState& state, TaskRunner& tasks, QWidget* parent)
    : QWidget(parent),
      state_(state),
      tasks_(tasks),
      display_(new DisplayImage(state, tasks, this)) {
  ui_.setupUi(this);
  setHint({});
  connectBar();
  connect(ui_.imageView, &ImageView::cursorMoved, this, &ImagePanel::showPlace);
  connect(ui_.imageView, &ImageView::cursorLeft, this, [this] { Q_EMIT placeText(QString()); });
  connect(ui_.imageView, &ImageView::transformChanged, this, [this] {
    const double percent =
        100.0 * ui_.imageView->transform().scale() * ui_.imageView->devicePixelRatioF();
    ui_.zoom->setText(tr("%1 %").arg(percent, 0, 'f', percent < 10.0 ? 1 : 0));
  });
  connect(ui_.imageView, &ImageView::itemClicked, this, [this](LayerId layer, int item) {
    if (layer != LayerId::kPoints) state_.selectTemplate(item);
  });
  state_.onChange(ViewChange::kCase, this, &ImagePanel::showCase);
  state_.onChange(ViewChange::kCursor, this, &ImagePanel::showIteration);
  state_.onChange(ViewChange::kTemplate, this, &ImagePanel::showTemplates);
  state_.onChange(ViewChange::kAlternative, this, &ImagePanel::showAlternative);
}

ImageView& ImagePanel::view() { return *ui_.imageView; }

void ImagePanel::setHint(const QString& hint) {
  ui_.imageView->setHint(
      !hint.isEmpty()
          ? hint
          : tr("Drop an image, a mesh, a camera (unless the image's label has one) and a seed "
               "here, with transforms where their frames differ; or a dataset.json, or a "
               "session"));
}

void ImagePanel::connectBar() {
  connect(ui_.fit, &QToolButton::clicked, ui_.imageView, &ImageView::fit);
  connect(ui_.oneToOne, &QToolButton::clicked, ui_.imageView, &ImageView::showOneToOne);
  connect(ui_.coreView, &QToolButton::toggled, display_, &DisplayImage::setShowsCore);
  connect(display_, &DisplayImage::levelsChanged, this,
          [this] { ui_.coreView->setChecked(display_->showsCore()); });
  connect(display_, &DisplayImage::pictureChanged, this, &ImagePanel::showImage);
  blink_timer_.setInterval(kBlinkMs);
  connect(&blink_timer_, &QTimer::timeout, this,
          [this] { ui_.imageView->setLayersHidden(!ui_.imageView->layersHidden()); });
  connect(ui_.blink, &QToolButton::toggled, this, [this](bool on) {
    ui_.imageView->setLayersHidden(false);
    on ? blink_timer_.start() : blink_timer_.stop();
  });
  const auto swipe = [this] {
    const bool on = ui_.swipe->isChecked();
    const double place = ui_.swipePlace->value() / 1000.0;
    ui_.swipePlace->setEnabled(on);
    ui_.imageView->setSwipe(on ? std::optional<double>(place) : std::nullopt);
  };
  connect(ui_.swipe, &QToolButton::toggled, this, swipe);
  connect(ui_.swipePlace, &QSlider::valueChanged, this, swipe);
}

void ImagePanel::toggleBlink() { ui_.blink->toggle(); }
void ImagePanel::toggleSwipe() { ui_.swipe->toggle(); }
void ImagePanel::toggleCoreView() { ui_.coreView->toggle(); }

const LayerStyle& ImagePanel::style(LayerId id) const { return ui_.imageView->layer(id).style; }

void ImagePanel::setStyle(LayerId id, const LayerStyle& style) {
  if (style == ui_.imageView->layer(id).style) return;
  ui_.imageView->setStyle(id, style);
  askForRenders();
  Q_EMIT stylesChanged();
}

void ImagePanel::setBits(LayerId id, std::vector<LayerBits> bits) {
  Layer layer = ui_.imageView->layer(id);
  layer.bits = std::move(bits);
  ui_.imageView->setLayer(std::move(layer));
}

void ImagePanel::setMarks(LayerId id, std::vector<Mark> marks) {
  Layer layer = ui_.imageView->layer(id);
  layer.marks = std::move(marks);
  ui_.imageView->setLayer(std::move(layer));
}

void ImagePanel::setNudgedRender(RenderPtr render, int level) {
  std::vector<LayerBits> bits = bitsOf(render, false);
  for (LayerBits& item : bits) item.level = level;
  setBits(LayerId::kNudgedEdges, std::move(bits));
}

void ImagePanel::showCase() {
  const ViewState::CasePtr before = std::exchange(shown_case_, state_.currentCase());
  const ViewState::CasePtr& after = shown_case_;
  // An edit of the mask leaves the image and the renders as they are.
  const bool same_scene = before && after && before->source.id == after->source.id &&
                          before->source.camera == after->source.camera &&
                          before->source.parts == after->source.parts;
  if (!same_scene ||
      !(before->source.camera_from_station_seed == after->source.camera_from_station_seed))
    forget(LayerId::kSeedEdges);
  if (!same_scene) {
    agreement_of_.reset();
    for (const LayerId id : {LayerId::kTruthEdges, LayerId::kAgreement, LayerId::kNudgedEdges,
                             LayerId::kChosenEdges, LayerId::kHypothesisEdges})
      forget(id);
  }
  setBits(LayerId::kIgnoreMask, ignoreBits(after));
  askForRenders();
}

void ImagePanel::forget(LayerId id) {
  asked_[static_cast<std::size_t>(id)] = false;
  setBits(id, {});
}

/// A hypothesis and the pose that the run went on with.
void ImagePanel::showAlternative() {
  forget(LayerId::kChosenEdges);
  forget(LayerId::kHypothesisEdges);
  std::vector<LegendLine> names;
  if (const auto& other = state_.alternative()) {
    names = {{LayerId::kHypothesisEdges, alternativeTitle(*other)},
             {LayerId::kChosenEdges, chosenTitle(*other)},
             {LayerId::kIterationEdges, tr("Render of the shown iteration")},
             {LayerId::kSeedEdges, tr("Seed")},
             {LayerId::kTruthEdges, tr("Truth")}};
  }
  ui_.imageView->setLegend(std::move(names));
  showTemplates();
  fadeOthers(*ui_.imageView, state_.alternative().has_value());
  askForRenders();
}

void ImagePanel::showImage() {
  ui_.imageView->setImage(display_->picture());
  if (!display_->picture().isNull()) ui_.imageView->setValues(display_->corePicture());
}

void ImagePanel::showIteration() {
  const auto iteration = state_.iteration();
  setBits(LayerId::kIterationEdges, iterationBits(iteration, false));
  fadeOthers(*ui_.imageView, state_.alternative().has_value());
  setBits(LayerId::kMask, iterationBits(iteration, true));
  const bool has_edges = state_.snapshot() && state_.snapshot()->edges;
  setBits(LayerId::kTestEdges,
          has_edges ? testEdgeBits(state_.snapshot()->edges, iteration ? iteration->level : 0)
                    : std::vector<LayerBits>());
  const bool posed = iteration && state_.cursor().stage >= Stage::kPose;
  setMarks(LayerId::kResiduals, posed
                                    ? residualMarks(*iteration, state_.currentCase()->source.camera)
                                    : std::vector<Mark>());
  if (agreement_of_ != iteration) {
    agreement_of_.reset();
    setBits(LayerId::kAgreement, {});
  }
  showTemplates();
  askForRenders();
}

void ImagePanel::showTemplates() {
  const auto iteration = state_.iteration();
  const Stage stage = state_.cursor().stage;
  const int selected = state_.selectedTemplate();
  const bool placed = iteration && stage >= Stage::kTemplates;
  const bool matched = iteration && stage >= Stage::kMatch;
  setMarks(LayerId::kTemplates, placed ? templateMarks(*iteration, selected) : std::vector<Mark>());
  setMarks(LayerId::kWindows, matched ? windowMarks(*iteration, selected) : std::vector<Mark>());
  // Arrows of the pose that was chosen do not hold for another hypothesis.
  const bool arrows = matched && !state_.alternative();
  setMarks(LayerId::kMatches, arrows ? matchMarks(*iteration, selected) : std::vector<Mark>());
}

void ImagePanel::askForRenders() {
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  if (!loaded_case) return;
  if (loaded_case->source.has_seed)
    askForRender(LayerId::kSeedEdges, "seed edges", loaded_case->source.camera_from_station_seed);
  if (loaded_case->source.camera_from_station_truth)
    askForRender(LayerId::kTruthEdges, "truth edges",
                 *loaded_case->source.camera_from_station_truth);
  if (const auto& other = state_.alternative()) {
    if (other->has_pose)
      askForRender(LayerId::kHypothesisEdges, "hypothesis' edges", other->camera_from_station);
    if (!other->chosen)
      askForRender(LayerId::kChosenEdges, "chosen pose's edges", other->camera_from_station_chosen);
  }
  askForAgreement();
}

void ImagePanel::askForRender(LayerId id, const char* key, const Pose& camera_from_station) {
  bool& asked = asked_[static_cast<std::size_t>(id)];
  if (asked || !style(id).visible) return;
  asked = true;
  const ViewState::CasePtr loaded_case = state_.currentCase();
  tasks_.start(
      QString::fromLatin1(key),
      [loaded_case, camera_from_station](const std::stop_token&) -> RenderPtr {
        auto render = std::make_shared<sessions::RenderTrace>();
        const Status status = sessions::renderScene(
            loaded_case->source.camera, loaded_case->scene.view(), camera_from_station, *render);
        return status == Status::kOk ? render : nullptr;
      },
      [this, loaded_case, id](const RenderPtr& render) {
        const ViewState::CasePtr& current = state_.currentCase();
        if (current && asked_[static_cast<std::size_t>(id)] &&
            loaded_case->source.id == current->source.id)
          setBits(id, bitsOf(render, false));
        fadeOthers(*ui_.imageView, state_.alternative().has_value());
      });
}

void ImagePanel::askForAgreement() {
  const auto iteration = state_.iteration();
  if (!iteration || !style(LayerId::kAgreement).visible || agreement_of_ == iteration) return;
  if (!state_.snapshot()->edges) return;
  agreement_of_ = iteration;
  tasks_.start(
      QStringLiteral("agreement"),
      [iteration, edges = state_.snapshot()->edges](const std::stop_token&) -> MapsPtr {
        return std::make_shared<const sessions::AgreementMaps>(sessions::agreementOf(
            iteration->render, edges->level[static_cast<std::size_t>(iteration->level)]));
      },
      [this, iteration](const MapsPtr& maps) {
        if (agreement_of_ == iteration)
          setBits(LayerId::kAgreement, agreementBits(maps, iteration->level));
      });
}

void ImagePanel::showPlace(const QPointF& pixel) {
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  if (!loaded_case) return;
  QString text = tr("x %1  y %2").arg(pixel.x(), 0, 'f', 1).arg(pixel.y(), 0, 'f', 1);
  const int x = static_cast<int>(std::floor(pixel.x() + 0.5));
  const int y = static_cast<int>(std::floor(pixel.y() + 0.5));
  if (x >= 0 && y >= 0 && x < loaded_case->image.width && y < loaded_case->image.height) {
    text += tr("  gray %1").arg(loaded_case->image.view().at(x, y));
    if (const auto& samples = display_->samples(); samples && samples->sample_bits > 8)
      text += tr(" (sample %1)").arg(sampleText(*samples, x, y));
    const auto point =
        sessions::surfacePointAt(loaded_case->source.camera, loaded_case->scene.view(),
                                 state_.shownPose(), {pixel.x(), pixel.y()});
    if (point) {
      text += tr("  station %1  %2  %3 mm, %4 m away")
                  .arg(1e3 * point->in_station_m.x(), 0, 'f', 2)
                  .arg(1e3 * point->in_station_m.y(), 0, 'f', 2)
                  .arg(1e3 * point->in_station_m.z(), 0, 'f', 2)
                  .arg(point->depth_m, 0, 'f', 3);
    }
  }
  Q_EMIT placeText(text);
}

}  // namespace boresight::ui
