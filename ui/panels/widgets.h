// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QAction>
#include <QKeySequence>
#include <QLabel>

class QAbstractItemModel;
class QAbstractItemView;
class QMenu;
class QTableView;

namespace boresight::ui {

/// How all tables look: whole rows, one at a time, no row numbers, compact, columns as wide as what
/// they hold.
void styleTable(QTableView& table);
/// A table of a model that looks so; `name` for tests and style sheets, `title` for readers of the
/// screen.
QTableView* newTable(const char* name, const QString& title, QAbstractItemModel& model,
                     QWidget* parent);

/// The widget, with a name for tests and a tool tip.
template <class Widget>
Widget* named(Widget* widget, const char* name, const QString& tip = {}) {
  widget->setObjectName(QLatin1String(name));
  if (!tip.isEmpty()) widget->setToolTip(tip);
  return widget;
}

/// "Ctrl+R".
inline QKeySequence keys(const char* text) { return QKeySequence(QLatin1String(text)); }

/// An action of a menu; its tool tip names the keys, if there are any.
QAction* addAction(QMenu& menu, const QString& text, const QKeySequence& keys, const QString& tip);
void setTip(QAction& action, const QString& tip);
template <class Receiver, class Function>
QAction* addAction(QMenu& menu, const QString& text, const QKeySequence& keys, const QString& tip,
                   Receiver* receiver, Function function) {
  QAction* action = addAction(menu, text, keys, tip);
  QObject::connect(action, &QAction::triggered, receiver, function);
  return action;
}

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
