// SPDX-License-Identifier: Apache-2.0
// Walking through a run stage by stage.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <QWidget>

#include "core/localizer/localizer.h"
#include "sessions/run/trace.h"
#include "ui/state/view_state.h"

class QAction;
class QButtonGroup;

namespace boresight::ui {

namespace Ui {
class RunScrubber;
}

/// The stages of an iteration that can be looked at, as far as it came.
std::vector<Stage> stagesOf(const sessions::IterationTrace& iteration);

/// Which of `stages` the cursor's stage shows: the last one not after it, or 0.
int shownStage(const std::vector<Stage>& stages, Stage cursor);

/// The cursor one stage on or back, across iterations; at the ends it stays. The last stage of an
/// iteration is kFinished, so that a cursor there follows an iteration that is under way.
RunCursor nextStage(const sessions::LocalizationTrace& run, const RunCursor& cursor);
RunCursor previousStage(const sessions::LocalizationTrace& run, const RunCursor& cursor);

/// Walks the cursor through a run: a slider over the iterations (leftmost: the seed), buttons, and
/// one button per stage of the chosen iteration. The window gives the actions their shortcuts.
class RunScrubber : public QWidget {
  Q_OBJECT

 public:
  enum class Step { kFirst, kPrevious, kNext, kLast, kPreviousStage, kNextStage };
  static constexpr int kStepCount = 6;

  explicit RunScrubber(ViewState& view, QWidget* parent = nullptr);
  ~RunScrubber() override;

  QAction* action(Step step) const { return actions_[static_cast<std::size_t>(step)]; }
  /// The name of the iteration under the cursor, for the label.
  void setPlace(const QString& text);

 private:
  void go(Step step);
  void chooseStage(int index);
  void showCursor();
  void showStages();

  ViewState& view_;
  std::array<QAction*, kStepCount> actions_{};
  QButtonGroup* stages_ = nullptr;
  const std::unique_ptr<Ui::RunScrubber> ui_;
};

}  // namespace boresight::ui
