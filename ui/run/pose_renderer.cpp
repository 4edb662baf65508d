// SPDX-License-Identifier: Apache-2.0
#include "ui/run/pose_renderer.h"

#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include "sessions/trace/scene_render.h"

namespace boresight::ui {

/// The thread that draws. It holds one order at a time; a newer one replaces it.
class PoseRenderer::Worker {
 public:
  struct Order {
    std::shared_ptr<const LoadedCase> one;
    Pose camera_from_station;
    int level = 0;
    std::uint64_t generation = 0;
  };

  explicit Worker(PoseRenderer& owner) : owner_(owner), thread_([this] { loop(); }) {}

  ~Worker() {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
      newer_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }

  void put(Order order) {
    {
      const std::lock_guard lock(mutex_);
      order_ = std::move(order);
      newer_ = true;
    }
    wake_.notify_all();
  }

  void drop() {
    const std::lock_guard lock(mutex_);
    order_.reset();
    newer_ = true;
  }

 private:
  void loop() {
    while (waitForOrder()) {
      try {
        draw();
      } catch (const std::bad_alloc&) {
        renderers_ = {};
        post(tr("There is not enough memory to draw this pose; close other sessions."));
      }
    }
  }

  /// False when it is time to go.
  bool waitForOrder() {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return quit_ || order_.has_value(); });
    if (quit_) return false;
    const bool other_case = working_.one != order_->one;
    if (other_case) renderers_ = {};  // before the mesh that they look at
    working_ = std::move(*order_);
    order_.reset();
    newer_ = false;
    return true;
  }

  /// Full resolution gives way to whatever is newer. Half resolution is finished: if it gave way
  /// too, somebody who moves fast would see nothing.
  bool givesWay() const { return newer_ && working_.level == 0; }

  void draw() {
    auto& renderer = renderers_[static_cast<std::size_t>(working_.level)];
    Status status = Status::kOk;
    if (!renderer) {
      renderer.emplace();
      status = renderer->create(cameraAtLevel(working_.one->camera, working_.level),
                                working_.one->scene.view());
      if (status != Status::kOk) renderer.reset();
    }
    if (status == Status::kOk) status = renderer->begin(working_.camera_from_station);
    bool done = false;
    while (status == Status::kOk && !done) {
      if (givesWay()) return;
      status = renderer->step(done);
    }
    if (status == Status::kOk)
      post(std::make_shared<const sessions::RenderTrace>(renderer->record()));
    else
      post(tr("The edges of this pose cannot be drawn: %1.")
               .arg(QString::fromUtf8(statusText(status))));
  }

  void post(RenderPtr render) {
    const auto generation = working_.generation;
    const int level = working_.level;
    QMetaObject::invokeMethod(
        &owner_,
        [this, generation, level, render = std::move(render)] {
          owner_.take(generation, render, level);
        },
        Qt::QueuedConnection);
  }

  void post(const QString& message) {
    const auto generation = working_.generation;
    QMetaObject::invokeMethod(
        &owner_, [this, generation, message] { owner_.takeFailure(generation, message); },
        Qt::QueuedConnection);
  }

  PoseRenderer& owner_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool quit_ = false;
  std::optional<Order> order_;
  std::atomic<bool> newer_ = false;

  // The thread's own:
  Order working_;
  std::array<std::optional<sessions::SceneRenderer>, kMovingLevel + 1> renderers_;  ///< by level

  std::thread thread_;  ///< last: it starts when everything above is there
};

PoseRenderer::PoseRenderer(QObject* parent)
    : QObject(parent), worker_(std::make_unique<Worker>(*this)) {
  rest_.setSingleShot(true);
  rest_.setInterval(kRest_ms);
  connect(&rest_, &QTimer::timeout, this, [this] { order(0); });
}

PoseRenderer::~PoseRenderer() = default;

void PoseRenderer::setCase(std::shared_ptr<const LoadedCase> one) {
  clear();
  case_ = std::move(one);
}

void PoseRenderer::setPose(const Pose& camera_from_station) {
  if (!case_) return;
  camera_from_station_ = camera_from_station;
  order(kMovingLevel);
  rest_.start();
}

void PoseRenderer::clear() {
  rest_.stop();
  ++generation_;
  worker_->drop();
}

void PoseRenderer::order(int level) {
  worker_->put({case_, camera_from_station_, level, generation_});
}

void PoseRenderer::take(std::uint64_t generation, const RenderPtr& render, int level) {
  if (generation == generation_) Q_EMIT rendered(render, level);
}

void PoseRenderer::takeFailure(std::uint64_t generation, const QString& message) {
  if (generation == generation_) Q_EMIT failed(message);
}

}  // namespace boresight::ui
