// SPDX-License-Identifier: Apache-2.0
#include "tls/exposure.h"

#include <algorithm>

#include "base/host_port.h"
#include "base/str_cat.h"

namespace viewloom {
namespace {

bool staysOnMachine(const std::string& address) {
  const std::optional<HostPort> parsed = parseHostPort(address);
  return address.starts_with("unix:") || (parsed && isLoopbackHost(parsed->host));
}

}  // namespace

ServerReach reachOf(const Exposure& exposure) {
  if (std::ranges::all_of(exposure.addresses, staysOnMachine)) return ServerReach::kMachine;
  return exposure.has_tls && exposure.has_access_control ? ServerReach::kProtected
                                                         : ServerReach::kOpen;
}

std::optional<std::string> refusalToListen(const Exposure& exposure) {
  if (exposure.is_open_wanted || reachOf(exposure) != ServerReach::kOpen) return std::nullopt;
  const auto outside = std::ranges::find_if_not(
      exposure.addresses, [](const auto& one) { return staysOnMachine(one); });
  const std::string missing = exposure.has_tls              ? "access control"
                              : exposure.has_access_control ? "encryption (tls.certificate)"
                                                            : "encryption (tls.certificate) and "
                                                              "access control";
  return strCat("the address ", *outside, " is open to the network without ", missing,
                "; add it, listen on 127.0.0.1, or give --open in a network that you trust");
}

}  // namespace viewloom
