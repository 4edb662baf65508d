// SPDX-License-Identifier: Apache-2.0
// What the operator does on the canvas and with lists of commands, edits and runs: one window, real
// events.
#include "tests/ui/window_test.h"

#include <cmath>

#include "sessions/session/ignore_strokes.h"
#include "tests/ui/pointer.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/annotation/station_snapper.h"
#include "ui/panels/annotate/levels_histogram.h"
#include "ui/panels/run/nudge_gizmo.h"
#include "ui/views/compare_view.h"
#include "ui/views/display_image.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/views/mask_editor.h"
#include "ui/views/measure_tool.h"
#include "ui/widgets/command_palette.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

class CanvasToolsTest : public test::SharedWindowTest {
 protected:
  void SetUp() override {
    window_.image().measure().setActive(false);
    for (const char* tool : {"nudgeSeed", "placePoints", "maskBrush"})
      if (action(tool).isChecked()) action(tool).trigger();
    SharedWindowTest::SetUp();
  }
  ImageView& view() { return window_.image().view(); }
  QAction& action(const char* name) { return find<QAction>(name); }
  const sessions::SessionCase& edited() {
    return *window_.document().session().findCase(window_.state().currentCase()->source.id);
  }
  Eigen::Vector3d middle() {
    return matchedBounds(window_.state().currentCase()->scene.view()).centre();
  }
  /// Of the station's middle in a pose, px.
  QPointF middleAt(const Pose& pose) {
    Eigen::Vector2d pixel;
    EXPECT_TRUE(project(window_.state().currentCase()->source.camera, pose * middle(), pixel));
    return {pixel.x(), pixel.y()};
  }
  /// Begins to nudge; where the gizmo then is on the widget.
  QPointF beginNudging() {
    QTest::keyClick(&window_, Qt::Key_N);
    return view().transform().toWidget(middleAt(edited().camera_from_station_seed));
  }
  /// On the widget, with the left button.
  void drag(const QPointF& from, const QPointF& to) {
    const auto send = [this](QEvent::Type type, const QPointF& at, Qt::MouseButton button,
                             Qt::MouseButtons buttons) {
      QMouseEvent event(type, at, view().mapToGlobal(at.toPoint()), button, buttons,
                        Qt::NoModifier);
      QCoreApplication::sendEvent(&view(), &event);
    };
    send(QEvent::MouseButtonPress, from, Qt::LeftButton, Qt::LeftButton);
    send(QEvent::MouseMove, 0.5 * (from + to), Qt::NoButton, Qt::LeftButton);
    send(QEvent::MouseMove, to, Qt::NoButton, Qt::LeftButton);
    send(QEvent::MouseButtonRelease, to, Qt::LeftButton, Qt::NoButton);
  }
};

/// The wheel over a field that slid under the pointer gave it the focus, and with it changed it.
TEST_F(CanvasToolsTest, WheelOverASpinBoxWithoutFocus_NeitherEditsNorFocusesIt) {
  window_.workspaces().reveal(QStringLiteral("pose"));
  view().setFocus();
  auto& box = find<QDoubleSpinBox>("moveY");
  EXPECT_EQ(box.focusPolicy(), Qt::StrongFocus);
  QWheelEvent event({5.0, 5.0}, box.mapToGlobal(QPoint(5, 5)), {}, {0, -120}, Qt::NoButton,
                    Qt::NoModifier, Qt::NoScrollPhase, false);
  QCoreApplication::sendEvent(&box, &event);
  EXPECT_EQ(box.value(), 0.0);
  EXPECT_FALSE(box.hasFocus());
  EXPECT_FALSE(window_.state().nudgedPose());
  for (QSpinBox* each : window_.findChildren<QSpinBox*>()) {
    const int before = each->value();
    QCoreApplication::sendEvent(each, &event);
    EXPECT_EQ(each->value(), before) << each->objectName().toStdString();
  }
}

TEST_F(CanvasToolsTest, CtrlZInASpinBoxIsTheSessionsUndo) {
  window_.activateWindow();
  moveSeed(0.01);
  ASSERT_TRUE(rests());
  window_.workspaces().reveal(QStringLiteral("pose"));
  auto& box = find<QDoubleSpinBox>("moveStep");
  const double before = box.value();
  box.setFocus();
  QTest::keyClicks(&box, QStringLiteral("3"));
  ASSERT_TRUE(window_.document().canUndo());
  QTest::keyClick(&box, Qt::Key_Z, Qt::ControlModifier);
  EXPECT_FALSE(window_.document().canUndo());
  box.setValue(before);
}

