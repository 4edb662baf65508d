// SPDX-License-Identifier: Apache-2.0
// An annotator at the image: real events on the view, at any zoom and screen scaling.
#pragma once

#include <cmath>

#include "tests/ui/annotation/annotation_fixture.h"
#include "tests/ui/annotation/image_pointer.h"
#include "ui/annotation/image_annotation.h"
#include "ui/annotation/loupe.h"
#include "ui/annotation/mark_tool.h"
#include "ui/annotation/station_snapper.h"
#include "ui/run/task_runner.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"

namespace boresight::ui {

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
    ASSERT_TRUE(QTest::qWaitFor([this] { return snapper_.mesh() != nullptr; }, kPatience_ms));
    ASSERT_TRUE(QTest::qWaitFor([this] { return !tasks_.isBusy(); }, kPatience_ms));
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
  MarkTool& tool() { return annotation_.tool(); }
  const sessions::Marks& marks() const { return controller_.marks(); }

  TaskRunner tasks_;
  ImagePanel panel_{state_, tasks_};
  StationSnapper snapper_{state_};
  ImageAnnotation annotation_{panel_, controller_, state_, snapper_};
  QString told_;
};

}  // namespace boresight::ui
