// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace boresight::sessions {

/// Threads that share out independent pieces of work and sleep in between. The calling thread is
/// worker 0 and works, too.
class WorkerPool {
 public:
  /// Throws std::system_error when the system has no thread left.
  explicit WorkerPool(int workers);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int workers() const { return static_cast<int>(threads_.size()) + 1; }

  using Work = std::function<void(int piece, int worker)>;  ///< must not throw
  /// Calls `work` once for each of the pieces 0 ... pieces - 1, and returns when all calls have.
  /// The pieces are taken in order by whoever is free. After a stop no further piece is begun.
  void run(int pieces, const Work& work, const std::stop_token& stop = {});

 private:
  void serve(int worker, const std::stop_token& ended);
  void takePieces(int worker, std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable_any begun_;
  std::condition_variable done_;
  const Work* work_ = nullptr;  ///< while pieces are left
  std::stop_token stop_;
  int next_ = 0;
  int pieces_ = 0;
  int busy_ = 0;                       ///< calls that have not returned
  std::vector<std::jthread> threads_;  ///< last: they use the others
};

}  // namespace boresight::sessions
