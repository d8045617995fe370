// SPDX-License-Identifier: Apache-2.0
#include "pipeline/encode_queue.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <thread>
#include <utility>

#include "encode/band_encoder.h"

namespace viewloom {
namespace {

// To be woken takes a thread about as long, and it may be put on a core that is busy.
constexpr std::chrono::microseconds kLookout{100};

uint32_t rowsOfStrip(const EncodeTask& task) {
  const StripBatch& batch = *task.batch;
  return batch.run->strips.rowsOf(batch.work->shape.first_strip + task.index).row_count;
}

uint64_t packedPx(const AtlasRun& run, uint32_t row_count) {
  return uint64_t{run.picture->layout->size_px.width} * row_count;
}

}  // namespace

void EncodeQueue::push(StripBatchPtr batch) {
  std::lock_guard lock(mutex_);
  if (is_closed_ || batch->run->isGivenUp()) return;
  batches_.push_back(std::move(batch));
  noteFilled();
}

void EncodeQueue::pushFirst(StripBatchPtr batch) {
  std::lock_guard lock(mutex_);
  if (batch->run->isGivenUp()) return;
  batches_.insert(batches_.begin(), std::move(batch));
  noteFilled();
}

bool EncodeQueue::hasForOthersWithLess(const Claim& claim) {
  std::lock_guard lock(mutex_);
  dropGivenUp();
  const StripBatchPtr batch = next();
  return batch && shares_.hasHadLess(batch->run->claim, claim);
}

// Whoever takes something wakes the next thread for what is left, from where it runs itself. Woken
// all at once, two threads were put on one core of two in every fifth atlas, and stayed there for
// as long as it took.
std::optional<EncodeTask> EncodeQueue::pop() {
  std::unique_lock lock(mutex_);
  std::optional<EncodeTask> task;
  while (!(task = take())) {
    if (is_closed_ && batches_.empty()) {
      filled_.notify_all();  // what was left may have been given up
      return std::nullopt;
    }
    waitForMore(lock);
  }
  const bool is_more = next() != nullptr;
  const bool is_over = is_closed_ && batches_.empty();
  lock.unlock();
  if (is_over)
    filled_.notify_all();
  else if (is_more)
    filled_.notify_one();
  return task;
}

// Between two pieces, strips or answers it is often not for long.
void EncodeQueue::waitForMore(std::unique_lock<std::mutex>& lock) {
  const uint32_t seen_count = fill_count_;
  ++lookout_count_;
  lock.unlock();
  const auto end = std::chrono::steady_clock::now() + kLookout;
  while (fill_count_ == seen_count && std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
  }
  lock.lock();
  --lookout_count_;
  if (fill_count_ == seen_count) filled_.wait(lock);
}

// A thread that looks sees it, even if it is about to sleep.
void EncodeQueue::noteFilled() {
  ++fill_count_;
  if (lookout_count_ == 0) filled_.notify_one();
}

std::optional<EncodeTask> EncodeQueue::take() {
  dropGivenUp();
  StripBatchPtr batch = next();
  if (!batch) return std::nullopt;
  EncodeTask task{.batch = batch};
  if (batch->next_piece < batch->work->shape.piece_count) {
    task.index = batch->next_piece++;
    task.predicted_ns = batch->work->shape.piece_ns;
    const StripWorkShape& shape = batch->work->shape;
    const bool is_over = shape.strip_count == 0 && batch->next_piece == shape.piece_count;
    if (is_over) std::erase(batches_, batch);
  } else {
    takePack(task);
  }
  shares_.begin(batch->run->claim, task.predicted_ns);
  return task;
}

void EncodeQueue::takePack(EncodeTask& task) {
  StripBatch& batch = *task.batch;
  task.is_strip = true;
  task.index = batch.next_strip;
  task.pack = batch.next_pack;
  const uint32_t row_count = rowsOfStrip(task);
  if (batch.next_row == 0) batch.slice_row_count = sliceRowCount(task);
  task.slice_row_count = batch.slice_row_count;
  task.rows = {batch.next_row, std::min(task.slice_row_count, row_count - batch.next_row)};
  task.predicted_ns = predictPackNs(task, task.rows.row_count);
  batch.next_row += task.rows.row_count;
  if (batch.next_row < row_count) return;
  batch.next_row = 0;
  if (++batch.next_pack < batch.run->packs.size()) return;
  batch.next_pack = 0;
  if (++batch.next_strip == batch.work->shape.strip_count) std::erase(batches_, task.batch);
}

// Halves, so that slices are bands or shares of one.
uint32_t EncodeQueue::sliceRowCount(const EncodeTask& task) const {
  const AtlasRun& run = *task.batch->run;
  const PackedPlane& packed = run.packs[task.pack];
  const uint32_t least =
      leastSliceRowCount(run.outputs[packed.output].display->encoding, packed.plane);
  uint32_t row_count = std::bit_ceil(rowsOfStrip(task));
  while (row_count / 2 >= least && predictPackNs(task, row_count) > kPiece_ns) row_count /= 2;
  return row_count;
}

int64_t EncodeQueue::predictPackNs(const EncodeTask& task, uint32_t row_count) const {
  const AtlasRun& run = *task.batch->run;
  const PackedPlane& packed = run.packs[task.pack];
  return pack_costs_.predictNs(run.outputs[packed.output].display->encoding, packed.plane,
                               packedPx(run, row_count));
}

// Those that hold them do not wait for the last of their work.
void EncodeQueue::dropGivenUp() {
  std::erase_if(batches_, [](const StripBatchPtr& batch) { return batch->run->isGivenUp(); });
}

StripBatchPtr EncodeQueue::next() const {
  const StripBatchPtr* const next = shares_.next(batches_, [](const StripBatchPtr& batch) {
    return batch->hasPart() ? &batch->run->claim : nullptr;
  });
  return next == nullptr ? nullptr : *next;
}

void EncodeQueue::noteMade(StripBatch& batch) {
  std::lock_guard lock(mutex_);
  ++batch.made_count;
  const bool was_awaited = batch.made_count == 1 && batch.work->shape.begins_with_one;
  if (was_awaited || batch.made_count == batch.work->shape.piece_count) noteFilled();
}

void EncodeQueue::noteServed(const EncodeTask& task, int64_t duration_ns) {
  const AtlasRun& run = *task.batch->run;
  shares_.finish(run.claim, task.predicted_ns, duration_ns);
  if (!task.is_strip) {
    task.batch->work->notePiece(duration_ns);
    return;
  }
  const PackedPlane& packed = run.packs[task.pack];
  pack_costs_.note(run.outputs[packed.output].display->encoding, packed.plane,
                   packedPx(run, task.rows.row_count), duration_ns);
}

void EncodeQueue::close() {
  std::lock_guard lock(mutex_);
  is_closed_ = true;
  ++fill_count_;
  filled_.notify_all();
}

void EncodeQueue::clear() {
  std::vector<StripBatchPtr> batches;  // let go after the lock
  std::lock_guard lock(mutex_);
  batches.swap(batches_);
  ++fill_count_;
  filled_.notify_all();
}

}  // namespace viewloom
