// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>

#include <QScrollArea>

#include "ui_file_slot.h"
#include "ui_start_page.h"

#include "sessions/session/case_inputs.h"

namespace boresight::ui {

class Document;
class SessionFiles;

/// Start page: the four files of a new case, examples, recent sessions, and untitled sessions left
/// by a killed program.
class StartPage : public QScrollArea {
  Q_OBJECT

 public:
  StartPage(SessionFiles& files, Document& document, QWidget* parent = nullptr);

  /// Updates files, recent sessions and left sessions.
  void refresh();

 private:
  /// One file of a case: its kind, its state, and buttons to choose and remove it.
  struct FileSlot : Ui::FileSlot {
    QFrame* card = nullptr;
  };

  void buildSlot(sessions::InputKind kind);
  void buildExamples();
  void addExample(const QString& title, const QString& text, const std::filesystem::path& session,
                  const std::filesystem::path& image);
  void buildLeft();
  void setDiscards(bool discards);
  FileSlot& slot(sessions::InputKind kind) { return slots_[static_cast<std::size_t>(kind)]; }
  void showSlots();
  void showSlot(sessions::InputKind kind);
  void showPicture();
  void showUnits();
  void showRecent();
  void showLeft();

  SessionFiles& files_;
  Document& document_;
  Ui::StartPage ui_;
  std::array<FileSlot, sessions::kInputKinds> slots_;
  QVBoxLayout* units_ = nullptr;
  QString shown_units_;
  QPushButton* seedless_ = nullptr;
  std::filesystem::path left_file_;
  bool discards_ = false;  ///< the next click deletes
};

}  // namespace boresight::ui
