// SPDX-License-Identifier: Apache-2.0
#include "lib/heartbeat_writer.h"

#include "lib/retry_loop.h"
#include "messages/wire_message.h"

namespace viewloom {
namespace {

constexpr int64_t kTick_ns = 250'000'000;
constexpr uint32_t kHeartbeatTicks = 4;  // a heartbeat a second

}  // namespace

HeartbeatWriter::HeartbeatWriter(Call& call)
    : call_(call), thread_([this](const std::stop_token& stop) { run(stop); }) {}

bool HeartbeatWriter::write(const grpc::ByteBuffer& message) {
  std::lock_guard lock(mutex_);
  const bool was_written = call_.Write(message);
  idle_tick_count_ = 0;
  return was_written;
}

void HeartbeatWriter::finish() {
  thread_.request_stop();
  thread_.join();
  call_.WritesDone();
}

void HeartbeatWriter::run(const std::stop_token& stop) {
  v1::PublishFramesRequest request;
  request.mutable_heartbeat();
  const grpc::ByteBuffer heartbeat = bytesFromMessage(request);
  while (!stop.stop_requested()) {
    RetryLoop::sleepUntilStopped(stop, kTick_ns);
    if (stop.stop_requested() || ++idle_tick_count_ < kHeartbeatTicks) continue;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) continue;  // a message is on its way, which says as much
    if (!call_.Write(heartbeat)) return;
    idle_tick_count_ = 0;
  }
}

}  // namespace viewloom
