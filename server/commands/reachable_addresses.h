// SPDX-License-Identifier: Apache-2.0
// Addresses at which other machines reach this one.
#pragma once

#include <string>
#include <vector>

namespace viewloom {

// The addresses of this machine's network interfaces that other machines may reach: neither
// loopback nor link-local. IPv6 ones are in brackets.
struct InterfaceAddresses {
  std::vector<std::string> ipv4;
  std::vector<std::string> ipv6;
};
InterfaceAddresses interfaceAddresses();

// "HOST:PORT" for each way to reach a server that listens at `listening`, a HOST:PORT. Empty for
// loopback and unix sockets. [::] takes both families.
std::vector<std::string> reachableAddresses(const std::string& listening,
                                            const InterfaceAddresses& interfaces);

}  // namespace viewloom
