// SPDX-License-Identifier: Apache-2.0
#include "cli/page_address.h"

#include <algorithm>
#include <optional>

#include "base/host_port.h"
#include "certificates/server_address.h"
#include "lib/channel.h"

namespace viewloom::cli {
namespace {

constexpr const char* kThisHost = "localhost";

// The host in an address that gRPC takes, also behind a scheme: "dns:///studio:50051".
std::string hostOf(const std::string& server) {
  const std::string target = parseServerAddress(server).target;
  if (target.starts_with("unix")) return kThisHost;
  const std::optional<HostPort> parsed = parseHostPort(target.substr(target.rfind('/') + 1));
  return parsed && !isAnyHost(parsed->host) ? parsed->host : kThisHost;
}

std::optional<HostPort> hostPortOf(const std::string& url) {
  const size_t scheme_end = url.find("://");
  if (scheme_end == std::string::npos) return std::nullopt;
  const size_t begin = scheme_end + 3;
  return parseHostPort(url.substr(begin, std::min(url.find('/', begin), url.size()) - begin));
}

}  // namespace

std::string pageToOpen(const std::string& url, const std::string& server) {
  return urlToOpen(url, hostOf(server));
}

std::string pageRemark(const std::string& url, const std::string& server) {
  const std::optional<HostPort> page = hostPortOf(url);
  if (!page || !isLoopbackHost(page->host) || isLoopbackHost(hostOf(server))) return "";
  return " (on the server's own machine)";
}

}  // namespace viewloom::cli
