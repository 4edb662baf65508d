// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/annotation_panel.h"

#include <QtWidgets>

#include "sessions/session/rig_links.h"
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
  QString headline() { return find<QLabel>("headline").text(); }
  QString summary() { return find<QTextBrowser>("solution").toPlainText(); }
  void clickCell(int row, int column) {
    QTableView& table = panel_->table();
    QTest::mouseClick(table.viewport(), Qt::LeftButton, {},
                      table.visualRect(table.model()->index(row, column)).center());
  }

  /// Four points of a small square far away: two poses explain them when they are seen with noise.
  sessions::Annotations smallSquare() const {
    sessions::Annotations annotations;
    for (int i = 0; i < 4; ++i) {
      sessions::PointPair point;
      point.id = "s" + std::to_string(i);
      point.point_in_station_m = Eigen::Vector3d((i & 1) * 0.008, (i >> 1) * 0.008, 0.0);
      point.pixel = pixelOf(*point.point_in_station_m) + Eigen::Vector2d(0.2 * (i - 1.5), 0.0);
      point.sigma_px = 0.5;
      annotations.points.push_back(point);
    }
    return annotations;
  }

  std::unique_ptr<AnnotationPanel> panel_;
};

TEST_F(AnnotationPanelTest, Headline_ReportsMissingPairsSolutionAndStaleness) {
  EXPECT_FALSE(headline().isEmpty());
  controller_.placeInImage({100.0, 100.0});
  ASSERT_TRUE(solved());
  EXPECT_TRUE(find<QLabel>("geometryMeter").text().contains(QStringLiteral("too few")));
  EXPECT_FALSE(find<QPushButton>("annotationAsTruth").isEnabled());
  controller_.remove("p1");
  const auto ids = markCorners(8);
  EXPECT_TRUE(headline().contains(QStringLiteral("Stale"))) << headline().toStdString();
  EXPECT_FALSE(find<QTextBrowser>("solution").isEnabled());
  ASSERT_TRUE(solved());
  EXPECT_TRUE(headline().startsWith(QStringLiteral("Solved from 8 annotations")));
  for (const char* said : {"normal", "lateral", "rotation", "seed", "truth"})
    EXPECT_TRUE(summary().contains(QString::fromLatin1(said))) << said;
}

TEST_F(AnnotationPanelTest, CameraSigma_IsShownOnlyWithAnEndEffector) {
  markCorners(8);
  ASSERT_TRUE(solved());
  const auto htmlWith = [this](const std::optional<Pose>& camera_from_end_effector) {
    AnnotationAnswer answer = controller_.answer();
    auto solution = std::make_shared<sessions::CaseAnnotationsSolution>(*answer.solution);
    solution->annotations.camera_from_end_effector = camera_from_end_effector;
    answer.solution = solution;
    return solutionHtml(answer, {{QStringLiteral("seed"), Pose()}});
  };
  const QString at_camera = QStringLiteral(">at the camera");
  const QString without = htmlWith({});
  EXPECT_FALSE(without.contains(at_camera)) << "said once";
  EXPECT_TRUE(without.contains(QStringLiteral("3 sigma at the camera")));
  EXPECT_TRUE(without.contains(QStringLiteral("Distance of the annotated pose at the camera")));
  Pose camera_from_end_effector;
  camera_from_end_effector.translation_m = {0.0, 0.1, 0.2};
  const QString with = htmlWith(camera_from_end_effector);
  EXPECT_TRUE(with.contains(at_camera));
  EXPECT_TRUE(with.contains(QStringLiteral("3 sigma at the end effector")));
}

TEST_F(AnnotationPanelTest, GeometryIsWeakWhereTheSigmaExceedsTheRequirement) {
  const auto ids = markCorners(5);
  ASSERT_TRUE(solved());
  const auto meter = [this] { return find<QLabel>("geometryMeter").text(); };
  EXPECT_FALSE(meter().contains(QStringLiteral("pose known to"))) << meter().toStdString();
  controller_.dragInImage(ids[0], pixelOf(corners_m(5)[0]) + Eigen::Vector2d(30.0, 40.0));
  controller_.finishMove();
  ASSERT_TRUE(solved());
  EXPECT_TRUE(meter().contains(QStringLiteral("pose known to"))) << meter().toStdString();
  EXPECT_FALSE(meter().contains(QStringLiteral("no weakness")));
}

TEST_F(AnnotationPanelTest, TheTableChoosesTurnsOffAndRemoves) {
  const auto ids = markCorners(5);
  clickCell(2, AnnotationsModel::kName);
  EXPECT_EQ(controller_.selected(), ids[2]);
  QTest::keyClick(panel_.get(), Qt::Key_Space);
  EXPECT_FALSE(controller_.annotations().points[2].enabled);
  EXPECT_EQ(document_.undoText(), QStringLiteral("Turn p3 off"));
  QTest::keyClick(panel_.get(), Qt::Key_Delete);
  EXPECT_EQ(controller_.annotations().points.size(), 4u);
  ASSERT_TRUE(document_.undo());
  ASSERT_TRUE(document_.undo());
  EXPECT_TRUE(controller_.annotations().points[2].enabled);
  controller_.select(ids[4]);
  EXPECT_EQ(panel_->table().currentIndex().row(), 4) << "the table follows the other views";
  QAbstractItemModel& model = *panel_->table().model();
  ASSERT_TRUE(model.setData(model.index(1, AnnotationsModel::kComment), QStringLiteral("rim")));
  EXPECT_EQ(controller_.annotations().points[1].comment, "rim");
}

