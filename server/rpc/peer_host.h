// SPDX-License-Identifier: Apache-2.0
// The host of a call's other end.
#pragma once

#include <string>
#include <string_view>

namespace viewloom {

// `peer` as gRPC names it: "ipv4:10.0.0.7:4711" gives "10.0.0.7". Connections that do not leave
// this machine give "this machine".
std::string peerHost(std::string_view peer);

}  // namespace viewloom
