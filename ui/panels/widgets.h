// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QAction>
#include <QKeySequence>
#include <QLabel>

class QAbstractItemModel;
class QAbstractItemView;
class QTableView;
class QTableWidget;

namespace boresight::ui {

/// How all tables look: whole rows, one at a time, no row numbers, compact, columns as wide as what
/// they hold.
void styleTable(QTableView& table);
/// The same for a table of a model, which it is given.
void setUpTable(QTableView& table, QAbstractItemModel& model);

/// Appends a row of texts: the first to the left, the others, figures, to the right.
void addRow(QTableWidget& table, const QStringList& texts);

/// The widget, with a name for tests and a tool tip.
template <class Widget>
Widget* named(Widget* widget, const char* name, const QString& tip = {}) {
  widget->setObjectName(QLatin1String(name));
  if (!tip.isEmpty()) widget->setToolTip(tip);
  return widget;
}

/// "Ctrl+R".
inline QKeySequence keys(const char* text) { return QKeySequence(QLatin1String(text)); }

/// A tip that names the keys of the action, if there are any.
void setTip(QAction& action, const QString& tip);
/// Says in an empty list why it is empty and what to do about it. Lies over the view and takes no
/// clicks.
class EmptyHint : public QLabel {
  Q_OBJECT

 public:
  /// The view must have its model already; a hint shows while that has at most `least_rows` rows.
  explicit EmptyHint(QAbstractItemView& view, int least_rows = 0);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void showOrHide();

  QAbstractItemView& view_;
  int least_rows_;
};

}  // namespace boresight::ui
