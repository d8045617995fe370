// SPDX-License-Identifier: Apache-2.0
#include "lib/watcher.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "lib/channel.h"

namespace viewloom {

Watcher::Watcher(std::shared_ptr<grpc::Channel> channel, v1::OpenDisplay open,
                 WatcherCallbacks callbacks, const BackoffOptions& backoff)
    : callbacks_(std::move(callbacks)),
      stub_(v1::DisplayService::NewStub(std::move(channel))),
      open_(std::move(open)) {
  thread_ = std::jthread([this, backoff](const std::stop_token& stop) {
    RetryLoop loop(backoff, callbacks_.on_connection);
    absl::Status status = loop.run(stop, [&] { return runCall(stop); });
    std::lock_guard lock(mutex_);
    ended_ = std::move(status);
    changed_.notify_all();
  });
}

Watcher::~Watcher() = default;

void Watcher::change(const v1::ChangeDisplay& change) {
  {
    std::lock_guard lock(mutex_);
    if (change.has_display()) *open_.mutable_display() = change.display();
    if (!open_.display().stereo().tracked()) eyes_.reset();
    if (change.has_encoding()) *open_.mutable_encoding() = change.encoding();
  }
  v1::StreamAtlasesRequest request;
  *request.mutable_change() = change;
  write(request);
}

void Watcher::sendEyePoses(const v1::EyePoses& poses) {
  {
    std::lock_guard lock(mutex_);
    eyes_ = poses;
  }
  v1::StreamAtlasesRequest request;
  *request.mutable_eye_poses() = poses;
  write(request);
}

void Watcher::probeClock() {
  v1::StreamAtlasesRequest request;
  request.mutable_clock_probe()->set_client_time_ns(steadyNowNs());
  write(request);
}

std::optional<ClockOffset> Watcher::serverClock() const {
  std::lock_guard lock(mutex_);
  return server_clock_.offset();
}

void Watcher::reportPresented(uint64_t sequence, int64_t presented_time_ns) {
  v1::StreamAtlasesRequest request;
  request.mutable_presented()->set_sequence(sequence);
  request.mutable_presented()->set_presented_time_ns(presented_time_ns);
  write(request);
}

void Watcher::write(const v1::StreamAtlasesRequest& request) {
  std::lock_guard lock(write_mutex_);
  if (call_ != nullptr) call_->Write(request);  // a failure shows where the call is read
}

void Watcher::stop() {
  thread_.request_stop();
}

std::optional<absl::Status> Watcher::ended() const {
  std::lock_guard lock(mutex_);
  return ended_;
}

bool Watcher::waitEnded(int64_t timeout_ns) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, std::chrono::nanoseconds(timeout_ns),
                           [&] { return ended_.has_value(); });
}

WatcherCounts Watcher::counts() const {
  std::lock_guard lock(mutex_);
  return counts_;
}

CallEnd Watcher::runCall(const std::stop_token& stop) {
  assembler_.restart();
  grpc::ClientContext context;
  const std::stop_callback cancel(stop, [&] { context.TryCancel(); });
  const std::unique_ptr<Call> call = stub_->StreamAtlases(&context);
  v1::StreamAtlasesRequest request;
  std::optional<v1::EyePoses> eyes;
  {
    std::lock_guard writing(write_mutex_);  // until the call is open, nothing else is written
    {
      std::lock_guard lock(mutex_);
      was_connected_ = false;
      server_clock_.restart();
      *request.mutable_open() = open_;
      request.mutable_open()->set_wants_heartbeats(true);
      eyes = eyes_;
    }
    call_ = call.get();
    call_->Write(request);
    if (eyes) {
      *request.mutable_eye_poses() = *std::move(eyes);
      call_->Write(request);
    }
  }
  SilenceWatch silence([&] { context.TryCancel(); });
  const absl::Status broken = readAtlases(*call, silence);
  if (!broken.ok()) context.TryCancel();
  {
    std::lock_guard lock(write_mutex_);
    call_ = nullptr;
  }
  absl::Status status = statusFromGrpc(call->Finish());
  if (!status.ok() && silence.hasFired()) status = silence.status();
  std::lock_guard lock(mutex_);
  counts_.atlases = assembler_.counts();
  if (is_complete_) return {absl::OkStatus(), was_connected_};
  counts_.reconnects += was_connected_ && isPassing(status) && !stop.stop_requested();
  return {broken.ok() ? status : broken, was_connected_};
}

absl::Status Watcher::readAtlases(Call& call, SilenceWatch& silence) {
  v1::StreamAtlasesResponse message;
  for (silence.listens(); call.Read(&message); silence.listens()) {
    silence.hears();
    if (message.has_heartbeat()) {
      silence.expectHeartbeats();
      noteConnected();
    } else {
      VIEWLOOM_RETURN_IF_ERROR(deliver(std::move(message)));
    }
  }
  silence.hears();
  return absl::OkStatus();
}

// The server has taken the call.
void Watcher::noteConnected() {
  {
    std::lock_guard lock(mutex_);
    if (std::exchange(was_connected_, true)) return;
    // Once seen, the stream comes back with its publisher, even after the server was gone.
    open_.set_wait_for_stream(true);
  }
  if (callbacks_.on_connection) callbacks_.on_connection({});
}

absl::Status Watcher::deliver(v1::StreamAtlasesResponse message) {
  if (message.has_clock_reply()) {
    const int64_t received_ns = steadyNowNs();
    std::lock_guard lock(mutex_);
    server_clock_.add(message.clock_reply(), received_ns);
    return absl::OkStatus();
  }
  if (callbacks_.on_message) callbacks_.on_message(message);
  const bool is_layout = message.has_layout();
  const size_t size = message.ByteSizeLong();
  absl::StatusOr<std::optional<Atlas>> atlas = assembler_.add(std::move(message));
  if (!atlas.ok()) return atlas.status();
  {
    std::lock_guard lock(mutex_);
    counts_.atlases = assembler_.counts();
    counts_.received_bytes += size;
    if (atlas->has_value() && open_.count() > 0) {
      open_.set_count(open_.count() - 1);
      is_complete_ = open_.count() == 0;
    }
  }
  noteConnected();
  if (is_layout && callbacks_.on_layout) callbacks_.on_layout(*assembler_.layout());
  if (atlas->has_value() && callbacks_.on_atlas) callbacks_.on_atlas(**std::move(atlas));
  return absl::OkStatus();
}

namespace {

constexpr std::chrono::milliseconds kFirstPause(50);
constexpr std::chrono::milliseconds kPause(1000);
constexpr size_t kFirstCount = ServerClock::kProbeCount;

}  // namespace

void ClockFollower::run(Watcher& watcher, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  for (size_t count = 0; !stop.stop_requested(); ++count) {
    watcher.probeClock();
    stopped.wait_for(lock, stop, count < kFirstCount ? kFirstPause : kPause, [] { return false; });
  }
}

}  // namespace viewloom
