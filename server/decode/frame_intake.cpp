// SPDX-License-Identifier: Apache-2.0
#include "decode/frame_intake.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "admission/frame_price.h"
#include "admission/out_of_memory.h"
#include "admission/request_boundary.h"
#include "base/latest_mailbox.h"
#include "base/log.h"
#include "base/rare_log.h"
#include "base/thread_name.h"
#include "base/thread_time.h"
#include "decode/frame_decoder.h"
#include "decode/open_frame.h"
#include "decode/stream_queue.h"

namespace viewloom {
namespace {

// A thread whose work was ended by an exception tries again after it: memory comes back with time.
// It does not wait for work meanwhile: it would take the wake-up of a thread that can decode.
constexpr std::chrono::milliseconds kRetryPause{50};
constexpr std::chrono::seconds kLogPause{1};

void reportRefused(const ReportFrame& report, uint64_t number, const absl::Status& status) {
  report({.number = number,
          .outcome = FrameOutcome::kRefused,
          .reason = std::string(status.message())});
}

// Gives its memory back to the budget once it is gone.
FramePtr heldFrame(std::unique_ptr<Frame> frame, Reservation memory) {
  const auto held = std::make_shared<Reservation>(std::move(memory));
  return {frame.release(), [held](const Frame* gone) { delete gone; }};
}

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
  StreamQueue queue;
  std::deque<std::shared_ptr<OpenFrame>> open_frames;  // those with a plane nobody has claimed
  size_t large_count = 0;      // planes of large frames in the hands of threads
  size_t large_count_max = 1;  // threads that may have them
  bool closed = false;
  RareLog rare_log{kLogPause};
  std::vector<std::jthread> threads;  // last: they use what is above

  // An exception beside the frames themselves costs a stream its turn.
  void decode(PlaneDecoder& decoder) {
    for (bool is_open = true; is_open;) {
      try {
        decodeUntilClosed(decoder);
        is_open = false;
      } catch (const std::bad_alloc&) {
        noteNoMemory();
        std::this_thread::sleep_for(kRetryPause);
      } catch (const std::exception& thrown) {
        noteThrown("decoding", thrown);
        std::this_thread::sleep_for(kRetryPause);
      }
    }
  }

  void noteNoMemory() noexcept {
    try {
      const auto line = rare_log.take("no memory is left to decode; trying again", wallTimeNs());
      if (line) log(LogLevel::kWarning, *line);
    } catch (const std::exception&) {
      // No memory to say it.
    }
  }

  void decodeUntilClosed(PlaneDecoder& decoder) {
    std::unique_lock lock(mutex);
    for (;;) {
      std::shared_ptr<OpenFrame> open;
      work.wait(lock, [&] {
        open = next(lock);
        return open || (closed && queue.empty() && open_frames.empty());
      });
      if (!open) return;
      const size_t plane = open->claimed_count++;
      if (open->claimed_count == open->planes.size()) std::erase(open_frames, open);
      large_count += open->is_large;
      lock.unlock();
      const int64_t begun_ns = threadTimeNs();
      open->decoded[plane] = unlessThrown([&] {
        if (plane == 0) open->frame.on_taken();
        return decoder.decode(*open->planes[plane], std::move(open->frame.collected.planes[plane]));
      });
      lock.lock();
      open->spent_ns += threadTimeNs() - begun_ns;
      large_count -= open->is_large;
      if (open->is_large) work.notify_one();
      if (--open->unfinished_count > 0) continue;
      lock.unlock();
      deliverOrTell(*open);
      lock.lock();
      finish(open->origin);
    }
  }

  // A frame with a plane to decode; nullptr = there is none for now.
  std::shared_ptr<OpenFrame> next(std::unique_lock<std::mutex>& lock) {
    do {
      for (const std::shared_ptr<OpenFrame>& open : open_frames) {
        if (!open->is_large || large_count < large_count_max) return open;
      }
    } while (openNextFrame(lock));
    return nullptr;
  }

  // False: no stream has a frame that is wanted.
  bool openNextFrame(std::unique_lock<std::mutex>& lock) {
    const std::optional<FrameOrigin> next_wanted =
        closed ? queue.takeNext(sink) : queue.takeWanted(sink);
    if (!next_wanted) return false;
    WaitingFrame waiting = *streams.at(next_wanted->stream).take();
    try {
      const auto open = std::make_shared<OpenFrame>(*next_wanted, waiting.collected.format);
      open_frames.push_back(open);
      open->begin(std::move(waiting));
    } catch (const std::bad_alloc&) {
      lock.unlock();
      reportRefused(waiting.report, waiting.collected.format.number, outOfMemory());
      waiting.on_taken();
      sink.noteLost(next_wanted->stream);
      lock.lock();
      finish(*next_wanted);
    }
    work.notify_all();  // its other planes are for others
    return true;
  }

