// SPDX-License-Identifier: Apache-2.0
#include "web/host_policy.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <utility>

#include "absl/strings/ascii.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  absl::AsciiStrToLower(&lower);
  return lower;
}

// "localhost:8080" → "localhost", "[::1]:8080" → "::1".
std::string withoutPort(std::string_view host) {
  if (host.starts_with('[')) return std::string(host.substr(1, host.find(']') - 1));
  return std::string(host.substr(0, host.find(':')));
}

bool isLoopback(const std::string& name) {
  if (name == "localhost" || name.ends_with(".localhost")) return true;
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(name, error);
  return !error && address.is_loopback();
}

}  // namespace

HostPolicy::HostPolicy(bool loopback, std::vector<std::string> allowed_hosts)
    : loopback_(loopback), allowed_hosts_(std::move(allowed_hosts)) {}

absl::Status HostPolicy::checkHost(std::string_view host) const {
  if (!loopback_) return absl::OkStatus();
  const std::string name = lowerCase(withoutPort(host));
  const bool allowed = std::any_of(allowed_hosts_.begin(), allowed_hosts_.end(),
                                   [&](const auto& other) { return lowerCase(other) == name; });
  if (allowed || isLoopback(name)) return absl::OkStatus();
  return fieldError(absl::StatusCode::kPermissionDenied, "host",
                    strCat("got \"", std::string(host),
                           "\", accepted on loopback are localhost, loopback addresses and "
                           "the hosts named in the settings"));
}

absl::Status HostPolicy::checkOrigin(std::string_view origin, std::string_view host) const {
  if (origin.empty()) return absl::OkStatus();
  const size_t scheme_end = origin.find("://");
  const bool same = scheme_end != std::string_view::npos &&
                    lowerCase(origin.substr(scheme_end + 3)) == lowerCase(host);
  if (same) return absl::OkStatus();
  return fieldError(
      absl::StatusCode::kPermissionDenied, "origin",
      strCat("got \"", std::string(origin), "\", accepted are pages of this server, and programs"));
}

}  // namespace viewloom