TEST_F(CanvasToolsTest, GizmoDragMovesTheSeedWithThePointerAsOneEdit) {
  const QPointF from = beginNudging();
  ASSERT_TRUE(action("nudgeSeed").isChecked());
  const QPointF to = from + QPointF(37.0, -21.0);
  drag(from, to);
  ASSERT_TRUE(window_.state().nudgedPose());
  const QPointF moved = view().transform().toWidget(middleAt(*window_.state().nudgedPose()));
  EXPECT_NEAR(moved.x(), to.x(), 0.6);
  EXPECT_NEAR(moved.y(), to.y(), 0.6);
  EXPECT_EQ(edited().camera_from_station_working, window_.state().nudgedPose());
  ASSERT_TRUE(window_.document().undo());
  EXPECT_FALSE(window_.state().nudgedPose());
  EXPECT_FALSE(window_.document().canUndo());
}

TEST_F(CanvasToolsTest, GizmoRingRollsAndWheelChangesTheDistance) {
  const Pose seed = edited().camera_from_station_seed;
  const QPointF centre = beginNudging();
  const double angle = 0.3;
  drag(centre + NudgeGizmo::kRing * QPointF(1.0, 0.0),
       centre + NudgeGizmo::kRing * QPointF(std::cos(angle), std::sin(angle)));
  const Pose rolled = window_.state().nudgedPose().value();
  EXPECT_NEAR(rolled.rotation.angularDistance(seed.rotation), angle, 0.5 / NudgeGizmo::kRing);
  EXPECT_LT((rolled * middle() - seed * middle()).norm(), 1e-9);
  QWheelEvent event(centre, view().mapToGlobal(centre.toPoint()), {}, {0, 120}, Qt::NoButton,
                    Qt::NoModifier, Qt::NoScrollPhase, false);
  QCoreApplication::sendEvent(&view(), &event);
  const Pose nearer = window_.state().nudgedPose().value();
  EXPECT_LT((nearer * middle()).norm(), (rolled * middle()).norm());
  EXPECT_NEAR((middleAt(nearer) - middleAt(rolled)).manhattanLength(), 0.0, 1e-6);
}

TEST_F(CanvasToolsTest, GizmoTilt_TurnsAboutTheImagesAxesAndShowsTheOffset) {
  const Pose seed = edited().camera_from_station_seed;
  const QPointF handle = beginNudging() + QPointF(0.0, NudgeGizmo::kRing + NudgeGizmo::kHandle);
  auto& gizmo = *window_.findChild<NudgeGizmo*>();
  EXPECT_EQ(gizmo.offsetText().toStdString(),
            "From the seed: x 0.00, y 0.00, z 0.00 mm; tilt 0.00, 0.00 deg, roll 0.00 deg.");
  drag(handle, handle + QPointF(0.1 * NudgeGizmo::kRing, 0.0));
  const Pose tilted = window_.state().nudgedPose().value();
  const Eigen::AngleAxisd turn(tilted.rotation * seed.rotation.conjugate());
  EXPECT_NEAR(turn.angle(), 0.1, 0.5 / NudgeGizmo::kRing);
  EXPECT_NEAR(turn.axis().y(), -1.0, 1e-9) << "its near side follows the pointer to the right";
  EXPECT_LT((tilted * middle() - seed * middle()).norm(), 1e-9);
  EXPECT_TRUE(test::has(gizmo.offsetText(), "tilt 0.00, -5.7"));
  // With Ctrl the keys turn too, all about the same middle.
  for (const auto key : {Qt::Key_Up, Qt::Key_PageUp})
    QTest::keyClick(&view(), key, Qt::ControlModifier | Qt::ShiftModifier);
  const Pose turned = window_.state().nudgedPose().value();
  EXPECT_LT((turned * middle() - seed * middle()).norm(), 1e-9);
  EXPECT_TRUE(test::has(gizmo.offsetText(), "x 0.00, y 0.00, z 0.00 mm"));
  EXPECT_TRUE(test::has(gizmo.offsetText(), "roll +2."));
  QTest::keyClick(&view(), Qt::Key_PageUp);
  EXPECT_NEAR((window_.state().nudgedPose().value() * middle()).z(), 1.01 * (seed * middle()).z(),
              1e-6);
}

