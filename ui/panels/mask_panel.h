// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <QWidget>

#include "sessions/session/session.h"
#include "ui/views/mask_editor.h"

class QBoxLayout;
class QDoubleSpinBox;
class QLabel;
class QListWidget;
class QPushButton;
class QSpinBox;
class QToolButton;

namespace boresight::ui {

/// The ignore mask of the case: tools to draw on the image, pixels above a level, and the strokes
/// made so far, which can be named, copied to the camera's other cases, and taken away. It only
/// asks for edits; the document makes them.
class MaskPanel : public QWidget {
  Q_OBJECT

 public:
  explicit MaskPanel(MaskEditor& editor, QWidget* parent = nullptr);

  /// nullptr: nothing can be edited. `named` are strokes that other cases of the camera offer.
  void setCase(const sessions::SessionCase* one, const sessions::MaskStrokes& named,
               int cases_of_camera);
  /// Pixels that are ignored, of so many; -1: not known yet.
  void setIgnored(std::int64_t ignored, std::int64_t pixels);

 public Q_SLOTS:
  void askForSaturated();
  void clearAll();

 Q_SIGNALS:
  void strokeRequested(const boresight::sessions::MaskStroke& stroke);
  /// All strokes of the case as they shall be; the text says what was done.
  void strokesRequested(const boresight::sessions::MaskStrokes& strokes, const QString& text);
  void copyRequested(int stroke);

 private:
  void buildTools(QBoxLayout& layout);
  void buildSaturation(QBoxLayout& layout);
  void buildStrokes(QBoxLayout& layout);
  void showTool();
  void showStrokes();
  void updateButtons();
  void nameChosen();
  void removeChosen();
  int chosen() const;

  MaskEditor& editor_;
  std::optional<sessions::SessionCase> case_;
  sessions::MaskStrokes named_;
  int cases_of_camera_ = 0;
  QToolButton* brush_ = nullptr;
  QToolButton* polygon_ = nullptr;
  QToolButton* erase_ = nullptr;
  QDoubleSpinBox* size_ = nullptr;
  QSpinBox* level_ = nullptr;
  QPushButton* saturated_ = nullptr;
  QListWidget* strokes_ = nullptr;
  QPushButton* name_ = nullptr;
  QPushButton* copy_ = nullptr;
  QPushButton* take_ = nullptr;
  QPushButton* remove_ = nullptr;
  QPushButton* clear_ = nullptr;
  QLabel* summary_ = nullptr;
};

}  // namespace boresight::ui
