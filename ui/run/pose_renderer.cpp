// SPDX-License-Identifier: Apache-2.0
#include "ui/run/pose_renderer.h"

#include <array>
#include <optional>
#include <utility>

#include "sessions/trace/scene_render.h"

namespace boresight::ui {

struct PoseRenderer::Drawn {
  RenderPtr render;  ///< nullptr: `problem` says why, or it was stopped
  int level = 0;
  QString problem;
};

/// Of one case. The worker's own but for the case.
struct PoseRenderer::Renderers {
  std::shared_ptr<const sessions::LoadedCase> one;
  std::array<std::optional<sessions::SceneRenderer>, kMovingLevel + 1> by_level;

  Drawn draw(const Pose& camera_from_station, int level, const std::stop_token& stop) {
    Drawn drawn;
    drawn.level = level;
    auto& renderer = by_level[static_cast<std::size_t>(level)];
    Status status = Status::kOk;
    if (!renderer)
      status =
          renderer.emplace().create(cameraAtLevel(one->source.camera, level), one->scene.view());
    if (status == Status::kOk)
      status = renderer->begin(camera_from_station);
    else
      renderer.reset();
    for (bool done = false; status == Status::kOk && !done;) {
      if (stop.stop_requested()) return drawn;
      status = renderer->step(done);
    }
    if (status == Status::kOk)
      drawn.render = std::make_shared<const sessions::RenderTrace>(renderer->record());
    else
      drawn.problem = tr("The edges of this pose cannot be drawn: %1.")
                          .arg(QString::fromUtf8(statusText(status)));
    return drawn;
  }
};

PoseRenderer::PoseRenderer(QObject* parent) : QObject(parent) {
  rest_.setSingleShot(true);
  rest_.setInterval(kRest_ms);
  connect(&rest_, &QTimer::timeout, this, [this] { draw(resting_, 0); });
}

void PoseRenderer::setCase(std::shared_ptr<const sessions::LoadedCase> loaded_case) {
  clear();
  renderers_.reset();
  if (!loaded_case) return;
  renderers_ = std::make_shared<Renderers>();
  renderers_->one = std::move(loaded_case);
}

void PoseRenderer::setPose(const Pose& camera_from_station) {
  if (!renderers_) return;
  camera_from_station_ = camera_from_station;
  runner_.cancel(resting_);
  rest_.start();
  // What is under way is finished first: an operator who moves fast would see nothing otherwise.
  if (drawing_)
    overtaken_ = true;
  else
    drawMoving();
}

void PoseRenderer::clear() {
  rest_.stop();
  runner_.cancel(moving_);
  runner_.cancel(resting_);
  drawing_ = false;
  overtaken_ = false;
}

void PoseRenderer::drawMoving() {
  drawing_ = true;
  overtaken_ = false;
  draw(moving_, kMovingLevel);
}

void PoseRenderer::draw(const TaskKind& kind, int level) {
  runner_.replace(
      kind,
      [renderers = renderers_, pose = camera_from_station_, level](const std::stop_token& stop) {
        return renderers->draw(pose, level, stop);
      },
      [this](const Drawn& drawn) { take(drawn); },
      [this](const QString& message) {
        setCase(renderers_ ? renderers_->one : nullptr);  // gives their memory back
        Q_EMIT failed(message);
      });
}

void PoseRenderer::take(const Drawn& drawn) {
  if (drawn.level == kMovingLevel) {
    drawing_ = false;
    if (overtaken_) drawMoving();
  }
  if (drawn.render)
    Q_EMIT rendered(drawn.render, drawn.level);
  else if (!drawn.problem.isEmpty())
    Q_EMIT failed(drawn.problem);
}

}  // namespace boresight::ui