TEST_F(CanvasToolsTest, GizmoEnterUsesThePoseAsSeedAndEscapeEndsTheTool) {
  QTest::keyClick(&window_, Qt::Key_N);
  QTest::keyClick(&view(), Qt::Key_Right);
  const Pose nudged = window_.state().nudgedPose().value();
  QTest::keyClick(&view(), Qt::Key_Return);
  EXPECT_EQ(edited().camera_from_station_seed, nudged);
  EXPECT_FALSE(action("nudgeSeed").isChecked());
  QTest::keyClick(&window_, Qt::Key_N);
  QTest::keyClick(&view(), Qt::Key_Escape);
  EXPECT_FALSE(action("nudgeSeed").isChecked());
}

/// All faces were tried for each move of the pointer.
TEST_F(CanvasToolsTest, PointUnderThePointer_IsFoundByTheTreeAsByAllFaces) {
  ASSERT_TRUE(wait([&] { return window_.findChild<StationSnapper*>()->mesh() != nullptr; }));
  std::optional<Eigen::Vector3d> hovered;
  QPointF pixel;
  QObject owner;
  QObject::connect(&view(), &ImageView::cursorMoved, &owner,
                   [&](const QPointF& at) { pixel = at; });
  QObject::connect(&window_.image(), &ImagePanel::stationPlaceHovered, &owner,
                   [&](const std::optional<Eigen::Vector3d>& place) { hovered = place; });
  const auto& shown = *window_.state().currentCase();
  int seen = 0;
  for (const QPointF& off : {QPointF(0, 0), QPointF(15, -9), QPointF(-22, 14), QPointF(400, 300)}) {
    test::moveMouse(view(),
                    view().transform().toWidget(middleAt(*window_.state().knownPose())) + off);
    const auto expected = sessions::surfacePointAt(shown.source.camera, shown.scene.view(),
                                                   *window_.state().knownPose(), vectorOf(pixel));
    ASSERT_EQ(hovered.has_value(), expected.has_value());
    if (!expected) continue;
    EXPECT_LT((*hovered - expected->in_station_m).norm(), 1e-9);
    ++seen;
  }
  EXPECT_GT(seen, 0);
}

TEST_F(CanvasToolsTest, OneToolWorksAtATime) {
  QTest::keyClick(&window_, Qt::Key_N);
  window_.image().measure().setActive(true);
  EXPECT_FALSE(action("nudgeSeed").isChecked());
  action("placePoints").trigger();
  EXPECT_FALSE(window_.image().measure().isActive());
  action("maskBrush").trigger();
  EXPECT_FALSE(action("placePoints").isChecked());
  QTest::keyClick(&window_, Qt::Key_N);
  EXPECT_TRUE(action("nudgeSeed").isChecked());
}

/// Tools, and gestures under way, on a session with annotations.
class GesturesTest : public CanvasToolsTest {
 protected:
  void SetUp() override {
    CanvasToolsTest::SetUp();
    sessions::Annotations annotations;
    for (int i = 0; i < 4; ++i) {
      sessions::PointPair point;
      point.id = "p" + std::to_string(i + 1);
      point.pixel = Eigen::Vector2d(100 + 40 * i, 120);
      annotations.points.push_back(point);
    }
    const sessions::Session& session = window_.document().session();
    ASSERT_TRUE(window_.document().edit(
        sessions::withAnnotations(session, session.cases[0]->id, annotations),
        QStringLiteral("Annotate")));
    window_.workspaces().show(Workspace::kAnnotate);
    ASSERT_TRUE(rests());
  }
  AnnotationController& annotation() { return window_.annotation(); }
  std::size_t pointsOf(const std::string& id) {
    const auto& all = window_.document().session().annotations;
    return all.contains(id) ? all.at(id)->points.size() + all.at(id)->lines.size() : 0;
  }
  const std::string& idOf(std::size_t index) {
    return window_.document().session().cases[index]->id;
  }
  bool showCase(std::size_t index) {
    window_.cases().chooseCase(QString::fromStdString(idOf(index)));
    return showsCase(idOf(index));
  }
  void clickPixel(const QPointF& pixel) {
    const QPointF at = view().transform().toWidget(pixel);
    test::sendMouse(view(), QEvent::MouseButtonPress, at);
    test::sendMouse(view(), QEvent::MouseButtonRelease, at);
  }
};

