// SPDX-License-Identifier: Apache-2.0
#include "ui/window/sequence_dialog.h"

#include <limits>

#include <QtWidgets>

#include "sessions/io/images/video_frames.h"
#include "sessions/trace/scene_render.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/style/icons.h"
#include "ui/views/display_image.h"
#include "ui/views/image_view.h"
#include "ui/widgets/column_fitter.h"
#include "ui/widgets/widgets.h"
#include "ui/window/case_controller.h"

namespace boresight::ui {
namespace {

constexpr QSize kDialogSize(1080, 640);
constexpr int kTableWidth_px = 640;  ///< holds all columns
constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();
constexpr double kMostMotion = 1000.0;
constexpr double kMostTurn_deg = 180.0;

/// What a chosen frame shows.
struct FramePicture {
  QImage image;
  LinesPtr lines;
  QString problem;  ///< why there is no image
};

/// In the order of sequenceColumns().
enum Column { kFrame, kImage, kState, kProbability, kMoved_mm, kTurned_deg, kTime_ms, kReason };

std::vector<TableColumn<sessions::SequenceRow>> sequenceColumns() {
  using Row = const sessions::SequenceRow&;
  constexpr auto tr = [](const char* text) { return SequenceModel::tr(text); };
  return {
      {tr("Frame"), tr("Number of the frame, from 1."), 0,
       [](Row row) { return static_cast<double>(row.number); }},
      {tr("Image"), tr("Name of the image."), -1, [](Row row) { return fromText(row.name); }},
      {tr("State"), tr("Accepted, or lost: the next frame starts from the last accepted pose."), -1,
       [tr](Row row) { return row.accepted ? tr("✓ accepted") : tr("✗ lost"); }},
      {tr("Probability"), tr("Probability that the pose is correct; – for a frame without a pose."),
       0,
       [](Row row) {
         return row.probability ? probabilityCell(*row.probability) : QStringLiteral("–");
       },
       [](Row row) { return row.probability.value_or(kNoFigure); }},
      {tr("Moved, mm"),
       tr("Displacement of the station's centre since the last accepted frame, as seen from the "
          "camera, in mm."),
       2, [](Row row) { return row.moved_mm.value_or(kNoFigure); }},
      {tr("Turned, deg"), tr("Rotation since the last accepted frame, in degrees."), 3,
       [](Row row) { return row.turned_deg.value_or(kNoFigure); }},
      {tr("Time, ms"), tr("Time of the run, in ms."), 0, [](Row row) { return 1e3 * row.seconds; }},
      {tr("Why lost"), tr("Why the frame is lost."), -1,
       [](Row row) { return fromText(row.reason); }},
  };
}

FramePicture pictureOf(const sessions::SequenceOrder& order, const sessions::LoadedCase& loaded,
                       const sessions::SequenceRow& row) {
  FramePicture picture;
  const auto frame =
      sessions::readFrame(order.images, row.number, order.session_case.image.eight_bit);
  if (!frame || !frame->image) {
    picture.problem =
        frame ? fromText(frame->problem) : SequenceDialog::tr("The sequence has no such frame.");
    return picture;
  }
  picture.image = grayImage(frame->image->view()).copy();
  sessions::RenderTrace render;
  if (row.accepted && sessions::renderScene(loaded.source.camera, loaded.scene.view(),
                                            row.camera_from_station, render) == Status::kOk)
    picture.lines = linesOf(render, 0);
  return picture;
}

QDoubleSpinBox* motionField(const char* name, double value, double most, const QString& unit) {
  auto* box = named(new QDoubleSpinBox, name);
  box->setRange(0.0, most);
  box->setDecimals(2);
  box->setValue(value);
  box->setSuffix(QLatin1Char(' ') + unit);
  return box;
}

std::filesystem::path pathOf(const QString& text) { return text.toStdString(); }

}  // namespace

SequenceModel::SequenceModel(QObject* parent) : RowsModel(sequenceColumns(), parent) {}

/// The whole sentence, which a narrow column cuts.
QVariant SequenceModel::look(const sessions::SequenceRow& row, int /*column*/, int role) const {
  return role == Qt::ToolTipRole && !row.reason.empty() ? fromText(row.reason) : QVariant();
}

SequenceDialog::SequenceDialog(const WindowParts& parts, QWidget* parent)
    : QDialog(parent),
      parts_(parts),
      model_(new SequenceModel(this)),
      images_(named(new QLineEdit, "sequenceImages")),
      results_(named(new QLineEdit, "sequenceResults")),
      run_(named(new QPushButton(iconOf(Icon::kRun), tr("Run")), "sequenceRun")),
      cancel_(named(new QPushButton(iconOf(Icon::kStop), tr("Cancel")), "sequenceCancel",
                    tr("End the run; stored frames are kept, and Run continues after them"))),
      progress_(named(new QLabel, "sequenceProgress")),
      banner_(named(new Banner, "sequenceBanner")),
      table_(named(new QTableView, "sequenceFrames")),
      picture_(named(new ImageView, "sequencePicture")) {
  setObjectName(QStringLiteral("sequenceDialog"));
  auto* column = new QVBoxLayout(this);
  column->addWidget(buildForm());
  column->addWidget(banner_);
  column->addWidget(buildFrames(), 1);
  resize(kDialogSize);
  connect(run_, &QPushButton::clicked, this, &SequenceDialog::start);
  connect(cancel_, &QPushButton::clicked, &parts_.sequence, &SequenceRunner::stop);
  connect(&parts_.sequence, &SequenceRunner::changed, this, &SequenceDialog::showProgress);
  connect(&parts_.sequence, &SequenceRunner::failed, this, [this](const QString& message) {
    problem_ = message;
    showProgress();
  });
  connect(images_, &QLineEdit::textEdited, this,
          [this](const QString& text) { setImages(pathOf(text)); });
  connect(results_, &QLineEdit::textEdited, this, [this](const QString& text) {
    chosen_results_ = pathOf(text);
    update();
  });
  connect(&pictures_, &TaskRunner::failed, picture_, &ImageView::setHint);
  parts_.state.onChange(ViewChange::kCase, this, &SequenceDialog::update);
  update();
  showProgress();
}

QWidget* SequenceDialog::buildForm() {
  const sessions::DeclaredUncertainty motion = sessions::assumedMotion();
  motion_mm_ = motionField("sequenceMotion", 1e3 * motion.translation_m.x(), kMostMotion, tr("mm"));
  motion_deg_ = motionField("sequenceTurn", motion.rotation_deg.x(), kMostTurn_deg, tr("deg"));
  const QString tip =
      tr("Largest motion between two images as seen from the camera: along and about each axis, "
         "about the station's centre. Prefer values that are too large.");
  for (QWidget* each : {motion_mm_, motion_deg_}) each->setToolTip(tip);
  const auto button = [this](const char* name, const QString& text, auto ask) {
    auto* push = named(new QPushButton(text), name);
    connect(push, &QPushButton::clicked, this, ask);
    return push;
  };
  auto* box = new QWidget;
  auto* grid = new QGridLayout(box);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->addWidget(new QLabel(tr("Images")), 0, 0);
  grid->addWidget(images_, 0, 1);
  grid->addWidget(button("sequenceFolder", tr("Folder..."), &SequenceDialog::askForFolder), 0, 2);
  grid->addWidget(button("sequenceVideo", tr("Video or list..."), &SequenceDialog::askForFile), 0,
                  3);
  grid->addWidget(new QLabel(tr("Results")), 1, 0);
  grid->addWidget(results_, 1, 1);
  grid->addWidget(button("sequenceChooseResults", tr("Choose..."), &SequenceDialog::askForResults),
                  1, 2, 1, 2);
  auto* line = new QHBoxLayout;
  line->addWidget(new QLabel(tr("Largest motion between two images")));
  line->addWidget(motion_mm_);
  line->addWidget(motion_deg_);
  line->addStretch(1);
  line->addWidget(progress_);
  line->addWidget(cancel_);
  line->addWidget(run_);
  grid->addLayout(line, 2, 0, 1, 4);
  grid->setColumnStretch(1, 1);
  return box;
}

QWidget* SequenceDialog::buildFrames() {
  setUpTable(*table_, *model_);
  table_->horizontalHeader()->setStretchLastSection(true);
  new ColumnFitter(*table_, {kTime_ms, kTurned_deg, kMoved_mm, kProbability});
  (new EmptyHint(*table_))->setText(tr("Choose the images, then Run: one row per frame."));
  auto* split = new QSplitter;
  split->addWidget(table_);
  split->addWidget(picture_);
  split->setSizes({kTableWidth_px, kDialogSize.width() - kTableWidth_px});
  split->setStretchFactor(1, 1);
  split->setChildrenCollapsible(false);
  Layer edges = picture_->layer(LayerId::kIterationEdges);
  edges.style = layerInfo(LayerId::kIterationEdges).style;
  edges.style.visible = true;
  picture_->setLayer(std::move(edges));
  clearPicture();
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          &SequenceDialog::showFrame);
  return split;
}

