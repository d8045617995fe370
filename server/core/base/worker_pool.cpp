// SPDX-License-Identifier: Apache-2.0
#include "base/worker_pool.h"

#include <algorithm>
#include <utility>

#include "base/thread_name.h"

namespace viewloom {

WorkerPool::WorkerPool(uint32_t worker_count) {
  const uint32_t wanted =
      worker_count > 0 ? worker_count : std::max(1U, std::thread::hardware_concurrency());
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
  const std::lock_guard one_caller(task_mutex_);
  {
    const std::lock_guard lock(mutex_);
    piece_ = &piece;
    count_ = count;
    next_ = 0;
    ++task_number_;
    busy_count_ = uint32_t(threads_.size());
  }
  begun_.notify_all();
  takePieces(0);
  std::unique_lock lock(mutex_);
  ended_.wait(lock, [this] { return busy_count_ == 0; });
  if (const std::exception_ptr failure = std::exchange(failure_, nullptr)) {
    std::rethrow_exception(failure);
  }
}

void WorkerPool::takePieces(uint32_t worker) {
  try {
    for (uint32_t index = next_++; index < count_; index = next_++) (*piece_)(index, worker);
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
    takePieces(worker);
    lock.lock();
    if (--busy_count_ == 0) ended_.notify_one();
  }
}

}  // namespace viewloom
