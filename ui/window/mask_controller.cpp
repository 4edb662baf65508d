// SPDX-License-Identifier: Apache-2.0
#include "ui/window/mask_controller.h"

#include <algorithm>
#include <vector>

#include "sessions/session/input_check.h"
#include "sessions/session/session.h"
#include "sessions/session/session_difference.h"
#include "ui/models/text.h"
#include "ui/panels/annotate/levels_panel.h"
#include "ui/panels/annotate/mask_panel.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/views/image_panel.h"
#include "ui/views/mask_editor.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

using sessions::Conversion;

bool CasesOfCamera::isOfOtherCases(const sessions::Session& session) const {
  const sessions::SessionDifference difference = sessions::differenceOf(session_, session);
  return difference.list || std::ranges::any_of(difference.cases, [&](const std::string& id) {
           const sessions::SessionCase* before = session_.findCase(id);
           const sessions::SessionCase* after = session.findCase(id);
           return !before || !after || !(before->camera == after->camera) ||
                  before->image.width != after->image.width ||
                  before->image.height != after->image.height ||
                  !(before->ignore_strokes == after->ignore_strokes);
         });
}

void CasesOfCamera::follow(const sessions::Session& session, const std::string& case_id) {
  const bool others = case_id != case_id_ || isOfOtherCases(session);
  session_ = session;
  if (!others) return;
  case_id_ = case_id;
  count_ = static_cast<int>(sessions::casesOfSameCamera(session, case_id).size());
  named_ = sessions::namedStrokesOfCamera(session, case_id);
}

LevelsController::LevelsController(WindowParts& parts, LevelsPanel& panel, QObject* parent)
    : QObject(parent), parts_(parts), panel_(panel) {
  connect(&panel_, &LevelsPanel::conversionRequested, this, &LevelsController::convert);
  connectEach(parts_.document, this, &LevelsController::showDocument, &Document::opened,
              &Document::changed);
  parts_.state.onChange(ViewChange::kCase, this, &LevelsController::showDocument);
  showDocument();
}

void LevelsController::convert(const sessions::ImageReadOptions& eight_bit, bool whole_camera) {
  const ViewState::CasePtr& shown = parts_.state.currentCase();
  if (!shown) return;
  const sessions::Session& session = parts_.document.session();
  const std::string id = shown->source.id;
  std::vector<std::string> ids;
  if (whole_camera) ids = sessions::casesOfSameCamera(session, id);
  ids.insert(ids.begin(), id);
  std::vector<Conversion> wanted;
  for (const std::string& each : ids)
    if (const sessions::SessionCase* found = session.findCase(each))
      wanted.push_back({each, found->image});
  Q_EMIT noted(tr("Converting %n image(s)...", "", static_cast<int>(wanted.size())));
  parts_.of_document.ofDocument(
      {tr("The conversion of %1").arg(fromText(id)), tr("convert it again")},
      [wanted, eight_bit](const std::stop_token& stop) {
        std::vector<Conversion> conversions;
        for (const Conversion& conversion : wanted)
          if (!stop.stop_requested())
            conversions.push_back(
                {conversion.case_id, sessions::converted(conversion.image, eight_bit)});
        return conversions;
      },
      [this, id](const std::vector<Conversion>& conversions) {
        const bool done =
            parts_.document.edit(withConversions(parts_.document.session(), conversions),
                                 tr("Change the 8-bit conversion of %1").arg(fromText(id)));
        Q_EMIT noted(done ? tr("Converted; earlier runs are stale") : QString());
      },
      [this](const QString& message) {
        Q_EMIT noted({});
        Q_EMIT failed(message);
      });
}

void LevelsController::showDocument() {
  const Document& document = parts_.document;
  const sessions::SessionCase* session_case =
      document.isEditable() ? shownCase(document, parts_.state) : nullptr;
  if (!session_case) return panel_.setCase(nullptr, nullptr, 0);
  of_camera_.follow(document.session(), session_case->id);
  panel_.setCase(session_case, &parts_.state.currentCase()->image, of_camera_.count());
}

