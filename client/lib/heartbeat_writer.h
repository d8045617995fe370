// SPDX-License-Identifier: Apache-2.0
// Writes the messages of a publisher's call, and heartbeats while there are no messages.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/sync_stream.h>

#include "viewloom/v1/ingest_service.grpc.pb.h"

namespace viewloom {

// Thread-safety: write() belongs to one thread. Another thread, of this object, sends heartbeats.
class HeartbeatWriter {
 public:
  // Call with serialised messages, so that chunks share the bytes of their planes.
  using Call = grpc::ClientReaderWriter<grpc::ByteBuffer, v1::PublishFramesResponse>;

  // Expects that the settings were sent. The call must outlive the writer.
  explicit HeartbeatWriter(Call& call);

  // Sends a message; returns false if the call is broken.
  bool write(const grpc::ByteBuffer& message);
  // Finishes a heartbeat that is being sent, and half-closes the call.
  void finish();

 private:
  void run(const std::stop_token& stop);

  Call& call_;
  std::mutex mutex_;  // one write at a time; held while a write waits for the network
  std::atomic<uint32_t> idle_tick_count_ = 0;
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace viewloom
