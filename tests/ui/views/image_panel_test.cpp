// SPDX-License-Identifier: Apache-2.0
#include "ui/views/image_panel.h"

#include <algorithm>
#include <optional>

#include <gtest/gtest.h>
#include <QtTest>
#include <QtWidgets>

#include "sessions/run/scene_render.h"
#include "tests/support/hypotheses_run.h"
#include "tests/support/loaded_example.h"
#include "ui/run/task_runner.h"
#include "ui/views/image_view.h"
#include "ui/views/layers_panel.h"

namespace boresight::ui {
namespace {

constexpr int kPatienceMs = 60'000;

class ImagePanelTest : public ::testing::Test {
 protected:
  void SetUp() override {
    QObject::connect(&panel_, &ImagePanel::placeText,
                     [this](const QString& text) { text_ = text; });
    panel_.resize(900, 700);
    panel_.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&panel_));
    static const auto value = test::loadedExample("os");
    state_.setCase(value);
  }

  /// With the middle of a screen pixel on this place.
  void pointAt(const QPointF& pixel) {
    const QPointF half(0.5, 0.5);
    const QPointF at = panel_.view().transform().toWidget(pixel) - half;
    QMouseEvent move(QEvent::MouseMove, at, panel_.view().mapToGlobal(at.toPoint()), Qt::NoButton,
                     Qt::NoButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&panel_.view(), &move);
  }

  /// Station coordinates in the text, m.
  std::optional<Eigen::Vector3d> pointInText() const {
    static const QRegularExpression form(
        QStringLiteral("station (-?[0-9.]+)  (-?[0-9.]+)  (-?[0-9.]+) mm"));
    const QRegularExpressionMatch match = form.match(text_);
    if (!match.hasMatch()) return std::nullopt;
    return 1e-3 * Eigen::Vector3d(match.captured(1).toDouble(), match.captured(2).toDouble(),
                                  match.captured(3).toDouble());
  }

  TaskRunner tasks_;
  ViewState state_;
  ImagePanel panel_{state_, tasks_};
  QString text_;
};

/// Pointing at the middle of a face tells that place, or one before it that hides it.
TEST_F(ImagePanelTest, TheStationPointUnderThePointerIsTold) {
  const auto& value = *state_.currentCase();
  const MeshView mesh = value.scene.view();
  Pose moved = *value.source.camera_from_station_truth;
  moved.translation_m.x() += 0.01;
  for (const Pose& pose : {value.source.camera_from_station_seed, moved}) {
    if (&pose != &value.source.camera_from_station_seed) state_.setNudgedPose(pose);
    int places = 0, seen = 0;
    for (std::size_t i = 0; i < mesh.faces.size(); i += 97) {
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      for (const std::int32_t vertex : mesh.faces[i].vertex)
        centre += mesh.vertices_in_station_m[static_cast<std::size_t>(vertex)].cast<double>() / 3.0;
      Eigen::Vector2d pixel;
      if (!project(value.source.camera, pose * centre, pixel)) continue;
      if (pixel.minCoeff() < 0.0 || pixel.x() > value.image.width - 1.0 ||
          pixel.y() > value.image.height - 1.0)
        continue;
      pointAt({pixel.x(), pixel.y()});
      const auto point = pointInText();
      ASSERT_TRUE(point) << text_.toStdString();
      ++places;
      Eigen::Vector2d back;
      ASSERT_TRUE(project(value.source.camera, pose * *point, back));
      EXPECT_LT((back - pixel).norm(), 0.1) << "the text has hundredths of a millimetre";
      EXPECT_LT((pose * *point).z(), (pose * centre).z() + 2e-5);
      if ((*point - centre).norm() < 2e-5) ++seen;
    }
    EXPECT_GT(places, 20);
    EXPECT_GT(seen, places / 5);
  }
}

TEST_F(ImagePanelTest, PointerOffTheStation_ShowsOnlyThePixel) {
  pointAt({3.0, 5.0});
  EXPECT_TRUE(text_.contains(QStringLiteral("gray ")));
  EXPECT_FALSE(pointInText());
  pointAt({-40.0, 5.0});
  EXPECT_FALSE(text_.contains(QStringLiteral("gray ")));
  QEvent leave(QEvent::Leave);
  QCoreApplication::sendEvent(&panel_.view(), &leave);
  EXPECT_TRUE(text_.isEmpty());
}

