// SPDX-License-Identifier: Apache-2.0
// Opens sockets that listen on an address as the settings write it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace viewloom {

struct ListeningSockets {
  std::vector<int> fds;  // do not block; the caller closes them
  uint16_t port = 0;     // of all of them; 0 = a UNIX socket
};

// HOST:PORT listens on each address of the host, with one port; port 0 takes a free one. "[::]"
// takes IPv4 also. unix:PATH replaces a socket at PATH, and no other file. None when the address
// cannot be had: another program has the port, or the address is not of this machine. An address of
// a kind that this machine lacks (IPv6) is left out, if the host has others.
ListeningSockets openListeningSockets(const std::string& address);

// Closes sockets that were opened for that address, and removes the file of unix:PATH.
void closeListeningSockets(const std::string& address, const std::vector<int>& fds);

}  // namespace viewloom
