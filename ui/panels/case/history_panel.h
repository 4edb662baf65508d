// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <QWidget>

#include "ui_history_panel.h"

namespace boresight::ui {

class Document;

/// The edits of the session since it was opened, the newest last; a click goes back or forward to
/// that state. Undone edits are gray.
class HistoryPanel : public QWidget {
  Q_OBJECT

 public:
  explicit HistoryPanel(Document& document);

 private:
  void fill();
  void fillAgain();

  Document& document_;
  std::size_t done_ = 0;  ///< edits in effect as listed
  bool filling_ = false;
  Ui::HistoryPanel ui_;
};

}  // namespace boresight::ui
