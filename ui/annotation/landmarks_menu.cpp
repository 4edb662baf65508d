// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/landmarks_menu.h"

#include "sessions/annotation/mark_edits.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/models/number_text.h"

namespace boresight::ui {

LandmarksMenu::LandmarksMenu(AnnotationController& controller, QWidget* parent)
    : QMenu(parent), controller_(controller) {
  connect(this, &QMenu::aboutToShow, this, &LandmarksMenu::fill);
  fill();
}

void LandmarksMenu::fill() {
  clear();
  addAction(tr("Open ..."), this, &LandmarksMenu::openRequested);
  addAction(tr("Save the marks as landmarks ..."), this, &LandmarksMenu::saveRequested);
  addSeparator();
  QAction* confirm =
      addAction(tr("Mark all that the image shows (%1)").arg(controller_.seenProposals()),
                &controller_, &AnnotationController::confirmSeen);
  confirm->setEnabled(controller_.seenProposals() > 0);
  addSeparator();
  bool any = false;
  for (const sessions::Landmark& landmark : controller_.landmarks()) {
    if (sessions::findPoint(controller_.marks(), landmark.name)) continue;
    any = true;
    QAction* begin = addAction(tr("Begin %1").arg(fromText(landmark.name)), this, [this, landmark] {
      controller_.setMode(PlaceMode::kPoint);
      controller_.begin(landmark);
    });
    begin->setToolTip(fromText(landmark.comment));
  }
  if (!any)
    addAction(controller_.landmarks().empty() ? tr("No landmarks are open")
                                              : tr("Every landmark has a mark here"))
        ->setEnabled(false);
}

}  // namespace boresight::ui