  void finish(const FrameOrigin& origin) {
    if (streams.at(origin.stream).empty()) {
      streams.erase(origin.stream);
    } else {
      queue.push(origin);  // behind the others
      work.notify_one();
    }
  }

  absl::StatusOr<FramePtr> join(OpenFrame& open) {
    CollectedFrame& collected = open.frame.collected;
    const uint64_t decoded_bytes = framePrice(collected.format).decoded_bytes;
    absl::StatusOr<std::unique_ptr<Frame>> frame =
        joinPlanes(std::move(collected.format), std::move(open.decoded), pool);
    if (!frame.ok()) return frame.status();
    (*frame)->times = open.frame.times;
    (*frame)->times.decoded_ns = clock.nowNs();
    (*frame)->publisher = std::move(collected.publisher);
    collected.memory.shrinkTo(decoded_bytes);
    return heldFrame(*std::move(frame), std::move(collected.memory));
  }

  // The stream goes on also where nobody could take its frame.
  void deliverOrTell(OpenFrame& open) {
    try {
      deliver(open);
    } catch (const std::exception& thrown) {
      noteThrown("handing over a frame", thrown);
      sink.noteLost(open.origin.stream);
    }
  }

  void deliver(OpenFrame& open) {
    WaitingFrame& waiting = open.frame;
    const uint64_t number = waiting.collected.format.number;
    const FrameOrigin origin = {open.origin.stream, waiting.collected.session,
                                Payer(waiting.collected.publisher)};
    sink.noteDecoded(origin, open.spent_ns);
    absl::StatusOr<FramePtr> frame = unlessThrown([&] { return join(open); });
    if (!frame.ok()) {
      reportRefused(waiting.report, number, frame.status());
      return sink.noteLost(origin.stream);
    }
    sink.offerFrame(origin, *std::move(frame), std::move(waiting.report));
  }
};

FrameIntake::FrameIntake(FrameSink& sink, const Clock& clock, BytePool& pool,
                         FrameIntakeOptions options)
    : state_(std::make_unique<State>(sink, clock, pool, std::move(options.on_replaced))) {
  state_->large_count_max = std::max(options.thread_count, 2U) - 1;
  for (uint32_t i = 0; i < options.thread_count; ++i) {
    state_->threads.emplace_back(
        [state = state_.get(), decoder = std::make_unique<PlaneDecoder>(pool)] {
          nameThread("decode");
          state->decode(*decoder);
        });
  }
}

FrameIntake::~FrameIntake() {
  close();
}

void FrameIntake::offer(const std::string& stream, CollectedFrame frame, FrameTimes times,
                        ReportFrame report, std::function<void()> on_taken) {
  const uint64_t number = frame.format.number;
  std::unique_lock lock(state_->mutex);
  if (state_->closed) {
    lock.unlock();
    report({.number = number,
            .outcome = FrameOutcome::kRefused,
            .reason = "the server is shutting down and takes no more frames"});
    on_taken();
    return;
  }
  const auto [entry, idle] = state_->streams.try_emplace(stream);
  if (idle) state_->queue.push({stream, frame.session, Payer(frame.publisher)});
  const std::optional<WaitingFrame> replaced =
      entry->second.push({std::move(frame), times, std::move(report), std::move(on_taken)});
  state_->work.notify_one();
  lock.unlock();
  if (replaced) {
    state_->on_replaced();
    replaced->on_taken();
    replaced->report(
        {.number = replaced->collected.format.number, .outcome = FrameOutcome::kReplaced});
  }
}

void FrameIntake::resume(const std::string& stream) {
  std::lock_guard lock(state_->mutex);
  if (state_->queue.allow(stream)) state_->work.notify_one();
}

bool FrameIntake::forget(const std::string& stream) {
  std::unique_lock lock(state_->mutex);
  const auto found = state_->streams.find(stream);
  if (found == state_->streams.end()) return true;
  if (!state_->queue.drop(stream)) return false;  // a frame of it is open
  const std::optional<WaitingFrame> dropped = found->second.take();
  state_->streams.erase(found);
  lock.unlock();
  dropped->on_taken();
  reportRefused(dropped->report, dropped->collected.format.number,
                absl::UnavailableError("its publisher has left, and the stream was dropped to make "
                                       "room for others; publish it again"));
  return true;
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
