// SPDX-License-Identifier: Apache-2.0
#include "lib/channel.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <grpcpp/channel.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>
#include <grpcpp/support/client_interceptor.h>
#include <grpcpp/support/status.h>

#include "absl/strings/cord.h"
#include "base/host_port.h"
#include "base/retry_delay.h"
#include "certificates/server_address.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "lib/credentials.h"

namespace viewloom {
namespace {

// Two round trips of any network, and a second attempt soon after a host has come back.
constexpr int kConnectMsMax = 2000;
// More often than proxies drop silent connections; seldom enough for every server's patience.
constexpr int kKeepaliveMs = 15000;
constexpr int kKeepaliveTimeoutMs = 5000;
constexpr double kRetryDelayMax_s = 3600;

constexpr const char* kOriginPayload = "viewloom.origin";
constexpr const char* kServer = "server";
constexpr const char* kTransport = "transport";

// Adds the token to each call. The credentials of gRPC do so on encrypted channels only.
class TokenInterceptor final : public grpc::experimental::Interceptor {
 public:
  explicit TokenInterceptor(std::string header) : header_(std::move(header)) {}

  void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
    using Point = grpc::experimental::InterceptionHookPoints;
    if (methods->QueryInterceptionHookPoint(Point::PRE_SEND_INITIAL_METADATA)) {
      methods->GetSendInitialMetadata()->emplace("authorization", header_);
    }
    methods->Proceed();
  }

 private:
  const std::string header_;
};

class TokenInterceptors final : public grpc::experimental::ClientInterceptorFactoryInterface {
 public:
  explicit TokenInterceptors(const std::string& token) : header_("Bearer " + token) {}

  grpc::experimental::Interceptor* CreateClientInterceptor(
      grpc::experimental::ClientRpcInfo*) override {
    return new TokenInterceptor(header_);  // gRPC deletes it
  }

 private:
  const std::string header_;
};

// Whatever is wrong with the address or with the system's authorities shows in the first call.
std::shared_ptr<grpc::ChannelCredentials> credentialsByAddress(const std::string& address) {
  const auto credentials = makeCredentials(address, {});
  return credentials.ok() ? *credentials : nullptr;
}

}  // namespace

std::shared_ptr<grpc::Channel> makeChannel(
    const std::string& address, const std::string& token,
    const std::shared_ptr<grpc::ChannelCredentials>& credentials) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(kMessageBytesMax);
  arguments.SetMaxSendMessageSize(kMessageBytesMax);
  // How long to wait between attempts is decided in RetryLoop; the channel itself tries at once.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 200);
  // How long one attempt may take, in spite of its name.
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, kConnectMsMax);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
  arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  // Two clients of one process do not share a connection, and with it its flow control.
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  const std::string target = parseServerAddress(address).target;
  const auto known_by = credentials != nullptr ? credentials : credentialsByAddress(address);
  if (token.empty()) return grpc::CreateCustomChannel(target, known_by, arguments);
  if (!isSendableToken(token)) {
    throw std::invalid_argument(
        "the access token (VIEWLOOM_TOKEN) has characters that cannot be sent; accepted is one "
        "line, as `viewloomd token add` prints it");
  }
  std::vector<std::unique_ptr<grpc::experimental::ClientInterceptorFactoryInterface>> interceptors;
  interceptors.push_back(std::make_unique<TokenInterceptors>(token));
  return grpc::experimental::CreateCustomChannelWithInterceptors(target, known_by, arguments,
                                                                 std::move(interceptors));
}

bool staysOnMachine(const std::string& address) {
  if (address.rfind("unix:", 0) == 0 || address.rfind("unix-abstract:", 0) == 0) return true;
  const std::optional<HostPort> parsed = parseHostPort(parseServerAddress(address).target);
  return parsed && isLoopbackHost(parsed->host);
}

absl::Status statusFromGrpc(const grpc::Status& status) {
  absl::Status result(static_cast<absl::StatusCode>(status.error_code()), status.error_message());
  if (result.ok()) return result;
  google::rpc::Status details;
  const bool has_details =
      !status.error_details().empty() && details.ParseFromString(status.error_details());
  result.SetPayload(kOriginPayload, absl::Cord(has_details ? kServer : kTransport));
  for (const google::protobuf::Any& detail : details.details()) {
    google::rpc::RetryInfo retry;
    if (!detail.UnpackTo(&retry)) continue;
    const double delay_s =
        double(retry.retry_delay().seconds()) + 1e-9 * double(retry.retry_delay().nanos());
    result = worthRetry(result, int64_t(1e9 * std::clamp(delay_s, 0.0, kRetryDelayMax_s)));
  }
  return result;
}

bool isFromServer(const absl::Status& status) {
  return status.GetPayload(kOriginPayload) == absl::Cord(kServer);
}

bool isFromTransport(const absl::Status& status) {
  return status.GetPayload(kOriginPayload) == absl::Cord(kTransport);
}

}  // namespace viewloom
