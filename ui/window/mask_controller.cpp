// SPDX-License-Identifier: Apache-2.0
#include "ui/window/mask_controller.h"

#include <algorithm>
#include <vector>

#include "sessions/session/input_check.h"
#include "sessions/session/session.h"
#include "ui/panels/annotate/levels_panel.h"
#include "ui/panels/annotate/mask_panel.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/views/image_panel.h"
#include "ui/views/mask_editor.h"

namespace boresight::ui {

using sessions::Conversion;

LevelsController::LevelsController(const WindowParts& parts, LevelsPanel& panel, QObject* parent)
    : QObject(parent), parts_(parts), panel_(panel) {
  connect(&panel_, &LevelsPanel::conversionRequested, this, &LevelsController::convert);
  connect(&parts_.document, &Document::opened, this, &LevelsController::showDocument);
  connect(&parts_.document, &Document::changed, this, &LevelsController::showDocument);
  parts_.state.onChange(ViewChange::kCase, this, &LevelsController::showDocument);
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
  for (const std::string& text : ids)
    if (const sessions::SessionCase* found = session.findCase(text))
      wanted.push_back({text, found->image});
  Q_EMIT noted(tr("Converting %n image(s)...", "", static_cast<int>(wanted.size())));
  parts_.tasks.start(
      QStringLiteral("conversion"),
      [wanted, eight_bit](const std::stop_token& stop) {
        std::vector<Conversion> conversions;
        for (const Conversion& conversion : wanted)
          if (!stop.stop_requested())
            conversions.push_back(
                {conversion.case_id, sessions::converted(conversion.image, eight_bit)});
        return conversions;
      },
      [this, id](const std::vector<Conversion>& conversions) {
        const bool done = parts_.document.edit(
            withConversions(parts_.document.session(), conversions),
            tr("Change the 8-bit conversion of %1").arg(QString::fromStdString(id)));
        Q_EMIT noted(done ? tr("Converted; earlier runs are stale") : QString());
      });
}

void LevelsController::showDocument() {
  const Document& document = parts_.document;
  const sessions::SessionCase* session_case =
      document.isEditable() ? shownCase(document, parts_.state) : nullptr;
  if (!session_case) {
    panel_.setCase(nullptr, nullptr, 0);
    return;
  }
  panel_.setCase(
      session_case, &parts_.state.currentCase()->image,
      static_cast<int>(sessions::casesOfSameCamera(document.session(), session_case->id).size()));
}

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
  parts_.state.onChange(ViewChange::kCase, this, &MaskController::showDocument);
  showDocument();
}

void MaskController::addStroke(const MaskStroke& stroke) {
  const std::string id = shownId();
  const QString text =
      stroke.erase ? tr("Use pixels of %1 again (%2)") : tr("Ignore pixels of %1 (%2)");
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
  const sessions::SessionCase* edited =
      parts_.document.isEditable() ? session.findCase(id) : nullptr;
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

/// A hidden mask cannot be drawn on.
void MaskController::showTool() {
  if (editor_.tool() == MaskTool::kNone) return;
  LayerStyle style = image_.style(LayerId::kIgnoreMask);
  style.visible = true;
  image_.setStyle(LayerId::kIgnoreMask, style);
}

}  // namespace boresight::ui
