// SPDX-License-Identifier: Apache-2.0
// A call with one request.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <grpcpp/impl/codegen/server_callback_handlers.h>
#include <grpcpp/impl/service_type.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>

#include "base/status.h"
#include "rpc/bidi_call.h"
#include "rpc/liveness.h"

namespace viewloom {

// Ticks (kTick) in which the request has to come: 10 s.
inline constexpr uint32_t kRequestTicks = 40;

// Is seen from its headers on: the library's own calls of this kind are seen once their request has
// come, so that nobody could count those whose request never comes. Ends with DEADLINE_EXCEEDED
// without a request in time. Thread-safety: tick() belongs to one thread, else as BidiCall.
class OneRequestCall : public BidiCall {
 public:
  // `identity`: name of the client whose share it takes.
  explicit OneRequestCall(std::string identity) : identity_(std::move(identity)) {}

  const std::string& identity() const { return identity_; }
  // To be called every kTick.
  void tick();

 protected:
  // The request has come; an error ends the call. Without the lock, once.
  virtual absl::Status handleRequest(grpc::ByteBuffer& bytes) = 0;

 private:
  absl::Status handleMessage(grpc::ByteBuffer& bytes) final;
  absl::Status handleHalfClose() final;
  void release() final {}

  const std::string identity_;
  bool has_request_ = false;  // under mutex_
  TicksSince opened_;         // of tick()
};

// A call with one request and one answer.
class QuestionCall final : public OneRequestCall {
 public:
  // Makes the answer of a request, or the error with which the call ends.
  using Answer = std::function<absl::StatusOr<grpc::ByteBuffer>(grpc::ByteBuffer& request)>;

  QuestionCall(std::string identity, Answer answer)
      : OneRequestCall(std::move(identity)), answer_(std::move(answer)) {}

 private:
  absl::Status handleRequest(grpc::ByteBuffer& bytes) override;
  std::optional<grpc::ByteBuffer> takeMessage() override;

  const Answer answer_;
  std::optional<grpc::ByteBuffer> reply_;  // under mutex_
};

// A service of which some methods have calls that are seen from their headers on. `Base` is a
// service that protoc has made.
template <typename Base>
class EarlyService : public Base {
 protected:
  using Reactor = grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>;

  // `open` makes the call of the method with that index in the proto.
  void openEarly(int method_index, std::function<Reactor*(grpc::CallbackServerContext*)> open) {
    this->MarkMethodStreamed(method_index, nullptr);  // the library then waits for no message
    this->MarkMethodRawCallback(
        method_index, new grpc::internal::CallbackBidiHandler<grpc::ByteBuffer, grpc::ByteBuffer>(
                          std::move(open)));
  }
};

}  // namespace viewloom