TEST_F(AnnotationPanelTest, ArrowsOnARowMoveItsAnnotationAndCtrlGoesToOtherRows) {
  const auto ids = markCorners(5);
  clickCell(2, AnnotationsModel::kName);
  const Eigen::Vector2d before = *controller_.annotations().points[2].pixel;
  QTest::keyClick(&panel_->table(), Qt::Key_Right);
  QTest::keyClick(&panel_->table(), Qt::Key_Down, Qt::ShiftModifier);
  EXPECT_EQ(controller_.selected(), ids[2]);
  EXPECT_LT(
      (*controller_.annotations().points[2].pixel - before - Eigen::Vector2d(0.1, 1.0)).norm(),
      1e-9);
  QTest::keyClick(&panel_->table(), Qt::Key_Down, Qt::ControlModifier);
  EXPECT_EQ(controller_.selected(), ids[3]);
}

TEST_F(AnnotationPanelTest, EnterOnARowGoesToItsAnnotationInTheImage) {
  const auto ids = markCorners(5);
  controller_.setMode(PlaceMode::kOff);
  bool requested = false;
  QObject::connect(panel_.get(), &AnnotationPanel::imageRequested, panel_.get(),
                   [&requested] { requested = true; });
  clickCell(2, AnnotationsModel::kName);
  QTest::keyClick(&panel_->table(), Qt::Key_Return);
  EXPECT_TRUE(requested);
  EXPECT_EQ(controller_.mode(), PlaceMode::kPoint);
  EXPECT_EQ(controller_.selected(), ids[2]);
}

TEST_F(AnnotationPanelTest, ButtonsSetModeWeightsAndTruth) {
  QTest::mouseClick(&find<QToolButton>("placePoints"), Qt::LeftButton);
  EXPECT_EQ(controller_.mode(), PlaceMode::kPoint);
  QTest::mouseClick(&find<QToolButton>("placeLines"), Qt::LeftButton);
  EXPECT_EQ(controller_.mode(), PlaceMode::kLine);
  EXPECT_FALSE(find<QToolButton>("placePoints").isChecked());
  QTest::mouseClick(&find<QToolButton>("placeLines"), Qt::LeftButton);
  EXPECT_EQ(controller_.mode(), PlaceMode::kOff);
  const auto ids = markCorners(8);
  ASSERT_TRUE(solved());
  const Pose before = *controller_.solvedPose();
  controller_.dragInImage(ids[0], pixelOf(corners_m(8)[0]) + Eigen::Vector2d(0.0, 20.0));
  controller_.finishMove();
  ASSERT_TRUE(solved());
  const auto far_off = (controller_.solvedPose()->translation_m - before.translation_m).norm();
  find<QCheckBox>("robust").click();
  ASSERT_TRUE(document_.session().robust_annotations && solved());
  EXPECT_LT((controller_.solvedPose()->translation_m - before.translation_m).norm(), 0.1 * far_off);
  QTest::mouseClick(&find<QPushButton>("annotationAsTruth"), Qt::LeftButton);
  EXPECT_EQ(document_.session().findCase(source().id)->camera_from_station_truth,
            controller_.solvedPose());
}

TEST_F(AnnotationPanelTest, CoplanarAnnotations_ShowBothPosesSideBySide) {
  StationSnapper snapper(state_);
  auto* ambiguity = new AmbiguityView(controller_, state_, snapper);
  panel_->addBeside(ambiguity);
  EXPECT_FALSE(ambiguity->isVisibleTo(panel_.get()));
  controller_.setAnnotations(smallSquare(), QStringLiteral("Import"));
  ASSERT_TRUE(solved());
  ASSERT_TRUE(controller_.solution()->ambiguous_camera_from_station())
      << "the case is not ambiguous";
  EXPECT_TRUE(ambiguity->isVisibleTo(panel_.get()));
  EXPECT_TRUE(summary().contains(QStringLiteral("fit two poses")));
  const auto edges = [this](const char* view) -> const std::vector<Mark>& {
    return find<ImageView>(view).layer(LayerId::kAnnotationBand).marks;
  };
  ASSERT_TRUE(QTest::qWaitFor([&] { return !edges("otherPicture").empty(); }, kPatience_ms));
  EXPECT_NE(edges("otherPicture").front().outline, edges("bestPicture").front().outline);
  EXPECT_EQ(find<ImageView>("bestPicture").layer(LayerId::kPoints).marks.size(), 4u);
  Pose asked;
  QObject::connect(ambiguity, &AmbiguityView::otherRequested, ambiguity,
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
  auto& menu = static_cast<RigMenu&>(*find<QToolButton>("rig").menu());
  const auto action = [&](const QString& text) -> QAction* {
    Q_EMIT menu.aboutToShow();
    for (QAction* each : menu.findChildren<QAction*>())
      if (each->text().contains(text)) return each;
    return nullptr;
  };
  QAction* link = action(QStringLiteral("not moved"));
  ASSERT_NE(link, nullptr);
  link->trigger();
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
  EXPECT_TRUE(summary().contains(QStringLiteral("Cameras solved together")));
  find<QCheckBox>("together").click();
  ASSERT_TRUE(solved());
  EXPECT_EQ(controller_.solution()->annotations.views.size(), 1u);
  QAction* unlink = action(QStringLiteral("out of this rig"));
  ASSERT_NE(unlink, nullptr);
  unlink->trigger();
  EXPECT_FALSE(document_.session().findCase(first)->rig);
}

}  // namespace
}  // namespace boresight::ui
