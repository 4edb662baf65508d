// SPDX-License-Identifier: Apache-2.0
// The ignore mask from the pointer to the run: one window, real events.
#include <algorithm>

#include "sessions/session/case_run.h"
#include "tests/ui/window/desktop.h"
#include "tests/ui/window_test.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/views/mask_editor.h"

namespace boresight::ui {
namespace {

class MaskEditingTest : public test::SharedWindowTest {
 protected:
  void SetUp() override {
    auto& editor = *window_.findChild<MaskEditor*>();
    editor.setTool(MaskTool::kNone);
    editor.setErase(false);
    SharedWindowTest::SetUp();
    id_ = window_.state().currentCase()->source.id;
  }
  sessions::Session firstSession() override {
    sessions::SessionCase second = *test::exampleSession().cases.front();
    second.id = "second";
    return withCase(test::withoutSearch(test::exampleSession()), second);
  }
  ImageView& view() { return window_.image().view(); }
  const sessions::MaskStrokes& strokes(const std::string& id) {
    return window_.document().session().findCase(id)->ignore_strokes;
  }
  bool ignored(int x, int y) {
    const auto& value = window_.state().currentCase();
    return value->ignore && value->ignore_bits.get(x, y);
  }
  /// Once the views have the document's mask.
  bool settled() {
    return wait([&] {
      return resting() && window_.state().currentCase()->source.ignore_strokes == strokes(id_);
    });
  }
  void send(QEvent::Type type, const QPointF& pixel) {
    const QPointF at = view().transform().toWidget(pixel) - QPointF(0.5, 0.5);
    QMouseEvent event(type, at, view().mapToGlobal(at.toPoint()),
                      type == QEvent::MouseMove ? Qt::NoButton : Qt::LeftButton,
                      type == QEvent::MouseButtonRelease ? Qt::NoButton : Qt::LeftButton,
                      Qt::NoModifier);
    QCoreApplication::sendEvent(&view(), &event);
  }
  void drag(const QPointF& from, const QPointF& to) {
    send(QEvent::MouseButtonPress, from);
    send(QEvent::MouseMove, to);
    send(QEvent::MouseButtonRelease, to);
  }
  void drawPolygon(const std::vector<QPointF>& corners) {
    QTest::keyClick(&window_, Qt::Key_P, Qt::ShiftModifier);
    for (const QPointF& corner : corners) {
      send(QEvent::MouseButtonPress, corner);
      send(QEvent::MouseButtonRelease, corner);
    }
    QTest::keyClick(&view(), Qt::Key_Return);
  }

