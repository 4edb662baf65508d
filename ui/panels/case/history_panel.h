// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QWidget>

class QListWidget;

namespace boresight::ui {

class Document;

/// The edits of the session since it was opened, the newest last; a click goes back or forward to
/// that state. Undone edits are gray.
class HistoryPanel : public QWidget {
  Q_OBJECT

 public:
  explicit HistoryPanel(Document& document, QWidget* parent = nullptr);

 private:
  void fill();

  Document& document_;
  QListWidget* list_;
  bool filling_ = false;
};

}  // namespace boresight::ui
