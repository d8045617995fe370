// SPDX-License-Identifier: Apache-2.0
#include "decode/frame_intake.h"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/latest_mailbox.h"
#include "decode/frame_decoder.h"

namespace viewloom {
namespace {

struct Waiting {
  CollectedFrame collected;
  FrameTimes times;
  ReportFrame report;
};

}  // namespace

struct FrameIntake::State {
  State(FrameSink& to, const Clock& time, BytePool& buffers)
      : sink(to), clock(time), pool(buffers) {}

  FrameSink& sink;
  const Clock& clock;
  BytePool& pool;

  std::mutex mutex;
  std::condition_variable work;
  // A stream is here while a frame of it waits or is being decoded. It is then either in the queue
  // or in the hands of one thread, never both: that keeps its frames in order.
  std::unordered_map<std::string, LatestMailbox<Waiting>> streams;
  std::deque<std::string> queue;
  bool closed = false;
  std::vector<std::jthread> threads;  // last: they use what is above

  void decodeUntilClosed(FrameDecoder& decoder) {
    std::unique_lock lock(mutex);
    for (;;) {
      work.wait(lock, [this] { return closed || !queue.empty(); });
      if (queue.empty()) return;
      const std::string stream = std::move(queue.front());
      queue.pop_front();
      Waiting waiting = *streams.at(stream).take();
      lock.unlock();
      decodeOne(decoder, stream, std::move(waiting));
      lock.lock();
      if (streams.at(stream).empty()) {
        streams.erase(stream);
      } else {
        queue.push_back(stream);  // behind the others
        work.notify_one();
      }
    }
  }

  void decodeOne(FrameDecoder& decoder, const std::string& stream, Waiting waiting) {
    const uint64_t number = waiting.collected.format.number;
    absl::StatusOr<std::unique_ptr<Frame>> frame = decoder.decode(std::move(waiting.collected));
    if (!frame.ok()) {
      waiting.report({.number = number,
                      .outcome = FrameOutcome::kRefused,
                      .reason = std::string(frame.status().message())});
      return;
    }
    (*frame)->times = waiting.times;
    (*frame)->times.decoded_ns = clock.nowNs();
    sink.offerFrame(stream, *std::move(frame), std::move(waiting.report));
  }
};

FrameIntake::FrameIntake(FrameSink& sink, const Clock& clock, BytePool& pool,
                         FrameIntakeOptions options)
    : state_(std::make_unique<State>(sink, clock, pool)) {
  for (uint32_t i = 0; i < options.thread_count; ++i) {
    state_->threads.emplace_back(
        [state = state_.get(), decoder = std::make_unique<FrameDecoder>(pool)] {
          state->decodeUntilClosed(*decoder);
        });
  }
}

FrameIntake::~FrameIntake() {
  close();
}

void FrameIntake::offer(const std::string& stream, CollectedFrame frame, FrameTimes times,
                        ReportFrame report) {
  const uint64_t number = frame.format.number;
  std::unique_lock lock(state_->mutex);
  if (state_->closed) {
    lock.unlock();
    report({.number = number,
            .outcome = FrameOutcome::kRefused,
            .reason = "the server drains and takes no more frames"});
    return;
  }
  const auto [entry, idle] = state_->streams.try_emplace(stream);
  const std::optional<Waiting> replaced =
      entry->second.push({std::move(frame), times, std::move(report)});
  if (idle) {
    state_->queue.push_back(stream);
    state_->work.notify_one();
  }
  lock.unlock();
  if (replaced) {
    replaced->report(
        {.number = replaced->collected.format.number, .outcome = FrameOutcome::kReplaced});
  }
}

void FrameIntake::close() {
  std::vector<std::jthread> threads;
  {
    std::lock_guard lock(state_->mutex);
    state_->closed = true;
    threads.swap(state_->threads);
  }
  state_->work.notify_all();
}

}  // namespace viewloom
