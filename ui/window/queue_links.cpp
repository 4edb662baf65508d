// SPDX-License-Identifier: Apache-2.0
#include "ui/window/queue_links.h"

#include <string>

#include <QAction>
#include <QDockWidget>
#include <QMenu>

#include "ui/models/number_text.h"
#include "ui/review/queue_panel.h"
#include "ui/state/view_state.h"
#include "ui/window/case_controller.h"
#include "ui/window/window_docks.h"

namespace boresight::ui {
namespace {

const QString kDock = QStringLiteral("queue");

}  // namespace

QueueLinks::QueueLinks(const WindowParts& parts, const WindowDocks& docks, QObject* parent)
    : QObject(parent), parts_(parts) {
  connect(&docks.queue(), &QueuePanel::openRequested, this,
          [this](const QString& id, const QString& digest, int iteration) {
            open({id, digest.toStdString(), iteration});
          });
  auto* dock = qobject_cast<QDockWidget*>(docks.queue().parentWidget());
  connect(dock, &QDockWidget::visibilityChanged, &docks.queue(), &QueuePanel::setInSight);
  connect(&parts_.state, &ViewState::snapshotChanged, this, &QueueLinks::goThere);
  connect(&parts_.cases, &CaseController::caseChosen, this, [this](const QString& id) {
    if (wanted_ && wanted_->case_id != id) wanted_.reset();  // somebody went elsewhere
  });
}

void QueueLinks::open(const Place& place) {
  wanted_ = place;
  parts_.cases.chooseCase(place.case_id);
  goThere();
}

/// As soon as the case is shown with its run. Another run of it that is shown stays as it is.
void QueueLinks::goThere() {
  const ViewState::CasePtr& one = parts_.state.currentCase();
  const ViewState::SnapshotPtr& run = parts_.state.snapshot();
  if (!wanted_ || !one || !run || fromText(one->source.id) != wanted_->case_id) return;
  const Place place = *wanted_;
  wanted_.reset();
  const int count = static_cast<int>(run->iterations.size());
  const bool exists = run->digest == place.run_digest && place.iteration < count;
  parts_.state.setCursor(
      {exists && place.iteration >= 0 ? place.iteration : count - 1, Stage::kFinished});
}

/// Keys that hold in the queue's list alone stand beside the text: elsewhere they are the image's.
void QueueLinks::addActions(QMenu& menu, const WindowDocks& docks) {
  QueuePanel& panel = docks.queue();
  QAction* show = menu.addAction(tr("Show the &queue"));
  show->setShortcut(QKeySequence(QStringLiteral("Shift+F9")));
  show->setStatusTip(tr("All cases, the most troubled first"));
  connect(show, &QAction::triggered, &panel, [&docks] {
    docks.raise(kDock);
    docks.queue().focusList();
  });
  menu.addSeparator();
  const auto add = [&menu, &panel](const QString& text, const QString& tip,
                                   void (QueuePanel::*act)()) {
    QAction* made = menu.addAction(text);
    made->setStatusTip(tip);
    connect(made, &QAction::triggered, &panel, act);
  };
  add(tr("&Open at the failed iteration\tEnter"),
      tr("Show the chosen case of the queue at the iteration that failed, or at the last one"),
      &QueuePanel::openChosen);
  add(tr("&Accept\tA"), tr("Validate the chosen case of the queue, when all checks passed"),
      &QueuePanel::accept);
  add(tr("&Reject\tR"), tr("Refuse the result of the chosen case of the queue"),
      &QueuePanel::reject);
  add(tr("&Next\tJ"), tr("The next case of the queue"), &QueuePanel::next);
  add(tr("&Previous\tK"), tr("The case of the queue before"), &QueuePanel::previous);
  QAction* differences = menu.addAction(tr("&Differences between the last two runs\tD"));
  differences->setStatusTip(tr("Each case's last run against the one before it"));
  connect(differences, &QAction::triggered, &panel, [&docks] {
    docks.raise(kDock);
    docks.queue().showDifferences(true);
  });
}

}  // namespace boresight::ui
