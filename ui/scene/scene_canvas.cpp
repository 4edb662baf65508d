// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_canvas.h"

#include <QVTKOpenGLNativeWidget.h>
#include <QtWidgets>

namespace boresight::ui {
namespace {

/// What a trial context says of itself; empty when none can be had.
QString rendererName() {
  QOpenGLContext context;
  context.setFormat(QSurfaceFormat::defaultFormat());
  if (!context.create()) return {};
  QOffscreenSurface surface;
  surface.setFormat(context.format());
  surface.create();
  if (!surface.isValid() || !context.makeCurrent(&surface)) return {};
  const QSurfaceFormat format = context.format();
  const auto* name = reinterpret_cast<const char*>(context.functions()->glGetString(GL_RENDERER));
  const QString renderer = QString::fromUtf8(name != nullptr ? name : "unknown");
  context.doneCurrent();
  const bool enough =
      format.renderableType() != QSurfaceFormat::OpenGLES && format.version() >= qMakePair(3, 2);
  return enough ? renderer : QString();
}

/// Of the one trial that is made.
const QString& triedRenderer() {
  static const QString name = rendererName();
  return name;
}

}  // namespace

void prepareSceneSurface() {
  QSurfaceFormat::setDefaultFormat(QVTKOpenGLNativeWidget::defaultFormat());
}

SceneBackend decideSceneBackend(const QString& platform, const QString& wish,
                                const std::function<bool()>& context_works) {
  if (wish == QLatin1String("picture")) return SceneBackend::kPicture;
  static const QStringList kPlatforms = {QStringLiteral("xcb"), QStringLiteral("windows"),
                                         QStringLiteral("cocoa")};
  if (!kPlatforms.contains(platform)) return SceneBackend::kPicture;
  return context_works() ? SceneBackend::kVtk : SceneBackend::kPicture;
}

SceneBackend sceneBackend() {
  static const SceneBackend decided =
      decideSceneBackend(QGuiApplication::platformName(), qEnvironmentVariable("BORESIGHT_SCENE"),
                         [] { return !triedRenderer().isEmpty(); });
  return decided;
}

bool sceneIsDrawnInSoftware() {
  if (sceneBackend() != SceneBackend::kVtk) return true;
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader"})
    if (triedRenderer().contains(QLatin1String(name), Qt::CaseInsensitive)) return true;
  return false;
}

}  // namespace boresight::ui
