// SPDX-License-Identifier: Apache-2.0
#include "lib/publisher.h"

#include <algorithm>
#include <chrono>
#include <random>
#include <utility>

#include "base/check.h"
#include "base/str_cat.h"
#include "lib/channel.h"
#include "lib/color_coder.h"
#include "lib/frame_messages.h"
#include "lib/server_clock.h"
#include "messages/wire_message.h"

namespace viewloom {
namespace {

PublisherOptions withSession(PublisherOptions options) {
  if (!options.session_id.empty()) return options;
  std::random_device random;  // 128 bits, not to be guessed
  for (int i = 0; i < 4; ++i) options.session_id += strCat(absl::Hex(random(), absl::kZeroPad8));
  return options;
}

}  // namespace

Publisher::Publisher(std::shared_ptr<grpc::Channel> channel, PublisherOptions options,
                     PublisherCallbacks callbacks)
    : options_(withSession(std::move(options))),
      callbacks_(std::move(callbacks)),
      channel_(std::move(channel)),
      color_coder_(options_.color_video ? std::make_unique<ColorCoder>(*options_.color_video)
                                        : nullptr) {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    RetryLoop loop(options_.backoff, callbacks_.on_connection);
    absl::Status status = loop.run(stop, [&] { return runCall(stop); });
    std::lock_guard lock(mutex_);
    ended_ = std::move(status);
    changed_.notify_all();
  });
}

Publisher::~Publisher() = default;

void Publisher::offer(WireFrame frame) {
  std::lock_guard lock(mutex_);
  VIEWLOOM_CHECK(!finishing_);
  frame.header.set_number(++last_number_);
  ++counts_.offered;
  counts_.replaced_here += waiting_.has_value();
  waiting_ = std::move(frame);
  changed_.notify_all();
}

bool Publisher::isWaiting() const {
  std::lock_guard lock(mutex_);
  return waiting_.has_value();
}

void Publisher::close() {
  std::lock_guard lock(mutex_);
  finishing_ = true;
  changed_.notify_all();
}

absl::Status Publisher::finish(int64_t timeout_ns) {
  close();
  const bool in_time = waitEnded(timeout_ns);
  thread_.request_stop();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return ended_.has_value(); });
  if (!in_time) return absl::DeadlineExceededError("the server did not report all frames in time");
  return *ended_;
}

std::optional<absl::Status> Publisher::ended() const {
  std::lock_guard lock(mutex_);
  return ended_;
}

bool Publisher::waitEnded(int64_t timeout_ns) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, std::chrono::nanoseconds(timeout_ns),
                           [&] { return ended_.has_value(); });
}

PublisherCounts Publisher::counts() const {
  std::lock_guard lock(mutex_);
  return counts_;
}

// Opens the call like the stub of the service. The stub takes no messages that are serialised.
std::unique_ptr<Publisher::Call> Publisher::openCall(grpc::ClientContext& context) const {
  constexpr const char* kMethod = "/viewloom.v1.IngestService/PublishFrames";
  const grpc::internal::RpcMethod method(kMethod, grpc::internal::RpcMethod::BIDI_STREAMING,
                                         channel_);
  using Factory =
      grpc::internal::ClientReaderWriterFactory<grpc::ByteBuffer, v1::PublishFramesResponse>;
  return std::unique_ptr<Call>(Factory::Create(channel_.get(), method, &context));
}

CallEnd Publisher::runCall(const std::stop_token& stop) {
  {
    std::lock_guard lock(mutex_);
    in_flight_.clear();
    answers_ended_ = false;
    was_connected_ = false;
    chunk_size_ = {};
    pace_.setRate(0);  // until the server says otherwise
    if (!waiting_) waiting_ = std::move(newest_sent_);
    newest_sent_.reset();
    // It may wait since a call before that found no server.
    const uint64_t number = waiting_ ? waiting_->header.number() : 0;
    again_ = number <= last_reported_ ? number : 0;
  }
  grpc::ClientContext context;
  const std::stop_callback cancel(stop, [&] { context.TryCancel(); });
  const std::unique_ptr<Call> call = openCall(context);
  v1::PublishFramesRequest request;
  request.mutable_settings()->set_stream(options_.stream);
  request.mutable_settings()->set_session_id(options_.session_id);
  request.mutable_settings()->set_sends_heartbeats(true);
  call->Write(bytesFromMessage(request));  // a failure shows in Finish
  SilenceWatch silence([&] { context.TryCancel(); });
  {
    const std::jthread reader([&] { readAnswers(*call, silence); });
    HeartbeatWriter writer(*call);
    sendFrames(writer, stop);
    writer.finish();
  }
  CallEnd end{statusFromGrpc(call->Finish()), false};
  if (!end.status.ok() && silence.hasFired()) end.status = silence.status();
  std::lock_guard lock(mutex_);
  end.was_connected = was_connected_;
  counts_.reconnects += was_connected_ && isPassing(end.status) && !stop.stop_requested();
  return end;
}

