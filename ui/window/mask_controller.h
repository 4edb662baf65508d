// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <QObject>

#include "sessions/io/images/image_file.h"
#include "sessions/session/session.h"
#include "ui/state/view_state.h"
#include "ui/window/window_parts.h"

namespace boresight::ui {

/// The other cases with the camera of a case. Searched again only after a change of the list, of a
/// camera or of a mask: a session has tens of thousands of cases.
class CasesOfCamera {
 public:
  void follow(const sessions::Session& session, const std::string& case_id);

  int count() const { return count_; }
  /// Their named strokes that the case lacks.
  const sessions::MaskStrokes& named() const { return named_; }

 private:
  bool isOfOtherCases(const sessions::Session& session) const;

  sessions::Session session_;
  std::string case_id_;
  int count_ = 0;
  sessions::MaskStrokes named_;
};

class LevelsPanel;

/// Changes the rule for the conversion of images to 8 bit by an edit of the document. The images
/// are read on a worker thread first, as the document stores the hash of their 8-bit pixels.
class LevelsController : public QObject {
  Q_OBJECT

 public:
  LevelsController(WindowParts& parts, LevelsPanel& panel, QObject* parent = nullptr);

 Q_SIGNALS:
  void noted(const QString& message);
  /// The images cannot be converted; one sentence.
  void failed(const QString& message);

 private:
  void convert(const sessions::ImageReadOptions& eight_bit, bool whole_camera);
  void showDocument();

  WindowParts& parts_;
  LevelsPanel& panel_;
  CasesOfCamera of_camera_;
};

class ImagePanel;
class MaskEditor;
class MaskPanel;

/// Turns strokes drawn on the image and requests of the panel into edits of the document, and shows
/// the document's state in both. A stroke belongs to the case on whose image it was drawn.
class MaskController : public QObject {
  Q_OBJECT

 public:
  MaskController(WindowParts& parts, MaskEditor& editor, MaskPanel& panel, ImagePanel& image,
                 QObject* parent = nullptr);

 private:
  std::string shownId() const { return shownCaseId(parts_.document, parts_.state); }
  void addStroke(const sessions::MaskStroke& stroke);
  void setStrokes(const std::string& case_id, const sessions::MaskStrokes& strokes,
                  const QString& text);
  void copyStroke(int stroke);
  void showDocument();
  void showPending(const sessions::SessionCase& edited);
  void showTool();

  WindowParts& parts_;
  MaskEditor& editor_;
  MaskPanel& panel_;
  ImagePanel& image_;
  CasesOfCamera of_camera_;
};

}  // namespace boresight::ui
