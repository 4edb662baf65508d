// SPDX-License-Identifier: Apache-2.0
// Pictures of the scene while somebody annotates, for people to look at: BORESIGHT_PICTURES names
// the folder.
#include <gtest/gtest.h>

#include <QApplication>
#include <QDir>
#include <QDockWidget>
#include <QMouseEvent>
#include <QtTest/QTest>

#include "tests/ui/annotation/annotation_fixture.h"
#include "ui/annotation/station_snapper.h"
#include "ui/scene/scene_annotator.h"
#include "ui/scene/scene_view.h"
#include "ui/window/application.h"
#include "ui/window/main_window.h"

namespace boresight::ui {
namespace {

constexpr int kPatience_ms = 60000;

class ScenePictures : public ::testing::Test {
 protected:
  void SetUp() override {
    into_ = qEnvironmentVariable("BORESIGHT_PICTURES");
    if (into_.isEmpty()) GTEST_SKIP() << "BORESIGHT_PICTURES names no folder";
    ASSERT_TRUE(QDir().mkpath(into_));
  }

  /// A corner of the mesh that the truth's camera sees, by the share of the way through all.
  static std::vector<Eigen::Vector3d> seenCorners(const sessions::MeshSnapper& mesh,
                                                  const sessions::SessionCase& source) {
    const Pose& pose = *source.camera_from_station_truth;
    const Eigen::Vector3d eye_m = pose.inverse().translation_m;
    std::vector<Eigen::Vector3d> seen;
    for (const sessions::ModelEdge& edge : mesh.edges()) {
      Eigen::Vector2d pixel;
      if (project(source.camera, pose * edge.start_in_station_m, pixel) &&
          sessions::isInImage(source.camera, pixel) &&
          mesh.seenFrom(eye_m, edge.start_in_station_m))
        seen.push_back(edge.start_in_station_m);
    }
    return seen;
  }

  /// Eight pairs of all kinds and an edge.
  static void mark(AnnotationController& annotation, const sessions::SessionCase& source,
                   const std::vector<Eigen::Vector3d>& corners_m,
                   const sessions::MeshSnapper& mesh) {
    const Pose& pose = *source.camera_from_station_truth;
    for (std::size_t i = 0; i < 8; ++i) {
      const Eigen::Vector3d& corner_m = corners_m[i * (corners_m.size() - 1) / 7];
      annotation.select({});
      const std::string id = annotation.placeOnStation(corner_m);
      if (i == 7) break;
      Eigen::Vector2d pixel;
      ASSERT_TRUE(project(source.camera, pose * corner_m, pixel));
      annotation.placeInImage(pixel + Eigen::Vector2d(i == 2 ? 9.0 : 0.1, 0.0));
      sessions::PointPair point = *annotation.selectedPoint();
      point.enabled = i != 4;
      point.locked = i == 5;
      annotation.replacePoint(id, point, QStringLiteral("Change"));
    }
    annotation.select({});
    annotation.placeEdgeOnStation(mesh.edges()[mesh.edges().size() / 3]);
    annotation.select({});
  }

  void take(const QSize& size, bool dark, const QString& name, bool through_camera) {
    const QPalette before = QApplication::palette();
    if (dark) useDarkColors(*static_cast<QApplication*>(QCoreApplication::instance()));
    test::TemporaryFolder folder;
    {
      MainWindow window;
      window.setQuiet(true);
      window.resize(size);
      window.show();
      ASSERT_TRUE(
          window.document().create(folder.path() / "one.boresight.json",
                                   sessions::makeSession(test::exampleFolder() / "dataset.json")));
      ASSERT_TRUE(
          QTest::qWaitFor([&] { return window.state().currentCase() != nullptr; }, kPatience_ms));
      draw(window, name, through_camera);
    }
    QApplication::setPalette(before);
  }

  void draw(MainWindow& window, const QString& name, bool through_camera) {
    auto* scene = window.findChild<SceneView*>();
    auto* snapper = window.findChild<StationSnapper*>();
    ASSERT_TRUE(scene && snapper);
    ASSERT_TRUE(QTest::qWaitFor([&] { return snapper->mesh() != nullptr; }, kPatience_ms));
    AnnotationController& annotation = window.annotation();
    const sessions::SessionCase& source = window.state().currentCase()->source;
    const auto corners_m = seenCorners(*snapper->mesh(), source);
    mark(annotation, source, corners_m, *snapper->mesh());
    ASSERT_TRUE(QTest::qWaitFor([&] { return !annotation.stale(); }, kPatience_ms));
    annotation.setMode(PlaceMode::kPoint);
    if (QDockWidget* dock = window.dock(QStringLiteral("annotation"))) dock->raise();
    scene->refresh();
    if (through_camera) {
      scene->setThroughCamera(true);
      scene->setThroughRole(PoseRole::kAnnotated);
      ASSERT_TRUE(QTest::qWaitFor([&] { return scene->backdropReady(); }, kPatience_ms));
    } else {
      for (int i = 0; i < 4; ++i) QTest::keyClick(scene->canvas(), Qt::Key_Plus);
    }
    hover(*scene, corners_m[corners_m.size() / 2]);
    ASSERT_TRUE(QTest::qWaitFor([&] { return scene->annotator()->loupe().ready(); }, kPatience_ms));
    QTest::qWait(200);
    EXPECT_TRUE(window.grab().save(into_ + QStringLiteral("/%1.png").arg(name)));
    EXPECT_TRUE(scene->grab().save(into_ + QStringLiteral("/%1_scene.png").arg(name)));
  }

  static void hover(SceneView& scene, const Eigen::Vector3d& place_m) {
    QPointF at;
    double depth_m = 0.0;
    ASSERT_TRUE(scene.viewpoint().toCanvas(place_m, at, depth_m));
    at += QPointF(4.0, 3.0);
    QMouseEvent move(QEvent::MouseMove, at, scene.canvas()->mapToGlobal(at.toPoint()), Qt::NoButton,
                     Qt::NoButton, Qt::NoModifier);
    QApplication::sendEvent(scene.canvas(), &move);
  }

  QString into_;
};

TEST_F(ScenePictures, OfAnAnnotatorsDesk) {
  for (const bool dark : {false, true})
    for (const QSize& size : {QSize(1280, 800), QSize(2560, 1440)})
      take(size, dark,
           QStringLiteral("%1_%2")
               .arg(dark ? QStringLiteral("dark") : QStringLiteral("light"))
               .arg(size.width()),
           false);
  take({2560, 1440}, false, QStringLiteral("through_camera"), true);
}

}  // namespace
}  // namespace boresight::ui
