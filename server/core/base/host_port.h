// SPDX-License-Identifier: Apache-2.0
// Addresses as people write them: "localhost", "127.0.0.1:8080", "[::1]:8080".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace viewloom {

struct HostPort {
  std::string host;              // without the brackets of an IPv6 address; never empty
  std::optional<uint16_t> port;  // empty if none is given

  std::string text() const;  // with brackets around an IPv6 address
};

// Parses HOST, HOST:PORT, [IPV6] or [IPV6]:PORT, with a port 0..65535; empty for other texts.
std::optional<HostPort> parseHostPort(std::string_view text);

// Whether a host, without port and brackets, is a name or an address of the loopback interface.
bool isLoopbackHost(std::string_view host);

// Whether a server that listens at the host takes calls at all addresses of its machine: 0.0.0.0
// and
// ::. Nobody can open such an address.
bool isAnyHost(std::string_view host);

// The URL of a page, http://HOST:PORT/PATH, as a browser opens it: `host` takes the place of a host
// that stands for all addresses. Other URLs stay as they are.
std::string urlToOpen(std::string_view url, std::string_view host);

// All clients on the server's own machine together.
inline constexpr std::string_view kThisMachine = "this machine";

// The client at an address, for shares: kThisMachine for loopback, the address for IPv4, and for
// IPv6 the first 64 bits ("2001:db8:0:1::/64"), as one client has all addresses below. Other texts
// stay as they are.
std::string identityOfHost(std::string_view host);

}  // namespace viewloom