void SequenceDialog::clearPicture() {
  picture_->setImage({});
  picture_->setHint(tr("Choose a frame: its image and the outline of its pose are shown here."));
}

void SequenceDialog::setImages(const std::filesystem::path& images) {
  if (pathOf(images_->text()) != images) images_->setText(fromText(images.string()));
  problem_.clear();
  update();
  showProgress();
}

void SequenceDialog::setResults(const std::filesystem::path& results) {
  chosen_results_ = results;
  update();
}

void SequenceDialog::askForFolder() {
  const QString folder =
      QFileDialog::getExistingDirectory(this, tr("Folder of the images"), images_->text());
  if (!folder.isEmpty()) setImages(pathOf(folder));
}

void SequenceDialog::askForFile() {
  const QString file = QFileDialog::getOpenFileName(
      this, tr("A video, or a text file with one image a line"), images_->text(),
      tr("Videos and lists (*.mp4 *.m4v *.mov *.avi *.mkv *.webm *.mpg *.mpeg *.ogv *.wmv *.mjpeg "
         "*.mjpg *.txt);;All files (*)"));
  if (!file.isEmpty()) setImages(pathOf(file));
}

/// An existing file of the same sequence is continued: nothing is replaced.
void SequenceDialog::askForResults() {
  const QString file = QFileDialog::getSaveFileName(
      this, tr("Results; an existing file of this sequence is continued"), results_->text(),
      tr("Results (*.sqlite)"), nullptr, QFileDialog::DontConfirmOverwrite);
  if (!file.isEmpty()) setResults(pathOf(file));
}

