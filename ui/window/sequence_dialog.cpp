// SPDX-License-Identifier: Apache-2.0
#include "ui/window/sequence_dialog.h"

#include <limits>

#include <QtWidgets>

#include "sessions/io/images/video_frames.h"
#include "ui/models/rows_model.h"
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
  constexpr auto tr = [](const char* text) { return SequenceDialog::tr(text); };
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
  if (row.accepted) picture.lines = linesOf(loaded, row.camera_from_station);
  return picture;
}

std::filesystem::path pathOf(const QString& text) { return text.toStdString(); }

}  // namespace

/// The frames of a sequence, one row each.
class SequenceModel final : public RowsModel<sessions::SequenceRow> {
 public:
  explicit SequenceModel(QObject* parent) : RowsModel(sequenceColumns()) { setParent(parent); }

 protected:
  /// The whole sentence, which a narrow column cuts.
  QVariant look(const sessions::SequenceRow& row, int, int role) const override {
    return role == Qt::ToolTipRole && !row.reason.empty() ? fromText(row.reason) : QVariant();
  }
};

SequenceDialog::SequenceDialog(WindowParts& parts, QWidget* parent)
    : QDialog(parent), parts_(parts), model_(new SequenceModel(this)) {
  ui_.setupUi(this);
  resize(kDialogSize);
  ui_.sequenceRun->setIcon(iconOf(Icon::kRun));
  ui_.sequenceCancel->setIcon(iconOf(Icon::kStop));
  const sessions::DeclaredUncertainty motion = sessions::assumedMotion();
  ui_.sequenceMotion->setValue(1e3 * motion.translation_m.x());
  ui_.sequenceTurn->setValue(motion.rotation_deg.x());
  setUpFrames();
  connect(ui_.sequenceFolder, &QPushButton::clicked, this, &SequenceDialog::askForFolder);
  connect(ui_.sequenceVideo, &QPushButton::clicked, this, &SequenceDialog::askForFile);
  connect(ui_.sequenceChooseResults, &QPushButton::clicked, this, &SequenceDialog::askForResults);
  connect(ui_.sequenceRun, &QPushButton::clicked, this, &SequenceDialog::start);
  connect(ui_.sequenceCancel, &QPushButton::clicked, &parts_.sequence, &SequenceRunner::stop);
  connect(&parts_.sequence, &SequenceRunner::changed, this, &SequenceDialog::showProgress);
  connect(&parts_.sequence, &SequenceRunner::failed, this, [this](const QString& message) {
    problem_ = message;
    showProgress();
  });
  connect(ui_.sequenceImages, &QLineEdit::textEdited, this,
          [this](const QString& text) { setImages(pathOf(text)); });
  connect(ui_.sequenceResults, &QLineEdit::textEdited, this,
          [this](const QString& text) { setResults(pathOf(text)); });
  parts_.state.onChange(ViewChange::kCase, this, &SequenceDialog::update);
  update();
  showProgress();
}

void SequenceDialog::setUpFrames() {
  setUpTable(*ui_.sequenceFrames, *model_);
  ui_.sequenceFrames->horizontalHeader()->setStretchLastSection(true);
  new ColumnFitter(*ui_.sequenceFrames, {kTime_ms, kTurned_deg, kMoved_mm, kProbability});
  (new EmptyHint(*ui_.sequenceFrames))
      ->setText(tr("Choose the images, then Run: one row per frame."));
  ui_.split->setSizes({kTableWidth_px, kDialogSize.width() - kTableWidth_px});
  ui_.split->setStretchFactor(1, 1);
  clearPicture();
  connect(ui_.sequenceFrames->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          &SequenceDialog::showFrame);
}

void SequenceDialog::clearPicture() {
  pictures_.cancel(showing_);
  ui_.sequencePicture->setImage({});
  ui_.sequencePicture->setHint(
      tr("Choose a frame: its image and the outline of its pose are shown here."));
}

void SequenceDialog::setImages(const std::filesystem::path& images) {
  if (pathOf(ui_.sequenceImages->text()) != images)
    ui_.sequenceImages->setText(fromText(images.string()));
  if (chosen_results_ && chosen_results_->empty()) chosen_results_.reset();
  problem_.clear();
  update();
  showProgress();
}

void SequenceDialog::setResults(const std::filesystem::path& results) {
  chosen_results_ = results;
  update();
}

void SequenceDialog::askForFolder() {
  const QString folder = QFileDialog::getExistingDirectory(this, tr("Folder of the images"),
                                                           ui_.sequenceImages->text());
  if (!folder.isEmpty()) setImages(pathOf(folder));
}

void SequenceDialog::askForFile() {
  const QString file = QFileDialog::getOpenFileName(
      this, tr("A video, or a text file with one image a line"), ui_.sequenceImages->text(),
      tr("Videos and lists (*.mp4 *.m4v *.mov *.avi *.mkv *.webm *.mpg *.mpeg *.ogv *.wmv *.mjpeg "
         "*.mjpg *.txt);;All files (*)"));
  if (!file.isEmpty()) setImages(pathOf(file));
}

/// An existing file of the same sequence is continued: nothing is replaced.
void SequenceDialog::askForResults() {
  const QString file = QFileDialog::getSaveFileName(
      this, tr("Results; an existing file of this sequence is continued"),
      ui_.sequenceResults->text(), tr("Results (*.sqlite)"), nullptr,
      QFileDialog::DontConfirmOverwrite);
  if (!file.isEmpty()) setResults(pathOf(file));
}

