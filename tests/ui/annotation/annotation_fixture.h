// SPDX-License-Identifier: Apache-2.0
// An annotator's desk without a window: a session of the shipped examples, one case open; and an
// annotator at the image, by real events on the view at any zoom and screen scaling.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <QtTest>
#include <QtWidgets>

#include "sessions/annotation/annotations.h"
#include "sessions/annotation/annotations_on_image.h"
#include "sessions/annotation/mesh_snap.h"
#include "tests/ui/pointer.h"
#include "tests/ui/window_test.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/annotation/annotation_tool.h"
#include "ui/annotation/image_annotation.h"
#include "ui/annotation/loupe.h"
#include "ui/annotation/station_snapper.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"

namespace boresight::ui {

using Eigen::Vector2d;
using Eigen::Vector3d;

class AnnotationTest : public ::testing::Test {
 protected:
  void SetUp() override {
    static const auto session = sessions::makeSession(test::exampleFolder() / "dataset.json");
    ASSERT_TRUE(document_.create(folder_.path() / "one.boresight.json", session));
    open(session.cases.front()->id);
  }

  void open(const std::string& id) {
    state_.setCase(sessions::loadCase(*document_.session().findCase(id)));
    ASSERT_TRUE(solved());
  }

  const sessions::SessionCase& source() const { return state_.currentCase()->source; }
  const Pose& truth() const { return *source().camera_from_station_truth; }
  const Camera& camera() const { return source().camera; }
  const sessions::Annotations& annotations() const { return controller_.annotations(); }

  static bool wait(const std::function<bool()>& holds) {
    return QTest::qWaitFor(holds, test::kPatienceMs);
  }
  /// Waits until what is annotated now has been solved.
  bool solved() {
    return wait([this] { return !controller_.stale(); });
  }

  /// Corners of salient edges, spread over the station, that the true pose projects into the image.
  std::vector<Vector3d> corners_m(std::size_t count) const {
    const sessions::MeshSnapper snapper(state_.currentCase()->scene.view());
    std::vector<Vector3d> seen;
    const std::size_t stride = std::max<std::size_t>(snapper.edges().size() / 60, 1);
    for (std::size_t i = 0; i < snapper.edges().size(); i += stride) {
      const Vector3d& corner_m = snapper.edges()[i].start_in_station_m;
      const Vector2d pixel = pixelOf(corner_m);
      if (!sessions::isInImage(camera(), pixel)) continue;
      for (const sessions::MeshSnap& snap : snapper.near(camera(), truth(), pixel, 2.0))
        if (snap.kind == sessions::MeshSnapKind::kVertex && snap.point_in_station_m == corner_m)
          seen.push_back(corner_m);
    }
    std::vector<Vector3d> spread;
    for (std::size_t i = 0; i < count && seen.size() >= count; ++i)
      spread.push_back(seen[i * (seen.size() - 1) / std::max<std::size_t>(count - 1, 1)]);
    return spread;
  }

  Vector2d pixelOf(const Vector3d& point_in_station_m) const {
    Vector2d pixel = Vector2d::Constant(-1e9);
    (void)project(camera(), truth() * point_in_station_m, pixel);
    return pixel;
  }

  /// Annotates a point exactly where the true pose projects it; returns its id.
  std::string annotatePair(const Vector3d& place_m) {
    const std::string id = controller_.placeInImage(pixelOf(place_m));
    EXPECT_EQ(controller_.placeOnStation(place_m), id);
    return id;
  }