sessions::SequenceOrder SequenceDialog::order() const {
  sessions::SequenceOrder order;
  order.images = pathOf(images_->text());
  order.session_case = parts_.state.currentCase()->source;
  order.motion.translation_m.setConstant(1e-3 * motion_mm_->value());
  order.motion.rotation_deg.setConstant(motion_deg_->value());
  order.profile = parts_.document.session().profile;
  order.options = parts_.cases.options();
  order.results = pathOf(results_->text());
  order.command = "boresight: Run as a sequence";
  return order;
}

void SequenceDialog::start() {
  if (!run_->isEnabled()) return;
  problem_.clear();
  clearPicture();
  parts_.sequence.start(order(), parts_.state.currentCase());
}

/// What can be done now.
void SequenceDialog::update() {
  const auto& shown = parts_.state.currentCase();
  setWindowTitle(shown ? tr("Run as a sequence: %1").arg(fromText(shown->source.id))
                       : tr("Run as a sequence"));
  std::filesystem::path results = chosen_results_;
  if (results.empty() && !images_->text().isEmpty()) {
    std::filesystem::path images = pathOf(images_->text()).lexically_normal();
    if (!images.has_filename()) images = images.parent_path();
    results = images.replace_extension(".sqlite");
  }
  if (pathOf(results_->text()) != results) results_->setText(fromText(results.string()));
  const bool running = parts_.sequence.isRunning();
  const QString obstacle = parts_.cases.whyNotRunnable();
  run_->setEnabled(!running && shown && obstacle.isEmpty() && !images_->text().isEmpty() &&
                   !results_->text().isEmpty());
  run_->setToolTip(obstacle.isEmpty() ? tr("Localize the images one after the other, each from the "
                                           "last accepted pose")
                                      : obstacle);
  cancel_->setEnabled(running);
}

void SequenceDialog::showProgress() {
  const SequenceRunner& sequence = parts_.sequence;
  const SequenceProgress& now = sequence.progress();
  model_->setRows(sequence.rows(), static_cast<int>(sequence.rows().size()) > 1);
  if (model_->rowCount() == 1) table_->resizeColumnsToContents();
  if (sequence.isRunning() && model_->rowCount() > 0) table_->scrollToBottom();
  QString text =
      now.of > 0 ? tr("%1 of %2 frames").arg(now.done).arg(now.of) : tr("%1 frames").arg(now.done);
  if (now.lost > 0) text += tr(", %1 lost").arg(now.lost);
  if (now.frames_per_s > 0.0) text += tr("; %1 frames/s").arg(numberText(now.frames_per_s, 1));
  progress_->setText(now.done > 0 ? text : QString());
  showOutcome();
  update();
}

/// One sentence; where no frame is accepted, with the reason of the first.
void SequenceDialog::showOutcome() {
  const SequenceProgress& now = parts_.sequence.progress();
  const bool ended = !parts_.sequence.isRunning() && now.done > 0;
  banner_->setVisible(ended || !problem_.isEmpty());
  if (!problem_.isEmpty())
    return banner_->setMessage(QStringLiteral("✗"), problem_, Banner::Tone::kBad);
  if (!ended) return;
  QString text = tr("%1.").arg(now.summary);
  if (parts_.sequence.isStopped()) text += tr(" Cancelled; Run continues.");
  const bool any = now.lost < now.done;
  if (!any) text += tr(" The first: %1.").arg(fromText(parts_.sequence.rows().front().reason));
  banner_->setMessage(!any            ? QStringLiteral("✗")
                      : now.lost == 0 ? QStringLiteral("✓")
                                      : QStringLiteral("!"),
                      text, any ? Banner::Tone::kGood : Banner::Tone::kBad);
}

void SequenceDialog::showFrame() {
  const int row = table_->currentIndex().row();
  const auto& loaded = parts_.sequence.loadedCase();
  if (row < 0 || row >= model_->rowCount() || !loaded) return;
  pictures_.start(
      QStringLiteral("frame"),
      [order = parts_.sequence.order(), loaded, frame = model_->at(row)](const std::stop_token&) {
        return pictureOf(order, *loaded, frame);
      },
      [this](const FramePicture& picture) {
        Layer layer = picture_->layer(LayerId::kIterationEdges);
        layer.lines = picture.lines;
        picture_->setHint(picture.problem);
        picture_->setImage(picture.image);
        picture_->setLayer(std::move(layer));
      });
}

}  // namespace boresight::ui
