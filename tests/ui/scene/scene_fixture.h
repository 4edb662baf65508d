// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include <QImage>

#include "sessions/trace/scene_render.h"
#include "tests/support/example_run.h"
#include "tests/support/loaded_example.h"
#include "tests/ui/pixels.h"
#include "ui/scene/scene_content.h"
#include "ui/scene/viewpoint.h"
#include "ui/state/view_state.h"

namespace boresight::test {

/// The example station whose run exampleRun() is, made once per program.
inline const std::shared_ptr<const sessions::LoadedCase>& sceneCase() {
  static const auto result = loadedExample("os");
  return result;
}

/// A view state with the case and its finished run, at the last iteration that has templates.
inline void showRun(ui::ViewState& state) {
  state.setCase(sceneCase());
  state.setSnapshot(exampleRun());
  int i = static_cast<int>(exampleRun()->iterations.size()) - 1;
  while (i > 0 && exampleRun()->iterations[static_cast<std::size_t>(i)]->templates.empty()) --i;
  state.setCursor({i, Stage::kFinished});
}

/// Number of pixels whose channels differ from a colour's by at most so much.
inline int pixelsLike(const QImage& picture, const QColor& color, int tolerance) {
  return countPixels(picture.size(), [&](int x, int y) {
    const QRgb pixel = picture.pixel(x, y);
    return std::abs(qRed(pixel) - color.red()) <= tolerance &&
           std::abs(qGreen(pixel) - color.green()) <= tolerance &&
           std::abs(qBlue(pixel) - color.blue()) <= tolerance;
  });
}

/// The face that the core renders at each pixel of a view, or -1.
inline std::vector<std::int32_t> renderedFaces(const ui::SceneContent& content,
                                               const ui::Viewpoint& view) {
  std::vector<std::int32_t> face(static_cast<std::size_t>(view.camera.width * view.camera.height));
  SurfaceRender wanted;
  wanted.face = face;
  sessions::RenderTrace render;
  EXPECT_EQ(
      sessions::renderScene(view.camera, content.mesh(), view.view_from_station, render, wanted),
      Status::kOk);
  return face;
}

}  // namespace boresight::test
