// SPDX-License-Identifier: Apache-2.0
// The host of the other end of a call or connection.
#pragma once

#include <string>
#include <string_view>

namespace viewloom {

// `peer` as gRPC names it: "ipv4:10.0.0.7:4711" gives "10.0.0.7". Connections that do not leave
// this machine give "this machine".
std::string peerHost(std::string_view peer);
// The same of a connected socket.
std::string peerHost(int fd);

}  // namespace viewloom
