// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/annotation_panel.h"

#include <algorithm>

#include <QtWidgets>

#include "sessions/session/rig_links.h"
#include "sessions/session/session_file.h"
#include "tests/ui/annotation/annotation_fixture.h"
#include "ui/annotation/ambiguity_view.h"

namespace boresight::ui {
namespace {

class AnnotationPanelTest : public AnnotationTest {
 protected:
  void SetUp() override {
    AnnotationTest::SetUp();
    panel_ = std::make_unique<AnnotationPanel>(document_, controller_, state_);
    panel_->resize(1100, 400);
    panel_->show();
  }

  template <class Widget>
  Widget& find(const char* name) {
    auto* found = panel_->findChild<Widget*>(QString::fromLatin1(name));
    EXPECT_NE(found, nullptr) << name;
    return *found;
  }
  QString meter() { return find<QLabel>("geometryMeter").text(); }
  QString headline() { return find<QLabel>("headline").text(); }
  QString summary() { return find<QTextBrowser>("solution").toPlainText(); }
  void clickCell(int row, int column) {
    QTableView& table = find<QTableView>("annotations");
    QTest::mouseClick(table.viewport(), Qt::LeftButton, {},
                      table.visualRect(table.model()->index(row, column)).center());
  }

  std::unique_ptr<AnnotationPanel> panel_;
};

TEST_F(AnnotationPanelTest, Headline_ReportsMissingPairsSolutionAndStaleness) {
  controller_.placeInImage({100.0, 100.0});
  ASSERT_TRUE(solved());
  EXPECT_TRUE(test::has(meter(), "too few"));
  EXPECT_FALSE(find<QPushButton>("annotationAsTruth").isEnabled());
  controller_.remove("p1");
  markCorners(8);
  EXPECT_TRUE(test::has(headline(), "Stale"));
  EXPECT_FALSE(find<QTextBrowser>("solution").isEnabled());
  ASSERT_TRUE(solved());
  EXPECT_TRUE(headline().startsWith(QStringLiteral("Solved from 8 annotations")));
  for (const char* word : {"normal", "lateral", "rotation", "seed", "truth"})
    EXPECT_TRUE(test::has(summary(), word));

  const auto htmlWith = [this](const std::optional<Pose>& camera_from_end_effector) {
    AnnotationAnswer answer = controller_.answer();
    auto solution = std::make_shared<sessions::CaseAnnotationsSolution>(*answer.solution);
    solution->annotations.camera_from_end_effector = camera_from_end_effector;
    answer.solution = solution;
    return solutionHtml(answer, {{QStringLiteral("seed"), Pose()}});
  };
  const QString without = htmlWith({});
  EXPECT_FALSE(without.contains(QStringLiteral(">at the camera"))) << "said once";
  EXPECT_TRUE(test::has(without, "3 sigma at the camera"));
  EXPECT_TRUE(test::has(without, "Distance of the annotated pose at the camera"));
  Pose camera_from_end_effector;
  camera_from_end_effector.translation_m = {0.0, 0.1, 0.2};
  const QString with = htmlWith(camera_from_end_effector);
  EXPECT_TRUE(test::has(with, ">at the camera"));
  EXPECT_TRUE(test::has(with, "3 sigma at the end effector"));
}

TEST_F(AnnotationPanelTest, WeakGeometry_IsShownAndReportedWithTheTruthMadeOfIt) {
  QSignalSpy told(&controller_, &AnnotationController::told);
  const Pose before = truth();
  const auto stored = [this]() -> const sessions::SessionCase& {
    return *document_.session().findCase(source().id);
  };
  controller_.useAsTruth();
  EXPECT_EQ(stored().camera_from_station_truth, before) << "there is no pose yet";
  controller_.setSigma(0.1);
  solveCorners(8);
  EXPECT_FALSE(meter().contains(QStringLiteral("pose known to"))) << meter().toStdString();
  told.clear();
  controller_.useAsTruth();
  EXPECT_EQ(stored().camera_from_station_truth, controller_.solvedPose());
  ASSERT_EQ(told.size(), 1);
  EXPECT_FALSE(test::has(told[0][0].toString(), "sigma"));
  moveFirst({30.0, 40.0});
  EXPECT_TRUE(test::has(meter(), "pose known to"));
  EXPECT_FALSE(test::has(meter(), "no weakness"));
  QTest::mouseClick(&find<QPushButton>("annotationAsTruth"), Qt::LeftButton);
  ASSERT_EQ(told.size(), 2);
  EXPECT_TRUE(test::has(told[1][0].toString(), "Its one sigma is"));
  EXPECT_TRUE(test::has(told[1][0].toString(), "required"));
  EXPECT_EQ(stored().camera_from_station_truth, controller_.solvedPose())
      << "the operator may go on";
  ASSERT_TRUE(stored().truth_covariance);
  EXPECT_EQ(stored().truth_covariance, controller_.answer().covariance);
  ASSERT_TRUE(document_.undo());
  ASSERT_TRUE(document_.undo());  // the drag
  ASSERT_TRUE(document_.undo());
  EXPECT_EQ(stored().camera_from_station_truth, before);
}

TEST_F(AnnotationPanelTest, TruthAndSeedThatCannotBeStored_AreNotReportedAsSet) {
  solveCorners(5);
  QSignalSpy told(&controller_, &AnnotationController::told);
  QSignalSpy refused(&document_, &Document::writeFailed);
  const std::filesystem::path journal = sessions::journalFileOf(document_.file());
  std::filesystem::remove(journal);
  std::filesystem::create_directory(journal);
  controller_.useAsTruth();
  controller_.useAsSeed();
  EXPECT_EQ(refused.size(), 2);
  EXPECT_EQ(told.size(), 0);
  std::filesystem::remove(journal);
}

TEST_F(AnnotationPanelTest, Table_SelectsMovesTurnsOffRemovesAndLeadsToTheImage) {
  const auto ids = markCorners(5);
  const auto& points = annotations().points;
  clickCell(2, AnnotationsModel::kName);
  EXPECT_EQ(controller_.selected(), ids[2]);
  QTest::keyClick(panel_.get(), Qt::Key_Space);
  EXPECT_FALSE(points[2].enabled);
  EXPECT_EQ(document_.undoText(), QStringLiteral("Turn p3 off"));
  QTest::keyClick(panel_.get(), Qt::Key_Delete);
  EXPECT_EQ(points.size(), 4u);
  ASSERT_TRUE(document_.undo());
  ASSERT_TRUE(document_.undo());
  EXPECT_TRUE(points[2].enabled);
  controller_.select(ids[4]);
  EXPECT_EQ(find<QTableView>("annotations").currentIndex().row(), 4)
      << "the table follows the other views";
  QAbstractItemModel& model = *find<QTableView>("annotations").model();
  ASSERT_TRUE(model.setData(model.index(1, AnnotationsModel::kComment), QStringLiteral("rim")));
  EXPECT_EQ(points[1].comment, "rim");

  clickCell(2, AnnotationsModel::kName);
  const Vector2d before = *points[2].pixel;
  QTest::keyClick(&find<QTableView>("annotations"), Qt::Key_Right);
  QTest::keyClick(&find<QTableView>("annotations"), Qt::Key_Down, Qt::ShiftModifier);
  EXPECT_EQ(controller_.selected(), ids[2]);
  EXPECT_LT((*points[2].pixel - before - Vector2d(0.1, 1.0)).norm(), 1e-9);
  QTest::keyClick(&find<QTableView>("annotations"), Qt::Key_Down, Qt::ControlModifier);
  EXPECT_EQ(controller_.selected(), ids[3]);

  controller_.setMode(PlaceMode::kOff);
  QSignalSpy requested(panel_.get(), &AnnotationPanel::imageRequested);
  clickCell(2, AnnotationsModel::kName);
  QTest::keyClick(&find<QTableView>("annotations"), Qt::Key_Return);
  EXPECT_GE(requested.count(), 1);
  EXPECT_EQ(controller_.mode(), PlaceMode::kPoint);
  EXPECT_EQ(controller_.selected(), ids[2]);
}

TEST_F(AnnotationPanelTest, ButtonsSetModeAndRobustWeights) {
  const auto click = [this](const char* name) {
    QTest::mouseClick(&find<QToolButton>(name), Qt::LeftButton);
  };
  click("placePoints");
  EXPECT_EQ(controller_.mode(), PlaceMode::kPoint);
  click("placeLines");
  EXPECT_EQ(controller_.mode(), PlaceMode::kLine);
  EXPECT_FALSE(find<QToolButton>("placePoints").isChecked());
  click("placeLines");
  EXPECT_EQ(controller_.mode(), PlaceMode::kOff);
  solveCorners(8);
  const Pose before = *controller_.solvedPose();
  const auto distance_m = [&] {
    return (controller_.solvedPose()->translation_m - before.translation_m).norm();
  };
  moveFirst({0.0, 20.0});
  const double far_off_m = distance_m();
  find<QCheckBox>("robust").click();
  ASSERT_TRUE(document_.session().robust_annotations && solved());
  EXPECT_LT(distance_m(), 0.1 * far_off_m);
}

TEST_F(AnnotationPanelTest, CoplanarAnnotations_ShowBothPosesSideBySide) {
  StationSnapper snapper(state_);
  auto* ambiguity = new AmbiguityView(controller_, state_, snapper);
  panel_->addBeside(ambiguity);
  EXPECT_FALSE(ambiguity->isVisibleTo(panel_.get()));
  // Four points of a small square far away: two poses explain them when they are seen with noise.
  sessions::Annotations square;
  for (int i = 0; i < 4; ++i) {
    sessions::PointPair& point = square.points.emplace_back();
    point.id = "s" + std::to_string(i);
    point.point_in_station_m = Vector3d((i & 1) * 0.008, (i >> 1) * 0.008, 0.0);
    point.pixel = pixelOf(*point.point_in_station_m) + Vector2d(0.2 * (i - 1.5), 0.0);
    point.sigma_px = 0.5;
  }
  controller_.setAnnotations(square, QStringLiteral("Import"));
  ASSERT_TRUE(solved());
  ASSERT_TRUE(controller_.solution()->ambiguous_camera_from_station())
      << "the case is not ambiguous";
  EXPECT_TRUE(ambiguity->isVisibleTo(panel_.get()));
  EXPECT_TRUE(test::has(summary(), "fit two poses"));
  const auto edges = [this](const char* view) -> const std::vector<Mark>& {
    return find<ImageView>(view).layer(LayerId::kAnnotationBand).marks;
  };
  ASSERT_TRUE(wait([&] { return !edges("otherPicture").empty(); }));
  EXPECT_NE(edges("otherPicture").front().outline, edges("bestPicture").front().outline);
  EXPECT_EQ(find<ImageView>("bestPicture").layer(LayerId::kPoints).marks.size(), 4u);
  Pose asked;
  QObject::connect(ambiguity, &AmbiguityView::otherRequested,
                   [&](const Pose& pose) { asked = pose; });
  QTest::mouseClick(&find<QPushButton>("showOtherPose"), Qt::LeftButton);
  EXPECT_EQ(asked, *controller_.solution()->ambiguous_camera_from_station());
}

TEST_F(AnnotationPanelTest, LinkedCases_AreSolvedTogether) {
  const std::string first = source().id;
  sessions::SessionCase second = source();
  second.id = "second image";
  ASSERT_TRUE(document_.edit(sessions::withCase(document_.session(), second),
                             QStringLiteral("Add a case")));
  QMenu& menu = *find<QToolButton>("rig").menu();
  const auto trigger = [&](const QString& text) {
    Q_EMIT menu.aboutToShow();
    const auto actions = menu.findChildren<QAction*>();
    const auto found = std::ranges::find_if(
        actions, [&](const QAction* action) { return action->text().contains(text); });
    ASSERT_NE(found, actions.end()) << text.toStdString();
    (*found)->trigger();
  };
  const auto menus = [&menu] { return menu.findChildren<QMenu*>().size(); };
  Q_EMIT menu.aboutToShow();
  const auto once = menus();
  Q_EMIT menu.aboutToShow();
  EXPECT_EQ(menus(), once) << "an opening leaves none behind";
  trigger(QStringLiteral("not moved"));
  EXPECT_EQ(sessions::casesOfRig(document_.session(), first),
            std::vector<std::string>{"second image"});
  // Three annotations in either image: one alone would not do without its seed.
  const auto places_m = corners_m(6);
  for (std::size_t i = 0; i < 3; ++i) annotatePair(places_m[i]);
  open("second image");
  for (std::size_t i = 3; i < 6; ++i) annotatePair(places_m[i]);
  ASSERT_TRUE(solved());
  ASSERT_TRUE(controller_.solvedPose());
  EXPECT_EQ(controller_.solution()->result.solution->annotations.size(), 6u);
  EXPECT_LT((controller_.solvedPose()->translation_m - truth().translation_m).norm(), 1e-6);
  EXPECT_TRUE(test::has(summary(), "Cameras solved together"));
  find<QCheckBox>("together").click();
  ASSERT_TRUE(solved());
  EXPECT_EQ(controller_.solution()->annotations.views.size(), 1u);
  trigger(QStringLiteral("out of this rig"));
  EXPECT_FALSE(document_.session().findCase(first)->rig);
}

}  // namespace
}  // namespace boresight::ui
