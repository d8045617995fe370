// SPDX-License-Identifier: Apache-2.0
#include "show/mode_question.h"

#include <utility>

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include "base/str_cat.h"
#include "lib/channel.h"
#include "viewloom/v1/catalog_service.grpc.pb.h"

namespace viewloom::show {

SuitedMode suitedMode(const absl::StatusOr<v1::GetServerInfoResponse>& info) {
  if (!info.ok()) {
    return {ShowMode::kNative,
            strCat("mode native: the server interlaces; it does not say what it renders on (",
                   std::string(info.status().message()), ")")};
  }
  if (info->traces_on_cpu()) {
    return {ShowMode::kWeave,
            strCat("mode weave: the server renders on a CPU (", info->device(),
                   "), where quilts cost less. They are woven here; --mode native lets the server "
                   "interlace instead")};
  }
  return {ShowMode::kNative, strCat("mode native: the server interlaces, on ", info->device())};
}

ModeQuestion::ModeQuestion(std::shared_ptr<grpc::Channel> channel, OnConnection on_connection,
                           std::function<void()> on_answer)
    : thread_([this, channel = std::move(channel), on_connection = std::move(on_connection),
               on_answer = std::move(on_answer)](const std::stop_token& stop) {
        ask(stop, channel, on_connection);
        if (!stop.stop_requested()) on_answer();
      }) {}

std::optional<SuitedMode> ModeQuestion::answer() const {
  std::lock_guard lock(mutex_);
  return answer_;
}

void ModeQuestion::ask(const std::stop_token& stop, const std::shared_ptr<grpc::Channel>& channel,
                       const OnConnection& on_connection) {
  const auto stub = v1::CatalogService::NewStub(channel);
  v1::GetServerInfoResponse info;
  const absl::Status status = RetryLoop({}, on_connection).run(stop, [&] {
    grpc::ClientContext context;
    const std::stop_callback break_off(stop, [&context] { context.TryCancel(); });
    return CallEnd{.status = statusFromGrpc(stub->GetServerInfo(&context, {}, &info)),
                   .was_connected = false};
  });
  std::lock_guard lock(mutex_);
  answer_ = status.ok() ? suitedMode(info) : suitedMode(status);
}

}  // namespace viewloom::show
