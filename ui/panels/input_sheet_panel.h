// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QWidget>

#include "sessions/session/input_sheet.h"

QT_BEGIN_NAMESPACE
class QLabel;
class QPushButton;
class QTableWidget;
QT_END_NAMESPACE

namespace boresight::ui {

/// What the inputs of the case are, in figures with units; what is probably wrong comes first, in
/// plain sentences. Ctrl+C copies the chosen lines. A button asks for what no image tells.
class InputSheetPanel : public QWidget {
  Q_OBJECT

 public:
  explicit InputSheetPanel(QWidget* parent = nullptr);

  /// Nothing: no case is open.
  void setSheet(const std::optional<sessions::InputSheet>& sheet);
  /// The whole sheet as lines of text.
  QString text() const;

 Q_SIGNALS:
  /// Somebody wants to state how well mesh and camera are known.
  void sigmasRequested();

 private:
  void showFlags(const std::vector<sessions::RedFlag>& flags);
  void copyChosen() const;

  QLabel* flags_ = nullptr;
  QTableWidget* table_ = nullptr;
  QPushButton* sigmas_ = nullptr;
};

}  // namespace boresight::ui