/// A competing pose and the result, each where the core renders it.
TEST_F(ImagePanelTest, AHypothesisIsDrawnWithTheChosenPose) {
  const auto run = test::runWithHypotheses();
  state_.setSnapshot(run);
  const sessions::Alternative competing = sessions::alternativesOf(*run).front();
  const auto bitsOfLayer = [this](LayerId id) -> const std::vector<LayerBits>& {
    return panel_.view().layer(id).bits;
  };
  EXPECT_TRUE(bitsOfLayer(LayerId::kHypothesisEdges).empty());
  EXPECT_TRUE(panel_.view().legend().empty());
  state_.setAlternative(competing);
  ASSERT_TRUE(QTest::qWaitFor(
      [&] {
        return !bitsOfLayer(LayerId::kHypothesisEdges).empty() &&
               !bitsOfLayer(LayerId::kChosenEdges).empty();
      },
      kPatienceMs));
  const auto& value = *state_.currentCase();
  const auto isRenderOf = [&](LayerId id, const Pose& pose) {
    sessions::RenderTrace expected;
    if (sessions::renderScene(value.source.camera, value.scene.view(), pose, expected) !=
        Status::kOk)
      return false;
    const auto words = bitsOfLayer(id).front().bits.words;
    return std::equal(words.begin(), words.end(), expected.edges.words.begin(),
                      expected.edges.words.end());
  };
  EXPECT_TRUE(isRenderOf(LayerId::kHypothesisEdges, competing.camera_from_station));
  EXPECT_TRUE(isRenderOf(LayerId::kChosenEdges, run->camera_from_station));
  EXPECT_EQ(panel_.view().legend().front(),
            (LegendLine{LayerId::kHypothesisEdges, QStringLiteral("Competing pose 1")}));
  state_.setAlternative(std::nullopt);
  EXPECT_TRUE(bitsOfLayer(LayerId::kHypothesisEdges).empty());
  EXPECT_TRUE(bitsOfLayer(LayerId::kChosenEdges).empty());
  EXPECT_TRUE(panel_.view().legend().empty());
}

TEST_F(ImagePanelTest, TheLegendNamesWhatShows) {
  const auto run = test::runWithHypotheses();
  state_.setSnapshot(run);
  const auto corner = [this] {
    const QImage shown = panel_.view().grab().toImage();
    return shown.copy(0, 0, 160, 40);
  };
  LayerStyle hidden = panel_.style(LayerId::kSeedEdges);
  for (const LayerId id : {LayerId::kSeedEdges, LayerId::kIterationEdges, LayerId::kMatches})
    panel_.setStyle(id, {false, hidden.color, 1.0});
  const QImage before = corner();
  state_.setAlternative(sessions::alternativesOf(*run).front());
  ASSERT_TRUE(QTest::qWaitFor(
      [&] {
        return !panel_.view().layer(LayerId::kHypothesisEdges).bits.empty() && !tasks_.isBusy();
      },
      kPatienceMs));
  EXPECT_NE(corner(), before);
  for (const LayerId id : {LayerId::kHypothesisEdges, LayerId::kChosenEdges})
    panel_.setStyle(id, {false, hidden.color, 1.0});
  EXPECT_EQ(corner(), before) << "what is hidden is not named";
}

class LayersPanelTest : public ::testing::Test {
 protected:
  LayersPanelTest() {
    panel_.resize(360, 500);
    panel_.show();
  }
  QCheckBox* box(LayerId id) {
    return panel_.findChild<QCheckBox*>(QStringLiteral("layer%1").arg(static_cast<int>(id)));
  }

  ViewState state_;
  TaskRunner tasks_;
  ImagePanel image_{state_, tasks_};
  LayersPanel panel_{image_};
};

TEST_F(LayersPanelTest, ABoxShowsAndHidesItsLayer) {
  for (int i = 0; i < kLayerCount; ++i) {
    const auto id = static_cast<LayerId>(i);
    const bool before = image_.style(id).visible;
    ASSERT_NE(box(id), nullptr) << i;
    EXPECT_EQ(box(id)->isChecked(), before);
    QTest::mouseClick(box(id), Qt::LeftButton, Qt::NoModifier, QPoint(8, box(id)->height() / 2));
    EXPECT_EQ(image_.style(id).visible, !before) << i;
  }
}

TEST_F(LayersPanelTest, LayerKey_UpdatesThePanel) {
  LayerStyle style = image_.style(LayerId::kTruthEdges);
  style.visible = !style.visible;
  style.opacity = 0.25;
  image_.setStyle(LayerId::kTruthEdges, style);
  EXPECT_EQ(box(LayerId::kTruthEdges)->isChecked(), style.visible);
  QSet<int> values;
  for (const QSlider* slider : panel_.findChildren<QSlider*>()) values.insert(slider->value());
  EXPECT_TRUE(values.contains(25));
}

TEST_F(LayersPanelTest, ASliderSetsTheOpacityOfOneLayer) {
  QList<QSlider*> sliders = panel_.findChildren<QSlider*>();
  ASSERT_EQ(sliders.size(), kLayerCount);
  for (QSlider* slider : sliders) {
    const int other = slider->value() == 37 ? 38 : 37;
    QSignalSpy changed(&image_, &ImagePanel::stylesChanged);
    slider->setValue(other);
    EXPECT_EQ(changed.count(), 1);
    int found = 0;
    for (int i = 0; i < kLayerCount; ++i)
      if (std::abs(image_.style(static_cast<LayerId>(i)).opacity - 0.01 * other) < 1e-12) ++found;
    EXPECT_EQ(found, 1);
    slider->setValue(99);
  }
}

TEST_F(LayersPanelTest, EveryControlSaysWhatItDoes) {
  for (const QWidget* widget : panel_.findChildren<QWidget*>()) {
    const bool control = qobject_cast<const QCheckBox*>(widget) ||
                         qobject_cast<const QToolButton*>(widget) ||
                         (qobject_cast<const QSlider*>(widget) && widget->isEnabled());
    EXPECT_TRUE(!control || !widget->toolTip().isEmpty());
  }
}

}  // namespace
}  // namespace boresight::ui
