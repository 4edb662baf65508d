// SPDX-License-Identifier: Apache-2.0
#include "ui/views/layers_panel.h"

#include <gtest/gtest.h>

#include <QtTest>
#include <QtWidgets>

#include "ui/run/task_runner.h"
#include "ui/views/image_panel.h"

namespace boresight::ui {
namespace {

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

TEST_F(LayersPanelTest, FollowsWhatAKeyHasDone) {
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
