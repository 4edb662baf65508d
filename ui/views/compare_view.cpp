// SPDX-License-Identifier: Apache-2.0
#include "ui/views/compare_view.h"

#include <algorithm>
#include <utility>

#include <QtWidgets>

#include "sessions/review/run_difference.h"
#include "sessions/session/case_run.h"
#include "sessions/session/rig_links.h"
#include "ui/models/text.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/views/display_image.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/views/overlay_painters.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr int kBoxMargin = 8;

/// How far a pose is from the shown run's, the seed's without one.
QString apartText(const sessions::LoadedCase& loaded, const sessions::LocalizationTrace* shown_run,
                  const Pose& other) {
  const Pose& shown = shown_run ? shown_run->lastPose() : loaded.source.camera_from_station_seed;
  const QString apart = fromText(poseDistanceText(poseDistance(loaded, shown, other)));
  return shown_run ? CompareView::tr("%1 from the shown run").arg(apart)
                   : CompareView::tr("%1 from the seed").arg(apart);
}

QStringList optionsText(const sessions::LocalizationTrace& shown_run,
                        const sessions::LocalizationTrace& other_run) {
  QStringList lines;
  for (const sessions::OptionChangeText& option :
       sessions::optionChanges(shown_run.lastOptions(), other_run.lastOptions()))
    lines << CompareView::tr("%1: %2, here %3")
                 .arg(fromText(option.name), fromText(option.before), fromText(option.after));
  return lines;
}

}  // namespace

CompareView::CompareView(ImagePanel& image, Document& document, ViewState& state, TaskRunner& tasks)
    : image_(image),
      document_(document),
      state_(state),
      tasks_(tasks),
      box_(named(new QComboBox, "compareWith", tr("What the second canvas shows"))),
      view_(named(new ImageView, "compareView")) {
  view_->setHint(tr("Reading ..."));
  view_->addOverlay(this, [this](QPainter& painter) { paintDifference(painter); });
  withoutMargins(new QVBoxLayout(this))->addWidget(view_);
  box_->setParent(view_);  // so that both images lie alike
  box_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  box_->move(kBoxMargin, kBoxMargin);
  connect(box_, QOverload<int>::of(&QComboBox::activated), this, &CompareView::order);
  ImageView& main = image_.view();
  connect(&main, &ImageView::transformChanged, this, [this] { follow(*view_, image_.view()); });
  connect(view_, &ImageView::transformChanged, this, [this] { follow(image_.view(), *view_); });
  connect(&main, &ImageView::cursorMoved, this, [this](const QPointF& pixel) {
    if (isVisible() && picture_.loaded_case == state_.currentCase()) view_->setLinkedCursor(pixel);
  });
  connect(&main, &ImageView::cursorLeft, this, [this] { view_->setLinkedCursor(std::nullopt); });
  connect(view_, &ImageView::cursorMoved, this, [this](const QPointF& pixel) {
    view_->setLinkedCursor(std::nullopt);
    if (picture_.loaded_case && !showsOtherCase()) image_.view().setLinkedCursor(pixel);
  });
  connect(view_, &ImageView::cursorLeft, this,
          [this] { image_.view().setLinkedCursor(std::nullopt); });
  // The rig's other camera follows the station under the pointer.
  connect(&image_, &ImagePanel::stationPlaceHovered, this,
          [this](const std::optional<Eigen::Vector3d>& place) {
            if (!showsOtherCase()) return;
            Eigen::Vector2d pixel;
            const bool seen = place && project(picture_.loaded_case->source.camera,
                                               picture_.camera_from_station * *place, pixel);
            view_->setLinkedCursor(seen ? std::optional(pointOf(pixel)) : std::nullopt);
          });
  state_.onChange(ViewChange::kCase | ViewChange::kSnapshot, this, &CompareView::fill);
  hide();
}

void CompareView::setOnboardRun(ViewState::SnapshotPtr run) {
  if (run == onboard_) return;
  onboard_ = std::move(run);
  fill();
}

QStringList CompareView::choices() const {
  QStringList names;
  for (const Choice& choice : choices_) names << choice.name;
  return names;
}

std::vector<CompareView::Choice> CompareView::choicesNow() const {
  std::vector<Choice> choices;
  const sessions::SessionCase* shown = shownCase(document_, state_);
  if (!shown) return choices;
  // Runs come first: what the last change did is what is compared most often.
  const auto& runs = document_.session().runs;
  const ViewState::SnapshotPtr& shown_run = state_.snapshot();
  for (auto run = runs.rbegin(); run != runs.rend(); ++run)
    if (run->case_id == shown->id && !(shown_run && run->digest == shown_run->digest))
      choices.push_back(
          {.name = tr("Run of %1: %2").arg(timeText(run->time), fromText(run->status)),
           .line = run->status == "converged" ? kPoseLine : kRejectedLine,
           .run = *run});
  if (const auto seed = poseOf(state_, PoseRole::kSeed))
    choices.push_back({.name = tr("Seed"), .line = kSeedLine, .camera_from_station = seed});
  if (const auto truth = poseOf(state_, PoseRole::kTruth))
    choices.push_back({.name = tr("Truth"), .line = kTruthLine, .camera_from_station = truth});
  if (onboard_)
    choices.push_back({.name = tr("Onboard run"),
                       .line = isRejected(*onboard_) ? kRejectedLine : kPoseLine,
                       .camera_from_station = onboard_->lastPose(),
                       .onboard = true});
  for (const std::string& id : sessions::casesOfRig(document_.session(), shown->id))
    choices.push_back({.name = tr("Camera of %1").arg(fromText(id)), .case_id = id});
  return choices;
}

