// SPDX-License-Identifier: Apache-2.0
#include "rpc/rpc_probe.h"

#include <sys/socket.h>

#include <array>
#include <atomic>
#include <chrono>
#include <optional>
#include <utility>

#include <grpcpp/client_context.h>
#include <grpcpp/create_channel_posix.h>
#include <grpcpp/generic/generic_stub.h>

#include "base/str_cat.h"

namespace viewloom {
namespace {

// Every client may ask for the health: no refusal goes into the audit log.
constexpr const char* kMethod = "/grpc.health.v1.Health/Check";
constexpr std::chrono::seconds kDeadline{2};
constexpr std::chrono::seconds kSilence{5};

bool isAnswer(const grpc::Status& status) {
  return status.error_code() != grpc::StatusCode::DEADLINE_EXCEEDED &&
         status.error_code() != grpc::StatusCode::UNAVAILABLE;
}

// Asks about the whole server.
grpc::ByteBuffer emptyMessage() {
  const grpc::Slice nothing;
  return {&nothing, 1};
}

}  // namespace

struct RpcProbe::Call {
  explicit Call(const Clock& its_clock) : clock(its_clock), answered_ns(its_clock.nowNs()) {}

  const Clock& clock;
  std::atomic<int64_t> answered_ns;
  std::atomic<bool> is_under_way = false;
  std::atomic<bool> is_answered = false;  // the last one
  // These belong to the library while a call is under way.
  std::optional<grpc::GenericStub> stub;
  std::optional<grpc::ClientContext> context;
  grpc::ByteBuffer request = emptyMessage();
  grpc::ByteBuffer response;
};

RpcProbe::RpcProbe(std::unique_ptr<Acceptor> acceptor, const Clock& clock)
    : acceptor_(std::move(acceptor)), call_(std::make_shared<Call>(clock)) {}

RpcProbe::~RpcProbe() {
  if (call_->is_under_way) call_->context->TryCancel();
  call_->is_under_way.wait(true);
}

void RpcProbe::connect() {
  call_->stub.reset();
  std::array<int, 2> ends{};
  constexpr int kType = SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC;
  if (socketpair(AF_UNIX, kType, 0, ends.data()) != 0) return;
  Acceptor::NewConnectionParameters connection;
  connection.fd = ends[0];
  acceptor_->HandleNewConnection(&connection);
  call_->stub.emplace(grpc::CreateInsecureChannelFromFd("viewloomd", ends[1]));
}

void RpcProbe::ask() {
  if (call_->is_under_way) return;
  if (!call_->is_answered) connect();
  if (!call_->stub) return;
  call_->is_under_way = true;
  call_->context.emplace();
  call_->context->set_deadline(std::chrono::system_clock::now() + kDeadline);
  call_->stub->UnaryCall(&*call_->context, kMethod, {}, &call_->request, &call_->response,
                         [call = call_](const grpc::Status& status) {
                           call->is_answered = isAnswer(status);
                           if (call->is_answered) call->answered_ns = call->clock.nowNs();
                           call->is_under_way = false;
                           call->is_under_way.notify_all();
                         });
}

absl::Status RpcProbe::status() const {
  const std::chrono::nanoseconds silence(call_->clock.nowNs() - call_->answered_ns);
  if (silence < kSilence) return absl::OkStatus();
  return absl::UnavailableError(
      strCat("no call has been answered for ",
             std::chrono::duration_cast<std::chrono::seconds>(silence).count(), " s"));
}

}  // namespace viewloom
