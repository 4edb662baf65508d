// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QFrame>
#include <QString>

class QListView;
class QToolButton;

namespace boresight::ui {

class CasesModel;

/// The cases as small pictures with a badge of their state, in every workspace. Names and errors
/// are in the panel of the cases, which the button at the top opens.
class CaseStrip : public QFrame {
  Q_OBJECT

 public:
  explicit CaseStrip(CasesModel& model, QWidget* parent = nullptr);

  void setCurrent(const QString& id);
  /// Pictures and names of a wide window, or smaller pictures.
  void setNarrow(bool narrow);
  QListView& list() { return *list_; }

 Q_SIGNALS:
  void caseRequested(const QString& id);
  void listRequested();
  void addRequested();

 private:
  void showRows();

  CasesModel& model_;
  QToolButton* filter_ = nullptr;
  QListView* list_ = nullptr;
  QString current_;  ///< the case that the window shows
  bool showing_ = false;  ///< the list follows the window, not the operator
};

}  // namespace boresight::ui