TEST_F(GesturesTest, Annotating_EndsOutsideAnnotate) {
  for (const Workspace next : {Workspace::kRun, Workspace::kDiagnose, Workspace::kReview}) {
    window_.workspaces().show(Workspace::kAnnotate);
    action("placePoints").trigger();
    ASSERT_EQ(annotation().mode(), PlaceMode::kPoint);
    window_.workspaces().show(next);
    EXPECT_EQ(annotation().mode(), PlaceMode::kOff);
    EXPECT_FALSE(action("placePoints").isChecked());
    clickPixel({220.0, 180.0});
    clickPixel({260.0, 200.0});
    EXPECT_EQ(pointsOf(idOf(0)), 4u);
  }
  QTest::keyClick(&window_, Qt::Key_F3);
  EXPECT_EQ(annotation().mode(), PlaceMode::kLine);
  EXPECT_EQ(window_.workspaces().current(), Workspace::kAnnotate) << "the key leads there";
}

TEST_F(GesturesTest, Annotating_EndsWithItsCase) {
  action("placePoints").trigger();
  ASSERT_TRUE(showCase(1));
  EXPECT_EQ(annotation().mode(), PlaceMode::kOff);
  EXPECT_FALSE(action("placePoints").isChecked());
  clickPixel({220.0, 180.0});
  EXPECT_EQ(pointsOf(idOf(1)), 0u);
}

TEST_F(GesturesTest, EscapeEndsTheTool_WhereverTheFocusIs) {
  action("placePoints").trigger();
  find<QListWidget>("history").setFocus();
  QTest::keyClick(&window_, Qt::Key_Escape);
  EXPECT_EQ(annotation().mode(), PlaceMode::kOff);
}

/// Text that is typed while no field has the focus.
TEST_F(GesturesTest, PlainLetters_NeverEditTheSession) {
  const std::size_t edits = window_.document().editsDone();
  find<QListWidget>("history").setFocus();
  for (int key = Qt::Key_A; key <= Qt::Key_Z; ++key)
    for (const Qt::KeyboardModifier modifier : {Qt::NoModifier, Qt::ShiftModifier})
      QTest::keyClick(&window_, static_cast<Qt::Key>(key), modifier);
  ASSERT_TRUE(rests());
  EXPECT_EQ(window_.document().editsDone(), edits) << window_.document().undoText().toStdString();
}

TEST_F(GesturesTest, NudgeUnderWay_IsStoredInItsCaseBeforeAnotherIsShown) {
  annotation().select("p1");
  const Eigen::Vector2d before = *annotation().annotations().points[0].pixel;
  ASSERT_TRUE(annotation().nudge({0.5, 0.0}));
  ASSERT_TRUE(showCase(1));
  const sessions::Annotations& stored = *window_.document().session().annotations.at(idOf(0));
  EXPECT_NEAR(stored.points[0].pixel->x(), before.x() + 0.5, 1e-9);
  EXPECT_EQ(pointsOf(idOf(1)), 0u);
}

TEST_F(GesturesTest, NudgeUnderWay_IsAnEditBeforeTheHistoryMoves) {
  annotation().remove("p3");
  annotation().select("p1");
  const std::size_t edits = window_.document().editsDone();
  ASSERT_TRUE(annotation().nudge({0.1, 0.0}));
  ASSERT_TRUE(window_.document().goToEdit(edits - 1));
  EXPECT_EQ(pointsOf(idOf(0)), 4u);
  EXPECT_EQ(annotation().annotations().points.size(), 4u);
  QTest::qWait(1000);  // longer than the pause that ends a nudge
  EXPECT_EQ(pointsOf(idOf(0)), 4u) << "the removed point does not go again";
  EXPECT_TRUE(window_.document().canRedo());
}

TEST_F(GesturesTest, HalfAPolygon_IsNotContinuedOnAnotherCase) {
  window_.findChild<MaskEditor*>()->setTool(MaskTool::kPolygon);
  clickPixel({50.0, 50.0});
  clickPixel({150.0, 50.0});
  ASSERT_TRUE(showCase(1));
  clickPixel({150.0, 150.0});
  QTest::keyClick(&view(), Qt::Key_Return);
  EXPECT_TRUE(window_.document().session().findCase(idOf(1))->ignore_strokes.empty());
}