using sessions::MaskStroke;
using sessions::MaskStrokes;

MaskController::MaskController(WindowParts& parts, MaskEditor& editor, MaskPanel& panel,
                               ImagePanel& image, QObject* parent)
    : QObject(parent), parts_(parts), editor_(editor), panel_(panel), image_(image) {
  connect(&editor_, &MaskEditor::strokeDrawn, this, &MaskController::addStroke);
  connect(&editor_, &MaskEditor::changed, this, &MaskController::showTool);
  connect(&panel_, &MaskPanel::strokeRequested, this, &MaskController::addStroke);
  connect(&panel_, &MaskPanel::strokesRequested, this, &MaskController::setStrokes);
  connect(&panel_, &MaskPanel::copyRequested, this, &MaskController::copyStroke);
  connectEach(parts_.document, this, &MaskController::showDocument, &Document::opened,
              &Document::changed);
  parts_.state.onChange(ViewChange::kCase, this, &MaskController::showDocument);
  showDocument();
}

void MaskController::addStroke(const MaskStroke& stroke) {
  const std::string id = shownId();
  if (id.empty()) return;
  const QString text =
      stroke.erase ? tr("Use pixels of %1 again (%2)") : tr("Ignore pixels of %1 (%2)");
  parts_.document.edit(withStroke(parts_.document.session(), id, stroke),
                       text.arg(fromText(id), fromText(sessions::strokeText(stroke))));
  showDocument();
}

void MaskController::setStrokes(const std::string& case_id, const MaskStrokes& strokes,
                                const QString& text) {
  parts_.document.edit(withStrokes(parts_.document.session(), case_id, strokes),
                       tr("%1 of %2").arg(text, fromText(case_id)));
}

void MaskController::copyStroke(int stroke) {
  if (stroke < 0 || shownId().empty()) return;
  parts_.document.edit(
      copyingStroke(parts_.document.session(), shownId(), static_cast<std::size_t>(stroke)),
      tr("Copy a stroke of the ignore mask of %1 to its camera's cases").arg(fromText(shownId())));
}

void MaskController::showDocument() {
  const sessions::Session& session = parts_.document.session();
  const std::string id = shownId();
  const sessions::SessionCase* edited =
      parts_.document.isEditable() ? session.findCase(id) : nullptr;
  if (!edited) {
    panel_.setCase(nullptr, {}, 0);
    panel_.setIgnored(-1, 0);
    editor_.setTool(MaskTool::kNone);
    editor_.setPending({});
    return;
  }
  of_camera_.follow(session, id);
  panel_.setCase(edited, of_camera_.named(), of_camera_.count());
  showPending(*edited);
}

/// Strokes that the document has and the loaded case has not yet.
void MaskController::showPending(const sessions::SessionCase& edited) {
  const sessions::LoadedCase& loaded = *parts_.state.currentCase();
  const MaskStrokes& shown = loaded.source.ignore_strokes;
  const MaskStrokes& strokes = edited.ignore_strokes;
  const bool extends =
      strokes.size() >= shown.size() && std::equal(shown.begin(), shown.end(), strokes.begin());
  const auto shown_count = static_cast<std::ptrdiff_t>(shown.size());
  editor_.setPending(extends ? MaskStrokes(strokes.begin() + shown_count, strokes.end())
                             : MaskStrokes());
  const std::int64_t pixels = std::int64_t{loaded.image.width} * loaded.image.height;
  panel_.setIgnored(loaded.ignore ? loaded.ignore->ignored_count : 0, pixels);
}

/// A hidden mask cannot be drawn on.
void MaskController::showTool() {
  if (editor_.tool() != MaskTool::kNone) image_.showLayer(LayerId::kIgnoreMask, true);
}

}  // namespace boresight::ui
