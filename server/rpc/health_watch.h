// SPDX-License-Identifier: Apache-2.0
// One client's call that watches the health of the server.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include "base/status.h"
#include "grpc/health/v1/health.pb.h"

namespace viewloom {

using Serving = grpc::health::v1::HealthCheckResponse::ServingStatus;

// Tells the state once, and once more if the server drains. The call keeps itself alive from open()
// to OnDone. Thread-safety: all methods may be called from any thread.
class HealthWatch final : public grpc::ServerWriteReactor<grpc::ByteBuffer>,
                          public std::enable_shared_from_this<HealthWatch> {
 public:
  // `identity`: name of the client whose share it takes.
  HealthWatch(std::string identity, Serving serving)
      : identity_(std::move(identity)), newest_(serving), untold_(serving) {}

  const std::string& identity() const { return identity_; }
  // Tells the first state; call once, on a call that a shared_ptr owns.
  void open();
  // A service that served serves no more.
  void drain();
  // Ends the call; the first status wins.
  void end(const absl::Status& status);

  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

 private:
  // Writes or finishes if there is reason to. With the lock.
  void advance();

  const std::string identity_;
  std::mutex mutex_;  // guards what follows
  std::shared_ptr<HealthWatch> self_;
  Serving newest_;
  std::optional<Serving> untold_;
  grpc::ByteBuffer outgoing_;
  bool is_open_ = false;
  bool is_writing_ = false;
  bool is_finished_ = false;
  std::optional<grpc::Status> end_status_;
};

}  // namespace viewloom
