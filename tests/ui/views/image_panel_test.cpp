// SPDX-License-Identifier: Apache-2.0
#include "ui/views/image_panel.h"

#include <algorithm>
#include <optional>

#include <gtest/gtest.h>
#include <QtTest>
#include <QtWidgets>

#include "sessions/trace/scene_render.h"
#include "tests/support/hypotheses_run.h"
#include "tests/support/loaded_example.h"
#include "tests/ui/patience.h"
#include "tests/ui/pointer.h"
#include "ui/run/task_runner.h"
#include "ui/views/image_view.h"
#include "ui/views/layer_legend.h"
#include "ui/views/layers_panel.h"
#include "ui/views/measure_tool.h"

namespace boresight::ui {
namespace {

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

  static bool wait(const std::function<bool()>& holds) {
    return QTest::qWaitFor(holds, test::kPatienceMs);
  }
  const Layer& layer(LayerId id) { return panel_.view().layer(id); }
  void show(LayerId id, bool visible) {
    LayerStyle style = panel_.style(id);
    style.visible = visible;
    panel_.setStyle(id, style);
  }
  bool legendLists(LayerId id) { return std::ranges::count(panel_.legend().shown(), id) > 0; }

  /// With the middle of a screen pixel on this place.
  void pointAt(const QPointF& pixel) {
    test::moveMouse(panel_.view(), panel_.view().transform().toWidget(pixel) - QPointF(0.5, 0.5));
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

/// Lines of a pose as the core renders it.
bool areLinesOf(const LinesPtr& lines, const sessions::LoadedCase& value, const Pose& pose) {
  sessions::RenderTrace render;
  if (!lines ||
      sessions::renderScene(value.source.camera, value.scene.view(), pose, render) != Status::kOk)
    return false;
  const sessions::EdgeLines expected = sessions::edgeLines(render, 0);
  return std::equal(lines->begin(), lines->end(), expected.begin(), expected.end(),
                    [](const auto& a, const auto& b) { return a.places_px == b.places_px; });
}

/// A competing pose and the result, each where the core renders it.
TEST_F(ImagePanelTest, AHypothesisIsDrawnWithTheChosenPose) {
  const auto run = test::runWithHypotheses();
  state_.setSnapshot(run);
  const sessions::Alternative competing = sessions::alternativesOf(*run).front();
  const Layer& hypothesis = layer(LayerId::kHypothesisEdges);
  const Layer& chosen = layer(LayerId::kChosenEdges);
  EXPECT_TRUE(hypothesis.empty());
  EXPECT_FALSE(legendLists(LayerId::kHypothesisEdges));
  EXPECT_TRUE(legendLists(LayerId::kSeedEdges));
  state_.setAlternative(competing);
  ASSERT_TRUE(wait([&] { return !hypothesis.empty() && !chosen.empty(); }));
  ASSERT_TRUE(wait([&] { return legendLists(LayerId::kHypothesisEdges); }));
  const auto& value = *state_.currentCase();
  EXPECT_TRUE(areLinesOf(hypothesis.lines, value, competing.camera_from_station));
  EXPECT_TRUE(areLinesOf(chosen.lines, value, run->camera_from_station));
  EXPECT_EQ(hypothesis.name, QStringLiteral("Competing pose 1"));
  EXPECT_TRUE(layer(LayerId::kSeedEdges).faded);
  state_.setAlternative(std::nullopt);
  EXPECT_TRUE(hypothesis.empty());
  EXPECT_TRUE(chosen.empty());
  EXPECT_FALSE(layer(LayerId::kSeedEdges).faded);
  EXPECT_FALSE(legendLists(LayerId::kHypothesisEdges));
}

TEST_F(ImagePanelTest, LegendListsWhatIsDrawn_ItsRowsToggleTheirLayers) {
  state_.setSnapshot(test::runWithHypotheses());
  EXPECT_FALSE(legendLists(LayerId::kTestEdges));
  show(LayerId::kTestEdges, true);
  ASSERT_TRUE(wait([&] { return legendLists(LayerId::kTestEdges); }));
  show(LayerId::kTestEdges, false);
  EXPECT_FALSE(legendLists(LayerId::kTestEdges));
  auto* row = panel_.legend().findChild<QAbstractButton*>(
      QStringLiteral("legend%1").arg(static_cast<int>(LayerId::kTruthEdges)));
  ASSERT_TRUE(row);
  const bool before = panel_.style(LayerId::kTruthEdges).visible;
  EXPECT_EQ(row->isChecked(), before);
  QTest::mouseClick(row, Qt::LeftButton);
  EXPECT_EQ(panel_.style(LayerId::kTruthEdges).visible, !before);
}

/// A failed run never looks like a result.
TEST_F(ImagePanelTest, PoseOfARejectedRunHasAColourAndAPatternOfItsOwn) {
  state_.setSnapshot(test::runWithHypotheses());
  const Layer found = layer(LayerId::kIterationEdges);
  auto run = std::make_shared<sessions::LocalizationTrace>(*test::runWithHypotheses());
  run->status = LocalizationStatus::kPnpFailed;
  state_.setSnapshot(run);
  const Layer& rejected = layer(LayerId::kIterationEdges);
  EXPECT_NE(rejected.shownLine().color, found.shownLine().color);
  EXPECT_NE(rejected.shownLine().gap_px, found.shownLine().gap_px);
  EXPECT_EQ(rejected.name, QStringLiteral("Rejected pose"));
}

TEST_F(ImagePanelTest, DoubtfulPose_IsCaptionedWithItsProbability_EarlierPosesOfTheRunAreRejected) {
  auto run = std::make_shared<sessions::LocalizationTrace>(*test::runWithHypotheses());
  run->status = LocalizationStatus::kNotSupported;
  run->probability = 0.095;
  state_.setSnapshot(run);
  const Layer doubtful = layer(LayerId::kIterationEdges);
  EXPECT_EQ(doubtful.name, QStringLiteral("Doubtful pose, 9.5 %"));
  for (const LineToken& other : {kPoseLine, kSeedLine, kRejectedLine})
    EXPECT_NE(doubtful.shownLine().dash_px, other.dash_px) << "the pattern differs too";
  EXPECT_NE(doubtful.shownLine().color, kPoseLine.color);
  state_.setCursor({0, Stage::kFinished});
  EXPECT_EQ(layer(LayerId::kIterationEdges).name, QStringLiteral("Rejected pose"));
}

TEST_F(ImagePanelTest, AStageBringsItsLayerAndTakesItAway) {
  const auto run = test::runWithHypotheses();
  state_.setSnapshot(run);
  EXPECT_FALSE(panel_.style(LayerId::kTemplates).visible);
  state_.setCursor({0, Stage::kTemplates});
  EXPECT_TRUE(panel_.style(LayerId::kTemplates).visible);
  EXPECT_FALSE(layer(LayerId::kTemplates).marks.empty());
  state_.setCursor({0, Stage::kMatch});
  EXPECT_TRUE(layer(LayerId::kWindows).marks.empty());
  state_.selectTemplate(3);
  EXPECT_EQ(layer(LayerId::kWindows).marks.size(), 2u) << "of the chosen template alone";
  const LinesPtr& lines = layer(LayerId::kIterationEdges).lines;
  ASSERT_TRUE(wait([&] { return lines && !tasks_.isBusy(); }));
  const LinesPtr before = lines;
  state_.setCursor({0, Stage::kPose});
  EXPECT_FALSE(panel_.style(LayerId::kTemplates).visible);
  ASSERT_TRUE(wait([&] { return lines != before; })) << "stage pose shows the corrected edges";
  EXPECT_TRUE(areLinesOf(lines, *state_.currentCase(), run->iterations[0]->camera_from_station));
}

TEST_F(ImagePanelTest, MeasuringTellsPixelsAndMillimetresOnTheSurface_ANewCaseIsShownWhole) {
  ASSERT_TRUE(wait([&] { return !panel_.view().imageSize().isEmpty(); }));
  MeasureTool& tool = panel_.measure();
  tool.setActive(true);
  const auto drag = [this](const QPointF& from, const QPointF& to) {
    Q_EMIT panel_.view().toolPressed(from);
    Q_EMIT panel_.view().toolMoved(to);
  };
  const auto& value = *state_.currentCase();
  const QPointF centre(0.5 * value.image.width, 0.5 * value.image.height);
  drag(centre, centre + QPointF(30.0, 40.0));
  EXPECT_TRUE(tool.text().startsWith(QStringLiteral("50.0 px, "))) << tool.text().toStdString();
  EXPECT_TRUE(tool.text().endsWith(QStringLiteral(" mm")));
  drag({1.0, 1.0}, {4.0, 5.0});
  EXPECT_EQ(tool.text(), QStringLiteral("5.0 px"));

  tool.setActive(false);
  panel_.view().centreOn({10.0, 10.0}, 7.0);
  state_.setCase(test::loadedExample("bc"));
  ASSERT_TRUE(wait([&] { return !tasks_.isBusy(); }));
  ViewTransform whole;
  whole.fit(panel_.view().imageSize(), panel_.view().size());
  EXPECT_EQ(panel_.view().transform(), whole);
}

TEST_F(ImagePanelTest, APlaceOfTheSceneIsMarkedWhereItProjects) {
  const auto& value = *state_.currentCase();
  const Eigen::Vector3d place = matchedBounds(value.scene.view()).centre();
  panel_.showStationPlace(place);
  Eigen::Vector2d pixel;
  ASSERT_TRUE(project(value.source.camera, state_.shownPose() * place, pixel));
  EXPECT_EQ(panel_.view().linkedCursor(), QPointF(pixel.x(), pixel.y()));
  panel_.showStationPlace(std::nullopt);
  EXPECT_FALSE(panel_.view().linkedCursor());
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

TEST_F(LayersPanelTest, ABoxShowsAndHidesItsLayer_AndFollowsItsKey) {
  for (int i = 0; i < kLayerCount; ++i) {
    const auto id = static_cast<LayerId>(i);
    const bool before = image_.style(id).visible;
    ASSERT_NE(box(id), nullptr) << i;
    EXPECT_EQ(box(id)->isChecked(), before);
    QTest::mouseClick(box(id), Qt::LeftButton, Qt::NoModifier, QPoint(8, box(id)->height() / 2));
    EXPECT_EQ(image_.style(id).visible, !before) << i;
  }
  LayerStyle style = image_.style(LayerId::kTruthEdges);
  style.visible = !style.visible;
  style.opacity = 0.25;
  image_.setStyle(LayerId::kTruthEdges, style);
  EXPECT_EQ(box(LayerId::kTruthEdges)->isChecked(), style.visible);
  const auto sliders = panel_.findChildren<QSlider*>();
  EXPECT_GE(std::ranges::count(sliders, 25, &QSlider::value), 1);
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
      found += std::abs(image_.style(static_cast<LayerId>(i)).opacity - 0.01 * other) < 1e-12;
    EXPECT_EQ(found, 1);
    slider->setValue(99);
  }
}

TEST_F(LayersPanelTest, AShortListHidesTheOthersUntilAllAreAskedFor) {
  panel_.setShortList({LayerId::kMatches, LayerId::kSeedEdges});
  EXPECT_TRUE(box(LayerId::kSeedEdges)->isVisible());
  EXPECT_FALSE(box(LayerId::kTruthEdges)->isVisible());
  EXPECT_LT(box(LayerId::kMatches)->y(), box(LayerId::kSeedEdges)->y());
  EXPECT_EQ(image_.legend().layers(),
            (std::vector<LayerId>{LayerId::kMatches, LayerId::kSeedEdges}));
  panel_.showAll();
  EXPECT_TRUE(box(LayerId::kTruthEdges)->isVisible());
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
