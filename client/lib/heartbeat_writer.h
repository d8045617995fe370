// SPDX-License-Identifier: Apache-2.0
// Writes the messages of a publisher's call, and heartbeats where there are none.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/sync_stream.h>

#include "viewloom/v1/ingest_service.grpc.pb.h"

namespace viewloom {

// Thread-safety: write() from one thread; the heartbeats come from a thread of its own.
class HeartbeatWriter {
 public:
  // Its messages go serialised, so that chunks share the bytes of their planes.
  using Call = grpc::ClientReaderWriter<grpc::ByteBuffer, v1::PublishFramesResponse>;

  // The call has its settings. It must outlive the writer.
  explicit HeartbeatWriter(Call& call);

  // False when the call is broken.
  bool write(const grpc::ByteBuffer& message);
  // Sends the last heartbeat, if one is under way, and tells the server that nothing follows.
  void finish();

 private:
  void run(const std::stop_token& stop);

  Call& call_;
  std::mutex mutex_;  // gRPC takes one write at a time; held while one waits for the network
  std::atomic<uint32_t> idle_tick_count_ = 0;
  std::jthread thread_;  // last: it uses what stands above
};

}  // namespace viewloom