sessions::SequenceOrder SequenceDialog::order() const {
  sessions::SequenceOrder order;
  order.images = pathOf(ui_.sequenceImages->text());
  order.session_case = parts_.state.currentCase()->source;
  order.motion.translation_m.setConstant(1e-3 * ui_.sequenceMotion->value());
  order.motion.rotation_deg.setConstant(ui_.sequenceTurn->value());
  order.profile = parts_.document.session().profile;
  order.options = parts_.cases.options();
  order.results = pathOf(ui_.sequenceResults->text());
  order.command = "boresight: Run as a sequence";
  return order;
}

void SequenceDialog::start() {
  if (!ui_.sequenceRun->isEnabled()) return;
  problem_.clear();
  clearPicture();
  parts_.sequence.start(order(), parts_.state.currentCase());
}

/// What can be done now.
void SequenceDialog::update() {
  const auto& shown = parts_.state.currentCase();
  setWindowTitle(shown ? tr("Run as a sequence: %1").arg(fromText(shown->source.id))
                       : tr("Run as a sequence"));
  std::filesystem::path results = chosen_results_.value_or(std::filesystem::path());
  if (!chosen_results_ && !ui_.sequenceImages->text().isEmpty()) {
    std::filesystem::path images = pathOf(ui_.sequenceImages->text()).lexically_normal();
    if (!images.has_filename()) images = images.parent_path();
    results = images.replace_extension(".sqlite");
  }
  if (pathOf(ui_.sequenceResults->text()) != results)
    ui_.sequenceResults->setText(fromText(results.string()));
  const bool running = parts_.sequence.isRunning();
  const QString obstacle = parts_.cases.whyNotRunnable();
  ui_.sequenceRun->setEnabled(!running && shown && obstacle.isEmpty() &&
                              !ui_.sequenceImages->text().isEmpty() &&
                              !ui_.sequenceResults->text().isEmpty());
  ui_.sequenceRun->setToolTip(obstacle.isEmpty()
                                  ? tr("Localize the images one after the other, each from the "
                                       "last accepted pose")
                                  : obstacle);
  ui_.sequenceCancel->setEnabled(running);
}

void SequenceDialog::showProgress() {
  const SequenceRunner& sequence = parts_.sequence;
  const SequenceProgress& now = sequence.progress();
  const QScrollBar& bar = *ui_.sequenceFrames->verticalScrollBar();
  const bool at_end = bar.value() == bar.maximum();  // the operator reads no earlier frames
  model_->setRows(sequence.rows(), static_cast<int>(sequence.rows().size()) > 1);
  if (model_->rowCount() == 1) ui_.sequenceFrames->resizeColumnsToContents();
  if (sequence.isRunning() && at_end) ui_.sequenceFrames->scrollToBottom();
  QString text =
      now.of > 0 ? tr("%1 of %2 frames").arg(now.done).arg(now.of) : tr("%1 frames").arg(now.done);
  if (now.lost > 0) text += tr(", %1 lost").arg(now.lost);
  if (now.frames_per_s > 0.0) text += tr("; %1 frames/s").arg(numberText(now.frames_per_s, 1));
  ui_.sequenceProgress->setText(now.done > 0 ? text : QString());
  showOutcome();
  update();
}

/// One sentence; where no frame is accepted, with the reason of the first.
void SequenceDialog::showOutcome() {
  const SequenceProgress& now = parts_.sequence.progress();
  const bool ended = !parts_.sequence.isRunning() && now.done > 0;
  ui_.sequenceBanner->setVisible(ended || !problem_.isEmpty());
  if (!problem_.isEmpty())
    return ui_.sequenceBanner->setMessage(QStringLiteral("✗"), problem_, Banner::Tone::kBad);
  if (!ended) return;
  QString text = tr("%1.").arg(now.summary);
  for (const std::string& note : now.notes) text += tr(" Note: %1.").arg(fromText(note));
  if (parts_.sequence.isStopped()) text += tr(" Cancelled; Run continues.");
  const bool any = now.lost < now.done;
  if (!any) text += tr(" The first: %1.").arg(fromText(parts_.sequence.rows().front().reason));
  const bool as_stated = now.lost == 0 && now.notes.empty();
  ui_.sequenceBanner->setMessage(!any        ? QStringLiteral("✗")
                                 : as_stated ? QStringLiteral("✓")
                                             : QStringLiteral("!"),
                                 text, any ? Banner::Tone::kGood : Banner::Tone::kBad);
}

void SequenceDialog::showFrame() {
  const int row = ui_.sequenceFrames->currentIndex().row();
  const auto& loaded = parts_.sequence.loadedCase();
  if (row < 0 || row >= model_->rowCount() || !loaded) return;
  pictures_.replace(
      showing_,
      [order = parts_.sequence.order(), loaded, frame = model_->at(row)](const std::stop_token&) {
        return pictureOf(order, *loaded, frame);
      },
      [this](const FramePicture& picture) {
        ui_.sequencePicture->setHint(picture.problem);
        ui_.sequencePicture->setImage(picture.image);
        ui_.sequencePicture->setPart(LayerId::kIterationEdges, &Layer::lines, picture.lines);
      },
      [this](const QString& message) { ui_.sequencePicture->setHint(message); });
}

}  // namespace boresight::ui
