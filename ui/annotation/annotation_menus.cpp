// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/annotation_menus.h"

#include <algorithm>

#include <QClipboard>
#include <QGuiApplication>

#include "sessions/annotation/marks.h"
#include "sessions/session/rig_links.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/models/number_text.h"
#include "ui/panels/paste_pose_dialog.h"
#include "ui/state/document.h"

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

RigMenu::RigMenu(Document& document, ViewState& state, AnnotationController& controller,
                 QWidget* parent)
    : QMenu(parent), document_(document), state_(state), controller_(controller) {
  connect(this, &QMenu::aboutToShow, this, &RigMenu::fill);
}

void RigMenu::fill() {
  clear();
  const sessions::Session& session = document_.session();
  const ViewState::CasePtr& one = state_.currentCase();
  const sessions::SessionCase* shown = one ? session.findCase(one->source.id) : nullptr;
  if (!shown) {
    addAction(tr("No case is open"))->setEnabled(false);
    return;
  }
  const std::vector<std::string> linked = sessions::casesOfRig(session, shown->id);
  for (const std::string& id : linked)
    addAction(tr("Go to %1").arg(fromText(id)), this,
              [this, id] { Q_EMIT openRequested(fromText(id)); });
  if (!linked.empty()) {
    addAction(tr("Take %1 out of this rig").arg(fromText(shown->id)), &controller_,
              &AnnotationController::unlinkCase);
    addSeparator();
  }
  QMenu* links = addMenu(tr("Link with"));
  for (const auto& other : session.cases)
    if (other->id != shown->id && other->station == shown->station &&
        std::find(linked.begin(), linked.end(), other->id) == linked.end())
      addLinks(*links->addMenu(fromText(other->id)), *shown, *other);
  if (links->isEmpty()) links->addAction(tr("No other case of this station"))->setEnabled(false);
}

void RigMenu::addLinks(QMenu& menu, const sessions::SessionCase& shown,
                       const sessions::SessionCase& other) {
  const std::string id = other.id;
  menu.addAction(tr("The same camera, not moved"), this,
                 [this, id] { controller_.linkCase(id, Pose()); });
  if (const auto other_from_shown = sessions::linkOfTruths(shown, other))
    menu.addAction(tr("As the true poses say"), this,
                   [this, id, link = *other_from_shown] { controller_.linkCase(id, link); });
  menu.addAction(tr("By a pose from the clipboard ..."), this, [this, id] { askForPose(id); });
}

void RigMenu::askForPose(const std::string& other_id) {
  PastePoseDialog dialog(QGuiApplication::clipboard()->text(), this);
  dialog.setWindowTitle(
      tr("Pose of %1 from the shown camera: p_other = R p_shown + t").arg(fromText(other_id)));
  if (dialog.exec() == QDialog::Accepted && dialog.parsed().valid)
    controller_.linkCase(other_id, dialog.parsed().camera_from_station);
}

}  // namespace boresight::ui
