// SPDX-License-Identifier: Apache-2.0
#include "rpc/open_sockets.h"

#include <sys/stat.h>

#include <optional>
#include <utility>

namespace viewloom {
namespace {

// None where nothing is open at that descriptor.
std::optional<ino_t> inodeOf(int fd) {
  struct stat file {};
  if (fstat(fd, &file) != 0) return std::nullopt;
  return file.st_ino;
}

}  // namespace

void OpenSockets::add(int fd, Reservation memory) {
  if (const std::optional<ino_t> inode = inodeOf(fd)) {
    sockets_.push_back({fd, *inode, std::move(memory)});
  }
}

size_t OpenSockets::count() {
  std::erase_if(sockets_, [](const Socket& socket) { return inodeOf(socket.fd) != socket.inode; });
  return sockets_.size();
}

}  // namespace viewloom
