// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/ui/patience.h"
#include "tests/ui/window_test.h"
#include "ui/review/review_panel.h"
#include "ui/widgets/widgets.h"

namespace boresight::test {

inline QString textAt(const QAbstractItemView& table, int row, int column) {
  return table.model()->index(row, column).data().toString();
}
/// The first row whose cell has a text in it; -1 where there is none.
inline int rowWith(const QAbstractItemView& table, int column, const QString& text) {
  for (int row = 0; row < table.model()->rowCount(); ++row)
    if (textAt(table, row, column).contains(text)) return row;
  return -1;
}

/// What a reviewer does with the panel, by its widgets.
class ReviewHands {
 public:
  explicit ReviewHands(QWidget& panel) : panel_(panel) {}

  QPushButton* button(const char* name) const {
    return panel_.findChild<QPushButton*>(QLatin1String(name));
  }
  QTableView& table() const { return *panel_.findChild<QTableView*>(QStringLiteral("checks")); }
  QString hint() const { return panel_.findChild<QLabel*>(QStringLiteral("emptyHint"))->text(); }
  QString banner() const { return panel_.findChild<ui::Banner*>()->text(); }
  void type(const char* name, const QString& text) const {
    auto* field = panel_.findChild<QLineEdit*>(QLatin1String(name));
    ASSERT_NE(field, nullptr) << name;
    field->setFocus();
    field->selectAll();
    QTest::keyClick(field, Qt::Key_Delete);
    QTest::keyClicks(field, text);
  }
  void sign(const QString& name, const QString& comment) const {
    type("decisionName", name);
    type("decisionComment", comment);
  }
  void click(const char* name) const { QTest::mouseClick(button(name), Qt::LeftButton); }
  int rowOf(const QString& check) const { return rowWith(table(), ui::ChecksModel::kCheck, check); }
  /// Types into a cell as a person does who goes there with the keys.
  static void typeInto(QTableView& table, int row, int column, const QString& text) {
    table.setFocus();
    table.setCurrentIndex(table.model()->index(row, column));
    QTest::keyClick(&table, Qt::Key_F2);
    auto* editor = table.findChild<QLineEdit*>();
    ASSERT_NE(editor, nullptr) << "the cell cannot be edited";
    editor->selectAll();
    QTest::keyClicks(editor, text);
    QTest::keyClick(editor, Qt::Key_Return);
    QApplication::processEvents();
    QApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);  // the editor
  }
  /// A reason for every check that failed.
  void passOverAll(const QString& reason) const {
    for (QLineEdit* field : panel_.findChildren<QLineEdit*>(QStringLiteral("waiver"))) {
      if (!field->isVisibleTo(&panel_)) continue;  // of an earlier card
      field->setFocus();
      field->selectAll();
      QTest::keyClicks(field, reason);
      QTest::keyClick(field, Qt::Key_Return);
    }
  }
  void validateAs(const QString& name) const {
    passOverAll(QStringLiteral("known"));
    sign(name, QStringLiteral("looked at it"));
    click("validate");
  }

 private:
  QWidget& panel_;
};

}  // namespace boresight::test
