// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/parts_panel.h"

#include "tests/ui/window_test.h"

namespace boresight::ui {
namespace {

using sessions::PartRole;

/// The example's station and a second copy of it, which only hides what is behind it.
class PartsPanelTest : public test::WindowTest {
 protected:
  void SetUp() override {
    sessions::Session session = test::exampleSession();
    sessions::SessionCase first = *session.cases[0];
    first.parts.push_back(first.parts[0]);
    first.parts[1].source.name = "cover";
    first.parts[1].source.state.role = PartRole::kOccludes;
    session.cases[0] = first;
    open(session);
  }
  QTableWidget& table() { return find<QTableWidget>("parts"); }
  const sessions::PartState& stateOf(std::size_t part) {
    return window_.document().session().cases[0]->parts[part].source.state;
  }
  void choose(int row, PartRole role) {
    auto* box = qobject_cast<QComboBox*>(table().cellWidget(row, 2));
    ASSERT_NE(box, nullptr);
    box->setCurrentIndex(static_cast<int>(role));
    Q_EMIT box->activated(static_cast<int>(role));
    QCoreApplication::processEvents();  // the edit follows the signal
    ASSERT_TRUE(rests());
  }
};

TEST_F(PartsPanelTest, ShowsTheStatesAndChangesThemAsEdits) {
  ASSERT_EQ(table().rowCount(), 2);
  EXPECT_EQ(table().item(1, 1)->text(), QStringLiteral("cover"));
  EXPECT_EQ(table().item(1, 3)->text(), QStringLiteral("STATION"));
  table().item(1, 0)->setCheckState(Qt::Unchecked);
  ASSERT_TRUE(wait([&] { return !stateOf(1).present; }));
  ASSERT_TRUE(rests());
  choose(1, PartRole::kIgnored);
  EXPECT_EQ(stateOf(1).role, PartRole::kIgnored);
  QTest::keySequence(&window_, QKeySequence::Undo);
  QTest::keySequence(&window_, QKeySequence::Undo);
  ASSERT_TRUE(rests());
  EXPECT_TRUE(stateOf(1).present);
  EXPECT_EQ(stateOf(1).role, PartRole::kOccludes);
  EXPECT_EQ(table().item(1, 0)->checkState(), Qt::Checked);
  choose(0, PartRole::kIgnored);
  EXPECT_EQ(stateOf(0).role, PartRole::kMatched) << "a station without a matched part is refused";
  EXPECT_TRUE(test::has(window_.lastMessage(), "matched"));
  EXPECT_EQ(qobject_cast<QComboBox*>(table().cellWidget(0, 2))->currentIndex(), 0);
}

TEST_F(PartsPanelTest, EditOfAnotherInput_LeavesAnOpenList) {
  const QWidget* box = table().cellWidget(1, 2);
  moveSeed(0.001);
  ASSERT_TRUE(rests());
  EXPECT_EQ(table().cellWidget(1, 2), box);
}

TEST_F(PartsPanelTest, NarrowPanel_HidesColumnsInsteadOfScrolling) {
  PartsPanel panel(window_.document(), window_.state());
  const auto& shown = *panel.findChild<QTableWidget*>(QStringLiteral("parts"));
  panel.show();
  panel.resize(900, 200);
  QCoreApplication::processEvents();
  EXPECT_FALSE(shown.isColumnHidden(4)) << "the mesh";
  panel.resize(250, 200);
  QCoreApplication::processEvents();
  EXPECT_TRUE(shown.isColumnHidden(3)) << "the frame";
  EXPECT_FALSE(shown.isColumnHidden(2)) << "the role";
  EXPECT_EQ(shown.horizontalScrollBar()->maximum(), 0);
  EXPECT_TRUE(test::has(shown.item(1, 1)->toolTip(), "fixed to STATION"));
}

}  // namespace
}  // namespace boresight::ui
