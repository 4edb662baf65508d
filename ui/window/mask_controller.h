// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QObject>

#include "sessions/io/images/image_file.h"
#include "sessions/session/session.h"
#include "ui/state/view_state.h"
#include "ui/window/window_parts.h"

namespace boresight::ui {

class LevelsPanel;

/// Makes another rule by which images become 8 bit an edit of the document. The images are read off
/// this thread first, as the document knows their 8-bit pixels by a hash.
class LevelsController : public QObject {
  Q_OBJECT

 public:
  LevelsController(const WindowParts& parts, LevelsPanel& panel, QObject* parent = nullptr);

 Q_SIGNALS:
  void noted(const QString& message);

 private:
  void convert(const sessions::ImageReadOptions& eight_bit, bool whole_camera);
  void showDocument();

  WindowParts parts_;
  LevelsPanel& panel_;
};

class ImagePanel;
class MaskEditor;
class MaskPanel;

/// Makes what is drawn on the image and asked for in the panel edits of the document, and shows in
/// both what the document says. A stroke belongs to the case whose image it was drawn on.
class MaskController : public QObject {
  Q_OBJECT

 public:
  MaskController(const WindowParts& parts, MaskEditor& editor, MaskPanel& panel, ImagePanel& image,
                 QObject* parent = nullptr);

 private:
  std::string shownId() const { return shownCaseId(parts_.document, parts_.state); }
  void addStroke(const sessions::MaskStroke& stroke);
  void setStrokes(const sessions::MaskStrokes& strokes, const QString& text);
  void copyStroke(int stroke);
  void showDocument();
  void showPending(const sessions::SessionCase& edited);
  void showTool();

  WindowParts parts_;
  MaskEditor& editor_;
  MaskPanel& panel_;
  ImagePanel& image_;
};

}  // namespace boresight::ui
