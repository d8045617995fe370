// SPDX-License-Identifier: Apache-2.0
#include "rpc/peer_host.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <utility>

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

// Empty for anything but IP.
std::string numericHost(int fd) {
  union {
    sockaddr any;
    sockaddr_in ipv4;
    sockaddr_in6 ipv6;
    sockaddr_storage largest;
  } address{};
  socklen_t size = sizeof address;
  if (getpeername(fd, &address.any, &size) != 0) return "";
  const int family = address.any.sa_family;
  if (family != AF_INET && family != AF_INET6) return "";
  const void* const bytes = family == AF_INET ? static_cast<const void*>(&address.ipv4.sin_addr)
                                              : &address.ipv6.sin6_addr;
  std::array<char, INET6_ADDRSTRLEN> text{};
  return inet_ntop(family, bytes, text.data(), text.size()) != nullptr ? text.data() : "";
}

std::string machineOrHost(std::string host) {
  if (host.starts_with(kMappedIpv4)) host.erase(0, kMappedIpv4.size());
  return host.empty() || isLoopbackHost(host) ? std::string(kThisMachine) : host;
}

}  // namespace

std::string peerHost(std::string_view peer) {
  const size_t scheme_end = peer.find(':');
  const std::string_view scheme = peer.substr(0, scheme_end);
  std::string host;
  if (scheme == "ipv4" || scheme == "ipv6") {
    const auto address = parseHostPort(unescaped(peer.substr(scheme_end + 1)));
    if (address) host = address->host;
  }
  return machineOrHost(std::move(host));
}

std::string peerHost(int fd) {
  return machineOrHost(numericHost(fd));
}

}  // namespace viewloom
