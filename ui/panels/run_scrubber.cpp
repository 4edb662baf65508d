// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/run_scrubber.h"

#include <cstddef>

#include <QtWidgets>

#include "ui_run_scrubber.h"

namespace boresight::ui {
namespace {

/// The cursor on a stage of an iteration; index counts within stagesOf.
RunCursor cursorAt(const sessions::LocalizationTrace& run, int iteration, int stage) {
  const auto stages = stagesOf(*run.iterations[static_cast<std::size_t>(iteration)]);
  const bool last = stage + 1 >= static_cast<int>(stages.size());
  return {iteration, last ? Stage::kFinished : stages[static_cast<std::size_t>(stage)]};
}

int stageCount(const sessions::LocalizationTrace& run, int iteration) {
  return static_cast<int>(stagesOf(*run.iterations[static_cast<std::size_t>(iteration)]).size());
}

int stageUnder(const sessions::LocalizationTrace& run, const RunCursor& cursor) {
  return shownStage(stagesOf(*run.iterations[static_cast<std::size_t>(cursor.iteration)]),
                    cursor.stage);
}

}  // namespace

std::vector<Stage> stagesOf(const sessions::IterationTrace& iteration) {
  const bool refines = iteration.kind == IterationKind::kRefine;
  const std::vector<Stage> all =
      refines ? std::vector<Stage>{Stage::kRender, Stage::kRefine}
              : std::vector<Stage>{Stage::kRender, Stage::kTemplates, Stage::kMatch, Stage::kPose};
  std::vector<Stage> reached;
  for (const Stage stage : all)
    if (stage == Stage::kRender || stage <= iteration.reached) reached.push_back(stage);
  return reached;
}

int shownStage(const std::vector<Stage>& stages, Stage cursor) {
  int shown = 0;
  for (std::size_t i = 0; i < stages.size(); ++i)
    if (stages[i] <= cursor) shown = static_cast<int>(i);
  return shown;
}

RunCursor nextStage(const sessions::LocalizationTrace& run, const RunCursor& cursor) {
  const int last = static_cast<int>(run.iterations.size()) - 1;
  if (cursor.iteration < 0) return last < 0 ? cursor : cursorAt(run, 0, 0);
  const int stage = stageUnder(run, cursor);
  if (stage + 1 < stageCount(run, cursor.iteration))
    return cursorAt(run, cursor.iteration, stage + 1);
  return cursor.iteration < last ? cursorAt(run, cursor.iteration + 1, 0) : cursor;
}

RunCursor previousStage(const sessions::LocalizationTrace& run, const RunCursor& cursor) {
  if (cursor.iteration < 0) return cursor;
  const int stage = stageUnder(run, cursor);
  if (stage > 0) return cursorAt(run, cursor.iteration, stage - 1);
  if (cursor.iteration == 0) return {-1, Stage::kFinished};
  return {cursor.iteration - 1, Stage::kFinished};
}

namespace {

struct StageText {
  Stage stage;
  const char* name;
  const char* help;
};
constexpr StageText kStageTexts[] = {
    {Stage::kRender, QT_TR_NOOP("Render"),
     QT_TR_NOOP("Show the edges rendered from the iteration's first pose.")},
    {Stage::kTemplates, QT_TR_NOOP("Templates"),
     QT_TR_NOOP("Show the templates cut from the render.")},
    {Stage::kMatch, QT_TR_NOOP("Match"),
     QT_TR_NOOP("Show where the templates were found in the image.")},
    {Stage::kPose, QT_TR_NOOP("Pose"),
     QT_TR_NOOP("Show the pose solved from the matches, its inliers and residuals.")},
    {Stage::kRefine, QT_TR_NOOP("Refine"),
     QT_TR_NOOP("Show the pose moved until rendered edges meet the image's own.")},
};

const StageText& textOf(Stage stage) {
  for (const StageText& text : kStageTexts)
    if (text.stage == stage) return text;
  return kStageTexts[std::size(kStageTexts) - 1];
}

}  // namespace

RunScrubber::RunScrubber(ViewState& view, QWidget* parent)
    : QWidget(parent), view_(view), ui_(std::make_unique<Ui::RunScrubber>()) {
  ui_->setupUi(this);
  actions_ = {ui_->goFirst, ui_->goPrevious,      ui_->goNext,
              ui_->goLast,  ui_->goPreviousStage, ui_->goNextStage};
  const std::array buttons = {ui_->first, ui_->previous,      ui_->next,
                              ui_->last,  ui_->previousStage, ui_->nextStage};
  for (std::size_t i = 0; i < buttons.size(); ++i) {
    buttons[i]->setDefaultAction(actions_[i]);
    buttons[i]->setAccessibleName(actions_[i]->text());
    connect(actions_[i], &QAction::triggered, this, [this, i] { go(static_cast<Step>(i)); });
  }
  ui_->shownIteration->setMinimumWidth(
      fontMetrics().horizontalAdvance(QStringLiteral("8.88 (88 of 88)")));
  stages_ = new QButtonGroup(this);
  for (QToolButton* each : {ui_->stage1, ui_->stage2, ui_->stage3, ui_->stage4})
    stages_->addButton(each, stages_->buttons().size());
  connect(stages_, &QButtonGroup::idClicked, this, &RunScrubber::chooseStage);
  connect(ui_->iterations, &QSlider::valueChanged, this, [this](int value) {
    view_.setCursor({value, Stage::kFinished});
  });
  view_.onChange(ViewChange::kSnapshot | ViewChange::kCursor, this, &RunScrubber::showCursor);
  showCursor();
}

RunScrubber::~RunScrubber() = default;

void RunScrubber::setPlace(const QString& text) { ui_->shownIteration->setText(text); }

void RunScrubber::go(Step step) {
  const RunCursor& cursor = view_.cursor();
  const bool by_stage = step == Step::kPreviousStage || step == Step::kNextStage;
  if (by_stage) {
    if (!view_.snapshot()) return;
    view_.setCursor(step == Step::kNextStage ? nextStage(*view_.snapshot(), cursor)
                                             : previousStage(*view_.snapshot(), cursor));
    return;
  }
  const int target = step == Step::kFirst      ? -1
                     : step == Step::kPrevious ? cursor.iteration - 1
                     : step == Step::kNext     ? cursor.iteration + 1
                                               : ui_->iterations->maximum();
  view_.setCursor({target, Stage::kFinished});
}

void RunScrubber::chooseStage(int index) {
  const sessions::IterationTrace* shown = view_.iteration();
  if (shown == nullptr) return;
  const std::vector<Stage> stages = stagesOf(*shown);
  const bool last = index + 1 >= static_cast<int>(stages.size());
  view_.setCursor({view_.cursor().iteration,
                   last ? Stage::kFinished : stages[static_cast<std::size_t>(index)]});
}

void RunScrubber::showCursor() {
  const int last =
      view_.snapshot() ? static_cast<int>(view_.snapshot()->iterations.size()) - 1 : -1;
  const QSignalBlocker blocked(ui_->iterations);
  ui_->iterations->setRange(-1, last);
  ui_->iterations->setValue(view_.cursor().iteration);
  ui_->iterations->setEnabled(last >= 0);
  const bool at_start = view_.cursor().iteration < 0;
  const bool at_end = view_.cursor().iteration >= last;
  action(Step::kFirst)->setEnabled(!at_start);
  action(Step::kPrevious)->setEnabled(!at_start);
  action(Step::kNext)->setEnabled(!at_end);
  action(Step::kLast)->setEnabled(!at_end);
  showStages();
}

void RunScrubber::showStages() {
  const sessions::IterationTrace* shown = view_.iteration();
  const std::vector<Stage> stages = shown ? stagesOf(*shown) : std::vector<Stage>();
  const int chosen = shown ? shownStage(stages, view_.cursor().stage) : -1;
  // An exclusive group cannot have none checked.
  stages_->setExclusive(false);
  for (int i = 0; i < stages_->buttons().size(); ++i) {
    auto* button = qobject_cast<QToolButton*>(stages_->button(i));
    const bool exists = i < static_cast<int>(stages.size());
    button->setVisible(exists);
    button->setChecked(i == chosen);
    QFont weight = font();
    weight.setBold(i == chosen);
    button->setFont(weight);
    if (!exists) continue;
    button->setText(tr(textOf(stages[static_cast<std::size_t>(i)]).name));
    button->setToolTip(tr(textOf(stages[static_cast<std::size_t>(i)]).help));
  }
  stages_->setExclusive(chosen >= 0);
  const auto* run = view_.snapshot().get();
  action(Step::kPreviousStage)->setEnabled(run && view_.cursor().iteration >= 0);
  action(Step::kNextStage)->setEnabled(run && !(nextStage(*run, view_.cursor()) == view_.cursor()));
}

}  // namespace boresight::ui
