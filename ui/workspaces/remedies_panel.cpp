// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/remedies_panel.h"

#include <utility>

#include <QtWidgets>

#include "ui/state/view_state.h"
#include "ui/style/tokens.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

RemediesPanel::RemediesPanel(ViewState& state, QWidget* parent)
    : QWidget(parent),
      state_(state),
      status_(named(new Banner, "runStatus")),
      rows_(withoutMargins(new QVBoxLayout, 8)) {
  auto* content = named(new QWidget, "remedies");
  content->setLayout(rows_);
  auto* scroll = new QScrollArea;
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setWidget(content);
  auto* column = new QVBoxLayout(this);
  column->addWidget(status_);
  column->addWidget(scroll, 1);
  state_.onChange(ViewChange::kSnapshot | ViewChange::kCase, this, &RemediesPanel::showRun);
  showRun();
}

QWidget* RemediesPanel::rowOf(const Remedy& remedy) {
  auto* row = new QWidget;
  auto* line = withoutMargins(new QHBoxLayout(row), 8);
  const QString text = QCoreApplication::translate("Remedies", remedy.cause);
  auto* cause = new QLabel(remedy.tried ? tr("Tried. %1").arg(text) : text);
  cause->setWordWrap(true);
  QSizePolicy policy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  policy.setHeightForWidth(true);  // next to a long button a cause takes more lines
  cause->setSizePolicy(policy);
  auto* button = new QPushButton;
  showStep(*button, remedy.step);
  button->setProperty("step", static_cast<int>(remedy.step));
  button->setMinimumWidth(kButtonHeight * 5);
  // Queued: the step may replace this very row.
  connect(
      button, &QPushButton::clicked, this,
      [this, step = remedy.step] { Q_EMIT stepRequested(step); }, Qt::QueuedConnection);
  line->addWidget(cause, 1);
  line->addWidget(button);
  return row;
}

void RemediesPanel::setTried(const std::vector<Step>& tried) {
  if (tried == tried_) return;
  tried_ = tried;
  showRun();
}

void RemediesPanel::showRun() {
  const auto run = state_.snapshot();
  status_->showRun(run.get());
  auto remedies = run ? remediesFor(*run, tried_) : std::vector<Remedy>();
  const QString none = !remedies.empty() ? QString()
                       : run && run->converged()
                           ? tr("The run converged: no remedies needed.")
                           : tr("Remedies are listed here after a failed run.");
  if (remedies == remedies_ && none == none_) return;  // a button that is pressed stays
  remedies_ = std::move(remedies);
  none_ = none;
  clearLayout(*rows_);
  if (!none_.isEmpty()) rows_->addWidget(captionLabel(none_));
  for (const Remedy& remedy : remedies_) rows_->addWidget(rowOf(remedy));
  rows_->addStretch(1);
}

}  // namespace boresight::ui
