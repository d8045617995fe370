// SPDX-License-Identifier: Apache-2.0
#include "bench/stream_ways.h"

#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/bare_stream.h"
#include "lib/channel.h"
#include "lib/publisher.h"
#include "lib/watcher.h"

namespace viewloom::bench {
namespace {

constexpr int64_t kPatience_ns = 600'000'000'000;

class Copies final : public Way {
 public:
  explicit Copies(const WireFrame& frame) : frame_(frame), copy_(byteCount(frame)) {}

  void send(int frame_count) override {
    for (int i = 0; i < frame_count; ++i) {
      size_t offset = 0;
      for (const SharedBytes& plane : frame_.planes) {
        std::memcpy(copy_.data() + offset, plane->data(), plane->size());
        offset += plane->size();
      }
    }
  }

 private:
  const WireFrame& frame_;
  std::vector<uint8_t> copy_;
};

class MeasuredWay : public Way {
 public:
  explicit MeasuredWay(const MeasuredProcess& there) : there_(there) {}
  double thereCpuTime_s() const final { return there_.cpuTime_s(); }

 private:
  const MeasuredProcess& there_;
};

class BareSending final : public MeasuredWay {
 public:
  BareSending(const WireFrame& frame, const MeasuredProcess& there)
      : MeasuredWay(there), frame_(frame), sender_(makeChannel(there.address())) {}

  // The same order as Published: the answer to a frame is awaited once the next has gone.
  void send(int frame_count) override {
    for (int i = 0; i < frame_count; ++i) {
      sender_.send(frame_.planes);
      if (i > 0) sender_.awaitAnswer();
    }
    sender_.awaitAnswer();
  }

 private:
  const WireFrame& frame_;
  BareSender sender_;
};

// Two frames are under way at most: one comes in while the one before is decoded. Where the decoder
// is late, a frame takes the place of another, and one more is sent: the same number is decoded.
class Published final : public MeasuredWay {
 public:
  Published(const WireFrame& frame, const MeasuredProcess& there)
      : MeasuredWay(there),
        frame_(frame),
        publisher_(makeChannel(there.address()),
                   {.stream = "noise", .in_flight_max = 2, .backoff = {}},
                   {.on_accepted = {},
                    .on_report = [this](const v1::FrameReport& report) { note(report); },
                    .on_wanted = {},
                    .on_connection = {},
                    .on_sent = {}}) {}

  void send(int frame_count) override {
    {
      const std::lock_guard lock(mutex_);
      missing_count_ = frame_count;
    }
    while (awaitMissing()) {
      while (publisher_.isWaiting()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      publisher_.offer(frame_);
    }
  }

 private:
  // Waits until a frame is to be offered, and counts it as under way. False: all are decoded.
  bool awaitMissing() {
    std::unique_lock lock(mutex_);
    reported_.wait(lock, [&] { return missing_count_ > 0 || under_way_count_ == 0; });
    if (!failure_.empty()) throw std::runtime_error(failure_);
    if (missing_count_ == 0) return false;
    --missing_count_;
    ++under_way_count_;
    return true;
  }

  void note(const v1::FrameReport& report) {
    const std::lock_guard lock(mutex_);
    --under_way_count_;
    if (report.outcome() == v1::FRAME_OUTCOME_REFUSED) failure_ = report.reason();
    if (report.outcome() == v1::FRAME_OUTCOME_REPLACED) ++missing_count_;
    reported_.notify_all();
  }

  const WireFrame& frame_;
  std::mutex mutex_;
  std::condition_variable reported_;
  int missing_count_ = 0;    // frames not offered yet, of those to be decoded
  int under_way_count_ = 0;  // frames offered and not reported yet
  std::string failure_;
  Publisher publisher_;  // last: it calls back
};

class BareReceiving final : public MeasuredWay {
 public:
  BareReceiving(uint64_t atlas_bytes, const MeasuredProcess& there, BareReceiver::Take take)
      : MeasuredWay(there), receiver_(makeChannel(there.address()), atlas_bytes, std::move(take)) {}

  void send(int frame_count) override { receiver_.receive(frame_count); }

 private:
  BareReceiver receiver_;
};

class Watched final : public MeasuredWay {
 public:
  Watched(uint32_t width_px, uint32_t height_px, const MeasuredProcess& there)
      : MeasuredWay(there), channel_(makeChannel(there.address())) {
    open_.set_stream("noise");
    open_.set_wait_for_stream(true);
    open_.mutable_encoding()->set_color(v1::BAND_ENCODING_RAW);
    v1::QuiltDisplay& quilt = *open_.mutable_display()->mutable_quilt();
    quilt.set_columns(1);
    quilt.set_rows(1);
    quilt.mutable_size()->set_width(width_px);
    quilt.mutable_size()->set_height(height_px);
  }

  void send(int frame_count) override {
    open_.set_count(static_cast<uint32_t>(frame_count));
    Watcher watcher(channel_, open_, {});
    const bool has_ended = watcher.waitEnded(kPatience_ns);
    const absl::Status status =
        has_ended ? *watcher.ended() : absl::DeadlineExceededError("no atlases came");
    if (!status.ok()) throw std::runtime_error(status.ToString());
  }

 private:
  const std::shared_ptr<grpc::Channel> channel_;
  v1::OpenDisplay open_;
};

}  // namespace

uint64_t byteCount(const WireFrame& frame) {
  uint64_t count = 0;
  for (const SharedBytes& plane : frame.planes) count += plane->size();
  return count;
}

std::unique_ptr<Way> copyWay(const WireFrame& frame) {
  return std::make_unique<Copies>(frame);
}

std::unique_ptr<Way> bareSendingWay(const WireFrame& frame, const MeasuredProcess& there) {
  return std::make_unique<BareSending>(frame, there);
}

std::unique_ptr<Way> publishingWay(const WireFrame& frame, const MeasuredProcess& there) {
  return std::make_unique<Published>(frame, there);
}

std::unique_ptr<Way> bareReceivingWay(uint64_t atlas_bytes, const MeasuredProcess& there) {
  return std::make_unique<BareReceiving>(atlas_bytes, there, [](const grpc::ByteBuffer&) {});
}

std::unique_ptr<Way> bareKeepingWay(uint64_t atlas_bytes, const MeasuredProcess& there) {
  const auto atlas = std::make_shared<KeptMessages>(atlas_bytes);
  return std::make_unique<BareReceiving>(atlas_bytes, there,
                                         [atlas](const grpc::ByteBuffer& message) {
                                           if (!atlas->add(message))
                                             throw std::runtime_error("a message cannot be read");
                                         });
}

std::unique_ptr<Way> watchingWay(uint32_t width_px, uint32_t height_px,
                                 const MeasuredProcess& there) {
  return std::make_unique<Watched>(width_px, height_px, there);
}

}  // namespace viewloom::bench