void Publisher::readAnswers(Call& call, SilenceWatch& silence) {
  v1::PublishFramesResponse answer;
  for (silence.listens(); call.Read(&answer); silence.listens()) {
    silence.hears();
    if (answer.has_heartbeat()) {
      silence.expectHeartbeats();
    } else {
      takeAnswer(answer);
    }
  }
  silence.hears();
  std::lock_guard lock(mutex_);
  answers_ended_ = true;
  changed_.notify_all();
}

void Publisher::takeAnswer(const v1::PublishFramesResponse& answer) {
  if (answer.has_accepted()) {
    {
      std::lock_guard lock(mutex_);
      was_connected_ = true;
      changed_.notify_all();
    }
    if (callbacks_.on_connection) callbacks_.on_connection({});
    if (callbacks_.on_accepted) callbacks_.on_accepted(answer.accepted());
  } else if (answer.has_report()) {
    noteReport(answer.report());
  } else if (answer.has_wanted()) {
    noteWanted(answer.wanted());
  }
}

void Publisher::noteWanted(const v1::Wanted& wanted) {
  {
    std::lock_guard lock(mutex_);
    pace_.setRate(wanted.rate_hz());
    changed_.notify_all();
  }
  if (callbacks_.on_wanted) callbacks_.on_wanted(wanted);
}

void Publisher::noteReport(const v1::FrameReport& report) {
  {
    std::lock_guard lock(mutex_);
    const auto sent = in_flight_.extract(report.number());
    if (!sent.empty() && report.number() != again_) count(report, sent.mapped());
    changed_.notify_all();
  }
  if (callbacks_.on_report) callbacks_.on_report(report);
}

// With mutex_ held.
void Publisher::count(const v1::FrameReport& report, uint64_t bytes) {
  const bool is_refused = report.outcome() == v1::FRAME_OUTCOME_REFUSED;
  last_reported_ = std::max(last_reported_, report.number());
  ++counts_.reported;
  counts_.refused += is_refused;
  counts_.replaced_there += report.outcome() == v1::FRAME_OUTCOME_REPLACED;
  if (is_refused) return;
  ++counts_.sent;
  counts_.sent_bytes += bytes;
}

std::optional<WireFrame> Publisher::waitForFrame(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  const auto isDue = [&] { return finishing_ || steadyNowNs() >= pace_.dueNs(); };
  const auto hasNext = [&] {
    if (answers_ended_) return true;
    if (!was_connected_) return false;
    if (waiting_) return in_flight_.size() < options_.in_flight_max;
    return finishing_ && in_flight_.empty();
  };
  changed_.wait(lock, stop, hasNext);
  while (waiting_ && !answers_ended_ && !stop.stop_requested() && !(isDue() && hasNext())) {
    const std::chrono::nanoseconds left(std::max<int64_t>(pace_.dueNs() - steadyNowNs(), 1));
    changed_.wait_for(lock, stop, left, [&] { return answers_ended_ || (isDue() && hasNext()); });
  }
  if (stop.stop_requested() || answers_ended_) return std::nullopt;
  pace_.note(steadyNowNs());
  return std::exchange(waiting_, std::nullopt);
}

void Publisher::sendFrames(HeartbeatWriter& writer, const std::stop_token& stop) {
  while (std::optional<WireFrame> frame = waitForFrame(stop)) {
    {
      std::lock_guard lock(mutex_);
      newest_sent_ = *frame;
    }
    if (color_coder_) color_coder_->code(*frame);
    const CompressedFrame compressed = compressFrame(
        *std::move(frame),
        {.zstd_level = options_.zstd_level, .predicts_depth = options_.predicts_depth});
    {
      uint64_t bytes = 0;
      for (const SharedBytes& plane : compressed.frame.planes) bytes += plane->size();
      std::lock_guard lock(mutex_);
      in_flight_[compressed.frame.header.number()] = bytes;
    }
    if (!sendFrame(writer, compressed.frame, stop)) return;
    if (callbacks_.on_sent) callbacks_.on_sent(compressed);
  }
}

bool Publisher::sendFrame(HeartbeatWriter& writer, const WireFrame& frame,
                          const std::stop_token& stop) {
  const auto send = [&](const FrameMessage& message) {
    const int64_t begun_ns = steadyNowNs();
    if (stop.stop_requested() || !writer.write(bytesOf(message))) return false;
    if (message.data.size() == chunk_size_.bytes()) {
      chunk_size_.note(steadyNowNs() - begun_ns);
    }
    return true;
  };
  return takeFrameMessages(frame, send, [&] { return chunk_size_.bytes(); });
}

}  // namespace viewloom