  std::string id_;
};

TEST_F(MaskEditingTest, ABrushStrokeIsOneUndoableJournalledEditOfTheMask) {
  QTest::keyClick(&window_, Qt::Key_B, Qt::ShiftModifier);
  drag({100.0, 100.0}, {200.0, 100.0});
  ASSERT_EQ(strokes(id_).size(), 1u);
  const auto other = sessions::SessionDocument::open(file_, sessions::Access::kReadOnly);
  ASSERT_TRUE(other.recovery()) << "the journal has it already";
  EXPECT_EQ(other.recovery()->session.findCase(id_)->ignore_strokes, strokes(id_));
  ASSERT_TRUE(settled());
  EXPECT_TRUE(ignored(150, 105));
  EXPECT_FALSE(ignored(150, 120));
  const auto& bits = view().layer(LayerId::kIgnoreMask).bits;
  ASSERT_EQ(bits.size(), 1u);
  EXPECT_TRUE(bits[0].bits.get(150, 105));
  QTest::keyClick(&window_, Qt::Key_E, Qt::ShiftModifier);
  drag({150.0, 100.0}, {150.0, 100.0});
  ASSERT_TRUE(settled());
  EXPECT_FALSE(ignored(150, 105));
  EXPECT_TRUE(ignored(110, 100));
  QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
  ASSERT_TRUE(settled());
  EXPECT_TRUE(ignored(150, 105));
  QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
  ASSERT_TRUE(settled());
  EXPECT_TRUE(strokes(id_).empty());
  EXPECT_TRUE(view().layer(LayerId::kIgnoreMask).bits.empty());
}

TEST_F(MaskEditingTest, ARunUsesTheMask_ItsShownIterationStaysAsStaleWhenItIsEdited) {
  openRun(firstSession());
  const std::string before = window_.document().session().runs[0].digest;
  window_.state().setCursor({0, Stage::kMatch});
  window_.state().selectTemplate(2);
  QTest::keyClick(&window_, Qt::Key_B, Qt::ShiftModifier);
  drag({10.0, 10.0}, {20.0, 10.0});
  ASSERT_TRUE(settled());
  EXPECT_EQ(window_.state().cursor(), (RunCursor{0, Stage::kMatch})) << "it stays";
  EXPECT_EQ(window_.state().selectedTemplate(), 2);
  EXPECT_FALSE(view().layer(LayerId::kSeedEdges).empty());
  EXPECT_FALSE(window_.cases().staleness().isEmpty());
  const auto& image = window_.state().currentCase()->image;
  const double right = image.width * 0.55, bottom = image.height - 1.0;
  drawPolygon({{0.0, 0.0}, {right, 0.0}, {right, bottom}, {0.0, bottom}});
  // At once: the run waits for the mask.
  QTest::keyClick(&window_, Qt::Key_F5);
  EXPECT_TRUE(window_.state().snapshot()) << "the run of before is still shown";
  ASSERT_TRUE(wait([&] { return window_.document().session().runs.size() == 2 && resting(); }));
  const auto& session = window_.document().session();
  EXPECT_NE(session.runs[1].digest, before);
  EXPECT_FALSE(stalenessOf(session.runs[1], session, {}).stale());
  EXPECT_TRUE(stalenessOf(session.runs[0], session, {}).inputs_changed);
  EXPECT_EQ(session.runs[1].digest,
            sessions::runCase(session, id_, sessions::RecordLevel::kSummary).digest);
}

TEST_F(MaskEditingTest, SaturatedPixelsAreThoseOfTheLevelOrMore) {
  find<QSpinBox>("saturationLevel").setValue(200);
  QTest::mouseClick(&find<QPushButton>("saturated"), Qt::LeftButton);
  ASSERT_TRUE(settled());
  const auto& value = *window_.state().currentCase();
  const auto bright =
      std::ranges::count_if(value.image.pixels, [](std::uint8_t gray) { return gray >= 200; });
  ASSERT_GT(bright, 0);
  EXPECT_EQ(value.ignore->ignored_count, bright);
  EXPECT_TRUE(
      find<QLabel>("maskSummary").text().startsWith(QString::number(bright) + QLatin1Char(' ')));
  QTest::mouseClick(&find<QPushButton>("clearMask"), Qt::LeftButton);
  ASSERT_TRUE(settled());
  EXPECT_TRUE(strokes(id_).empty());
}

/// A stroke was chosen by its row: Remove took another one.
TEST_F(MaskEditingTest, ChosenStroke_StaysTheSameStroke) {
  drawPolygon({{100.0, 100.0}, {300.0, 100.0}, {300.0, 300.0}});
  QTest::keyClick(&window_, Qt::Key_B, Qt::ShiftModifier);
  drag({10.0, 10.0}, {30.0, 10.0});
  ASSERT_EQ(strokes(id_).size(), 2u);
  const auto& list = find<QListWidget>("strokes");
  find<QListWidget>("strokes").setCurrentRow(1);
  sessions::MaskStrokes rest = {strokes(id_)[1]};
  sessions::SessionCase one = *window_.document().session().findCase(id_);
  one.ignore_strokes = rest;
  ASSERT_TRUE(window_.document().edit(sessions::withCase(window_.document().session(), one),
                                      QStringLiteral("Remove the first")));
  ASSERT_TRUE(settled());
  EXPECT_EQ(list.currentRow(), 0);
  one.ignore_strokes.clear();
  ASSERT_TRUE(window_.document().edit(sessions::withCase(window_.document().session(), one),
                                      QStringLiteral("Remove the other")));
  ASSERT_TRUE(window_.document().undo());
  ASSERT_TRUE(settled());
  EXPECT_EQ(list.currentRow(), -1);
  find<QListWidget>("strokes").setCurrentRow(0);
  window_.cases().chooseCase(QStringLiteral("second"));
  ASSERT_TRUE(wait([&] {
    const auto& shown = window_.state().currentCase();
    return shown && shown->source.id == "second" && resting();
  }));
  EXPECT_EQ(list.currentRow(), -1);
}

TEST_F(MaskEditingTest, ANamedPolygonIsCopiedToTheCamerasOtherCases) {
  drawPolygon({{100.0, 100.0}, {300.0, 100.0}, {300.0, 300.0}});
  ASSERT_EQ(strokes(id_).size(), 1u);
  auto& list = find<QListWidget>("strokes");
  list.setCurrentRow(0);
  const test::ModalAnswer<QInputDialog> answer([](QInputDialog& dialog) {
    dialog.setTextValue(QStringLiteral("gripper"));
    dialog.accept();
  });
  QTest::mouseClick(&find<QPushButton>("nameStroke"), Qt::LeftButton);
  window_.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&window_)) << "after the dialog";
  EXPECT_EQ(strokes(id_)[0].name, "gripper");
  EXPECT_TRUE(list.item(0)->text().startsWith(QStringLiteral("gripper")));
  QTest::mouseClick(&find<QPushButton>("copyStroke"), Qt::LeftButton);
  EXPECT_EQ(strokes("second"), strokes(id_));
  EXPECT_TRUE(window_.document().session().cases[1]->ignore_strokes.empty()) << "another camera";
  QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
  EXPECT_TRUE(strokes("second").empty());
  // The case whose edit was undone is shown.
  ASSERT_TRUE(showsCase("second"));
  const QList<QAction*> offered = find<QPushButton>("takeStroke").menu()->actions();
  ASSERT_EQ(offered.size(), 1);
  offered[0]->trigger();
  EXPECT_EQ(strokes("second"), strokes(id_));
}

TEST_F(MaskEditingTest, ReadOnlySession_CannotBeDrawnOn) {
  ASSERT_TRUE(window_.document().save());
  window_.document().close();
  const auto holder = sessions::SessionDocument::open(file_);  // has the lock
  ASSERT_TRUE(window_.openSession(file_));
  ASSERT_TRUE(wait([&] { return window_.state().currentCase() && resting(); }));
  QTest::keyClick(&window_, Qt::Key_B, Qt::ShiftModifier);
  EXPECT_FALSE(view().toolActive());
  EXPECT_FALSE(find<QPushButton>("saturated").isEnabled());
}

}  // namespace
}  // namespace boresight::ui
