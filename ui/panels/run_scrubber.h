// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <QWidget>

#include "core/localizer/localizer.h"
#include "ui/state/view_state.h"

QT_BEGIN_NAMESPACE
class QAction;
class QButtonGroup;
class QHBoxLayout;
class QLabel;
class QSlider;
class QToolButton;
QT_END_NAMESPACE

namespace boresight::ui {

/// Walks the cursor through a run: a slider over the iterations (leftmost: the seed), buttons, and
/// one button per stage of the chosen iteration. The window gives the actions their shortcuts.
class RunScrubber : public QWidget {
  Q_OBJECT

 public:
  enum class Step { kFirst, kPrevious, kNext, kLast, kPreviousStage, kNextStage };
  static constexpr int kStepCount = 6;

  explicit RunScrubber(ViewState& view, QWidget* parent = nullptr);

  QAction* action(Step step) const { return actions_[static_cast<std::size_t>(step)]; }
  /// The name of the iteration under the cursor, for the label.
  void setPlace(const QString& text);

 private:
  void addStep(Step step, const QString& sign, const QString& name, const QString& help);
  void addStageButtons();
  void go(Step step);
  void chooseStage(int index);
  void showCursor();
  void showStages();

  ViewState& view_;
  std::array<QAction*, kStepCount> actions_{};
  QSlider* slider_ = nullptr;
  QLabel* place_ = nullptr;
  QButtonGroup* stages_ = nullptr;
  QHBoxLayout* stage_row_ = nullptr;
};

}  // namespace boresight::ui
