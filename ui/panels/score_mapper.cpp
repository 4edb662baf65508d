// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/score_mapper.h"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

namespace boresight::ui {
namespace {

constexpr std::size_t kMostKnown = 32;

}  // namespace

/// The thread that works; a newer request replaces the one it holds.
class ScoreMapper::Worker {
 public:
  explicit Worker(ScoreMapper& owner) : owner_(owner), thread_([this] { loop(); }) {}

  ~Worker() {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
      stop_.request_stop();
    }
    wake_.notify_all();
    thread_.join();
  }

  void order(std::uint64_t generation, const std::optional<Request>& request) {
    {
      const std::lock_guard lock(mutex_);
      stop_.request_stop();
      stop_ = std::stop_source();
      ordered_ = request;
      generation_ = generation;
    }
    wake_.notify_all();
  }

 private:
  void loop() {
    while (true) {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return quit_ || ordered_.has_value(); });
      if (quit_) return;
      const Request request = std::move(*ordered_);
      ordered_.reset();
      const std::uint64_t generation = generation_;
      const std::stop_token stop = stop_.get_token();
      lock.unlock();
      answer(request, generation, stop);
    }
  }

  void answer(const Request& request, std::uint64_t generation, const std::stop_token& stop) {
    auto map = sessions::scoreMap(*request.edges, *request.iteration, request.template_index, stop);
    if (stop.stop_requested()) return;
    const MapPtr made =
        map ? std::make_shared<const sessions::ScoreMap>(std::move(*map)) : MapPtr();
    // In the owner's thread; dropped when the owner is gone.
    QMetaObject::invokeMethod(
        &owner_, [this, generation, request, made] { owner_.take(generation, request, made); },
        Qt::QueuedConnection);
  }

  ScoreMapper& owner_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool quit_ = false;
  std::optional<Request> ordered_;
  std::uint64_t generation_ = 0;
  std::stop_source stop_;
  std::thread thread_;  ///< last: it starts when everything above is there
};

ScoreMapper::ScoreMapper(QObject* parent)
    : QObject(parent), worker_(std::make_unique<Worker>(*this)) {}

ScoreMapper::~ScoreMapper() = default;

ScoreMapper::MapPtr ScoreMapper::request(const Request& request) {
  cancel();
  for (const Known& one : known_)
    if (one.request == request) return one.map;
  if (request.edges && request.iteration) worker_->order(generation_, request);
  return nullptr;
}

void ScoreMapper::cancel() {
  ++generation_;
  worker_->order(generation_, std::nullopt);
}

void ScoreMapper::take(std::uint64_t generation, const Request& request, const MapPtr& map) {
  if (generation != generation_) return;
  if (map) known_.push_front({request, map});
  if (known_.size() > kMostKnown) known_.pop_back();
  Q_EMIT ready(map);
}

}  // namespace boresight::ui
