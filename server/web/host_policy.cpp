// SPDX-License-Identifier: Apache-2.0
#include "web/host_policy.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "absl/strings/ascii.h"
#include "base/host_port.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  absl::AsciiStrToLower(&lower);
  return lower;
}

}  // namespace

HostPolicy::HostPolicy(bool loopback, std::vector<std::string> allowed_hosts)
    : loopback_(loopback), allowed_hosts_(std::move(allowed_hosts)) {}

absl::Status HostPolicy::checkHost(std::string_view host) const {
  if (!loopback_) return absl::OkStatus();
  const std::optional<HostPort> parsed = parseHostPort(host);
  const std::string name = parsed ? lowerCase(parsed->host) : "";
  const bool allowed = std::any_of(allowed_hosts_.begin(), allowed_hosts_.end(),
                                   [&](const auto& other) { return lowerCase(other) == name; });
  if (allowed || isLoopbackHost(name)) return absl::OkStatus();
  return fieldError(absl::StatusCode::kPermissionDenied, "host",
                    strCat("the request names the host \"", std::string(host),
                           "\"; accepted is localhost, a loopback address, or a host named in the "
                           "setting http.allowed_hosts"));
}

absl::Status HostPolicy::checkOrigin(std::string_view origin, std::string_view host) const {
  if (origin.empty()) return absl::OkStatus();
  const size_t scheme_end = origin.find("://");
  const bool same = scheme_end != std::string_view::npos &&
                    lowerCase(origin.substr(scheme_end + 3)) == lowerCase(host);
  if (same) return absl::OkStatus();
  return fieldError(
      absl::StatusCode::kPermissionDenied, "origin",
      strCat("a page of \"", std::string(origin),
             "\" asks for a WebSocket; accepted are pages of this server, and programs"));
}

}  // namespace viewloom
