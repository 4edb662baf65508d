// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QFrame>
#include <QString>

#include "ui_case_strip.h"

namespace boresight::ui {

class CasesModel;
class DecisionOrder;

/// The cases as thumbnails with a badge of their state, in every workspace. Names and errors are in
/// the panel of cases, which the button at the top opens.
class CaseStrip : public QFrame {
  Q_OBJECT

 public:
  explicit CaseStrip(CasesModel& model, QWidget* parent = nullptr);

  void setCurrent(const QString& id);
  /// Wide: pictures and names; narrow: smaller pictures only.
  void setNarrow(bool narrow);
  /// Sorts for review: failed cases first, then those to decide on, then those not run, then
  /// decided ones. Otherwise the order is the session's.
  void setForDecisions(bool for_decisions);
  QListView& list() { return *ui_.stripList; }

 Q_SIGNALS:
  void caseRequested(const QString& id);
  void listRequested();
  void addRequested();
  /// At a place on the screen.
  void menuRequested(const QString& id, const QPoint& at);

 private:
  void showRows();
  QString idAt(const QModelIndex& index) const;

  CasesModel& model_;
  DecisionOrder* order_;
  Ui::CaseStrip ui_;
  QString current_;       ///< the case that the window shows
  bool showing_ = false;  ///< the list is being updated by the window, not the operator
};

}  // namespace boresight::ui
