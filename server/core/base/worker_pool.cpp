// SPDX-License-Identifier: Apache-2.0
#include "base/worker_pool.h"

#include <utility>

#include "base/processor_count.h"
#include "base/thread_name.h"
#include "base/thread_time.h"

namespace viewloom {
namespace {

thread_local int64_t help_of_thread_ns = 0;

}  // namespace

WorkerPool::WorkerPool(uint32_t worker_count) {
  const uint32_t wanted = worker_count > 0 ? worker_count : processorCount();
  for (uint32_t worker = 1; worker < wanted; ++worker) {
    threads_.emplace_back([this, worker](const std::stop_token& stop) {
      nameThread("worker");
      run(stop, worker);
    });
  }
}

WorkerPool::~WorkerPool() {
  for (std::jthread& thread : threads_) thread.request_stop();
  begun_.notify_all();
}

void WorkerPool::forEach(uint32_t count, const Piece& piece) {
  // Ends also where a piece throws.
  struct Turn {
    explicit Turn(WorkerPool& its_pool) : pool(its_pool) { pool.waitForTurn(); }
    ~Turn() { pool.endTurn(); }
    WorkerPool& pool;
  };
  for (uint32_t first = 0; first < count;) {
    const Turn turn(*this);
    first = takeTurn(first, count, piece);
  }
}

int64_t WorkerPool::helpNs() {
  return help_of_thread_ns;
}

void WorkerPool::waitForTurn() {
  std::unique_lock lock(turn_mutex_);
  const uint64_t ticket = ++last_ticket_;
  ++waiting_count_;
  turned_.wait(lock, [&] { return served_ticket_ == ticket; });
  --waiting_count_;
}

void WorkerPool::endTurn() {
  const std::lock_guard lock(turn_mutex_);
  ++served_ticket_;
  turned_.notify_all();
}

bool WorkerPool::isOver() const {
  return waiting_count_ > 0 && std::chrono::steady_clock::now() >= turn_end_;
}

uint32_t WorkerPool::takeTurn(uint32_t first, uint32_t count, const Piece& piece) {
  turn_end_ = std::chrono::steady_clock::now() + kTurn;
  {
    const std::lock_guard lock(mutex_);
    piece_ = &piece;
    count_ = count;
    next_ = first;
    ++task_number_;
    busy_count_ = uint32_t(threads_.size());
  }
  begun_.notify_all();
  takePieces(0);
  std::unique_lock lock(mutex_);
  ended_.wait(lock, [this] { return busy_count_ == 0; });
  help_of_thread_ns += std::exchange(help_ns_, 0);
  if (const std::exception_ptr failure = std::exchange(failure_, nullptr)) {
    std::rethrow_exception(failure);
  }
  return next_;
}

void WorkerPool::takePieces(uint32_t worker) {
  try {
    do {
      const uint32_t index = next_++;
      if (index >= count_) return;
      (*piece_)(index, worker);
    } while (!isOver());
  } catch (...) {
    noteFailure();
  }
}

void WorkerPool::noteFailure() {
  next_ = count_;
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = std::current_exception();
}

void WorkerPool::run(const std::stop_token& stop, uint32_t worker) {
  uint64_t last_task = 0;
  std::unique_lock lock(mutex_);
  while (begun_.wait(lock, stop, [&] { return task_number_ != last_task; })) {
    last_task = task_number_;
    lock.unlock();
    const int64_t begun_ns = threadTimeNs();
    takePieces(worker);
    const int64_t worked_ns = threadTimeNs() - begun_ns;
    lock.lock();
    help_ns_ += worked_ns;
    if (--busy_count_ == 0) ended_.notify_one();
  }
}

}  // namespace viewloom
