// SPDX-License-Identifier: Apache-2.0
#include "commands/reachable_addresses.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <array>
#include <memory>
#include <optional>

#include "base/host_port.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

void add(const in_addr& address, InterfaceAddresses& found) {
  std::array<char, INET_ADDRSTRLEN> text{};
  const uint32_t bits = ntohl(address.s_addr);
  const bool is_link_local = (bits >> 16U) == 0xa9fe;  // 169.254.0.0/16
  if (is_link_local || inet_ntop(AF_INET, &address, text.data(), text.size()) == nullptr) return;
  found.ipv4.emplace_back(text.data());
}

void add(const in6_addr& address, InterfaceAddresses& found) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (IN6_IS_ADDR_LINKLOCAL(&address) || IN6_IS_ADDR_LOOPBACK(&address)) return;
  if (inet_ntop(AF_INET6, &address, text.data(), text.size()) == nullptr) return;
  found.ipv6.push_back(std::string("[") + text.data() + "]");
}

}  // namespace

InterfaceAddresses interfaceAddresses() {
  InterfaceAddresses found;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return found;
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(list, &freeifaddrs);
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    const bool is_up = (entry->ifa_flags & IFF_UP) != 0 && (entry->ifa_flags & IFF_LOOPBACK) == 0;
    if (!is_up || entry->ifa_addr == nullptr) continue;
    if (entry->ifa_addr->sa_family == AF_INET) {
      add(reinterpret_cast<const sockaddr_in*>(entry->ifa_addr)->sin_addr, found);
    } else if (entry->ifa_addr->sa_family == AF_INET6) {
      add(reinterpret_cast<const sockaddr_in6*>(entry->ifa_addr)->sin6_addr, found);
    }
  }
  return found;
}

std::vector<std::string> reachableAddresses(const std::string& listening,
                                            const InterfaceAddresses& interfaces) {
  const std::optional<HostPort> parsed = parseHostPort(listening);
  if (listening.starts_with("unix:") || !parsed || !parsed->port) return {};
  if (isLoopbackHost(parsed->host)) return {};
  const bool takes_ipv6 = parsed->host == "::";
  if (!isAnyHost(parsed->host)) return {listening};
  const std::string port = strCat(":", *parsed->port);
  std::vector<std::string> addresses;
  for (const std::string& address : interfaces.ipv4) addresses.push_back(address + port);
  if (!takes_ipv6) return addresses;
  for (const std::string& address : interfaces.ipv6) addresses.push_back(address + port);
  return addresses;
}

}  // namespace viewloom
