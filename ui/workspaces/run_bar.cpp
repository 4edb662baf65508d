// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/run_bar.h"

#include <QtWidgets>

#include "ui/models/text.h"
#include "ui/panels/iterations_panel.h"
#include "ui/panels/widgets.h"
#include "ui/state/view_state.h"
#include "ui/style/tokens.h"

namespace boresight::ui {
namespace {

constexpr int kNarrowHeight = 36;  // the image keeps 40 % of a screen of 1280 x 800
constexpr int kWideHeight = 48;

/// "Moved 17.3 → 0.015 mm": by the first and by the shown iteration.
QString correctionText(const ViewState& state) {
  const auto shown = state.iteration();
  if (!shown) return {};
  const auto& first = *state.snapshot()->iterations.front();
  return RunBar::tr("Moved %1 → %2 mm")
      .arg(numberText(1e3 * first.correction_translation_m, 1),
           numberText(1e3 * shown->correction_translation_m, 3));
}

}  // namespace

RunBar::RunBar(ViewState& state, QWidget* parent)
    : QFrame(parent),
      state_(state),
      buttons_(new QHBoxLayout),
      scrubber_(new RunScrubber(state)),
      correction_(named(new QLabel, "runCorrection",
                        tr("Translation by the first iteration, and by the shown one"))) {
  setObjectName(QStringLiteral("runBar"));
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 0, 8, 0);
  row->setSpacing(8);
  buttons_->setSpacing(4);
  row->addLayout(buttons_);
  row->addWidget(scrubber_, 1);
  row->addWidget(correction_);
  state_.onChange(ViewChange::kSnapshot | ViewChange::kCursor, this, &RunBar::showCursor);
  setNarrow(false);
}

void RunBar::setActions(const QList<QAction*>& actions) {
  for (QAction* action : actions) {
    auto* button = new QToolButton;
    button->setDefaultAction(action);
    button->setAutoRaise(true);
    button->setIconSize(QSize(kIcon, kIcon));
    buttons_->addWidget(button);
    run_buttons_ << button;
  }
  setNarrow(narrow_);
}

void RunBar::setNarrow(bool narrow) {
  narrow_ = narrow;
  setFixedHeight(narrow ? kNarrowHeight : kWideHeight);
  for (QToolButton* button : run_buttons_)
    button->setToolButtonStyle(narrow ? Qt::ToolButtonIconOnly : Qt::ToolButtonTextBesideIcon);
  showCursor();
}

void RunBar::showCursor() {
  correction_->setText(correctionText(state_));
  correction_->setVisible(!narrow_ && !correction_->text().isEmpty());
}

}  // namespace boresight::ui
