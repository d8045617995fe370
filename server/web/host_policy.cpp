// SPDX-License-Identifier: Apache-2.0
#include "web/host_policy.h"

#include <arpa/inet.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <optional>

#include "absl/strings/ascii.h"
#include "base/host_port.h"
#include "base/printable.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  absl::AsciiStrToLower(&lower);
  return lower;
}

// No DNS entry leads to a numeric address, so no foreign page has one for a name.
bool isNumeric(const std::string& host) {
  in6_addr any_kind{};
  return inet_pton(AF_INET, host.c_str(), &any_kind) == 1 ||
         inet_pton(AF_INET6, host.c_str(), &any_kind) == 1;
}

// "https://studio.example" of "https://studio.example/page?x"; "" of other texts.
std::string originOf(std::string_view address) {
  const size_t scheme_end = address.find("://");
  if (scheme_end == std::string_view::npos) return "";
  return lowerCase(address.substr(0, address.find('/', scheme_end + 3)));
}

absl::Status refusedPage(std::string_view page, std::string_view wanted) {
  return fieldError(
      absl::StatusCode::kPermissionDenied, "origin",
      strCat("a page of \"", quotable(page), "\" ", wanted,
             "; accepted are pages of this server, programs, and pages named in the setting "
             "http.allowed_origins"));
}

}  // namespace

HostPolicy::HostPolicy(std::vector<std::string> machine_names,
                       std::vector<std::string> allowed_hosts,
                       std::vector<std::string> allowed_origins) {
  for (const auto& names : {machine_names, allowed_hosts}) {
    for (const std::string& name : names) names_.push_back(lowerCase(name));
  }
  for (const std::string& origin : allowed_origins) origins_.push_back(lowerCase(origin));
}

absl::Status HostPolicy::checkHost(std::string_view host) const {
  const std::optional<HostPort> parsed = parseHostPort(host);
  const std::string name = parsed ? lowerCase(parsed->host) : "";
  const bool is_known = std::ranges::find(names_, name) != names_.end();
  if (!name.empty() && (is_known || isNumeric(name) || isLoopbackHost(name))) {
    return absl::OkStatus();
  }
  return fieldError(absl::StatusCode::kPermissionDenied, "host",
                    strCat("the request names the host \"", quotable(host),
                           "\"; accepted is a numeric address, localhost, the name of this machine "
                           "or a host named in the setting http.allowed_hosts"));
}

absl::Status HostPolicy::checkWebSocket(const PageHeaders& page, std::string_view host) const {
  if (page.origin.empty() || !allowedOrigin(page).empty()) return absl::OkStatus();
  const size_t scheme_end = page.origin.find("://");
  const bool is_own = scheme_end != std::string::npos &&
                      lowerCase(page.origin.substr(scheme_end + 3)) == lowerCase(host);
  return is_own ? absl::OkStatus() : refusedPage(page.origin, "asks for a WebSocket");
}

absl::Status HostPolicy::checkPage(const PageHeaders& page) const {
  const bool is_foreign = page.fetch_site == "cross-site" || page.fetch_site == "same-site";
  const bool follows_link = page.fetch_mode == "navigate" && page.fetch_dest == "document";
  if (!is_foreign || follows_link || !allowedOrigin(page).empty()) {
    return absl::OkStatus();
  }
  const std::string name = page.origin.empty() ? originOf(page.referer) : page.origin;
  return refusedPage(name.empty() ? "another server" : name, "asks for something to embed");
}

std::string HostPolicy::allowedOrigin(const PageHeaders& page) const {
  const std::string origin = originOf(page.origin.empty() ? page.referer : page.origin);
  const auto found = std::ranges::find(origins_, origin);
  return found == origins_.end() ? "" : *found;
}

std::vector<std::string> machineNames() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0 || name.front() == 0) return {};
  const std::string whole = name.data();
  const std::string first = whole.substr(0, whole.find('.'));
  return {whole, first, first + ".local"};
}

}  // namespace viewloom