TEST_F(GesturesTest, CtrlArrowsInTheTable_MoveThroughItsCells) {
  auto& table = find<QTableView>("annotations");
  table.setFocus();
  annotation().select("p1");
  const int row = table.currentIndex().row();
  QTest::keyClick(&table, Qt::Key_Down, Qt::ControlModifier);
  EXPECT_EQ(window_.cases().caseId().toStdString(), idOf(0));
  EXPECT_EQ(table.currentIndex().row(), row + 1);
  const int column = table.currentIndex().column();
  QTest::keyClick(&table, Qt::Key_Right, Qt::ControlModifier);
  EXPECT_EQ(table.currentIndex().column(), column + 1);
}

TEST_F(GesturesTest, PageKeysWithCtrl_ShowTheNextCase_ArrowsInAFieldDoNot) {
  QTest::keyClick(&window_, Qt::Key_Down, Qt::ControlModifier);
  EXPECT_EQ(window_.cases().caseId().toStdString(), idOf(0));
  QTest::keyClick(&window_, Qt::Key_PageDown, Qt::ControlModifier);
  EXPECT_EQ(window_.cases().caseId().toStdString(), idOf(1));
}

TEST_F(GesturesTest, GizmoDrag_EndsWhereTheButtonIsNoLongerDown) {
  const Pose seed = edited().camera_from_station_seed;
  const QPointF from = beginNudging();
  test::sendMouse(view(), QEvent::MouseButtonPress, from);
  test::sendMouse(view(), QEvent::MouseMove, from + QPointF(20.0, 0.0));
  ASSERT_TRUE(window_.state().nudgedPose());
  // A message box took the release.
  test::moveMouse(view(), from + QPointF(60.0, 40.0));
  EXPECT_FALSE(window_.state().nudgedPose());
  test::moveMouse(view(), from + QPointF(80.0, 40.0));
  EXPECT_FALSE(window_.state().nudgedPose());
  EXPECT_EQ(edited().camera_from_station_seed, seed);
}

TEST_F(GesturesTest, CaseWithoutASeed_IsNotNudgedFromTheCamerasOrigin) {
  sessions::SessionCase seedless = edited();
  seedless.has_seed = false;
  seedless.camera_from_station_seed = Pose();
  ASSERT_TRUE(window_.document().edit(sessions::withCase(window_.document().session(), seedless),
                                      QStringLiteral("Drop the seed")));
  ASSERT_TRUE(wait([&] { return !window_.state().currentCase()->source.has_seed && resting(); }));
  view().setFocus();
  QTest::keyClick(&view(), Qt::Key_N);
  for (const Qt::Key key : {Qt::Key_PageUp, Qt::Key_Right, Qt::Key_Return})
    QTest::keyClick(&view(), key);
  EXPECT_FALSE(edited().has_seed);
  EXPECT_FALSE(window_.state().nudgedPose());
}

TEST_F(CanvasToolsTest, PaletteFindsCommandsByPartsOfTheirNames) {
  CommandPalette palette(find<QMenuBar>("menuBar"), &window_);
  palette.show();
  auto* line = palette.findChild<QLineEdit*>(QStringLiteral("commandLine"));
  const auto* found = palette.findChild<QListWidget*>(QStringLiteral("commands"));
  QTest::keyClicks(line, QStringLiteral("step iter"));
  ASSERT_GT(found->count(), 0);
  EXPECT_TRUE(found->item(0)->text().contains(
      QStringLiteral("> ") + action("stepIteration").text().remove(QLatin1Char('&'))));
  line->clear();
  QTest::keyClicks(line, QStringLiteral("nudge seed"));
  ASSERT_GT(found->count(), 0);
  QTest::keyClick(line, Qt::Key_Return);
  QCoreApplication::processEvents();
  EXPECT_FALSE(palette.isVisible());
  EXPECT_TRUE(action("nudgeSeed").isChecked());
}

TEST_F(CanvasToolsTest, HistoryListsEditsAndGoesToOne) {
  auto& list = find<QListWidget>("history");
  for (int i = 0; i < 2; ++i) {
    moveSeed(0.01);
    ASSERT_TRUE(rests());
  }
  ASSERT_EQ(list.count(), 3);
  EXPECT_EQ(list.currentRow(), 2);
  list.setCurrentRow(0);
  EXPECT_FALSE(window_.document().canUndo());
  EXPECT_EQ(list.count(), 3);
  list.setCurrentRow(2);
  EXPECT_FALSE(window_.document().canRedo());
}

