// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <QWidget>

#include "ui_mask_panel.h"

#include "sessions/session/session.h"
#include "ui/views/mask_editor.h"

namespace boresight::ui {

/// The ignore mask of the case: tools to draw on the image, pixels above a level, and the strokes
/// so far, to be named, copied to the camera's other cases, and removed. It only requests edits;
/// the document makes them.
class MaskPanel : public QWidget {
  Q_OBJECT

 public:
  explicit MaskPanel(MaskEditor& editor);

  /// nullptr: nothing can be edited. `named` are strokes that other cases of the camera offer.
  void setCase(const sessions::SessionCase* session_case, const sessions::MaskStrokes& named,
               int cases_of_camera);
  /// Number of ignored pixels and of all pixels; -1: not known yet.
  void setIgnored(std::int64_t ignored, std::int64_t pixels);

 public Q_SLOTS:
  void askForSaturated();
  void clearAll();

 Q_SIGNALS:
  void strokeRequested(const boresight::sessions::MaskStroke& stroke);
  /// The new strokes of the case with this id; the text describes the edit.
  void strokesRequested(const std::string& case_id, const boresight::sessions::MaskStrokes& strokes,
                        const QString& text);
  /// The case of a dialog is no longer shown; one sentence.
  void failed(const QString& message);
  void copyRequested(int stroke);

 private:
  void showTool();
  int rowInNext(const sessions::SessionCase& next) const;
  void showStrokes(int row);
  void updateButtons();
  void nameChosen();
  void removeChosen();
  int chosen() const;

  MaskEditor& editor_;
  std::optional<sessions::SessionCase> case_;
  sessions::MaskStrokes named_;
  int cases_of_camera_ = 0;
  Ui::MaskPanel ui_;
};

}  // namespace boresight::ui
