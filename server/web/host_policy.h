// SPDX-License-Identifier: Apache-2.0
// Which names and which pages may reach the server.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace viewloom {

// Headers by which a browser says which page a request comes from; empty where it does not.
struct PageHeaders {
  std::string origin;
  std::string referer;
  std::string fetch_site;  // Sec-Fetch-Site: "same-origin", "cross-site", ...
  std::string fetch_mode;  // Sec-Fetch-Mode: "navigate" for links, and for frames
  std::string
      fetch_dest;  // Sec-Fetch-Dest: "document" for a link; "iframe", "object", "image", ...
};

// Any web page can make its visitor's browser reach this server: under its address, or under a name
// of the page's own (DNS rebinding). A browser takes answers to such a name for the page's own. So
// only numeric addresses, localhost, the names of this machine and `allowed_hosts` are answered.
// WebSockets and <img> are not bound by the browser's same-origin rule: a page must come from the
// server itself, or from one of `allowed_origins`. Programs send no such headers.
class HostPolicy {
 public:
  // Names and origins are compared without regard to case.
  HostPolicy(std::vector<std::string> machine_names, std::vector<std::string> allowed_hosts,
             std::vector<std::string> allowed_origins);

  // PERMISSION_DENIED. `host` is the Host header.
  absl::Status checkHost(std::string_view host) const;
  // PERMISSION_DENIED for WebSockets and sign-ins of foreign pages.
  absl::Status checkWebSocket(const PageHeaders& page, std::string_view host) const;
  // PERMISSION_DENIED where a foreign page embeds or fetches something, also in a frame. A link may
  // lead here.
  absl::Status checkPage(const PageHeaders& page) const;
  // The one of `allowed_origins` that the page belongs to; "" if it belongs to none.
  std::string allowedOrigin(const PageHeaders& page) const;
  // All of them, in lower case.
  const std::vector<std::string>& allowedOrigins() const { return origins_; }

 private:
  std::vector<std::string> names_;
  std::vector<std::string> origins_;
};

// The names of this machine: its host name, that without its domain, and that below .local.
std::vector<std::string> machineNames();

}  // namespace viewloom
