// SPDX-License-Identifier: Apache-2.0
#include "ui/window/levels_controller.h"

#include <vector>

#include "sessions/session/image_conversion.h"
#include "sessions/session/mask_edits.h"
#include "ui/panels/levels_panel.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

using sessions::Conversion;

LevelsController::LevelsController(const WindowParts& parts, LevelsPanel& panel, QObject* parent)
    : QObject(parent), parts_(parts), panel_(panel) {
  connect(&panel_, &LevelsPanel::conversionRequested, this, &LevelsController::convert);
  connect(&parts_.document, &Document::opened, this, &LevelsController::showDocument);
  connect(&parts_.document, &Document::changed, this, &LevelsController::showDocument);
  connect(&parts_.state, &ViewState::caseChanged, this, &LevelsController::showDocument);
  showDocument();
}

void LevelsController::convert(const sessions::ImageReadOptions& eight_bit, bool whole_camera) {
  const ViewState::CasePtr& shown = parts_.state.currentCase();
  if (!shown) return;
  const sessions::Session& session = parts_.document.session();
  const std::string id = shown->source.id;
  std::vector<std::string> ids = {id};
  if (whole_camera) {
    const auto others = sessions::casesOfSameCamera(session, id);
    ids.insert(ids.end(), others.begin(), others.end());
  }
  std::vector<Conversion> wanted;
  for (const std::string& one : ids)
    if (const sessions::SessionCase* found = session.findCase(one))
      wanted.push_back({one, found->image});
  Q_EMIT noted(tr("Converting %n image(s)...", "", static_cast<int>(wanted.size())));
  parts_.tasks.start(
      QStringLiteral("conversion"),
      [wanted, eight_bit](const std::stop_token& stop) {
        std::vector<Conversion> made;
        for (const Conversion& one : wanted)
          if (!stop.stop_requested())
            made.push_back({one.case_id, sessions::converted(one.image, eight_bit)});
        return made;
      },
      [this, id](const std::vector<Conversion>& made) {
        const bool done = parts_.document.edit(
            withConversions(parts_.document.session(), made),
            tr("Change the 8-bit conversion of %1").arg(QString::fromStdString(id)));
        Q_EMIT noted(done ? tr("Converted; runs made before are stale") : QString());
      });
}

void LevelsController::showDocument() {
  const ViewState::CasePtr& shown = parts_.state.currentCase();
  const sessions::Session& session = parts_.document.session();
  const bool editable = parts_.document.isOpen() && parts_.document.readOnlyReason().isEmpty();
  const sessions::SessionCase* one =
      editable && shown ? session.findCase(shown->source.id) : nullptr;
  if (!one) {
    panel_.setCase(nullptr, nullptr, 0);
    return;
  }
  panel_.setCase(one, &shown->image,
                 static_cast<int>(sessions::casesOfSameCamera(session, one->id).size()));
}

}  // namespace boresight::ui
