// SPDX-License-Identifier: Apache-2.0
#include "service_options.h"

#include "absl/strings/str_split.h"
#include "base/host_port.h"
#include "base/log.h"
#include "certificates/server_address.h"

namespace viewloom {
namespace {

// Connections of the page beside those that watch: files, stills, metrics.
constexpr uint32_t kOtherHttpConnections = 256;

}  // namespace

FrameLimits frameLimits(const LimitsConfig& limits) {
  FrameLimits result;
  result.plane_side_px_max = limits.plane_side_px_max;
  result.frame_bytes_max = limits.frame_bytes_max;
  return result;
}

AtlasLimits atlasLimits(const LimitsConfig& limits) {
  return {.side_px_max = limits.atlas_side_px_max,
          .area_px_max = uint64_t{limits.atlas_side_px_max} * limits.atlas_side_px_max,
          .view_count_max = limits.views_max};
}

BroadcasterLimits broadcasterLimits(const LimitsConfig& limits) {
  return {.display_count_max = limits.displays_max, .subscriber_count_max = limits.subscribers_max};
}

AccessOptions accessOptions(const AccessConfig& config) {
  AccessOptions options;
  options.token_file = config.token_file;
  options.jwks_file = config.jwks_file;
  options.audience = config.audience;
  options.issuer = config.issuer;
  options.audit_file = config.audit_file;
  return options;
}

ConnectionShares connectionShares(const Config& config) {
  const ConnectionShares wanted{.grpc = config.grpc.connections_max,
                                .http = config.limits.subscribers_max + kOtherHttpConnections};
  const uint64_t limit = descriptorLimit();
  const ConnectionShares shares = shareDescriptors(limit, wanted);
  if (shares != wanted) {
    log(LogLevel::kWarning, "the system allows ", limit, " open files: at most ", shares.grpc,
        " gRPC and ", shares.http, " HTTP connections, instead of ", wanted.grpc, " and ",
        wanted.http, "; raise the limit (ulimit -Hn, LimitNOFILE), or lower ",
        "grpc.connections_max and limits.subscribers_max");
  }
  return shares;
}

HttpOptions httpOptions(const HttpConfig& config, uint32_t connection_count_max) {
  const HostPort address = parseHostPort(config.address).value();
  HttpOptions options;
  options.address = address.host == "localhost" ? "127.0.0.1" : address.host;
  options.port = address.port.value();
  options.allowed_hosts = absl::StrSplit(config.allowed_hosts, ',', absl::SkipEmpty());
  options.allowed_origins = absl::StrSplit(config.allowed_origins, ',', absl::SkipEmpty());
  options.connection_count_max = connection_count_max;
  options.movie_count_max = config.videos_max;
  return options;
}

std::string listeningAddress(const std::string& configured, uint16_t port, bool has_tls) {
  if (configured.starts_with("unix:")) return configured;
  const HostPort address{.host = parseHostPort(configured).value().host, .port = port};
  return ServerAddress{.target = address.text(), .has_tls = has_tls}.text();
}

}  // namespace viewloom
