// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_backdrop.h"

#include <algorithm>

#include "sessions/io/undistort.h"

namespace boresight::ui {
namespace {

QImage copyOf(const ImageView& image) {
  QImage gray(image.width, image.height, QImage::Format_Grayscale8);
  for (int y = 0; y < image.height; ++y) std::copy_n(image.row(y), image.width, gray.scanLine(y));
  return gray;
}

}  // namespace

void SceneBackdrop::clear() {
  gray_ = QImage();
  of_.reset();
}

void SceneBackdrop::order(const CasePtr& one) {
  if (!one || of_.lock() == one) return;
  of_ = one;
  if (one->source.camera.model == CameraModel::kPinhole) {
    gray_ = copyOf(one->image.view());
    return;
  }
  gray_ = QImage();
  runner_.start(
      QStringLiteral("backdrop"),
      [one](const std::stop_token&) {
        return copyOf(sessions::undistort(one->source.camera, one->image.view()).view());
      },
      [this, one](const QImage& gray) { take(one, gray); });
}

void SceneBackdrop::take(const CasePtr& one, const QImage& gray) {
  if (of_.lock() != one) return;
  gray_ = gray;
  Q_EMIT ready();
}

}  // namespace boresight::ui
