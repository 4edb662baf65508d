// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QObject>

#include "sessions/session/session.h"
#include "ui/window/window_parts.h"

namespace boresight::ui {

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
  std::string shownId() const;
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