TEST_F(CanvasToolsTest, HistogramHandlesSetBlackAndWhite) {
  DisplayImage& display = window_.image().display();
  ASSERT_TRUE(wait([&] { return display.samples() && resting(); }));
  auto& histogram = find<LevelsHistogram>("histogram");
  window_.workspaces().reveal(QStringLiteral("levels"));
  const auto x = [&](int level) { return static_cast<int>(std::lround(histogram.xOf(level))); };
  QTest::mousePress(&histogram, Qt::LeftButton, {}, {x(display.levels().black), 20});
  QTest::mouseMove(&histogram, {x(60), 20});
  QMouseEvent move(QEvent::MouseMove, QPointF(x(60), 20.0), Qt::NoButton, Qt::LeftButton, {});
  QCoreApplication::sendEvent(&histogram, &move);
  QTest::mouseRelease(&histogram, Qt::LeftButton, {}, {x(60), 20});
  EXPECT_NEAR(display.levels().black, 60, 2);
}

class RunOnCanvasTest : public test::WindowTest {
 protected:
  ImageView& view_ = window_.image().view();
};

TEST_F(RunOnCanvasTest, AClickRaisesTheInspector_AnEarlierRunIsComparedSideBySide) {
  openRun();
  window_.workspaces().show(Workspace::kDiagnose);
  window_.workspaces().reveal(QStringLiteral("iterations"));
  QCoreApplication::processEvents();
  Q_EMIT view_.itemClicked(LayerId::kMatches, 0);
  QCoreApplication::processEvents();
  EXPECT_FALSE(window_.dock(QStringLiteral("inspector"))->visibleRegion().isEmpty());
  window_.workspaces().show(Workspace::kRun);
  const std::string first = window_.document().session().runs[0].digest;
  moveSeed(0.002);
  ASSERT_TRUE(rests());
  ASSERT_TRUE(runToTheEnd(2));
  auto& list = find<QTreeWidget>("runs");
  ASSERT_EQ(list.topLevelItemCount(), 2);
  window_.workspaces().reveal(QStringLiteral("runs"));
  constexpr int kChanged = 3;
  constexpr int kMoved = 4;
  ASSERT_TRUE(
      wait([&] { return list.topLevelItem(0)->text(kChanged) == QStringLiteral("inputs"); }));
  EXPECT_TRUE(test::has(list.topLevelItem(0)->text(kMoved), " mm, "));
  EXPECT_EQ(list.topLevelItem(1)->text(kChanged), QString());
  list.setCurrentItem(list.topLevelItem(1));
  window_.state().setSnapshot(window_.state().snapshot());  // as each step of a run does
  EXPECT_EQ(list.currentItem(), list.topLevelItem(1)) << "what was chosen stays chosen";
  window_.cases().showRun(first);
  ASSERT_TRUE(wait([&] { return window_.state().snapshot()->digest == first; }));
  auto& compare = *window_.findChild<CompareView*>();
  compare.showRun(window_.document().session().runs[1].digest);
  EXPECT_TRUE(compare.isVisible());
  EXPECT_TRUE(test::has(compare.choices().front(), "Run of ")) << "what is compared first";
  ASSERT_TRUE(wait([&] { return !compare.view().layer(LayerId::kIterationEdges).empty(); }));
  ASSERT_EQ(compare.difference().size(), 1) << "no option differs";
  EXPECT_TRUE(test::has(compare.difference()[0], " px from the shown run"));
  EXPECT_TRUE(view_.isFitted() && compare.view().isFitted()) << "until the operator zooms";
  view_.centreOn({200.0, 150.0}, 3.0);
  EXPECT_NEAR(compare.view().transform().scale(), view_.transform().scale(), 1e-9);
  const auto centreOf = [](const ImageView& each) {
    return each.transform().toPixel(QPointF(each.rect().center()));
  };
  EXPECT_LT((centreOf(compare.view()) - centreOf(view_)).manhattanLength(), 1.0);
  Q_EMIT view_.cursorMoved({40.0, 50.0});
  EXPECT_EQ(compare.view().linkedCursor(), QPointF(40.0, 50.0));
  // A run whose file is gone is said in its canvas, not in a box for each step of a run.
  std::filesystem::remove(window_.document().session().runs[1].file);
  const QString message = window_.lastMessage();
  window_.state().setSnapshot(window_.state().snapshot());
  ASSERT_TRUE(wait([&] { return compare.view().imageSize().isEmpty(); }));
  EXPECT_EQ(window_.lastMessage(), message);
}

}  // namespace
}  // namespace boresight::ui
