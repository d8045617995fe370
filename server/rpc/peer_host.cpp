// SPDX-License-Identifier: Apache-2.0
#include "rpc/peer_host.h"

#include "base/host_port.h"

namespace viewloom {
namespace {

constexpr std::string_view kMappedIpv4 = "::ffff:";

// gRPC escapes the brackets of an IPv6 address.
std::string unescaped(std::string_view text) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    const std::string_view escape = text.substr(i, 3);
    if (escape == "%5B" || escape == "%5D") {
      result += escape == "%5B" ? '[' : ']';
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

}  // namespace

std::string peerHost(std::string_view peer) {
  const size_t scheme_end = peer.find(':');
  const std::string_view scheme = peer.substr(0, scheme_end);
  std::string host;
  if (scheme == "ipv4" || scheme == "ipv6") {
    const auto address = parseHostPort(unescaped(peer.substr(scheme_end + 1)));
    if (address) host = address->host;
    if (host.starts_with(kMappedIpv4)) host.erase(0, kMappedIpv4.size());
  }
  return host.empty() || isLoopbackHost(host) ? "this machine" : host;
}

}  // namespace viewloom
