// SPDX-License-Identifier: Apache-2.0
#include "decode/frame_intake.h"

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/latest_mailbox.h"
#include "base/thread_name.h"
#include "decode/frame_decoder.h"

namespace viewloom {
namespace {

struct WaitingFrame {
  CollectedFrame collected;
  FrameTimes times;
  ReportFrame report;
};

// A frame in the hands of the threads. Each plane is decoded by whoever claims it; what decoded[i]
// holds is seen by the thread that ends the last plane.
struct OpenFrame {
  OpenFrame(std::string name, WaitingFrame waiting)
      : stream(std::move(name)),
        frame(std::move(waiting)),
        planes(wirePlanes(frame.collected.format)),
        decoded(planes.size()),
        unfinished_count(planes.size()) {}

  const std::string stream;
  WaitingFrame frame;
  const std::vector<const PlaneFormat*> planes;
  DecodedPlanes decoded;
  size_t claimed_count = 0;  // guarded by the intake's mutex, as the next
  size_t unfinished_count;
};

}  // namespace

struct FrameIntake::State {
  State(FrameSink& to, const Clock& time, BytePool& buffers, std::function<void()> when_replaced)
      : sink(to), clock(time), pool(buffers), on_replaced(std::move(when_replaced)) {}

  FrameSink& sink;
  const Clock& clock;
  BytePool& pool;
  const std::function<void()> on_replaced;

  std::mutex mutex;
  std::condition_variable work;
  // A stream is here while a frame of it waits or is open. It is in the queue or has an open frame,
  // never both: that keeps its frames in order.
  std::unordered_map<std::string, LatestMailbox<WaitingFrame>> streams;
  std::deque<std::string> queue;
  std::deque<std::shared_ptr<OpenFrame>> open_frames;  // those with a plane nobody has claimed
  bool closed = false;
  std::vector<std::jthread> threads;  // last: they use what is above

  void decodeUntilClosed(PlaneDecoder& decoder) {
    std::unique_lock lock(mutex);
    for (;;) {
      work.wait(lock, [this] { return closed || !open_frames.empty() || !queue.empty(); });
      if (open_frames.empty()) {
        if (queue.empty()) return;
        openNextFrame();
      }
      const std::shared_ptr<OpenFrame> open = open_frames.front();
      const size_t plane = open->claimed_count++;
      if (open->claimed_count == open->planes.size()) open_frames.pop_front();
      lock.unlock();
      open->decoded[plane] =
          decoder.decode(*open->planes[plane], std::move(open->frame.collected.planes[plane]));
      lock.lock();
      if (--open->unfinished_count > 0) continue;
      lock.unlock();
      deliver(*open);
      lock.lock();
      finish(open->stream);
    }
  }

  void openNextFrame() {
    const std::string stream = std::move(queue.front());
    queue.pop_front();
    WaitingFrame waiting = *streams.at(stream).take();
    open_frames.push_back(std::make_shared<OpenFrame>(stream, std::move(waiting)));
    work.notify_all();  // its other planes are for others
  }

  void finish(const std::string& stream) {
    if (streams.at(stream).empty()) {
      streams.erase(stream);
    } else {
      queue.push_back(stream);  // behind the others
      work.notify_one();
    }
  }

  void deliver(OpenFrame& open) {
    WaitingFrame& waiting = open.frame;
    const uint64_t number = waiting.collected.format.number;
    const uint64_t session = waiting.collected.session;
    absl::StatusOr<std::unique_ptr<Frame>> frame =
        joinPlanes(std::move(waiting.collected.format), std::move(open.decoded), pool);
    if (!frame.ok()) {
      waiting.report({.number = number,
                      .outcome = FrameOutcome::kRefused,
                      .reason = std::string(frame.status().message())});
      return;
    }
    (*frame)->times = waiting.times;
    (*frame)->times.decoded_ns = clock.nowNs();
    sink.offerFrame({open.stream, session}, *std::move(frame), std::move(waiting.report));
  }
};

FrameIntake::FrameIntake(FrameSink& sink, const Clock& clock, BytePool& pool,
                         FrameIntakeOptions options)
    : state_(std::make_unique<State>(sink, clock, pool, std::move(options.on_replaced))) {
  for (uint32_t i = 0; i < options.thread_count; ++i) {
    state_->threads.emplace_back(
        [state = state_.get(), decoder = std::make_unique<PlaneDecoder>(pool)] {
          nameThread("decode");
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
            .reason = "the server is shutting down and takes no more frames"});
    return;
  }
  const auto [entry, idle] = state_->streams.try_emplace(stream);
  const std::optional<WaitingFrame> replaced =
      entry->second.push({std::move(frame), times, std::move(report)});
  if (idle) {
    state_->queue.push_back(stream);
    state_->work.notify_one();
  }
  lock.unlock();
  if (replaced) {
    state_->on_replaced();
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
