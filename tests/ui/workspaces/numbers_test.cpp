// SPDX-License-Identifier: Apache-2.0
// Numbers are shown and typed with a point, whatever the desktop's locale; runs in a German one too.
#include "tests/ui/window_test.h"
#include "ui/models/text.h"
#include "ui/widgets/input_guard.h"
#include "ui/window/application.h"

namespace boresight::ui {
namespace {

class NumbersTest : public ::testing::Test {
 protected:
  NumbersTest() {
    nameApplication(*qApp);
    qApp->setStyle(QStringLiteral("fusion"));
    box_ = std::make_unique<QDoubleSpinBox>();  // it keeps the locale of its birth
    box_->setRange(-1e5, 1e5);
    box_->setDecimals(3);
    box_->show();
  }
  /// As typed and confirmed in the place of all that is there.
  double typed(const QString& text) {
    box_->setValue(7.0);
    box_->selectAll();
    QTest::keyClicks(box_.get(), text);
    QTest::keyClick(box_.get(), Qt::Key_Return);
    return box_->value();
  }
  double pasted(const QString& text) {
    QGuiApplication::clipboard()->setText(text);
    box_->setValue(7.0);
    box_->selectAll();
    QTest::keyClick(box_.get(), Qt::Key_V, Qt::ControlModifier);
    QTest::keyClick(box_.get(), Qt::Key_Return);
    return box_->value();
  }

  QObject owner_;
  InputGuard guard_{&owner_};
  std::unique_ptr<QDoubleSpinBox> box_;
};

TEST_F(NumbersTest, FieldsShowThePoint) {
  EXPECT_EQ(QLocale(), QLocale::c());
  box_->setValue(1234.5);
  EXPECT_EQ(box_->text(), QStringLiteral("1234.500"));
}

TEST_F(NumbersTest, CommaInAField_IsAPoint_NeverASeparatorOfThousands) {
  for (const auto& [text, value] :
       {std::pair("0.5", 0.5), std::pair("0,5", 0.5), std::pair("-12,25", -12.25),
        std::pair("1,234", 1.234)}) {
    EXPECT_EQ(typed(QString::fromLatin1(text)), value) << text;
    EXPECT_EQ(pasted(QString::fromLatin1(text)), value) << text;
  }
  EXPECT_EQ(pasted(QStringLiteral("1,234.5")), 7.0) << "it is refused";
}

TEST_F(NumbersTest, CommaInAFieldOfWholeNumbers_IsRefused) {
  QSpinBox whole;
  whole.setRange(0, 100000);
  whole.setValue(7);
  whole.show();
  QGuiApplication::clipboard()->setText(QStringLiteral("1,5"));
  whole.selectAll();
  QTest::keyClick(&whole, Qt::Key_V, Qt::ControlModifier);
  QTest::keyClick(&whole, Qt::Key_Return);
  EXPECT_EQ(whole.value(), 7);
}

TEST_F(NumbersTest, TextsOfCells_AreReadAlike) {
  EXPECT_EQ(typedNumber(QStringLiteral("0,5")), 0.5);
  EXPECT_EQ(typedNumber(QStringLiteral("-1.25e-3")), -1.25e-3);
  for (const char* wrong : {"", "abc", "1,234.5", "1.2.3", "nan", "inf"})
    EXPECT_FALSE(typedNumber(QString::fromLatin1(wrong))) << wrong;
}

TEST_F(NumbersTest, WheelOverTabs_ChangesNone) {
  QTabBar tabs;
  for (const char* title : {"Run", "Diagnose", "Review"}) tabs.addTab(QString::fromLatin1(title));
  tabs.show();
  QWheelEvent event({5.0, 5.0}, tabs.mapToGlobal(QPoint(5, 5)), {}, {0, -120}, Qt::NoButton,
                    Qt::NoModifier, Qt::NoScrollPhase, false);
  QCoreApplication::sendEvent(&tabs, &event);
  EXPECT_EQ(tabs.currentIndex(), 0);
}

}  // namespace
}  // namespace boresight::ui
