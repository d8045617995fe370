// SPDX-License-Identifier: Apache-2.0
#include "base/host_port.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>

#include "absl/strings/ascii.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

constexpr size_t kIpv4Bytes = 4;
constexpr uint8_t kLoopbackNet = 127;  // 127.0.0.0/8

// Sets the port from what stands behind the host: "", ":" or ":PORT".
bool readPort(std::string_view text, std::optional<uint16_t>& port) {
  if (text.empty() || text == ":") return true;
  uint16_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + 1, end, value);
  if (text.front() != ':' || error != std::errc() || stop != end) return false;
  port = value;
  return true;
}

}  // namespace

std::string HostPort::text() const {
  const bool is_ipv6 = host.find(':') != std::string::npos;
  std::string text = is_ipv6 ? strCat("[", host, "]") : host;
  if (port) text += strCat(":", *port);
  return text;
}

std::optional<HostPort> parseHostPort(std::string_view text) {
  HostPort parsed;
  if (text.starts_with('[')) {
    const size_t end = text.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    parsed.host = text.substr(1, end - 1);
    text.remove_prefix(end + 1);
  } else {
    parsed.host = text.substr(0, text.find(':'));
    text.remove_prefix(parsed.host.size());
  }
  if (parsed.host.empty() || !readPort(text, parsed.port)) return std::nullopt;
  return parsed;
}

bool isAnyHost(std::string_view host) {
  return host == "0.0.0.0" || host == "::";
}

std::string urlToOpen(std::string_view url, std::string_view host) {
  constexpr std::string_view kSchemeEnd = "://";
  const size_t scheme_end = url.find(kSchemeEnd);
  if (scheme_end == std::string_view::npos) return std::string(url);
  const size_t begin = scheme_end + kSchemeEnd.size();
  const size_t end = std::min(url.find('/', begin), url.size());
  std::optional<HostPort> listening = parseHostPort(url.substr(begin, end - begin));
  if (!listening || !isAnyHost(listening->host)) return std::string(url);
  listening->host = host;
  return strCat(url.substr(0, begin), listening->text(), url.substr(end));
}

std::string identityOfHost(std::string_view host) {
  constexpr size_t kSubnetBytes = 8;
  if (isLoopbackHost(host)) return std::string(kThisMachine);
  in6_addr ipv6{};
  const std::string without_zone(host.substr(0, host.find('%')));
  if (inet_pton(AF_INET6, without_zone.c_str(), &ipv6) != 1) return std::string(host);
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (IN6_IS_ADDR_V4MAPPED(&ipv6)) {
    const uint8_t* const mapped = &ipv6.s6_addr[sizeof ipv6.s6_addr - kIpv4Bytes];
    return inet_ntop(AF_INET, mapped, text.data(), text.size());
  }
  std::memset(&ipv6.s6_addr[kSubnetBytes], 0, sizeof ipv6.s6_addr - kSubnetBytes);
  return strCat(inet_ntop(AF_INET6, &ipv6, text.data(), text.size()), "/64");
}

bool isLoopbackHost(std::string_view host) {
  std::string name(host);
  absl::AsciiStrToLower(&name);
  if (name == "localhost" || name.ends_with(".localhost")) return true;
  in_addr ipv4{};
  if (inet_pton(AF_INET, name.c_str(), &ipv4) == 1) {
    return ntohl(ipv4.s_addr) >> 24U == kLoopbackNet;
  }
  in6_addr ipv6{};
  if (inet_pton(AF_INET6, name.c_str(), &ipv6) != 1) return false;
  const uint8_t* const mapped = &ipv6.s6_addr[sizeof ipv6.s6_addr - kIpv4Bytes];
  return IN6_IS_ADDR_LOOPBACK(&ipv6) || (IN6_IS_ADDR_V4MAPPED(&ipv6) && *mapped == kLoopbackNet);
}

}  // namespace viewloom
