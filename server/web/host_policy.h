// SPDX-License-Identifier: Apache-2.0
// Which names and which pages may reach the server.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace viewloom {

// A server on loopback trusts whoever reaches it, and any web page can make its visitor's browser
// reach it, under a name of the page's own (DNS rebinding). So on loopback only names that mean
// loopback are answered. WebSockets are not bound by the browser's same-origin rule, so everywhere
// a page must come from the server itself; programs send no Origin.
class HostPolicy {
 public:
  HostPolicy(bool loopback, std::vector<std::string> allowed_hosts);

  // PERMISSION_DENIED. `host` is the Host header, `origin` the Origin header; empty when not given.
  absl::Status checkHost(std::string_view host) const;
  absl::Status checkOrigin(std::string_view origin, std::string_view host) const;

 private:
  const bool loopback_;
  const std::vector<std::string> allowed_hosts_;
};

}  // namespace viewloom