/// Keeps what is chosen where it is still there, also while another case is read.
void CompareView::fill() {
  if (!isVisible()) return;
  const QStringList listed = choices();
  choices_ = choicesNow();
  // A list that is open stays.
  if (!choices_.empty() && (choices() != listed || box_->count() == 0)) {
    const QString former = box_->currentText();
    box_->clear();
    box_->addItems(choices());
    box_->setCurrentIndex(std::max(0, box_->findText(former)));
    box_->adjustSize();
  }
  order();
}

/// The last choice that is wanted.
template <class Wanted>
void CompareView::choose(const Wanted& wanted) {
  image_.showBeside(true);
  fill();
  for (std::size_t i = 0; i < choices_.size(); ++i)
    if (wanted(choices_[i])) box_->setCurrentIndex(static_cast<int>(i));
  order();
}

void CompareView::showRun(const std::string& digest) {
  choose([&digest](const Choice& each) { return each.run && each.run->digest == digest; });
}

void CompareView::showOnboardRun() {
  if (onboard_) choose([](const Choice& each) { return each.onboard; });
}

void CompareView::order() {
  const auto& shown = state_.currentCase();
  const auto index = static_cast<std::size_t>(std::max(0, box_->currentIndex()));
  tasks_.cancel(comparing_);
  Q_EMIT chosen(index < choices_.size() && choices_[index].onboard);
  if (!shown || index >= choices_.size()) return view_->setImage({});
  std::optional<sessions::SessionCase> other_case;
  if (const auto* other = document_.session().findCase(choices_[index].case_id))
    other_case = *other;
  tasks_.replace(
      comparing_,
      [shown, choice = choices_[index], other_case, pose = state_.shownPose(),
       shown_run = state_.snapshot()](const std::stop_token&) {
        Picture picture{shown, pose, nullptr, choice.line, {}};
        std::optional<sessions::LocalizationTrace> run;
        if (choice.camera_from_station) picture.camera_from_station = *choice.camera_from_station;
        if (choice.run) run = sessions::loadRun(*choice.run);
        if (run) picture.camera_from_station = run->lastPose();
        if (choice.case_id.empty())
          picture.difference << apartText(*shown, shown_run.get(), picture.camera_from_station);
        if (run && shown_run) picture.difference << optionsText(*shown_run, *run);
        if (other_case) {
          picture.loaded_case = sessions::loadCase(*other_case);
          picture.camera_from_station = *sessions::linkOfRig(shown->source, *other_case) * pose;
        }
        picture.lines = linesOf(*picture.loaded_case, picture.camera_from_station);
        return picture;
      },
      [this](Picture picture) { take(std::move(picture)); },
      [this](const QString& problem) {  // a run's file may be gone
        view_->setImage({});
        view_->setHint(problem);
      });
}

void CompareView::take(Picture picture) {
  picture_ = std::move(picture);
  // As the operator sees the other canvas; another image as the algorithm sees it.
  const auto& compared = picture_.loaded_case;
  const bool same = state_.currentCase() == compared;
  following_ = true;  // the operator's part of the image stays
  view_->setHint(tr("Reading ..."));
  view_->setImage(same ? image_.display().picture() : grayImage(compared->image.view()));
  following_ = false;
  Layer layer = view_->layer(LayerId::kIterationEdges);
  layer.lines = picture_.lines;
  layer.line = picture_.line;
  view_->setLayer(std::move(layer));
  follow(*view_, image_.view());
}

/// The same part of the image, as a share where the images differ in size.
void CompareView::follow(ImageView& follower, const ImageView& leader) {
  if (following_ || !isVisible() || follower.imageSize().isEmpty() || leader.imageSize().isEmpty())
    return;
  const QScopedValueRollback<bool> once(following_, true);
  if (leader.isFitted()) return follower.fit();
  const QPointF centre = leader.transform().toPixel(QPointF(leader.rect().center()));
  const QSizeF from = leader.imageSize();
  const QSizeF to = follower.imageSize();
  ViewTransform transform = follower.transform();
  transform.zoomAt({}, leader.transform().scale() * from.width() / to.width());
  transform.centreOn(
      {centre.x() * to.width() / from.width(), centre.y() * to.height() / from.height()},
      follower.size());
  follower.setTransform(transform);
}

/// In the lower left corner; options without room are counted.
void CompareView::paintDifference(QPainter& painter) const {
  QStringList lines = picture_.difference;
  constexpr int kMost = 6;
  if (lines.size() > kMost) {
    const auto more = lines.size() - kMost + 1;
    lines = lines.mid(0, kMost - 1) << tr("and %1 other options").arg(more);
  }
  double bottom = view_->height() - kBoxMargin;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    const double top = bottom - noteSize(painter, *line).height();
    paintNote(painter, {static_cast<double>(kBoxMargin), top}, *line);
    bottom = top - 2.0;
  }
}

/// The image of another camera of the rig.
bool CompareView::showsOtherCase() const {
  const auto& shown = state_.currentCase();
  return picture_.loaded_case && shown && picture_.loaded_case->source.id != shown->source.id;
}

void CompareView::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  fill();
}

void CompareView::hideEvent(QHideEvent* event) {
  QWidget::hideEvent(event);
  image_.view().setLinkedCursor(std::nullopt);
}

}  // namespace boresight::ui
