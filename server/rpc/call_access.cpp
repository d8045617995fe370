// SPDX-License-Identifier: Apache-2.0
#include "rpc/call_access.h"

#include "access/bearer.h"
#include "rpc/peer_host.h"
#include "rpc/tls_credentials.h"

namespace viewloom {
namespace {

constexpr uint32_t kCheckTicks = 4;  // 1 s

}  // namespace

std::string clientHost(const grpc::CallbackServerContext& context) {
  const std::string subject = clientSubject(context);
  return subject.empty() ? peerHost(context.peer()) : subject;
}

absl::StatusOr<Caller> admitCall(AccessControl& access, const grpc::CallbackServerContext& context,
                                 std::string_view rpc) {
  const auto& metadata = context.client_metadata();
  const auto found = metadata.find("authorization");
  const std::string_view header =
      found == metadata.end() ? std::string_view()
                              : std::string_view(found->second.data(), found->second.size());
  return access.admit(rpc, peerHost(context.peer()), bearerToken(header));
}

absl::StatusOr<Caller> admitLiveCall(AccessControl& access,
                                     const grpc::CallbackServerContext& context,
                                     std::string_view rpc) {
  absl::StatusOr<Caller> caller = admitCall(access, context, rpc);
  VIEWLOOM_RETURN_IF_ERROR(caller.status());
  VIEWLOOM_RETURN_IF_ERROR(caller->stay());
  return caller;
}

absl::Status LiveCaller::tick() {
  if (!checked_.reaches(kCheckTicks)) return absl::OkStatus();
  checked_.restart();
  return caller_.recheck();
}

}  // namespace viewloom
