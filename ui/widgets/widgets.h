// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>

#include <QAction>
#include <QComboBox>
#include <QFrame>
#include <QKeySequence>
#include <QLabel>
#include <QStringList>
#include <QToolButton>

#include "ui_banner.h"

#include "sessions/trace/trace.h"
#include "ui/style/icons.h"

class QAbstractItemModel;
class QAbstractItemView;
class QTableView;
class QTableWidget;

namespace boresight::ui {

/// Style of all tables: whole rows, one at a time, no row numbers, compact, columns as wide as
/// their contents. A menu of the header hides and shows columns; the choice is remembered.
void styleTable(QTableView& table);
/// Whether the operator has chosen the columns of this view.
bool hasChosenColumns(const QAbstractItemView& view);
/// Sets the model of a table and styles it.
void setUpTable(QTableView& table, QAbstractItemModel& model);

/// Chooses a row and scrolls to it if another was chosen; an invalid index: none. Meanwhile
/// `following` is true, since the choice is not the operator's.
void followRow(QTableView& table, const QModelIndex& row, bool& following);

/// Appends a row of texts: the first left aligned, the others (figures) right aligned.
void addRow(QTableWidget& table, const QStringList& texts);

/// The widget, with a name for tests and a tool tip.
template <class Widget>
Widget* named(Widget* widget, const char* name, const QString& tip = {}) {
  widget->setObjectName(QLatin1String(name));
  if (!tip.isEmpty()) widget->setToolTip(tip);
  return widget;
}

/// Whether the widget with the focus is a field that takes typed text, or an editor of a cell.
bool isTyping();

/// "Ctrl+R".
inline QKeySequence keys(const char* text) { return QKeySequence(QLatin1String(text)); }

/// A tip that names the keys of the action, if there are any.
void setTip(QAction& action, const QString& tip);

/// The layout, without margins.
template <class Layout>
Layout* withoutMargins(Layout* layout, int spacing = 0) {
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(spacing);
  return layout;
}
/// Deletes the items of a layout and their widgets.
void clearLayout(QLayout& layout);
/// The same, where one of the widgets may be handling an event: they are hidden, and deleted later.
void clearLayoutLater(QLayout& layout);
/// Applies the style sheet again, after a change of properties that its rules name.
void restyle(std::initializer_list<QWidget*> widgets);

/// A small, gray text that wraps.
QLabel* captionLabel(const QString& text);

/// Another entry of a list is chosen, by the operator or by the program.
inline constexpr auto kIndexChanged = QOverload<int>::of(&QComboBox::currentIndexChanged);

/// Calls a function of the receiver at each of these signals of the sender.
template <class Sender, class Receiver, class Function, class... Signals>
void connectEach(Sender& sender, Receiver* receiver, Function function, Signals... signals) {
  (QObject::connect(&sender, signals, receiver, function), ...);
}

/// States in an empty list why it is empty and what to do. Lies over the view and takes no clicks.
class EmptyHint : public QLabel {
  Q_OBJECT

 public:
  /// The view must have its model already; a hint shows while it has at most `least_rows` rows.
  explicit EmptyHint(QAbstractItemView& view, int least_rows = 0);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void showOrHide();
  void place();

  QAbstractItemView& view_;
  int least_rows_;
};

/// An icon in a colour of the theme in use, as large as the widget.
class IconLabel : public QWidget {
  Q_OBJECT

 public:
  using QWidget::QWidget;

  void setIcon(Icon icon, QRgb Theme::*color = &Theme::text);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  Icon icon_ = Icon::kNone;
  QRgb Theme::*color_ = &Theme::text;
};

/// A line below a list that shows and hides a part of it, which is remembered by its name.
class FoldButton : public QToolButton {
  Q_OBJECT

 public:
  explicit FoldButton(QWidget* parent = nullptr);

  /// `folded` is used until the operator chooses.
  void restore(bool folded);
  bool isFolded() const { return !isChecked(); }
  /// Describes the folded part; the button hides when `text` is empty.
  void setContent(const QString& text);

 Q_SIGNALS:
  void foldedChanged();

 private:
  QString key() const;
};

/// A sentence after a sign with a unique shape, and a button for a remedy. The colour is never the
/// only distinction.
class Banner : public QFrame {
  Q_OBJECT

 public:
  enum class Tone { kPlain, kGood, kBad };

  explicit Banner(QWidget* parent = nullptr);

  void setMessage(const QString& sign, const QString& text, Tone tone);
  /// Progress of a run; after its end the measured values, the required values and a remedy.
  /// nullptr: no run.
  void showRun(const sessions::LocalizationTrace* run);
  /// Shows the first sentences, and all of them in the tooltip. Hides the banner when empty.
  void showWarnings(const QStringList& sentences);
  /// Adds the button; `tip` describes its action.
  void setAction(const QString& text, const QString& tip);
  QString text() const;

 Q_SIGNALS:
  void actionRequested();

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void applyPalette();

  Tone tone_ = Tone::kPlain;
  bool tinting_ = false;
  Ui::Banner ui_{};
};

}  // namespace boresight::ui
