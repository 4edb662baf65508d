// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <QStringList>
#include <QWidget>

class QTreeWidget;
class QTreeWidgetItem;

namespace boresight::ui {

class Document;
class ViewState;

/// The runs of the shown case, pinned ones first, then the newest: each can be opened in every view
/// or compared with the shown one. Pins are stored in the program's settings.
class RunsPanel : public QWidget {
  Q_OBJECT

 public:
  RunsPanel(Document& document, ViewState& state, QWidget* parent = nullptr);

 Q_SIGNALS:
  void openRequested(const std::string& digest);
  void compareRequested(const std::string& digest);

 private:
  void fill();
  void pin(const std::string& digest);
  void showMenu(const QPoint& at);
  std::string chosen() const;

  Document& document_;
  ViewState& state_;
  QTreeWidget* list_;
  QStringList pinned_;  ///< digests
};

}  // namespace boresight::ui
