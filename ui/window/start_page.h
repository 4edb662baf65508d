// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>

#include <QScrollArea>

#include "sessions/session/case_inputs.h"

class QFrame;
class QLabel;
class QPushButton;
class QToolButton;
class QVBoxLayout;

namespace boresight::ui {

class Document;
class SessionFiles;

/// Widgets of one file of a case: its kind, its state, and buttons to choose and remove it.
struct FileSlot {
  QFrame* card = nullptr;
  QLabel* state = nullptr;
  QLabel* picture = nullptr;
  QLabel* name = nullptr;
  QLabel* detail = nullptr;
  QPushButton* choose = nullptr;
  QToolButton* remove = nullptr;
};

/// Start page: the four files of a new case, examples, recent sessions, and untitled sessions left
/// by a killed program.
class StartPage : public QScrollArea {
  Q_OBJECT

 public:
  /// In the order of sessions::InputKind.
  enum Slot { kImage, kCamera, kMesh, kSeed };
  static constexpr int kSlotCount = sessions::kInputKinds;

  StartPage(SessionFiles& files, Document& document, QWidget* parent = nullptr);

  /// Updates files, recent sessions and left sessions.
  void refresh();

 private:
  QWidget* buildSlots();
  void buildSlot(int index);
  QWidget* buildExamples();
  QWidget* exampleRow(const QString& title, const QString& text,
                      const std::filesystem::path& session, const std::filesystem::path& image);
  QWidget* buildGoOn();
  void showSlots();
  void showSlot(int index, bool added, const QString& name, const QString& detail);
  void showPicture();
  void showUnits();
  void showRecent();
  void showLeft();

  SessionFiles& files_;
  Document& document_;
  std::array<FileSlot, kSlotCount> slots_;
  QLabel* heading_ = nullptr;  ///< of the slots: names the session that gets the case
  QVBoxLayout* units_ = nullptr;
  QString shown_units_;
  QPushButton* seedless_ = nullptr;
  QFrame* left_ = nullptr;
  QLabel* left_text_ = nullptr;
  std::filesystem::path left_file_;
  bool discards_ = false;  ///< the next click deletes
  QVBoxLayout* recent_ = nullptr;
};

}  // namespace boresight::ui
