// SPDX-License-Identifier: Apache-2.0
// Threads that share the pieces of a task with the calling thread.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace viewloom {

// A pool of workers. Thread-safety: forEach() may be called from any thread. Tasks of several
// callers take turns: each gets the workers for about kTurn, in the order in which they wait.
class WorkerPool {
 public:
  // Number of workers, including the caller of forEach(). 0 = processorCount().
  explicit WorkerPool(uint32_t worker_count = 0);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  uint32_t workerCount() const { return uint32_t(threads_.size()) + 1; }

  // Calls piece(index, worker) once for every index below `count`, and returns after all calls. A
  // worker has one piece at a time; its number is below workerCount(). Where a piece throws, those
  // that have not begun are left out, and the first exception goes on to the caller.
  using Piece = std::function<void(uint32_t index, uint32_t worker)>;
  void forEach(uint32_t count, const Piece& piece);

  // CPU time, ns, that workers have spent on pieces of the calling thread so far, in any pool.
  // Together with that thread's own (threadTimeNs) it is the cost of its tasks, however long they
  // have waited for their turns.
  static int64_t helpNs();

 private:
  static constexpr std::chrono::milliseconds kTurn{10};

  void run(const std::stop_token& stop, uint32_t worker);
  void takePieces(uint32_t worker);
  void noteFailure();
  void waitForTurn();
  void endTurn();
  // Does pieces from the first on. Returns the first that is left: others wait for their turn.
  uint32_t takeTurn(uint32_t first, uint32_t count, const Piece& piece);
  bool isOver() const;

  std::mutex turn_mutex_;  // guards the next three
  std::condition_variable turned_;
  uint64_t last_ticket_ = 0;
  uint64_t served_ticket_ = 1;               // whose turn it is
  std::atomic<uint32_t> waiting_count_ = 0;  // callers
  std::chrono::steady_clock::time_point turn_end_;
  std::mutex mutex_;  // guards what follows, but for next_
  std::condition_variable_any begun_;
  std::condition_variable ended_;
  const Piece* piece_ = nullptr;
  uint32_t count_ = 0;
  uint64_t task_number_ = 0;
  uint32_t busy_count_ = 0;
  int64_t help_ns_ = 0;  // of this turn, by workers that are done
  std::exception_ptr failure_;
  std::atomic<uint32_t> next_ = 0;
  std::vector<std::jthread> threads_;  // last: they use all of the above
};

}  // namespace viewloom