  /// Annotates corners exactly where the true pose shows them; their ids.
  std::vector<std::string> markCorners(std::size_t count) {
    std::vector<std::string> ids;
    for (const Vector3d& corner_m : corners_m(count)) ids.push_back(annotatePair(corner_m));
    return ids;
  }
  std::vector<std::string> solveCorners(std::size_t count) {
    const std::vector<std::string> ids = markCorners(count);
    EXPECT_EQ(ids.size(), count);
    EXPECT_TRUE(solved() && controller_.solvedPose());
    return ids;
  }
  /// Moves the first point in the image, and solves again.
  void moveFirst(const Vector2d& by_px) {
    const sessions::PointPair first = annotations().points.at(0);
    ASSERT_TRUE(controller_.dragInImage(first.id, *first.pixel + by_px));
    controller_.finishMove();
    ASSERT_TRUE(solved());
  }

  test::TemporaryFolder folder_;
  Document document_;
  ViewState state_;
  AnnotationController controller_{document_, state_};
};

/// The pointer on an image view.
class ImagePointer {
 protected:
  ~ImagePointer() = default;

  virtual ImageView& view() = 0;
  /// Length of a screen pixel in image pixels.
  double screenPixel_px() {
    return 1.0 / (view().transform().scale() * view().devicePixelRatioF());
  }

  /// Sets the scale, widget coordinates per image pixel, and centres the view on a pixel.
  void zoom(const Vector2d& pixel, double scale) {
    ViewTransform transform = view().transform();
    transform.zoomAt(QPointF(0.0, 0.0), scale);
    transform.centreOn(QPointF(pixel.x(), pixel.y()), view().size());
    view().setTransform(transform);
  }

  void send(QEvent::Type type, const Vector2d& pixel, Qt::MouseButton button = Qt::LeftButton,
            Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    const QPointF at = view().transform().toWidget(pointOf(pixel));
    test::sendMouse(view(), type, test::cornerOfScreenPixel(view(), at), button, modifiers);
  }
  void moveTo(const Vector2d& pixel, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    send(QEvent::MouseMove, pixel, Qt::NoButton, modifiers);
  }
  void click(const Vector2d& pixel, Qt::KeyboardModifiers modifiers = Qt::NoModifier,
             Qt::MouseButton button = Qt::LeftButton) {
    moveTo(pixel, modifiers);
    send(QEvent::MouseButtonPress, pixel, button, modifiers);
    send(QEvent::MouseButtonRelease, pixel, button, modifiers);
  }
  void drag(const Vector2d& from, const Vector2d& to) {
    moveTo(from);
    send(QEvent::MouseButtonPress, from);
    for (const Vector2d& at : {Vector2d(0.5 * (from + to)), to}) send(QEvent::MouseMove, at);
    send(QEvent::MouseButtonRelease, to);
  }
};

class ImageAnnotationTest : public AnnotationTest, protected ImagePointer {
 protected:
  void SetUp() override {
    panel_.resize(900, 700);
    panel_.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&panel_));
    AnnotationTest::SetUp();
    ready();
    QObject::connect(&controller_, &AnnotationController::told,
                     [this](const QString& told) { told_ = told; });
  }

  void ready() {
    ASSERT_TRUE(wait([this] { return snapper_.mesh() && !tasks_.isBusy(); }));
  }

  /// The open case with another image of the same size.
  template <class Gray>
  void paintImage(const Gray& gray_at) {
    auto painted = std::make_shared<sessions::LoadedCase>();
    painted->source = source();
    painted->scene = state_.currentCase()->scene;
    painted->image = state_.currentCase()->image;
    for (int y = 0; y < painted->image.height; ++y)
      for (int x = 0; x < painted->image.width; ++x)
        painted->image.pixels[static_cast<std::size_t>(y * painted->image.width + x)] =
            static_cast<std::uint8_t>(std::lround(gray_at(x, y)));
    state_.replaceCase(painted);
    ready();
  }

  ImageView& view() override { return panel_.view(); }
  AnnotationTool& tool() { return annotation_.tool(); }

  TaskRunner tasks_;
  ImagePanel panel_{state_, tasks_};
  StationSnapper snapper_{state_};
  ImageAnnotation annotation_{panel_, controller_, state_, snapper_};
  QString told_;
};

}  // namespace boresight::ui
