// SPDX-License-Identifier: Apache-2.0
#include "ui/window/mask_controller.h"

#include <algorithm>

#include "sessions/session/mask_edits.h"
#include "ui/panels/mask_panel.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/views/image_panel.h"
#include "ui/views/mask_editor.h"

namespace boresight::ui {

using sessions::MaskStroke;
using sessions::MaskStrokes;

MaskController::MaskController(const WindowParts& parts, MaskEditor& editor, MaskPanel& panel,
                               ImagePanel& image, QObject* parent)
    : QObject(parent), parts_(parts), editor_(editor), panel_(panel), image_(image) {
  connect(&editor_, &MaskEditor::strokeDrawn, this, &MaskController::addStroke);
  connect(&editor_, &MaskEditor::changed, this, &MaskController::showTool);
  connect(&panel_, &MaskPanel::strokeRequested, this, &MaskController::addStroke);
  connect(&panel_, &MaskPanel::strokesRequested, this, &MaskController::setStrokes);
  connect(&panel_, &MaskPanel::copyRequested, this, &MaskController::copyStroke);
  connect(&parts_.document, &Document::opened, this, &MaskController::showDocument);
  connect(&parts_.document, &Document::changed, this, &MaskController::showDocument);
  connect(&parts_.state, &ViewState::caseChanged, this, &MaskController::showDocument);
  showDocument();
}

std::string MaskController::shownId() const {
  const ViewState::CasePtr& one = parts_.state.currentCase();
  return one ? one->source.id : std::string();
}

void MaskController::addStroke(const MaskStroke& stroke) {
  const std::string id = shownId();
  const QString text =
      stroke.erase ? tr("Trust pixels of %1 again (%2)") : tr("Ignore pixels of %1 (%2)");
  const QString what = QString::fromStdString(sessions::strokeText(stroke));
  parts_.document.edit(withStroke(parts_.document.session(), id, stroke),
                       text.arg(QString::fromStdString(id), what));
  showDocument();
}

void MaskController::setStrokes(const MaskStrokes& strokes, const QString& text) {
  parts_.document.edit(withStrokes(parts_.document.session(), shownId(), strokes),
                       tr("%1 of %2").arg(text, QString::fromStdString(shownId())));
}

void MaskController::copyStroke(int stroke) {
  if (stroke < 0) return;
  parts_.document.edit(
      copyingStroke(parts_.document.session(), shownId(), static_cast<std::size_t>(stroke)),
      tr("Copy a stroke of the ignore mask of %1 to its camera's cases")
          .arg(QString::fromStdString(shownId())));
}

void MaskController::showDocument() {
  const sessions::Session& session = parts_.document.session();
  const std::string id = shownId();
  const bool editable = parts_.document.isOpen() && parts_.document.readOnlyReason().isEmpty();
  const sessions::SessionCase* edited = editable ? session.findCase(id) : nullptr;
  if (!edited) {
    panel_.setCase(nullptr, {}, 0);
    panel_.setIgnored(-1, 0);
    editor_.setTool(MaskTool::kNone);
    editor_.setPending({});
    return;
  }
  panel_.setCase(edited, namedStrokesOfCamera(session, id),
                 static_cast<int>(casesOfSameCamera(session, id).size()));
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

/// Nobody draws on a mask that does not show.
void MaskController::showTool() {
  if (editor_.tool() == MaskTool::kNone) return;
  LayerStyle style = image_.style(LayerId::kIgnoreMask);
  style.visible = true;
  image_.setStyle(LayerId::kIgnoreMask, style);
}

}  // namespace boresight::ui
